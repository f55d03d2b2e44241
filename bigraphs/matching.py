"""Matching: every occurrence of a redex in a target, place and link graph together.

An occurrence maps nodes injectively and preserves controls, nesting and links. A node without a site has no further
child. A closed link matches an edge all of whose points are matched. An open link matches any other link; several may
match the same. A region may lie in any active place that is neither matched nor below a match (Milner's disjointness).
If all nodes of a region have other parents in the redex, the region may have no place: in Sevegnani and Calder's
bigraphs with sharing, a site of the context may be an orphan.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator
from dataclasses import dataclass
from itertools import permutations, product

from bigraphs.bigraph import Bigraph, Link, Place, children, find, link_key, points, sites_in
from bigraphs.errors import BigraphError
from bigraphs.region_matching import placements


@dataclass(frozen=True, slots=True)
class Match:
    """An occurrence of `redex` in `target`.

    `nodes` gives the target node of each redex node, and `links` the target link of each redex link. `regions` gives
    the places of each region, and `sites` the topmost target nodes in each site.
    """

    redex: Bigraph
    target: Bigraph
    nodes: tuple[int, ...]
    links: tuple[tuple[Link, Link], ...]
    regions: tuple[tuple[Place, ...], ...]
    sites: tuple[tuple[int, ...], ...]


def find_matches(
    redex: Bigraph,
    target: Bigraph,
    *,
    node_variables: frozenset[str] = frozenset(),
    link_constants: frozenset[str] = frozenset(),
) -> Iterator[Match]:
    """Yield every occurrence once, in a deterministic order.

    A named redex node matches the node of the same name; an anonymous node or a variable matches any node. An outer
    name matches any link; a constant matches only the link of the same name.

    Raises:
        BigraphError: If the redex has inner names or an empty region (it would match anywhere), or if the target is not
            ground.
    """
    _check(redex, target)
    search = _Search(redex, target, node_variables, link_constants)
    for _ in search.run():
        for links in search.with_idle_links():
            nodes = tuple(search.nodes[number] for number in range(len(redex.nodes)))
            for regions, sites in placements(redex, target, nodes):
                yield Match(redex, target, nodes, links, regions, sites)


def _check(redex: Bigraph, target: Bigraph) -> None:
    _ = redex.signature | target.signature
    if redex.inner_links:
        raise BigraphError("redex", "a redex with inner names cannot be matched", "use outer names")
    if target.sites or target.inner_links:
        raise BigraphError(
            "target", f"rules apply to ground bigraphs, this one has {target.inner}", "fill its sites"
        )
    inhabited = {parent for node in redex.nodes for parent in node.parents}
    for region in range(redex.regions):
        if ~region not in inhabited:
            raise BigraphError(
                "redex", f"region {region} of the redex has no node, so it would match anywhere"
            )


class _Graph:
    """A bigraph with indexes for the search."""

    def __init__(self, bigraph: Bigraph) -> None:
        self.nodes = bigraph.nodes
        self.children = children(bigraph)
        self.points = points(bigraph)
        self.sited = frozenset(sites_in(bigraph))
        self.by_control: dict[str, list[int]] = {}
        for number, node in enumerate(bigraph.nodes):
            self.by_control.setdefault(node.control, []).append(number)


class _Search:
    """A depth-first search over node images; each step places the redex node with the fewest candidates."""

    def __init__(
        self, redex: Bigraph, target: Bigraph, variables: frozenset[str], constants: frozenset[str]
    ) -> None:
        self.redex, self.target = _Graph(redex), _Graph(target)
        self.constants = constants
        self.unordered = frozenset(
            control.name for control in target.signature.controls if not control.ordered
        )
        self.fixed: dict[int, int | None] = {
            number: find(target, node.name)
            for number, node in enumerate(redex.nodes)
            if node.name is not None and node.name not in variables
        }
        self.nodes: dict[int, int] = {}
        self.images: dict[int, int] = {}
        self.links: dict[Link, Link] = {}
        self.closed: dict[Link, Link] = {}  # target edge to the redex edge that owns it
        self.shared: Counter[Link] = Counter()  # target link to the number of open links on it

    def run(self) -> Iterator[None]:
        """Yield for each complete assignment of nodes; the state holds it until the next step."""
        if not self.redex.nodes:
            yield
            return
        stack = [self.options()]
        while stack:
            if next(stack[-1], None) is None:
                stack.pop()
            elif len(self.nodes) == len(self.redex.nodes):
                yield
            else:
                stack.append(self.options())

    def options(self) -> Iterator[bool]:
        """Place one more node in every way that fits, and undo each placement."""
        number, candidates = self.most_constrained()
        for image in candidates:
            if self.fits(number, image):
                for _ in self.bindings(number, image):
                    self.nodes[number], self.images[image] = image, number
                    yield True
                    del self.nodes[number], self.images[image]

    def most_constrained(self) -> tuple[int, list[int]]:
        waiting = (number for number in range(len(self.redex.nodes)) if number not in self.nodes)
        return min(((number, self.candidates(number)) for number in waiting), key=lambda pair: len(pair[1]))

    def candidates(self, number: int) -> list[int]:
        """Return the shortest list that contains every possible image: by name, neighbour, link or control."""
        if number in self.fixed:
            image = self.fixed[number]
            return [] if image is None else [image]
        node = self.redex.nodes[number]
        choices = [self.target.by_control.get(node.control, [])]
        choices += [
            self.target.children[self.nodes[parent]] for parent in node.parents if parent in self.nodes
        ]
        for child in self.redex.children[number]:
            if child in self.nodes:
                choices.append(
                    [place for place in self.target.nodes[self.nodes[child]].parents if place >= 0]
                )
        for link in node.ports:
            if link in self.links:
                choices.append(sorted({point for point, _ in self.target.points[self.links[link]]}))
        return min(choices, key=len)

    def fits(self, number: int, image: int) -> bool:
        """Return whether an image fits a node and its placed neighbours; links are checked later."""
        node, other = self.redex.nodes[number], self.target.nodes[image]
        if image in self.images or node.control != other.control or len(node.ports) != len(other.ports):
            return False
        inside, there = len(self.redex.children[number]), len(self.target.children[image])
        if there < inside or (there > inside and number not in self.redex.sited):
            return False
        above = sum(parent >= 0 for parent in node.parents)
        spare, rooted = len(other.parents) - above, above < len(node.parents)
        if spare < 0 or (spare and not rooted):
            return False
        return self.same_neighbours(number, image)

    def same_neighbours(self, number: int, image: int) -> bool:
        """Return whether the placed parents and children of the node are those of its image."""
        above = {self.nodes[place] for place in self.redex.nodes[number].parents if place in self.nodes}
        below = {self.nodes[place] for place in self.redex.children[number] if place in self.nodes}
        return above == {
            place for place in self.target.nodes[image].parents if place in self.images
        } and below == {place for place in self.target.children[image] if place in self.images}

    def bindings(self, number: int, image: int) -> Iterator[None]:
        """Bind the links of a node in every way that fits, and undo each binding."""
        ports, targets = self.redex.nodes[number].ports, self.target.nodes[image].ports
        if self.redex.nodes[number].control in self.unordered:
            wanted = sorted(Counter(ports).items(), key=lambda item: link_key(item[0]))
            yield from self.unordered_bindings(wanted, Counter(targets))
            return
        bound: list[Link] = []
        if all(self.bind(link, target, bound) for link, target in zip(ports, targets, strict=True)):
            yield
        self.unbind(bound)

    def unordered_bindings(self, wanted: list[tuple[Link, int]], free: Counter[Link]) -> Iterator[None]:
        """Bind each link of a node to a target link that occurs at least as often on the target node."""
        if not wanted:
            yield
            return
        link, times = wanted[0]
        for target in [target for target in free if free[target] >= times]:
            bound: list[Link] = []
            if self.bind(link, target, bound):
                free[target] -= times
                yield from self.unordered_bindings(wanted[1:], free)
                free[target] += times
            self.unbind(bound)

    def bind(self, link: Link, target: Link, bound: list[Link]) -> bool:
        """Bind a redex link to a target link if permitted; record a new binding in `bound`."""
        if link in self.links:
            return self.links[link] == target
        if target in self.closed or not self.may_bind(link, target):
            return False
        self.links[link] = target
        if isinstance(link, int):
            self.closed[target] = link
        else:
            self.shared[target] += 1
        bound.append(link)
        return True

    def may_bind(self, link: Link, target: Link) -> bool:
        if isinstance(link, str):
            return link not in self.constants or link == target
        alike = len(self.redex.points[link]) == len(self.target.points[target])
        return isinstance(target, int) and alike and not self.shared[target]

    def unbind(self, bound: list[Link]) -> None:
        for link in bound:
            target = self.links.pop(link)
            if isinstance(link, int):
                del self.closed[target]
            else:
                self.shared[target] -= 1

    def with_idle_links(self) -> Iterator[tuple[tuple[Link, Link], ...]]:
        """Yield all links with images; idle edges map to idle edges, idle names to any link."""
        idle = [link for link, on in self.redex.points.items() if not on]
        edges = [link for link in idle if isinstance(link, int)]
        names = [link for link in idle if isinstance(link, str)]
        free = [link for link, on in self.target.points.items() if isinstance(link, int) and not on]
        for chosen in permutations(free, len(edges)):
            open_to = [link for link in self.target.points if link not in self.closed and link not in chosen]
            for images in product(
                *([link for link in open_to if self.may_bind(name, link)] for name in names)
            ):
                found = (
                    self.links | dict(zip(edges, chosen, strict=True)) | dict(zip(names, images, strict=True))
                )
                yield tuple((link, found[link]) for link in self.redex.points)
