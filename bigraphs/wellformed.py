"""What makes a bigraph one: each way to fail has its own message."""

from __future__ import annotations

from collections import Counter
from collections.abc import Collection
from typing import TYPE_CHECKING

from bigraphs.errors import BigraphError

if TYPE_CHECKING:  # the value checks itself with these functions
    from bigraphs.bigraph import Bigraph, Link, Node, Place


def check(bigraph: Bigraph) -> None:
    """Raise BigraphError at the first thing that makes this no bigraph; linear in its size."""
    _check_counts(bigraph)
    _check_names(bigraph)
    for node in bigraph.nodes:
        _check_ports(bigraph, node)
        _check_parents(bigraph, node.parents, str(node))
    for site, parents in enumerate(bigraph.sites):
        _check_parents(bigraph, parents, f"site {site}")
    for name, link in bigraph.inner_links:
        _check_link(bigraph, link, f"inner name '{name}'")
    _check_acyclic(bigraph)


def _check_counts(bigraph: Bigraph) -> None:
    if bigraph.regions < 0 or bigraph.edges < 0:
        raise BigraphError("count", "regions and edges are counted from 0")


def _check_names(bigraph: Bigraph) -> None:
    _check_distinct("node", [node.name for node in bigraph.nodes if node.name is not None])
    _check_distinct("inner name", [name for name, _ in bigraph.inner_links])
    _check_distinct("outer name", bigraph.outer_names)


def _check_distinct(what: str, names: Collection[str]) -> None:
    if len(set(names)) == len(names) and all(name.isprintable() and name for name in names):
        return
    for name, times in sorted(Counter(names).items()):
        if not name:
            raise BigraphError("name", f"an empty {what}", "leave the name out, or give it letters")
        if not name.isprintable():
            raise BigraphError("name", f"{what} {name!r} has a character that cannot be shown")
        if times > 1:
            raise BigraphError(
                "name", f"{what} '{name}' is there {times} times", "a name identifies one of them"
            )


def _check_ports(bigraph: Bigraph, node: Node) -> None:
    arity = bigraph.signature[node.control].arity
    if arity is not None and arity != len(node.ports):
        raise BigraphError("arity", f"{node} has {len(node.ports)} links, its control has {arity} ports")
    for link in node.ports:
        _check_link(bigraph, link, str(node))


def _check_link(bigraph: Bigraph, link: Link, who: str) -> None:
    if isinstance(link, str):
        if link not in bigraph.outer_names:
            raise BigraphError("link", f"{who} is linked to '{link}', which is no outer name of the bigraph")
    elif not 0 <= link < bigraph.edges:
        raise BigraphError("link", f"{who} is linked to edge {link} of {bigraph.edges}")


def _check_parents(bigraph: Bigraph, parents: tuple[Place, ...], who: str) -> None:
    if not parents:
        raise BigraphError("parent", f"{who} has no parent", "put it into a node or a region")
    for parent in parents:
        if not -bigraph.regions <= parent < len(bigraph.nodes):
            what = f"region {~parent}" if parent < 0 else f"node {parent}"
            raise BigraphError("parent", f"{who} is in {what}, which the bigraph does not have")
        if parent >= 0:
            _check_holds(bigraph, bigraph.nodes[parent], who)


def _check_holds(bigraph: Bigraph, parent: Node, who: str) -> None:
    if bigraph.signature[parent.control].status == "atomic":
        raise BigraphError("atomic", f"{who} is in {parent}, whose control is atomic and holds nothing")


def _check_acyclic(bigraph: Bigraph) -> None:
    waiting = [sum(parent >= 0 for parent in node.parents) for node in bigraph.nodes]
    below: list[list[int]] = [[] for _ in bigraph.nodes]
    for number, node in enumerate(bigraph.nodes):
        for parent in node.parents:
            if parent >= 0:
                below[parent].append(number)
    free = [number for number, count in enumerate(waiting) if count == 0]
    for number in free:  # grows while it is walked
        for child in below[number]:
            waiting[child] -= 1
            if waiting[child] == 0:
                free.append(child)
    if len(free) < len(bigraph.nodes):
        raise _cycle(bigraph, waiting)


def _cycle(bigraph: Bigraph, waiting: list[int]) -> BigraphError:
    """Walk parents that never became free until one repeats."""
    number = next(number for number, count in enumerate(waiting) if count > 0)
    path: list[int] = []
    while number not in path:
        path.append(number)
        number = next(
            parent for parent in bigraph.nodes[number].parents if parent >= 0 and waiting[parent] > 0
        )
    round_trip = " in ".join(str(bigraph.nodes[step]) for step in [*path[path.index(number) :], number])
    return BigraphError("cycle", f"places contain each other: {round_trip}", "take one of them out")
