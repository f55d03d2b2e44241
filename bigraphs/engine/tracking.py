"""Node identity in a rule: the nodes of the reactum that are nodes of the redex."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence

from bigraphs.bigraph import Bigraph, children

Pairing = Callable[[int, int], bool]


def track(redex: Bigraph, reactum: Bigraph) -> tuple[int, ...]:
    """Return for each node of the reactum its node of the redex, or -1 for a new node.

    A named node is the node of the same name. An anonymous node takes a free node of the same control: preferably with
    the same links and the same place, else the same links, else the same place, else any. Places are compared as nodes,
    so a node that keeps its neighbours keeps its identity.
    """
    found = [-1] * len(reactum.nodes)
    for fits in _passes(redex, reactum, found):
        for number in top_down(reactum):
            if found[number] < 0:
                free = (old for old in range(len(redex.nodes)) if old not in found)
                alike = (old for old in free if _same_kind(redex, reactum, old, number))
                found[number] = next((old for old in alike if fits(old, number)), -1)
    return tuple(found)


def track_edges(redex: Bigraph, reactum: Bigraph, nodes: tuple[int, ...]) -> tuple[int, ...]:
    """Return for each edge of the reactum its edge of the redex, one that shares a tracked node, or -1."""
    found: list[int] = []
    for edge in range(reactum.edges):
        on = [nodes[number] for number, node in enumerate(reactum.nodes) if edge in node.ports]
        olds = (link for old in on if old >= 0 for link in redex.nodes[old].ports if isinstance(link, int))
        found.append(next((link for link in olds if link not in found), -1))
    return tuple(found)


def _same_kind(redex: Bigraph, reactum: Bigraph, old: int, new: int) -> bool:
    one, other = redex.nodes[old], reactum.nodes[new]
    return one.control == other.control and one.name == other.name


def _passes(redex: Bigraph, reactum: Bigraph, found: list[int]) -> list[Pairing]:
    def links(old: int, new: int) -> bool:
        return _open(redex, old) == _open(reactum, new)

    def place(old: int, new: int) -> bool:
        return traced(reactum.nodes[new].parents, found) == set(redex.nodes[old].parents)

    return [
        lambda old, new: links(old, new) and place(old, new),
        links,
        place,
        lambda _old, _new: True,
    ]


def traced(places: Iterable[int], nodes: Sequence[int]) -> set[int | None]:
    """Return places of the reactum as places of the redex; a new node becomes None."""
    return {(nodes[place] if nodes[place] >= 0 else None) if place >= 0 else place for place in places}


def _open(bigraph: Bigraph, number: int) -> list[str]:
    return [link if isinstance(link, str) else "" for link in bigraph.nodes[number].ports]


def top_down(bigraph: Bigraph) -> list[int]:
    """Return the nodes, each after its parents."""
    inside, order = children(bigraph), list[int]()
    waiting = [len(node.parents) for node in bigraph.nodes]
    places: list[int] = [~region for region in range(bigraph.regions)]
    for place in places:  # the list grows during the loop
        for child in inside[place]:
            waiting[child] -= 1
            if waiting[child] == 0:
                order.append(child)
                places.append(child)
    return order
