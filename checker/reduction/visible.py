"""What properties see: the questions about cells that decide the truth of a proposition."""

from collections.abc import Callable, Iterable, Iterator
from dataclasses import dataclass
from typing import Any

from checker.reduction.bounds import Bounds
from semantics.agents import Store, code_cell, host_cell, store_cell
from semantics.cells import AGENTS, Cell
from semantics.configuration import Configuration
from semantics.eta import line_cell, sends_cell
from semantics.logical_model import links_cell, parent_cell
from semantics.physical_model import channels_cell, down_cell, placement_cell
from semantics.program import Program
from semantics.propositions import (
    And,
    Ended,
    HasPending,
    HostedAt,
    Inside,
    IsBound,
    Known,
    LinkedWith,
    Not,
    Or,
    Present,
    Proposition,
    VariableIs,
    Waiting,
    is_true_of,
)
from semantics.signature import REGION, Name
from semantics.statements import React


@dataclass(frozen=True, slots=True)
class Seen:
    """One cell as far as a proposition asks for it: its value, or the answer to a question about the value.

    No question is about what an observation says.
    """

    cell: Cell
    question: Callable[[Any], bool] | None = None

    def of(self, c: Configuration) -> Any:
        """Return what is seen in a configuration."""
        value = c.read(self.cell)
        return value if self.question is None else self.question(value)


class Eyes:
    """All that some propositions look at."""

    def __init__(self, c: Configuration, formulas: Iterable[Proposition]) -> None:
        self.bounds = Bounds(c)
        self.program = c.setting.program
        self.seen = tuple(dict.fromkeys(each for formula in formulas for each in self._sees(formula)))

    def differ(self, before: Configuration, after: Configuration) -> bool:
        """Tell whether two configurations look different."""
        return any(each.of(before) != each.of(after) for each in self.seen)

    def _sees(self, formula: Proposition) -> Iterator[Seen]:
        match formula:
            case Not(inner):
                yield from self._sees(inner)
            case And(parts) | Or(parts):
                for part in parts:
                    yield from self._sees(part)
            case Inside(node, _, actually):
                yield from self._places(node, actually)
            case LinkedWith(node, other, actually):
                yield from self._links({node, other}, actually)
            case Present(node):
                yield Seen(placement_cell(node), _is_there)
            case Known(node):
                yield Seen(parent_cell(node), _is_there)
            case Ended(agent):
                yield from (Seen(AGENTS), Seen(code_cell(agent), bool))
            case Waiting(agent):
                yield from (Seen(AGENTS), Seen(code_cell(agent), _Waits(self.program)))
            case HostedAt(agent):
                yield from (Seen(AGENTS), Seen(host_cell(agent)))
            case HasPending(agent):
                yield from (Seen(AGENTS), Seen(line_cell(agent)), Seen(sends_cell(agent)))
            case VariableIs(variable) | IsBound(variable):
                yield from (Seen(AGENTS), Seen(store_cell(variable.agent), _IsTrue(formula)))

    def _places(self, node: Name, actually: bool) -> Iterator[Seen]:
        if node not in self.bounds.names or node == REGION:
            return
        if actually:
            yield from (Seen(placement_cell(each)) for each in sorted(self.bounds.around(node)))
        else:
            yield from (Seen(parent_cell(each)) for each in sorted({node, *self.bounds.above(node)}))

    def _links(self, names: Iterable[Name], actually: bool) -> Iterator[Seen]:
        for name in sorted(self.bounds.names.intersection(names)):
            if actually:
                yield from (Seen(channels_cell(name)), Seen(placement_cell(name), _is_there))
            else:
                yield from (Seen(links_cell(name)), Seen(parent_cell(name), _is_there))
        if actually:
            yield from (Seen(down_cell(channel)) for channel in sorted(self.bounds.channels))


def _is_there(value: Any) -> bool:
    return value is not None


@dataclass(frozen=True)
class _IsTrue:
    """Whether an atom about a variable is true of a store."""

    atom: VariableIs | IsBound

    def __call__(self, store: Store | None) -> bool:
        return is_true_of(self.atom, store or ())


@dataclass(frozen=True)
class _Waits:
    """Whether code is at a `react`."""

    program: Program

    def __call__(self, code: tuple[int, ...] | None) -> bool:
        return bool(code) and isinstance(self.program.statements[code[0]], React)  # type: ignore[index]  # not None
