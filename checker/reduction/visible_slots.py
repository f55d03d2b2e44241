"""Visible slots: the questions about cells that determine the truth of a proposition."""

from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from typing import Any

from semantics.analysis.overapproximation import Overapproximation
from semantics.behaviours.process_conversion import waits
from semantics.properties.propositions import (
    Atom,
    Ended,
    Exists,
    HasPending,
    HostedAt,
    Inside,
    IsBound,
    Known,
    LinkedWith,
    Present,
    Proposition,
    VariableIs,
    Waiting,
    atoms_of,
    is_true_of,
)
from semantics.properties.region_atoms import (
    ApartFrom,
    PossiblyIn,
    RegionAtom,
    SurelyIn,
    WithinRangeOf,
    operands,
)
from semantics.properties.temporal import Steps
from semantics.state.agents import code_cell, host_cell, is_over, store_cell
from semantics.state.cell_values import AGENTS, Cell, Question, has, is_something
from semantics.state.configuration import Configuration, Label, Transition
from semantics.state.eta import line_cell, sends_cell
from semantics.state.logical_model import links_cell, parent_cell
from semantics.state.physical_model import channels_cell, down_cell, placement_cell
from semantics.state.signature import REGION, Name


@dataclass(frozen=True, slots=True)
class VisiblePart:
    """The visible part of one cell: its value, or the answer to a question with some constants.

    No question is about the content of an observation.
    """

    cell: Cell
    question: Question | None = None
    constants: tuple[Any, ...] = ()

    def of(self, c: Configuration) -> Any:
        """Return the visible part of a configuration."""
        return self.says(c.read(self.cell))

    def says(self, value: Any) -> Any:
        """Return the visible part of a value."""
        return value if self.question is None else self.question(value, *self.constants)


class Eyes:
    """The visible parts of some propositions, and the visible steps: those that a formula names."""

    def __init__(
        self, c: Configuration, formulas: Iterable[Proposition], steps: Iterable[Steps] = ()
    ) -> None:
        self.steps = tuple(steps)
        self.bounds = Overapproximation(c)
        self.program = c.setting.program
        self.formulas = tuple(formulas)
        atoms = dict.fromkeys(_anywhere(atom) for formula in self.formulas for atom in atoms_of(formula))
        self.seen = tuple(dict.fromkeys(each for atom in atoms for each in self._sees(atom)))

    def sees(self, c: Configuration, step: Transition) -> bool:
        """Return whether a step from a configuration is visible."""
        return self.names(step.label) or self.differ(c, step.target)

    def names(self, label: Label) -> bool:
        """Return whether a formula names steps with this label."""
        return any(each.has(label) for each in self.steps)

    def differ(self, before: Configuration, after: Configuration) -> bool:
        """Return whether two configurations differ visibly."""
        return any(each.of(before) != each.of(after) for each in self.seen)

    def _sees(self, atom: Atom) -> Iterator[VisiblePart]:
        match atom:
            case Inside(node, _, actually):
                yield from self._places(node, actually)
            case PossiblyIn() | SurelyIn() | ApartFrom() | WithinRangeOf():
                yield from self._regions(atom)
            case LinkedWith(node, other, actually):
                yield from self._links({node, other}, actually)
            case Present(node):
                yield VisiblePart(placement_cell(node), is_something)
            case Known(node):
                yield VisiblePart(parent_cell(node), is_something)
            case Exists() | Ended() | Waiting() | HostedAt() | HasPending():
                yield VisiblePart(AGENTS, has, (atom.agent,))
                yield from self._of_agent(atom)
            case VariableIs(variable) | IsBound(variable):
                yield VisiblePart(store_cell(variable.agent), is_true_of, (atom,))

    def _of_agent(self, atom: Exists | Ended | Waiting | HostedAt | HasPending) -> Iterator[VisiblePart]:
        match atom:
            case Ended(agent):
                yield VisiblePart(code_cell(agent), is_over)
            case Waiting(agent):
                yield VisiblePart(code_cell(agent), waits, (self.program,))
            case HostedAt(agent):
                yield VisiblePart(host_cell(agent))
            case HasPending(agent):
                yield from (VisiblePart(line_cell(agent)), VisiblePart(sends_cell(agent)))

    def _places(self, node: Name, actually: bool) -> Iterator[VisiblePart]:
        if node not in self.bounds.names or node == REGION:
            return
        if actually:
            yield from (VisiblePart(placement_cell(each)) for each in sorted(self.bounds.around(node)))
        else:
            yield from (VisiblePart(parent_cell(each)) for each in sorted({node, *self.bounds.above(node)}))

    def _regions(self, atom: RegionAtom) -> Iterator[VisiblePart]:
        """Yield the placements of two entities and of all that may carry them, and the flights that move them."""
        from semantics.regions.region_truth import plans_of  # noqa: PLC0415 - geometry takes its time to load

        facts = self.bounds.setting.regions
        if facts is None:
            raise ValueError("a property asks for regions: begin with watching(initial, properties)")
        for name in sorted({bearer for entity in operands(atom) for bearer in facts.bearers(entity)}):
            yield VisiblePart(placement_cell(name))
            for agent in facts.movers[name]:
                yield VisiblePart(line_cell(agent), plans_of, (name,))

    def _links(self, names: Iterable[Name], actually: bool) -> Iterator[VisiblePart]:
        for name in sorted(self.bounds.names.intersection(names)):
            if actually:
                yield from (VisiblePart(channels_cell(name)), VisiblePart(placement_cell(name), is_something))
            else:
                yield from (VisiblePart(links_cell(name)), VisiblePart(parent_cell(name), is_something))
        if actually:
            yield from (VisiblePart(down_cell(channel)) for channel in sorted(self.bounds.channels))


def _anywhere(atom: Atom) -> Atom:
    """Return an atom with the same visible cells: those of a node's position are the same for all places."""
    return Inside(atom.node, REGION, atom.actually) if isinstance(atom, Inside) else atom
