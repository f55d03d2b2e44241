"""Vacuity of invariants: whether one holds only because nothing could break it.

The unneeded parts (`checker.properties.subformulas`) are decided exactly, on the valuations of its atoms that occur.
"""

from collections.abc import Callable, Iterable, Iterator, Mapping, Set
from dataclasses import dataclass, field
from functools import reduce
from operator import and_, or_
from typing import Any, Final

from checker.limits import look
from checker.properties.subformulas import STILL, Subformula, few, never_needed, unneeded
from semantics.properties.property import Ranges
from semantics.properties.propositions import (
    Always,
    And,
    Atom,
    Formulas,
    IsBound,
    Not,
    Or,
    Proposition,
    VariableIs,
    atoms_of,
    holds,
)
from semantics.state import cell_values
from semantics.state.cell_values import (
    Cell,
    Cells,
    Changes,
    Edit,
    Question,
    WritableCells,
    Written,
    is_,
    merged,
)
from semantics.state.configuration import Configuration

MOST_ATOMS: Final = 64
"""The most different atoms of a formula whose valuations are collected."""

Columns = Mapping[Atom, int]
"""For each atom the valuations in which it is true, a bit for each."""


@dataclass(slots=True)
class Valuations:
    """The truth of a formula's atoms in each visited configuration, and whether anything they read changed.

    Attributes:
        formula: The formula.
        atoms: Its atoms, once each; none if there are too many.
        met: The valuations that occur, a bit for each atom.
        still: The answers of the first configuration while all others agree; None after a different one.
    """

    formula: Proposition
    atoms: tuple[Atom, ...] = ()
    met: set[int] = field(default_factory=set)
    still: "Answers | None" = None
    begun: bool = False

    def __post_init__(self) -> None:
        self.atoms = few_atoms(self.formula)

    def holds(self, c: Configuration) -> bool:
        """Return whether the formula is true of a configuration, and record its valuation."""
        self.compare(c)
        if not self.atoms:
            return holds(self.formula, c)
        valuation = sum(1 << rank for rank, atom in enumerate(self.atoms) if holds(atom, c))
        self.met.add(valuation)
        columns = {atom: valuation >> rank & 1 for rank, atom in enumerate(self.atoms)}
        return truth(self.formula, columns, 1) == 1

    def add(self, part: "Valuations") -> None:
        """Add the valuations of another worker."""
        self.met |= part.met
        if part.begun:
            self.still = part.still if not self.begun or part.still is None else self.still
            self.begun = True

    def compare(self, c: Configuration) -> None:
        """Record whether a configuration gives the same answers as the first one."""
        if not self.begun:
            self.begun = True
            self.still = asked(self.atoms or tuple(atoms_of(self.formula)), c)
        elif self.still is not None and any(
            c.ask(cell, question, *constants) != said
            for (cell, question, constants), said in self.still.items()
        ):
            self.still = None

    @property
    def columns(self) -> Columns:
        """The valuations that occur, atom by atom."""
        met = sorted(self.met)
        return {
            atom: sum(1 << number for number, valuation in enumerate(met) if valuation >> rank & 1)
            for rank, atom in enumerate(self.atoms)
        }

    def remarks(self, ranges: Ranges) -> tuple[str, ...]:
        """Return the reasons why a true invariant is vacuous, at most a few sentences."""
        if self.still is not None and self.begun:
            return (STILL,)
        if not self.atoms:
            return ()
        return few(tuple(remarks_on(self.formula, self.columns, len(self.met), ranges)))


def is_still(configurations: Iterable[Configuration], atoms: tuple[Atom, ...]) -> bool:
    """Return whether the values that atoms read never change."""
    valuations = Valuations(And(atoms))
    for c in configurations:
        look()
        valuations.compare(c)
        if valuations.still is None:
            return False
    return True


Answers = dict[tuple[Cell, Question, tuple[Any, ...]], Any]
"""Questions to cells, with their answers."""


