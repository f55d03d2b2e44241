"""The pairs of σ_L: parents of nodes, and the links that they are on."""

from dataclasses import dataclass

from semantics.state.signature import Name


@dataclass(frozen=True, slots=True)
class Parent:
    """The pair (node, place) of σ_L's `parent`."""

    node: Name
    place: Name

    def __str__(self) -> str:
        return f"parent({self.node}) = {self.place}"


@dataclass(frozen=True, slots=True)
class Linked:
    """The pair (link, node) of σ_L's `linked`."""

    link: Name
    node: Name

    def __str__(self) -> str:
        return f"linked({self.link}, {self.node})"


Relation = Parent | Linked
"""One pair of σ_L. A part L' of L is a set of them."""
