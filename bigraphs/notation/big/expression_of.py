"""The expression of a bigraph; it elaborates to an equal bigraph."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from typing import Final

from bigraphs.bigraph import Bigraph, Link, Node, Place, children, sites_in
from bigraphs.errors import BigraphError
from bigraphs.notation.big.printer import format_expression
from bigraphs.notation.big.syntax import (
    Arguments,
    Chain,
    Close,
    Expression,
    Identity,
    Ion,
    Literal,
    Negated,
    Nest,
    NewNames,
    Number,
    PlacingLiteral,
    Share,
    Substitute,
    ValueExpression,
    Wired,
)
from bigraphs.system import Value

DEEPEST: Final = 90
"""The deepest nesting of places in a written text: each level may need a dot and a parenthesis, with sharing two."""


def write_big(bigraph: Bigraph) -> str:
    """Return the text of a bigraph; raises BigraphError for a named node, and for places that nest too deeply.

    >>> from bigraphs.relational_bigraphs import from_relations
    >>> from dataclasses import replace
    >>> one = from_relations({"u": "UAV", "a": "Area"}, {"u": "a"}, {"net": ["u"]})
    >>> write_big(replace(one, nodes=tuple(replace(node, name=None) for node in one.nodes)))
    'Area.UAV{net}.1'
    """
    return format_expression(expression_of(bigraph))


def expression_of(bigraph: Bigraph) -> Expression:
    """Return an expression of a bigraph: closures, then places side by side, then wires."""
    for node in bigraph.nodes:
        if node.name is not None:
            raise BigraphError(
                "notation", f"this notation cannot name a node, as {node}", "use the paper's notation"
            )
    if _depth(bigraph) > DEEPEST:
        hint = "the texts that are read nest no deeper"
        raise BigraphError("too-deep", f"places nest deeper than {DEEPEST}", hint)
    edges = _edge_names(bigraph)
    shared = any(len(parents) > 1 for parents in [*(node.parents for node in bigraph.nodes), *bigraph.sites])
    places = _layers(bigraph, edges) if shared else _nested(bigraph, edges)
    parts = [*places, *_wires(bigraph, edges)]
    body = _chain("||", parts) if parts else Identity(0)
    return Wired(tuple(Close((name,)) for name in edges), body) if edges else body


def _depth(bigraph: Bigraph) -> int:
    """Return the nesting depth of nodes, at most DEEPEST plus 1."""
    inside = children(bigraph)
    layer: set[Place] = set(range(-bigraph.regions, 0))
    depth = 0
    while layer and depth <= DEEPEST:
        layer = {child for place in layer for child in inside[place]}
        depth += bool(layer)
    return depth


def _edge_names(bigraph: Bigraph) -> list[str]:
    taken = {*bigraph.outer_names, *(name for name, _ in bigraph.inner_links)}
    free = (name for name in map("e{}".format, range(bigraph.edges + len(taken))) if name not in taken)
    return [name for _, name in zip(range(bigraph.edges), free, strict=False)]


def _named(link: Link, edges: Sequence[str]) -> str:
    return link if isinstance(link, str) else edges[link]


def _chain(operator: str, parts: Sequence[Expression]) -> Expression:
    return Chain(parts[0], tuple((operator, part) for part in parts[1:])) if len(parts) > 1 else parts[0]


def _wires(bigraph: Bigraph, edges: Sequence[str]) -> list[Expression]:
    """Return substitutions for inner names, and the idle names."""
    grouped: dict[str, list[str]] = {}
    for name, link in bigraph.inner_links:
        grouped.setdefault(_named(link, edges), []).append(name)
    used = {_named(link, edges) for node in bigraph.nodes for link in node.ports} | set(grouped)
    idle = tuple(name for name in (*bigraph.outer_names, *edges) if name not in used)
    wires: list[Expression] = [Substitute(outer, tuple(inner)) for outer, inner in sorted(grouped.items())]
    return [*wires, NewNames(idle)] if idle else wires


def _ion(node: Node, edges: Sequence[str]) -> Ion:
    name, _, parameters = node.control.partition("(")
    return Ion(name, tuple(_named(link, edges) for link in node.ports), values_of(parameters))


def values_of(parameters: str) -> Arguments:
    """Return the values in `1,2.5,"a")`, the part after the opening parenthesis of a parametrised control's name."""
    return tuple(map(_literal, parameters.removesuffix(")").split(","))) if parameters else ()


def _literal(written: str) -> ValueExpression:
    if written.startswith('"'):
        return Literal(written.strip('"'))
    number = float(written) if set(written) & set(".einf") else int(written)
    return written_value(number)


def written_value(value: Value) -> ValueExpression:
    """Return the expression of a value; a negative number gets a sign."""
    if isinstance(value, str) or value >= 0:
        return Literal(value)
    return Negated(Literal(-value))