class Asking:
    """Cells that record the questions to them."""

    def __init__(self, asked: Cells) -> None:
        self.cells = asked
        self.answers: Answers = {}

    def read(self, cell: Cell) -> Any:
        """Return the value of a cell; recorded as the question whether it is this value."""
        value = self.cells.read(cell)
        self.answers[cell, is_, (value,)] = True
        return value

    def test(self, cell: Cell, question: Question, *constants: Any) -> bool:
        """Return whether the answer to a question about a cell is true."""
        return bool(self.ask(cell, question, *constants))

    def ask(self, cell: Cell, question: Question, *constants: Any) -> Any:
        """Return the answer to a question about a cell, and record both."""
        self.answers[cell, question, constants] = found = self.cells.ask(cell, question, *constants)
        return found

    def edited(self, cell: Cell, edit: Edit, *constants: Any) -> Any:
        """Return the edited value of a cell."""
        return edit(self.read(cell), *constants)

    def each(
        self, names: Iterable[str], part: Callable[[str], cell_values.Part]
    ) -> Mapping[str, cell_values.Part]:
        """Return a pointwise definition's value for each name."""
        return {name: part(name) for name in names}

    def with_(self, changes: Mapping[Cell, Any]) -> Written:
        """Return the cells with changes written over them."""
        return Written(self, dict(changes))

    def with_each(self, parts: Mapping[str, Changes]) -> Written:
        """Return the cells with the changes of each part written over them."""
        return Written(self, merged(parts.values()))

    def changed(self, since: WritableCells) -> Set[Cell]:  # noqa: ARG002  # nothing is earlier
        """Return the empty set: nothing was written."""
        return frozenset()


def asked(atoms: Iterable[Atom], c: Configuration) -> Answers:
    """Return all questions of atoms to a configuration, with their answers."""
    asking = Asking(c.state)
    atoms = tuple(atoms)
    for atom in (*atoms, *bindings(atoms)):
        holds(atom, Configuration(c.setting, asking))
    return asking.answers


def bindings(atoms: Iterable[Proposition]) -> tuple[IsBound, ...]:
    """Return the propositions that each compared variable has a value.

    Initially no variable has a value. These propositions change with the first one, so a comparison that is always true
    doesn't count as constant.
    """
    return tuple({IsBound(atom.variable): None for atom in atoms if isinstance(atom, VariableIs)})


def few_atoms(formula: Proposition) -> tuple[Atom, ...]:
    """Return the atoms of a formula, once each; none if there are too many."""
    found: dict[Atom, None] = {}
    for atom in atoms_of(formula):
        found[atom] = None
        if len(found) > MOST_ATOMS:
            return ()
    return tuple(found)


# --- unneeded parts -------------------------------------------------------------------------------------------


def truth(formula: Proposition, columns: Columns, every: int) -> int:
    """Return the valuations in which a formula is true, of `every`, a bit for each."""
    match formula:
        case Not(inner):
            return every & ~truth(inner, columns, every)
        case And(parts):
            return reduce(and_, (truth(part, columns, every) for part in parts), every)
        case Or(parts):
            return reduce(or_, (truth(part, columns, every) for part in parts), 0)
        case Always(value):
            return every if value else 0
        case _:
            return columns[formula]


def remarks_on(formula: Proposition, columns: Columns, count: int, ranges: Ranges) -> Iterator[str]:
    """Yield in words the outermost unneeded parts of an invariant, on so many valuations."""
    every = (1 << count) - 1

    def is_true(formula: Any) -> bool:
        return truth(formula, columns, every) == every

    if is_true(formula):
        yield from (_remark(*each, columns, every) for each in unneeded(formula, ranges, is_true))


def _remark(around: Subformula, part: Subformula, columns: Columns, every: int) -> str:
    """Return the remark that a part is never needed, with the reason."""
    many, said = len(part.paths) > 1, never_needed(around, part)
    match around.formula:
        case Or((Not(condition), conclusion)) if part.formula == conclusion:
            never = f"'{condition}' {'and its like are' if many else 'is'} never true"
            if next(atoms_of(condition), None) is None:
                never = "the comparison of names before it is never true"
            return f"vacuous: {never}, so that {said}"
        case Or(parts):
            rest: Proposition = Or(_others(parts, part))
            always = truth(rest, columns, every) == every
            return f"{said}: '{rest}' is always true" if always else f"{said}: it holds without"
        case And(parts):
            rest = And(_others(parts, part))
            return (
                f"{said}: it holds without"
                if truth(rest, columns, every)
                else f"{said}: '{rest}' is never true"
            )
        case _:
            return f"{said}: it holds without"


def _others(parts: Formulas, part: Subformula) -> tuple[Proposition, ...]:
    """Return the operands of a connective without one of them."""
    rank = part.paths[0][-1]
    return (*parts[:rank], *parts[rank + 1 :])
