"""Vacuity of invariants: whether one holds only because nothing could break it.

Which parts of it are never needed (`checker.properties.subformulas`) is decided exactly: on the
valuations of its atoms that were met.
"""

from collections.abc import Callable, Iterable, Iterator, Mapping, Set
from dataclasses import dataclass, field
from functools import reduce
from operator import and_, or_
from typing import Any, Final

from checker.limits import look
from checker.properties.subformulas import STILL, Part, few, never_needed, unneeded
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
from semantics.state import cells
from semantics.state.cells import Cell, Cells, Changes, Edit, Question, State, Written, is_, merged
from semantics.state.configuration import Configuration

MOST_ATOMS: Final = 64
"""The most different atoms of a formula whose valuations are gathered."""

Columns = Mapping[Atom, int]
"""For each atom the valuations in which it is true, a bit for each."""


@dataclass(slots=True)
class Valuations:
    """The truth of a formula's atoms in each configuration that was visited, and whether anything they read changed.

    Attributes:
        formula: The formula.
        atoms: Its atoms, once each; none where there are too many to be gathered.
        met: The valuations that were met, a bit for each atom.
        still: What the first configuration answered, as long as all others answer alike; None since one didn't.
    """

    formula: Proposition
    atoms: tuple[Atom, ...] = ()
    met: set[int] = field(default_factory=set)
    still: "Answers | None" = None
    begun: bool = False

    def __post_init__(self) -> None:
        self.atoms = few_atoms(self.formula)

    def holds(self, c: Configuration) -> bool:
        """Tell whether the formula is true of a configuration, and remember its valuation."""
        self.compare(c)
        if not self.atoms:
            return holds(self.formula, c)
        valuation = sum(1 << rank for rank, atom in enumerate(self.atoms) if holds(atom, c))
        self.met.add(valuation)
        columns = {atom: valuation >> rank & 1 for rank, atom in enumerate(self.atoms)}
        return truth(self.formula, columns, 1) == 1

    def add(self, part: "Valuations") -> None:
        """Add what was met elsewhere."""
        self.met |= part.met
        if part.begun:
            self.still = part.still if not self.begun or part.still is None else self.still
            self.begun = True

    def compare(self, c: Configuration) -> None:
        """Note whether a configuration still answers as the first one did."""
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
        """The valuations that were met, atom by atom."""
        met = sorted(self.met)
        return {
            atom: sum(1 << number for number, valuation in enumerate(met) if valuation >> rank & 1)
            for rank, atom in enumerate(self.atoms)
        }

    def remarks(self, ranges: Ranges) -> tuple[str, ...]:
        """Return what makes the invariant vacuous, if it holds: at most a few sentences."""
        if self.still is not None and self.begun:
            return (STILL,)
        if not self.atoms:
            return ()
        return few(tuple(remarks_on(self.formula, self.columns, len(self.met), ranges)))


def is_still(configurations: Iterable[Configuration], atoms: tuple[Atom, ...]) -> bool:
    """Tell whether nothing that atoms ask of configurations ever changes."""
    valuations = Valuations(And(atoms))
    for c in configurations:
        look()
        valuations.compare(c)
        if valuations.still is None:
            return False
    return True


Answers = dict[tuple[Cell, Question, tuple[Any, ...]], Any]
"""What was asked of cells, with the answers."""


class Asking:
    """Cells that note what is asked of them."""

    def __init__(self, asked: Cells) -> None:
        self.cells = asked
        self.answers: Answers = {}

    def read(self, cell: Cell) -> Any:
        """Return the value of a cell: it is asked whether it is this one."""
        value = self.cells.read(cell)
        self.answers[cell, is_, (value,)] = True
        return value

    def test(self, cell: Cell, question: Question, *constants: Any) -> bool:
        """Ask a cell."""
        return bool(self.ask(cell, question, *constants))

    def ask(self, cell: Cell, question: Question, *constants: Any) -> Any:
        """Ask a cell."""
        self.answers[cell, question, constants] = found = self.cells.ask(cell, question, *constants)
        return found

    def edited(self, cell: Cell, edit: Edit, *constants: Any) -> Any:
        """Return what an edit makes of a cell's value."""
        return edit(self.read(cell), *constants)

    def each(self, names: Iterable[str], part: Callable[[str], cells.Part]) -> Mapping[str, cells.Part]:
        """Return what a pointwise definition says of each name."""
        return {name: part(name) for name in names}

    def with_(self, changes: Mapping[Cell, Any]) -> Written:
        """Return the cells with more written over them."""
        return Written(self, dict(changes))

    def with_each(self, parts: Mapping[str, Changes]) -> Written:
        """Return the cells with what each part writes."""
        return Written(self, merged(parts.values()))

    def changed(self, since: State) -> Set[Cell]:  # noqa: ARG002  # it is where everything begins
        """Return that nothing was written."""
        return frozenset()


def asked(atoms: Iterable[Atom], c: Configuration) -> Answers:
    """Return all that atoms ask of a configuration."""
    asking = Asking(c.state)
    atoms = tuple(atoms)
    for atom in (*atoms, *bindings(atoms)):
        holds(atom, Configuration(c.setting, asking))
    return asking.answers


def bindings(atoms: Iterable[Proposition]) -> tuple[IsBound, ...]:
    """Return that each variable has a value that atoms compare.

    At first none has one. So a comparison that is true throughout is about something as soon as there is a value.
    """
    return tuple({IsBound(atom.variable): None for atom in atoms if isinstance(atom, VariableIs)})


def few_atoms(formula: Proposition) -> tuple[Atom, ...]:
    """Return the atoms of a formula, once each; none where there are more than can be gathered."""
    found: dict[Atom, None] = {}
    for atom in atoms_of(formula):
        found[atom] = None
        if len(found) > MOST_ATOMS:
            return ()
    return tuple(found)


# --- which parts are never needed -----------------------------------------------------------------------------


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
    """Yield in words the outermost parts of an invariant that are never needed, on so many valuations."""
    every = (1 << count) - 1

    def is_true(formula: Any) -> bool:
        return truth(formula, columns, every) == every

    if is_true(formula):
        yield from (_remark(*each, columns, every) for each in unneeded(formula, ranges, is_true))


def _remark(around: Part, part: Part, columns: Columns, every: int) -> str:
    """Say that a part is never needed, and why."""
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


def _others(parts: Formulas, part: Part) -> tuple[Proposition, ...]:
    """Return the operands of a connective but for one."""
    rank = part.paths[0][-1]
    return (*parts[:rank], *parts[rank + 1 :])
