"""The algebra of bigraphs: products, composition, nesting, closure, and the elementary bigraphs."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from functools import reduce
from itertools import chain

from bigraphs.bigraph import Bigraph, Link, Node, Place, assemble, moved
from bigraphs.errors import BigraphError
from bigraphs.interface import Interface
from bigraphs.signature import Signature

EMPTY = Signature()


def compose(context: Bigraph, content: Bigraph) -> Bigraph:
    """Return context ∘ content: each region of the content fills a site of the context, and equal names join.

    Raises:
        BigraphError: Unless the outer face of the content is the inner face of the context.
    """
    if context.inner != content.outer:
        hint = "extend one of them with an identity, or use nest"
        message = f"a context for {context.inner} does not fit a content of {content.outer}"
        raise BigraphError("interface", message, hint)
    joined = dict(context.inner_links)
    shift, edges = len(context.nodes), context.edges

    def places(place: Place) -> tuple[Place, ...]:
        return (place + shift,) if place >= 0 else context.sites[~place]

    def link(old: Link) -> Link:
        return old + edges if isinstance(old, int) else joined[old]

    return assemble(
        context.signature | content.signature,
        (*context.nodes, *(moved(node, places, link) for node in content.nodes)),
        regions=context.regions,
        sites=[chain.from_iterable(map(places, parents)) for parents in content.sites],
        edges=edges + content.edges,
        inner_links={name: link(old) for name, old in content.inner_links},
        outer_names=context.outer_names,
    )


def parallel(*operands: Bigraph) -> Bigraph:
    """Return left || right: the operands side by side, sharing outer names; linear in the total size.

    Raises:
        BigraphError: If two operands have the same inner name.
    """
    nodes: list[Node] = []
    sites: list[tuple[Place, ...]] = []
    inner_links: dict[str, Link] = {}
    signature, regions, edges = EMPTY, 0, 0
    for each in operands:
        _ = Interface(0, tuple(name for name, _ in each.inner_links if name in inner_links)) * each.inner
        places, link = _shifted(len(nodes), regions, edges)
        signature |= each.signature
        nodes.extend(moved(node, places, link) for node in each.nodes)
        sites.extend(tuple(chain.from_iterable(map(places, parents))) for parents in each.sites)
        inner_links.update((name, link(old)) for name, old in each.inner_links)
        regions, edges = regions + each.regions, edges + each.edges
    outer = {name for each in operands for name in each.outer_names}
    return assemble(
        signature,
        nodes,
        regions=regions,
        sites=sites,
        edges=edges,
        inner_links=inner_links,
        outer_names=outer,
    )


def _shifted(
    nodes: int, regions: int, edges: int
) -> tuple[Callable[[Place], tuple[Place]], Callable[[Link], Link]]:
    """Return the maps of places and links that shift an operand behind this many nodes, regions and edges."""

    def places(place: Place) -> tuple[Place]:
        return (place + nodes if place >= 0 else place - regions,)

    def link(old: Link) -> Link:
        return old + edges if isinstance(old, int) else old

    return places, link


def tensor(left: Bigraph, right: Bigraph) -> Bigraph:
    """Return left ⊗ right: both side by side; raises BigraphError if they share a name."""
    _ = left.outer * right.outer
    return parallel(left, right)


def merge_product(left: Bigraph, right: Bigraph) -> Bigraph:
    """Return left | right: both in one region, sharing outer names."""
    return merged(parallel(left, right))


def merged(bigraph: Bigraph) -> Bigraph:
    """Return the bigraph with all its regions merged into one."""
    return compose(merge(bigraph.regions) * names(bigraph.outer_names), bigraph)


def nest(outside: Bigraph, inside: Bigraph) -> Bigraph:
    """Return outside . inside: fill the sites of `outside` with `inside` and share outer names."""
    if outside.inner_links:
        raise BigraphError("interface", "nesting needs an outside without inner names", "compose instead")
    return compose(parallel(outside, names(inside.outer_names)), inside)


def close(bigraph: Bigraph, *closed: str) -> Bigraph:
    """Return /x bigraph: the outer names become edges; raises BigraphError for a missing name."""
    for name in closed:
        if name not in bigraph.outer_names:
            raise BigraphError("closure", f"there is no outer name '{name}' to close")
    kept = names(name for name in bigraph.outer_names if name not in closed)
    caps = [closure(name) for name in sorted(set(closed))]
    return compose(reduce(tensor, caps, identity(Interface(bigraph.regions)) * kept), bigraph)


def rename(bigraph: Bigraph, renaming: Mapping[str, str]) -> Bigraph:
    """Return the bigraph with renamed outer names; two names that become equal are joined."""
    grouped: dict[str, list[str]] = {}
    for name in bigraph.outer_names:
        grouped.setdefault(renaming.get(name, name), []).append(name)
    wiring = [substitution(new, old) for new, old in sorted(grouped.items())]
    return compose(reduce(tensor, wiring, identity(Interface(bigraph.regions))), bigraph)


def lean(bigraph: Bigraph) -> Bigraph:
    """Return the bigraph without its idle edges."""
    used = sorted(
        {link for node in bigraph.nodes for link in node.ports if isinstance(link, int)}.union(
            link for _, link in bigraph.inner_links if isinstance(link, int)
        )
    )
    if len(used) == bigraph.edges:
        return bigraph
    number = {edge: place for place, edge in enumerate(used)}

    def link(old: Link) -> Link:
        return number[old] if isinstance(old, int) else old

    return assemble(
        bigraph.signature,
        [moved(node, lambda place: (place,), link) for node in bigraph.nodes],
        regions=bigraph.regions,
        sites=bigraph.sites,
        edges=len(used),
        inner_links={name: link(old) for name, old in bigraph.inner_links},
        outer_names=bigraph.outer_names,
    )


def identity(interface: Interface) -> Bigraph:
    """Return the identity of an interface."""
    return tensor(
        placing([{region} for region in range(interface.width)], interface.width), names(interface.names)
    )


def names(kept: Iterable[str]) -> Bigraph:
    """Return the identity on these link names."""
    kept = sorted(set(kept))
    return assemble(EMPTY, (), regions=0, inner_links={name: name for name in kept}, outer_names=kept)


def placing(parents: Iterable[Iterable[int]], regions: int) -> Bigraph:
    """Return a placing: sites, each with its regions (several mean sharing). It can merge, permute and split."""
    return assemble(EMPTY, (), regions=regions, sites=[[~region for region in within] for within in parents])


def merge(width: int) -> Bigraph:
    """Return `width` sites in one region; `merge(0)` is the empty region 1."""
    return placing([{0}] * width, 1)


def symmetry(left: int, right: int) -> Bigraph:
    """Return the placing that swaps `left` regions with the `right` ones after them."""
    order = [*range(right, right + left), *range(right)]
    return placing([{region} for region in order], left + right)


def closure(name: str) -> Bigraph:
    """Return /x: an edge with one inner name."""
    return assemble(EMPTY, (), regions=0, edges=1, inner_links={name: 0})


def substitution(outer: str, inner: Iterable[str]) -> Bigraph:
    """Return y/{x, ...}: inner names joined to one outer name, which is idle without inner names."""
    return assemble(EMPTY, (), regions=0, inner_links=dict.fromkeys(inner, outer), outer_names=(outer,))


def ion(signature: Signature, control: str, links: Iterable[str] = (), name: str | None = None) -> Bigraph:
    """Return one node that contains a site, with its ports linked to outer names."""
    ports = tuple(links)
    return assemble(signature, [Node(control, name, ports)], sites=[(0,)], outer_names=ports)


def atom(signature: Signature, control: str, links: Iterable[str] = (), name: str | None = None) -> Bigraph:
    """Return one empty node, with its ports linked to outer names."""
    ports = tuple(links)
    return assemble(signature, [Node(control, name, ports)], outer_names=ports)
