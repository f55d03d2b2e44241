"""The logical model L as a view over cells: σ_L = {parent, linked}, slot by slot."""

from collections.abc import Iterator

from bigraphs import Bigraph, from_relations, open_signature
from semantics.state.cell_values import NAMES, Cell, Cells, Changes, is_, is_something
from semantics.state.signature import REGION, EntityKinds, Name
from semantics.state.views import CellView


def parent_cell(node: Name) -> Cell:
    """Address the slot `parent(n)`; None means that n is not in dom(L)."""
    return ("parent", node)


def links_cell(node: Name) -> Cell:
    """Address the slot `links(n)`: a sorted tuple."""
    return ("links", node)


class LogicalModel(CellView):
    """L over the cells of a configuration."""

    __slots__ = ("cells", "sorting")
    SORTS = frozenset({"parent", "links"})

    def __init__(self, cells: Cells, sorting: EntityKinds) -> None:
        self.cells = cells
        self.sorting = sorting

    def parent(self, node: Name) -> Name | None:
        """Return `parent(n)`: a node, the region, or None if n is not in dom(L)."""
        parent: Name | None = self.cells.read(parent_cell(node))
        return parent

    def links(self, node: Name) -> tuple[Name, ...]:
        """Return `links(n)`, sorted."""
        return self.cells.read(links_cell(node)) or ()

    def __contains__(self, node: Name) -> bool:
        return self.cells.test(parent_cell(node), is_something)

    def nodes(self) -> tuple[Name, ...]:
        """Return dom(L), sorted."""
        return tuple(name for name in self.cells.read(NAMES) if name in self)

    def children(self, place: Name) -> tuple[Name, ...]:
        """Return the nodes whose parent is a place, sorted."""
        return tuple(name for name in self.cells.read(NAMES) if self.is_in(name, place))

    def is_in(self, node: Name, place: Name) -> bool:
        """Whether `parent(n)` is a place."""
        return self.cells.test(parent_cell(node), is_, place)

    def ancestors(self, node: Name) -> Iterator[Name]:
        """Yield the places around a node, innermost first, without the region."""
        place = self.parent(node)
        while place is not None and place != REGION:
            yield place
            place = self.parent(place)

    def linked(self, node: Name, other: Name) -> bool:
        """Whether two nodes share a link."""
        return not set(self.links(node)).isdisjoint(self.links(other))

    def nesting(self, node: Name, place: Name) -> Changes:
        """Return the writes of parent[node ↦ place]."""
        return {parent_cell(node): place}

    def linking(self, node: Name, links: frozenset[Name]) -> Changes:
        """Return the writes of links[node ↦ links]."""
        return {links_cell(node): tuple(sorted(links))}

    def bigraph(self) -> Bigraph:
        """Return L as a concrete bigraph whose support is names; its signature has all kinds of the mission."""
        nodes, kinds = self.nodes(), self.sorting.kinds
        links = sorted({link for node in nodes for link in self.links(node)})
        parents = {node: self.parent(node) for node in nodes}
        return from_relations(
            {node: kinds[node] for node in nodes},
            {node: None if parent == REGION else parent for node, parent in parents.items()},
            {link: [node for node in nodes if link in self.links(node)] for link in links},
            open_signature({*self.sorting.signature.kinds, *kinds.values()}),
        )
