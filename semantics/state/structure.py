"""The structure S = (L, P, β, γ), and its consistency."""

from collections.abc import Iterable

from semantics.state.cell_values import Cells
from semantics.state.logical_model import LogicalModel
from semantics.state.physical_model import PhysicalModel
from semantics.state.relations import Linked, Parent, Relation
from semantics.state.signature import REGION, EntityKinds, Name


class Structure:
    """S over the cells of a configuration: `logical`, `physical`, and β and γ between them."""

    __slots__ = ("logical", "physical")

    def __init__(self, cells: Cells, sorting: EntityKinds) -> None:
        self.logical = LogicalModel(cells, sorting)
        self.physical = PhysicalModel(cells, sorting)

    def __eq__(self, other: object) -> bool:
        if not isinstance(other, Structure):
            return NotImplemented
        return self.logical == other.logical and self.physical == other.physical

    def __hash__(self) -> int:
        return hash((self.logical, self.physical))

    def beta(self, node: Name) -> Name | None:
        """Return β(node): the naming service gives an entity its node's name; a vanished entity has no image."""
        return node if node in self.physical else None

    def gamma(self, relation: Relation) -> bool:
        """Whether P relates the β-images by the image of the relation under γ.

        γ(parent) = contains or carries, γ(linked) = connected.
        """
        physical = self.physical
        if isinstance(relation, Linked):
            return self.beta(relation.node) is not None and physical.connected(relation.link, relation.node)
        if self.beta(relation.node) is None:
            return False
        if relation.place == REGION:
            return True
        return physical.carries(relation.place, relation.node) or physical.contains(
            relation.place, relation.node
        )

    def believes(self, relation: Relation) -> bool:
        """Whether L has a pair."""
        if isinstance(relation, Linked):
            return relation.link in self.logical.links(relation.node)
        return self.logical.parent(relation.node) == relation.place

    def relations(self) -> tuple[Relation, ...]:
        """Return all of σ_L, sorted by node."""
        nodes = self.logical.nodes()
        parents = [Parent(node, self.logical.parent(node) or REGION) for node in nodes]
        return (*parents, *(Linked(link, node) for node in nodes for link in self.logical.links(node)))

    def consistent(self, relations: Iterable[Relation], nodes: Iterable[Name] = ()) -> bool:
        """Whether (L', P, β, γ) is consistent, for L' given by its pairs and nodes; the cost is the size of L'."""
        return all(self.beta(node) is not None for node in nodes) and all(map(self.gamma, relations))

    def locally_consistent(self, relations: Iterable[Relation], nodes: Iterable[Name] = ()) -> bool:
        """Whether S is locally consistent with respect to L': L' ⊆ L, and (L', P, β, γ) is consistent."""
        relations, nodes = tuple(relations), tuple(nodes)
        contained = all(node in self.logical for node in nodes) and all(map(self.believes, relations))
        return contained and self.consistent(relations, nodes)
