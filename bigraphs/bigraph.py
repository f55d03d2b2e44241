"""Concrete bigraphs: a place graph and a link graph over the same nodes, as one immutable value.

Places are integers: node `n` is place `n`, region `r` is place `~r` (-1, -2, ...). A link is the number of an edge or,
as a string, an outer name. A node with several parents is shared (Sevegnani and Calder). A site may have no parent; the
content of such a site must have a parent of its own. A name identifies its node; nodes without a name, and all edges,
are anonymous.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Collection, Iterable, Mapping, Sequence
from dataclasses import dataclass
from typing import Final, TypeAlias

from bigraphs.errors import BigraphError, counted
from bigraphs.interface import Interface
from bigraphs.signature import Signature

Place: TypeAlias = int
Link: TypeAlias = int | str

MOST_DRAWN: Final = 200
"""The largest number of nodes that notebooks draw automatically."""


@dataclass(frozen=True, slots=True)
class Node:
    """A node: its control, its optional name, the link of each port, and its parents."""

    control: str
    name: str | None = None
    ports: tuple[Link, ...] = ()
    parents: tuple[Place, ...] = (~0,)

    def __str__(self) -> str:
        return f"{self.name}:{self.control}" if self.name else self.control


@dataclass(frozen=True, slots=True)
class Bigraph:
    """A bigraph in normal order; build it with `assemble`, `from_relations`, the algebra or a notation.

    `sites` holds the parents of each site; `inner_links` the link of each inner name, sorted. Use `==` only if all
    nodes have names, else compare `canonical` forms. The operators are `|` merge product, `//` parallel product, `*`
    tensor product, `@` composition.
    """

    signature: Signature
    nodes: tuple[Node, ...] = ()
    regions: int = 0
    sites: tuple[tuple[Place, ...], ...] = ()
    edges: int = 0
    inner_links: tuple[tuple[str, Link], ...] = ()
    outer_names: tuple[str, ...] = ()

    def __post_init__(self) -> None:
        check(self)

    @property
    def inner(self) -> Interface:
        """Return the inner face: the sites and the inner names."""
        return Interface(len(self.sites), tuple(name for name, _ in self.inner_links))

    @property
    def outer(self) -> Interface:
        """Return the outer face: the regions and the outer names."""
        return Interface(self.regions, self.outer_names)

    def __or__(self, other: Bigraph) -> Bigraph:
        from bigraphs.algebra import merge_product  # noqa: PLC0415 - the algebra imports this module

        return merge_product(self, other)

    def __floordiv__(self, other: Bigraph) -> Bigraph:
        from bigraphs.algebra import parallel  # noqa: PLC0415 - the algebra imports this module

        return parallel(self, other)

    def __mul__(self, other: Bigraph) -> Bigraph:
        from bigraphs.algebra import tensor  # noqa: PLC0415 - the algebra imports this module

        return tensor(self, other)

    def __matmul__(self, other: Bigraph) -> Bigraph:
        from bigraphs.algebra import compose  # noqa: PLC0415 - the algebra imports this module

        return compose(self, other)

    def __repr__(self) -> str:
        links = self.edges + len(self.outer_names)
        return (
            f"<Bigraph nodes={len(self.nodes)} links={links} regions={self.regions} sites={len(self.sites)}>"
        )

    def _repr_svg_(self) -> str | None:
        from bigraphs.drawing import draw_bigraph  # noqa: PLC0415 - drawing imports this module

        return draw_bigraph(self)._repr_svg_() if len(self.nodes) <= MOST_DRAWN else None

    def __str__(self) -> str:
        from bigraphs.text import draw_text  # noqa: PLC0415 - drawing imports this module

        return draw_text(self)


def relabelled(bigraph: Bigraph, controls: Mapping[str, str], signature: Signature) -> Bigraph:
    """Return the bigraph with other controls.

    Each new control has the arity, the status and the port order of the old one, so the result needs no check.
    """
    nodes = [
        Node(controls[node.control], node.name, node.ports, node.parents)
        if node.control in controls
        else node
        for node in bigraph.nodes
    ]
    return _with(bigraph, nodes=tuple(nodes) if controls else bigraph.nodes, signature=signature)


def _with(bigraph: Bigraph, **parts: object) -> Bigraph:
    """Return the bigraph with other parts, without a check: the caller guarantees a valid bigraph."""
    found = object.__new__(Bigraph)
    for name in Bigraph.__slots__:
        object.__setattr__(found, name, parts[name] if name in parts else getattr(bigraph, name))
    return found


def link_key(link: Link) -> tuple[bool, Link]:
    """Order edges before names."""
    return isinstance(link, str), link


def find(bigraph: Bigraph, name: str) -> int | None:
    """Return the number of the node with this name, or None."""
    return next((number for number, node in enumerate(bigraph.nodes) if node.name == name), None)


def children(bigraph: Bigraph) -> dict[Place, list[int]]:
    """Return the nodes in each place, sorted; every place has an entry."""
    found: dict[Place, list[int]] = {place: [] for place in range(-bigraph.regions, len(bigraph.nodes))}
    for number, node in enumerate(bigraph.nodes):
        for parent in node.parents:
            found[parent].append(number)
    return found


def sites_in(bigraph: Bigraph) -> dict[Place, list[int]]:
    """Return the sites in each place that has any, sorted."""
    found: dict[Place, list[int]] = {}
    for site, parents in enumerate(bigraph.sites):
        for parent in parents:
            found.setdefault(parent, []).append(site)
    return found


def points(bigraph: Bigraph) -> dict[Link, list[tuple[int, int]]]:
    """Return the (node, port) pairs on each link, sorted; the list of an idle link is empty."""
    found: dict[Link, list[tuple[int, int]]] = {link: [] for link in links(bigraph)}
    for number, node in enumerate(bigraph.nodes):
        for port, link in enumerate(node.ports):
            found[link].append((number, port))
    return found


def links(bigraph: Bigraph) -> list[Link]:
    """Return every link: edges, then outer names."""
    return [*range(bigraph.edges), *bigraph.outer_names]


def moved(node: Node, places: Callable[[Place], Iterable[Place]], links: Callable[[Link], Link]) -> Node:
    """Return the node with its parents and links mapped."""
    parents = tuple({target: None for parent in node.parents for target in places(parent)})
    return Node(node.control, node.name, tuple(map(links, node.ports)), parents)


def assemble(  # noqa: PLR0913 - keyword arguments, one for each part of a bigraph
    signature: Signature,
    nodes: Sequence[Node],
    *,
    regions: int = 1,
    sites: Sequence[Iterable[Place]] = (),
    edges: int = 0,
    inner_links: Mapping[str, Link] | None = None,
    outer_names: Iterable[str] = (),
) -> Bigraph:
    """Return the bigraph in normal order.

    Named nodes come first, sorted by name; anonymous nodes follow in the given order. Parents are sorted. Edges are
    numbered by their points, so the result does not depend on the order of construction.

    Raises:
        BigraphError: If the parts do not form a bigraph.
    """
    given = Bigraph(
        signature,
        tuple(nodes),
        regions,
        tuple(tuple(sorted(set(parents))) for parents in sites),
        edges,
        tuple(sorted((inner_links or {}).items())),
        tuple(sorted(set(outer_names))),
    )
    return normal(given, sorted(range(len(nodes)), key=lambda number: _name_key(nodes[number], number)))


def _name_key(node: Node, number: int) -> tuple[bool, str, int]:
    return node.name is None, node.name or "", number


def normal(bigraph: Bigraph, order: Sequence[int]) -> Bigraph:
    """Return the same bigraph with its nodes in this order, and all other parts sorted."""
    rank = {number: place for place, number in enumerate(order)}
    edge_rank = _edge_ranks(bigraph, rank)

    def place(old: Place) -> tuple[Place]:
        return (rank.get(old, old),)

    def link(old: Link) -> Link:
        return edge_rank[old] if isinstance(old, int) else old

    renamed = [_tidy(bigraph.signature, moved(bigraph.nodes[number], place, link)) for number in order]
    return _with(
        bigraph,
        nodes=tuple(renamed),
        sites=tuple(tuple(sorted(rank.get(old, old) for old in parents)) for parents in bigraph.sites),
        inner_links=tuple((name, link(old)) for name, old in bigraph.inner_links),
    )


def _tidy(signature: Signature, node: Node) -> Node:
    ports = node.ports if signature[node.control].ordered else tuple(sorted(node.ports, key=link_key))
    return Node(node.control, node.name, ports, tuple(sorted(node.parents)))


def _edge_ranks(bigraph: Bigraph, rank: Mapping[int, int]) -> dict[int, int]:
    """Number edges by their points; edges with the same points are interchangeable."""
    at: list[list[tuple[int, int]]] = [[] for _ in range(bigraph.edges)]
    for number, node in enumerate(bigraph.nodes):
        ordered = bigraph.signature[node.control].ordered
        for port, link in enumerate(node.ports):
            if isinstance(link, int):
                at[link].append((rank[number], port if ordered else 0))
    within: list[list[str]] = [[] for _ in range(bigraph.edges)]
    for name, link in bigraph.inner_links:
        if isinstance(link, int):
            within[link].append(name)
    by_points = sorted(range(bigraph.edges), key=lambda edge: (sorted(at[edge]), within[edge]))
    return {edge: place for place, edge in enumerate(by_points)}


# --- validity: each condition has its own message


def check(bigraph: Bigraph) -> None:
    """Raise BigraphError for the first violated condition of a bigraph; linear in its size."""
    _check_counts(bigraph)
    _check_names(bigraph)
    for node in bigraph.nodes:
        _check_ports(bigraph, node)
        _check_parents(bigraph, node.parents, str(node))
    for site, parents in enumerate(bigraph.sites):
        _check_places(bigraph, parents, f"site {site}")
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
        links = counted(len(node.ports), "link")
        raise BigraphError("arity", f"{node} has {links}, its control has {counted(arity, 'port')}")
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
    _check_places(bigraph, parents, who)


def _check_places(bigraph: Bigraph, parents: tuple[Place, ...], who: str) -> None:
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
    for number in free:  # the list grows during the loop
        for child in below[number]:
            waiting[child] -= 1
            if waiting[child] == 0:
                free.append(child)
    if len(free) < len(bigraph.nodes):
        raise _cycle(bigraph, waiting)


def _cycle(bigraph: Bigraph, waiting: list[int]) -> BigraphError:
    """Return the error that names a cycle: follow blocked parents until one repeats."""
    number = next(number for number, count in enumerate(waiting) if count > 0)
    path: list[int] = []
    while number not in path:
        path.append(number)
        number = next(
            parent for parent in bigraph.nodes[number].parents if parent >= 0 and waiting[parent] > 0
        )
    round_trip = " in ".join(str(bigraph.nodes[step]) for step in [*path[path.index(number) :], number])
    return BigraphError("cycle", f"places contain each other: {round_trip}", "take one of them out")
