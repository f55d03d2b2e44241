"""The conditions on redexes and patterns that make occurrences unambiguous and searchable."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace

from bigraphs.algebra import lean
from bigraphs.bigraph import Bigraph, assemble, points, sites_in


def faults(redex: Bigraph) -> Iterator[tuple[str, str]]:
    """Yield each violation of BigraphER's condition of solid redexes, with a remedy."""
    inhabited = {parent for node in redex.nodes for parent in node.parents}
    for region in range(redex.regions):
        if ~region not in inhabited:
            yield f"region {region} of the redex has no node, so it would be anywhere", "put a node into it"
    if redex.inner_links:
        yield (
            f"the redex has the inner name '{redex.inner_links[0][0]}'",
            "a rule has sites, but no inner names",
        )
    yield from _faults_of_sites(redex)
    yield from _faults_of_sharing(redex)
    for name, on in points(redex).items():
        if isinstance(name, str) and not on:
            yield f"no port of the redex is on '{name}', so it would be any link", "leave it out"


def _faults_of_sites(redex: Bigraph) -> Iterator[tuple[str, str]]:
    for site, parents in enumerate(redex.sites):
        if not parents or any(parent < 0 for parent in parents):
            hint = "leave it out: the context of the redex stays as it is"
            yield f"site {site} of the redex is in no node", hint
    for place, sites in sorted(sites_in(redex).items()):
        if place >= 0 and len(sites) > 1:
            found = f"sites {sites[0]} and {sites[1]} of the redex are in one place"
            yield found, "one site holds all there is"


def _faults_of_sharing(redex: Bigraph) -> Iterator[tuple[str, str]]:
    if any(sum(parent < 0 for parent in node.parents) > 1 for node in redex.nodes):
        yield "a node of the redex is in two regions", "put them into nodes, or into one region"


def pattern_of(bigraph: Bigraph) -> Bigraph:
    """Return a pattern without parts that match anything: idle names, sites in regions, empty regions."""
    inhabited = {parent for node in bigraph.nodes for parent in node.parents}
    kept = [region for region in range(bigraph.regions) if ~region in inhabited]
    names = _used_names(bigraph)
    if len(kept) == bigraph.regions and len(names) == len(bigraph.outer_names) and _sites_ask(bigraph):
        return lean(bigraph)
    rank = {~region: ~place for place, region in enumerate(kept)}
    nodes = [
        replace(node, parents=tuple(rank.get(parent, parent) for parent in node.parents))
        for node in bigraph.nodes
    ]
    found = assemble(
        bigraph.signature,
        nodes,
        regions=len(kept),
        sites=sorted(
            {parents for parents in bigraph.sites if parents and all(parent >= 0 for parent in parents)}
        ),
        edges=bigraph.edges,
        inner_links=dict(bigraph.inner_links),
        outer_names=names,
    )
    return lean(found)


def _sites_ask(bigraph: Bigraph) -> bool:
    """Return whether each site is meaningful: distinct, sorted and inside nodes, where it permits more content."""
    distinct = len(set(bigraph.sites)) == len(bigraph.sites) and list(bigraph.sites) == sorted(bigraph.sites)
    return distinct and all(parents and all(parent >= 0 for parent in parents) for parents in bigraph.sites)


def _used_names(bigraph: Bigraph) -> list[str]:
    within = {link for _, link in bigraph.inner_links}
    return [name for name, on in points(bigraph).items() if isinstance(name, str) and (on or name in within)]
