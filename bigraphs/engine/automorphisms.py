"""The automorphisms of a rule: occurrences that a symmetry maps to each other count once.

A symmetry of a redex permutes its nodes, links, regions and sites. It is a symmetry of the rule if it also preserves
the reactum. So `A{x} | A{y} --> B{x} | B{y}` has a symmetry, and `A{x} | A{y} --> B{x} | A{y}` has none.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

from bigraphs.bigraph import Bigraph, Link, Node, Place, assemble, moved
from bigraphs.canonical_form import equal
from bigraphs.engine.intern_tables import InternTables, has_sharing
from bigraphs.engine.occurrence_search import Matcher
from bigraphs.engine.patterns import CompiledPattern, compile_pattern
from bigraphs.engine.search_state import PatternOccurrence
from bigraphs.engine.state_arrays import make_state
from bigraphs.signature import Control, Signature
from bigraphs.system import Rule


@dataclass(frozen=True, slots=True)
class Automorphism:
    """The image of each node and each link under a symmetry."""

    nodes: tuple[int, ...]
    links: tuple[int, ...]

    def of(self, occurrence: PatternOccurrence) -> tuple[tuple[int, ...], tuple[int, ...]]:
        """Return the nodes and links of an occurrence, permuted by the symmetry."""
        nodes, links = occurrence.nodes, occurrence.links
        return tuple([nodes[node] for node in self.nodes]), tuple([links[link] for link in self.links])


class Representatives:
    """Selects one representative of each set of symmetric occurrences.

    The search already orders twins (`CompiledPattern.twins`); this class handles all other symmetries.
    """

    def __init__(self, pattern: CompiledPattern, symmetries: Sequence[Automorphism]) -> None:
        self.twins = pattern.twins
        self.symmetries = symmetries

    def choose(self, occurrences: list[PatternOccurrence]) -> list[PatternOccurrence]:
        """Return the representatives among the occurrences, in the given order."""
        return list(filter(self.chosen, occurrences)) if self.symmetries else occurrences

    def chosen(self, occurrence: PatternOccurrence) -> bool:
        """Return whether an occurrence is the least of its symmetric images."""
        mine = (occurrence.nodes, occurrence.links)
        return all(self.ordered(*symmetry.of(occurrence)) >= mine for symmetry in self.symmetries)

    def ordered(
        self, nodes: tuple[int, ...], links: tuple[int, ...]
    ) -> tuple[tuple[int, ...], tuple[int, ...]]:
        """Return the nodes and links with twins in order, as the search returns them."""
        if not self.twins:
            return nodes, links
        found = list(nodes)
        for group in self.twins:
            for place, slot in zip(group, sorted(nodes[node] for node in group), strict=True):
                found[place] = slot
        return tuple(found), links


def symmetries(rule: Rule, pattern: CompiledPattern) -> tuple[Automorphism, ...]:
    """Return the symmetries of a rule up to exchanges of twins, without the identity."""
    width = len(rule.redex.sites)
    closed = _with_markers(rule.redex, range(width), width)
    result = _with_markers(rule.reactum, rule.instantiation, width)
    found = []
    for occurrence in _self_matches(closed):
        nodes = occurrence.nodes[: pattern.size]
        symmetry = Automorphism(nodes, occurrence.links)
        if symmetry == Automorphism(tuple(range(pattern.size)), tuple(range(len(occurrence.links)))):
            continue
        if equal(result, _seen_through(result, closed, occurrence, pattern.size)):
            found.append(symmetry)
    return tuple(found)


def _with_markers(bigraph: Bigraph, sites: Sequence[int], width: int) -> Bigraph:
    """Return a ground bigraph in which a node replaces each site; its control is the number of the redex site."""
    kinds = [Control(f"${site}", 0) for site in range(width)]
    markers = [
        Node(f"${site}", None, (), parents) for site, parents in zip(sites, bigraph.sites, strict=True)
    ]
    return replace(
        bigraph,
        signature=Signature((*bigraph.signature.controls, *kinds)),
        nodes=(*bigraph.nodes, *markers),
        sites=(),
    )


def _self_matches(marked: Bigraph) -> list[PatternOccurrence]:
    """Return every map of a redex to itself that preserves nodes, nesting and links; twins are in order."""
    site = Control("$", 0)
    kinds = [control for control in marked.signature.controls if not control.name.startswith("$")]
    alike = replace(
        marked,
        signature=Signature((*kinds, site)),
        nodes=tuple(replace(node, control=_plain(node.control)) for node in marked.nodes),
    )
    world = InternTables(alike.signature, alike.outer_names, alike.regions, sharing=has_sharing(alike))
    pattern = compile_pattern(world, alike)
    names = set(range(pattern.names))
    return [
        found
        for found in Matcher(world, pattern).find(make_state(world, alike))
        if len(set(found.links)) == len(found.links)
        and set(found.links[: pattern.names]) == names
        and _region_map(marked, found) is not None
    ]


def _plain(control: str) -> str:
    return "$" if control.startswith("$") else control


def _region_map(marked: Bigraph, symmetry: PatternOccurrence) -> dict[Place, Place] | None:
    """Return the images of the regions, or None if the nodes of one region are not mapped to one region."""
    tops = [
        {number for number, node in enumerate(marked.nodes) if ~region in node.parents}
        for region in range(marked.regions)
    ]
    found: dict[Place, Place] = {}
    for region, top in enumerate(tops):
        image = {symmetry.nodes[number] for number in top}
        there = [~other for other, held in enumerate(tops) if held == image and ~other not in found.values()]
        if not there:
            return None
        found[~region] = there[0]
    return found


def _seen_through(result: Bigraph, marked: Bigraph, symmetry: PatternOccurrence, size: int) -> Bigraph:
    """Return the reactum with its regions, names and sites renamed by a symmetry of the redex."""
    regions = _region_map(marked, symmetry) or {}
    names = marked.outer_names
    renamed = {name: names[symmetry.links[number]] for number, name in enumerate(names)}
    sites = {
        marked.nodes[number].control: marked.nodes[symmetry.nodes[number]].control
        for number in range(size, len(marked.nodes))
    }

    def link(old: Link) -> Link:
        return renamed[old] if isinstance(old, str) else old

    nodes = [
        replace(
            moved(node, lambda place: (regions.get(place, place),), link),
            control=sites.get(node.control, node.control),
        )
        for node in result.nodes
    ]
    return assemble(
        result.signature, nodes, regions=result.regions, edges=result.edges, outer_names=result.outer_names
    )