def _nested(bigraph: Bigraph, edges: Sequence[str]) -> list[Expression]:
    """Return one expression per region; if sites are out of order, their composition with a permutation."""
    inside, sited = children(bigraph), sites_in(bigraph)
    written: list[int] = []

    def within(place: Place) -> Expression:
        parts: list[Expression] = []
        for child in inside[place]:
            ion = _ion(bigraph.nodes[child], edges)
            atomic = bigraph.signature[bigraph.nodes[child].control].status == "atomic"
            parts.append(ion if atomic else Nest(ion, within(child)))
        written.extend(sited.get(place, ()))
        parts.extend(Identity() for _ in sited.get(place, ()))
        return _chain("|", parts) if parts else Number(1)

    regions = [within(~region) for region in range(bigraph.regions)]
    if written == sorted(written):
        return regions
    rank = {site: place for place, site in enumerate(written)}
    order = PlacingLiteral(tuple((rank[site],) for site in range(len(written))), len(written))
    return [Chain(_chain("||", regions), (("*", order),))]


def _layers(bigraph: Bigraph, edges: Sequence[str]) -> list[Expression]:
    """Return one expression that builds shared places in layers: each layer fills the slots of the previous ones.

    The content of a node is written inside it if it has no other place and no site.
    """
    inside = children(bigraph)
    closed = {number: inside[number] for number in _closed(bigraph)}
    slots: list[Place] = [~region for region in range(bigraph.regions)]
    found: Expression = Identity(len(slots))
    within = {child for content in closed.values() for child in content}
    waiting = [number for number in range(len(bigraph.nodes)) if number not in within]
    while waiting:
        layer = [number for number in waiting if set(bigraph.nodes[number].parents) <= set(slots)]
        waiting = [number for number in waiting if number not in layer]
        kept = [place for place in slots if place in _needed(bigraph, waiting)]
        whats = [_content(bigraph, edges, number, closed) for number in layer]
        names = sorted({name for number in layer for name in _links_within(bigraph, edges, number, closed)})
        where = _chain("||", [found, Identity(0, tuple(names))]) if names else found
        found = _shared(whats, [bigraph.nodes[number].parents for number in layer], kept, slots, where)
        slots = [*(number for number in layer if number not in closed), *kept]
    rank = {place: slot for slot, place in enumerate(slots)}
    sites = PlacingLiteral(
        tuple(tuple(rank[place] for place in parents) for parents in bigraph.sites), len(slots)
    )
    in_order = sites == PlacingLiteral(tuple((slot,) for slot in range(len(slots))), len(slots))
    return [found if in_order else Chain(found, (("*", sites),))]


def _closed(bigraph: Bigraph) -> set[int]:
    """Return the nodes whose descendants have single places and no sites, atomic nodes included."""
    inside, sited = children(bigraph), sites_in(bigraph)
    known: dict[int, bool] = {}

    def closed(number: int) -> bool:
        if number not in known:
            known[number] = number not in sited and all(
                len(bigraph.nodes[child].parents) == 1 and closed(child) for child in inside[number]
            )
        return known[number]

    return {number for number in range(len(bigraph.nodes)) if closed(number)}


def _needed(bigraph: Bigraph, waiting: Sequence[int]) -> set[Place]:
    """Return the parents of unwritten nodes and of sites."""
    later = (place for number in waiting for place in bigraph.nodes[number].parents)
    return {*later, *(place for parents in bigraph.sites for place in parents)}


def _content(
    bigraph: Bigraph, edges: Sequence[str], number: int, closed: Mapping[int, Sequence[int]]
) -> Expression:
    """Return a node, with its content if `closed` lists it; `closed` maps a node to its children."""
    ion = _ion(bigraph.nodes[number], edges)
    if number not in closed or bigraph.signature[bigraph.nodes[number].control].status == "atomic":
        return ion
    inside = [_content(bigraph, edges, child, closed) for child in closed[number]]
    return Nest(ion, _chain("|", inside) if inside else Number(1))


def _links_within(
    bigraph: Bigraph, edges: Sequence[str], number: int, closed: Mapping[int, Sequence[int]]
) -> Iterator[str]:
    """Yield the links of a node and of its listed content."""
    yield from (_named(link, edges) for link in bigraph.nodes[number].ports)
    for child in closed.get(number, ()):
        yield from _links_within(bigraph, edges, child, closed)


def _shared(
    whats: Sequence[Expression],
    parents: Sequence[Sequence[Place]],
    kept: Sequence[Place],
    slots: Sequence[Place],
    where: Expression,
) -> Expression:
    rank = {place: slot for slot, place in enumerate(slots)}
    placed = [*parents, *((place,) for place in kept)]
    what = _chain("||", [*whats, *([Identity(len(kept))] if kept else [])])
    return Share(
        what,
        PlacingLiteral(tuple(tuple(rank[place] for place in each) for each in placed), len(slots)),
        where,
    )
