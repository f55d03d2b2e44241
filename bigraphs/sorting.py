"""Sorts: the permitted content of nodes and the ports that a link may join (simple sortings, after Milner).

A control without a place sort may hold anything. A port without a link sort may be joined only with other such ports. A
sort of `A` applies to every `A(1)`, `A(2)`, ... of a parametrised control.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import dataclass

from bigraphs.bigraph import Bigraph, Link, Place, children, points, sites_in
from bigraphs.node_labels import link_label
from bigraphs.rules import ReactionRule
from bigraphs.signature import Signature


@dataclass(frozen=True, slots=True)
class LinkSort:
    """A named set of ports: each is a control with a port number, or with None for all its ports."""

    name: str
    ports: tuple[tuple[str, int | None], ...]


@dataclass(frozen=True, slots=True)
class Sorting:
    """The permitted content of each control, and the sorts of links; both sorted by name."""

    places: tuple[tuple[str, tuple[str, ...]], ...] = ()
    links: tuple[LinkSort, ...] = ()

    def allows(self, parent: str, child: str) -> bool:
        """Return whether a node may be directly inside another, by their controls."""
        content = dict(self.places).get(base(parent))
        return content is None or base(child) in content

    def sort_of(self, control: str, port: int) -> str | None:
        """Return the link sort of a port."""
        named = base(control)
        return next(
            (sort.name for sort in self.links if {(named, None), (named, port)} & {*sort.ports}), None
        )


UNSORTED = Sorting()


def base(control: str) -> str:
    """Return the name of a control without its parameters.

    >>> base("Buffer(3)")
    'Buffer'
    """
    return control.partition("(")[0]


def violations(bigraph: Bigraph, sorting: Sorting) -> Iterator[str]:
    """Yield the violations of a sorting in a bigraph."""
    for node in bigraph.nodes:
        for parent in node.parents:
            if parent >= 0 and not sorting.allows(bigraph.nodes[parent].control, node.control):
                yield f"{node} is in {bigraph.nodes[parent]}, which may not hold it"
    for link in points(bigraph):
        joined = sorts_on(bigraph, link, sorting)
        if len(joined) > 1:
            yield f"the link {link_label(link)} joins ports of sort {_listed(joined)}"


def sorts_on(bigraph: Bigraph, link: Link, sorting: Sorting) -> set[str | None]:
    """Return the sorts of the ports on a link."""
    found = set()
    for number, port in points(bigraph)[link]:
        control = bigraph.nodes[number].control
        found.add(sorting.sort_of(control, port if bigraph.signature[control].ordered else 0))
    return found


def _listed(sorts: Iterable[str | None]) -> str:
    return " and ".join(sorted(sort or "none" for sort in sorts))


def unkept(rule: ReactionRule, signature: Signature, sorting: Sorting) -> Iterator[str]:
    """Yield the ways in which a rule can turn a sorted bigraph into an unsorted one.

    The context of a redex and the content of its sites are assumed to be sorted, and otherwise arbitrary.
    """
    for side, bigraph in (("redex", rule.redex), ("reactum", rule.reactum)):
        yield from (f"in the {side}, {found}" for found in violations(bigraph, sorting))
    yield from _region_content(rule, signature, sorting)
    yield from _site_content(rule, signature, sorting)
    for name in rule.redex.outer_names:
        before, after = (sorts_on(side, name, sorting) for side in (rule.redex, rule.reactum))
        if before and after and before != after:
            yield f"the link {name} joins ports of sort {_listed(before)} before, of {_listed(after)} after"


def _holders(rule: ReactionRule, region: Place, signature: Signature, sorting: Sorting) -> list[str]:
    """Return the controls of the nodes that may contain a region of the redex."""
    tops = {rule.redex.nodes[child].control for child in children(rule.redex)[region]}
    return [
        control.name
        for control in signature.controls
        if control.status != "atomic" and all(sorting.allows(control.name, top) for top in tops)
    ]


def _region_content(rule: ReactionRule, signature: Signature, sorting: Sorting) -> Iterator[str]:
    inside = children(rule.reactum)
    for region in range(-rule.redex.regions, 0):
        for holder in _holders(rule, region, signature, sorting):
            for child in inside[region]:
                control = rule.reactum.nodes[child].control
                if not sorting.allows(holder, control):
                    yield f"the redex may be in {holder}, which may not hold the {control} of the reactum"


def _site_content(rule: ReactionRule, signature: Signature, sorting: Sorting) -> Iterator[str]:
    for place, sites in sorted(sites_in(rule.reactum).items()):
        holders = (
            [rule.reactum.nodes[place].control] if place >= 0 else _holders(rule, place, signature, sorting)
        )
        for site in sites:
            source = [parent for parent in rule.redex.sites[rule.instantiation[site]] if parent >= 0]
            around = [rule.redex.nodes[parent].control for parent in source]
            for control in signature.controls:
                if all(sorting.allows(parent, control.name) for parent in around):
                    for holder in holders:
                        if not sorting.allows(holder, control.name):
                            yield f"site {site} may hold {control.name}, and is put into {holder}, which may not"
