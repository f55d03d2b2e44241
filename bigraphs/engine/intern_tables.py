"""The common tables of all states of one system: numbers of controls and names, and interned subtrees.

Controls, outer names and regions are small integers here. A *label* is a control, or a control with a node's name. A
*row* describes a node: its label, its links, the codes of its children and, if it has several parents, the link that
identifies it. The number of a row is its *code*. Equal codes are equal subtrees, so the codes of the nodes in its
regions identify a state.
"""

from __future__ import annotations

from collections.abc import Callable, Hashable, Iterable
from dataclasses import dataclass
from typing import Any, TypeAlias

from bigraphs.bigraph import Bigraph
from bigraphs.errors import BigraphError
from bigraphs.signature import Signature

Row: TypeAlias = tuple[int, tuple[int, ...], tuple[int, ...], int]

REFERENCE = -1
"""The label of a row that refers to a shared node; such a row stands in each of the node's places."""


@dataclass(frozen=True, slots=True)
class Codes:
    """The translation from the codes of a copy of a world to its own; those below `first` are equal."""

    first: int
    here: list[int]

    def translated(self, codes: Iterable[int]) -> list[int]:
        """Return the codes of the copy as codes of the world."""
        first, here = self.first, self.here
        return [code if code < first else here[code - first] for code in codes]


class InternTables:
    """The tables of one system; they only grow.

    Attributes:
        names: The outer names of every state, sorted; link `i` is name `i`, edges are numbered after them.
        regions: The number of regions of every state.
        sharing: Whether a node may have several parents.
        plain: Whether no state has an edge or a shared node, so that equal keys are equal states.
        named: Whether nodes may have names.
        rows: The row of each code.
        bare: For each code whether its subtree has no edge and no shared node.
        plans: The search plans of patterns, by their forms (`bigraphs.engine.occurrence_search`).
        pause: Long searches call it at intervals; it may raise an exception to end them.
    """

    def __init__(
        self, signature: Signature, names: tuple[str, ...], regions: int, *, sharing: bool, edges: bool = True
    ) -> None:
        self.signature = signature
        self.names = names
        self.regions = regions
        self.sharing = sharing
        self.plain = not sharing and not edges
        self.pause: Callable[[], None] = lambda: None
        self.named = False
        self.controls = {control.name: number for number, control in enumerate(signature.controls)}
        self.ordered = tuple(control.ordered for control in signature.controls)
        self.active = tuple(control.status == "active" for control in signature.controls)
        self.passive = any(control.status == "passive" for control in signature.controls)
        self.control_of: list[int] = list(range(len(signature.controls)))
        self.name_of: list[str | None] = [None] * len(signature.controls)
        self._labels: dict[tuple[int, str], int] = {}
        self.codes: dict[Row, int] = {}
        self.rows: list[Row] = []
        self.bare: list[bool] = []
        self.plans: dict[Hashable, Any] = {}

    def label(self, control: str, name: str | None) -> int:
        """Return the label of a control and an optional node name."""
        number = self.controls.get(control)
        if number is None:
            raise BigraphError("control", f"unknown control '{control}'", "give all rules one signature")
        if name is None:
            return number
        self.named = True
        found = self._labels.get((number, name))
        if found is None:
            found = self._labels[number, name] = len(self.control_of)
            self.control_of.append(number)
            self.name_of.append(name)
        return found

    def know(self, bigraph: Bigraph) -> None:
        """Register the labels of a bigraph's nodes."""
        for node in bigraph.nodes:
            self.label(node.control, node.name)

    def code(self, row: Row) -> int:
        """Return the code of a row; a new row gets the next code."""
        found = self.codes.get(row)
        if found is None:
            found = self.codes[row] = len(self.rows)
            self.rows.append(row)
            fixed = len(self.names)
            alone = row[3] == 0 and all(0 <= link < fixed for link in row[1])
            self.bare.append(alone and all(self.bare[kid] for kid in row[2]))
        return found

    def adopt(self, codes: Codes, rows: Iterable[Row]) -> None:
        """Add the next rows that a copy of this world has numbered."""
        for label, ports, kids, itself in rows:
            codes.here.append(self.code((label, ports, tuple(sorted(codes.translated(kids))), itself)))


def has_edges(bigraph: Bigraph) -> bool:
    """Return whether a node is on an edge."""
    return bigraph.edges > 0 and any(isinstance(link, int) for node in bigraph.nodes for link in node.ports)


def has_sharing(bigraph: Bigraph) -> bool:
    """Return whether a node or a site has several parents."""
    return any(len(node.parents) > 1 for node in bigraph.nodes) or any(
        len(parents) > 1 for parents in bigraph.sites
    )
