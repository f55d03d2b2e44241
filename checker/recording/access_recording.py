"""Recording: the cells that a rule reads, in order, and those it writes; pointwise parts separately.

A rule is pure and reads cells only through `read`, `test`, `ask` and `each`. So one recorded run holds for every
configuration that gives the same answers. Constant cells are not recorded as questions: they are equal everywhere.
"""

from collections.abc import Callable, Iterable, Iterator, Mapping, Set
from dataclasses import dataclass, field
from typing import Any, Protocol

from checker.recording.value_templates import ObservationHole, has_no_holes, join_value, split_value
from semantics.behaviours.observations import Fact
from semantics.state.cell_values import Cell, Changes, Edit, Part, Question, Row, WritableCells, merged
from semantics.state.signature import Name


@dataclass(frozen=True, slots=True)
class ColumnQuestion:
    """A question to a column: its value, or a function of its value, mostly a truth value.

    Attributes:
        cell: The cell.
        hole: The number of an observation in the cell's value, with a name; None for the skeleton.
        question: The function; None for the value itself.
        constants: Further arguments of the function.
    """

    cell: Cell
    hole: tuple[int, Name] | None = None
    question: Question | None = None
    constants: tuple[Any, ...] = ()


Asked = dict[ColumnQuestion, Any]
"""Questions with their answers, in the order of their first occurrence."""


class CellSource(Protocol):
    """The cells of one configuration, split into skeletons and facts, as `CellRecorder` reads them."""

    def skeleton(self, cell: Cell) -> Any:
        """Return the skeleton of a cell's value, None if there is no such cell."""

    def fact(self, cell: Cell, number: int, name: Name) -> Fact:
        """Return the fact about a mobile name in a hole of a cell."""


@dataclass(frozen=True, slots=True)
class Edited:
    """A placeholder for an edited cell value that no rule has read yet."""

    cell: Cell
    edit: Edit
    constants: tuple[Any, ...]

    def of(self, value: Any) -> Any:
        """Return the edited value."""
        return self.edit(value, *self.constants)


@dataclass(slots=True)
class QuestionScope:
    """The questions of a rule, or the further questions of one part of its conclusion.

    Attributes:
        asked: The questions with their answers.
        taken: The cells assumed constant, each with the number of questions asked before.
        known: Intermediate results.
    """

    asked: Asked = field(default_factory=dict)
    taken: dict[Cell, int] = field(default_factory=dict)
    known: dict[Any, Any] = field(default_factory=dict)

    def take(self, cell: Cell) -> None:
        """Note that a cell was assumed constant."""
        self.taken.setdefault(cell, len(self.asked))


@dataclass(slots=True)
class CellRecorder:
    """Cells that record the questions put to them.

    Attributes:
        source: The configuration.
        still: The values of constant cells, None for a cell that does not exist.
        varies: Returns whether a cell is ever written.
        mobile: The names with separately recorded parts.
        scopes: The scope of the rule, and behind it that of the part that is being recorded.
        families: The pointwise definitions created.
    """

    source: CellSource
    still: Row
    varies: Callable[[Cell], bool]
    mobile: frozenset[Name]
    scopes: list[QuestionScope] = field(default_factory=lambda: [QuestionScope()])
    families: list[Any] = field(default_factory=list)

    def read(self, cell: Cell) -> Any:
        """Return the value of a cell and record its skeleton; its observations' facts are recorded at their access."""
        if not self.varies(cell):
            self.scopes[-1].take(cell)
            return self.still.read(cell)
        skeleton = self._note(ColumnQuestion(cell), lambda: self.source.skeleton(cell))
        return join_value(skeleton, lambda hole: ObservedFacts(self, cell, hole))

    def test(self, cell: Cell, question: Question, *constants: Any) -> bool:
        """Return the truth of a predicate of a cell, and record it."""
        if not self.varies(cell):
            self.scopes[-1].take(cell)
            return bool(question(self.still.read(cell), *constants))
        ask = ColumnQuestion(cell, None, question, constants)
        answer: bool = self._note(ask, lambda: bool(question(self.source.skeleton(cell), *constants)))
        return answer

    def ask(self, cell: Cell, question: Question, *constants: Any) -> Any:
        """Return a function of a cell's value, and record it."""
        if not self.varies(cell):
            self.scopes[-1].take(cell)
            return question(self.still.read(cell), *constants)
        answer = self._note(
            ColumnQuestion(cell, None, question, constants),
            lambda: question(self.source.skeleton(cell), *constants),
        )
        return join_value(answer, lambda hole: ObservedFacts(self, cell, hole))

    def edited(self, cell: Cell, edit: Edit, *constants: Any) -> Any:
        """Return the edited value of a cell: a placeholder, with the cell unread, if neither contains observations."""
        is_plain = not split_value(constants, self.mobile)[1]
        if is_plain and self.varies(cell) and self.test(cell, has_no_holes):
            return Edited(cell, edit, constants)
        return edit(self.read(cell), *constants)

    def hear(self, cell: Cell, number: int, name: Name) -> Fact:
        """Return an observation's fact about a mobile name, and record it."""
        fact: Fact = self._note(
            ColumnQuestion(cell, (number, name)), lambda: self.source.fact(cell, number, name)
        )
        return fact

    def each(self, names: Iterable[str], part: Callable[[str], Part]) -> Mapping[str, Part]:
        """Return a pointwise definition that evaluates each part at its access."""
        family = Pointwise(self, tuple(names), part)
        self.families.append(family)  # its cached parts are keyed by its id, which must not be reused
        return family

    def with_(self, changes: Mapping[Cell, Any]) -> "Conclusion":
        """Return the cells with a rule's changes applied."""
        return Conclusion(self, dict(changes))

    def with_each(self, parts: Mapping[str, Changes]) -> "Conclusion":
        """Return the cells with the parts of a conclusion applied."""
        return Conclusion(self, {}, (parts,))

    def changed(self, since: WritableCells) -> Set[Cell]:  # noqa: ARG002  # the recorder is the initial state
        """Return the empty set: nothing was written."""
        return frozenset()

    def apart(self, part: Callable[[], Part]) -> tuple[Part, QuestionScope]:
        """Return a part, with the questions that it asked in addition to the rule's."""
        self.scopes.append(QuestionScope())
        try:
            return part(), self.scopes[-1]
        finally:
            self.scopes.pop()

    def once(self, what: Any, work: Callable[[], Any]) -> Any:
        """Evaluate something at its first use; its questions belong to the scope that first used it."""
        for scope in self.scopes:
            if what in scope.known:
                return scope.known[what]
        self.scopes[-1].known[what] = found = work()
        return found

    def _note(self, ask: ColumnQuestion, answer: Callable[[], Any]) -> Any:
        for scope in self.scopes:
            if ask in scope.asked:
                return scope.asked[ask]
        self.scopes[-1].asked[ask] = found = answer()
        return found


class Pointwise(Mapping[str, Part]):
    """A pointwise definition; each part is evaluated at its access."""

    def __init__(self, recorder: CellRecorder, names: tuple[str, ...], part: Callable[[str], Part]) -> None:
        self.recorder = recorder
        self.names = dict.fromkeys(names)
        self.part = part

    def __getitem__(self, name: str) -> Part:
        if name not in self.names:
            raise KeyError(name)
        part: Part = self.recorder.once((id(self), name), lambda: self.part(name))
        return part

    def __iter__(self) -> Iterator[str]:
        return iter(self.names)

    def __len__(self) -> int:
        return len(self.names)


class ObservedFacts(Mapping[Name, Fact]):
    """The facts of an observation in a cell; a fact about a mobile name is recorded at its access."""

    def __init__(self, recorder: CellRecorder, cell: Cell, hole: ObservationHole) -> None:
        self.recorder = recorder
        self.cell = cell
        self.hole = hole
        self.still = dict(hole.still)

    def __getitem__(self, name: Name) -> Fact:
        if name in self.recorder.mobile:
            return self.recorder.hear(self.cell, self.hole.number, name)
        return self.still[name]

    def __iter__(self) -> Iterator[Name]:
        return iter(sorted(self.recorder.mobile.union(self.still)))

    def __len__(self) -> int:
        return len(self.recorder.mobile.union(self.still))


class Conclusion:
    """Cells with a rule's writes: changes, and families of parts that are evaluated at their access."""

    __slots__ = ("changes", "families", "recorder")

    def __init__(
        self, recorder: CellRecorder, changes: Changes, families: tuple[Mapping[str, Changes], ...] = ()
    ) -> None:
        self.recorder = recorder
        self.changes = changes
        self.families = families

    def read(self, cell: Cell) -> Any:
        """Return the written value of a cell, else the original one."""
        written = self.written(cell)
        value = written[cell] if cell in written else self.recorder.read(cell)
        return value.of(self.recorder.read(cell)) if isinstance(value, Edited) else value

    def test(self, cell: Cell, question: Question, *constants: Any) -> bool:
        """Return the truth of a predicate of the written value, else of the original one."""
        if cell in self.written(cell):
            return bool(question(self.read(cell), *constants))
        return self.recorder.test(cell, question, *constants)

    def ask(self, cell: Cell, question: Question, *constants: Any) -> Any:
        """Return a function of the written value, else of the original one."""
        if cell in self.written(cell):
            return question(self.read(cell), *constants)
        return self.recorder.ask(cell, question, *constants)

    def edited(self, cell: Cell, edit: Edit, *constants: Any) -> Any:
        """Return the edited value, from the written value if there is one, else from the original."""
        if cell in self.written(cell):
            return edit(self.read(cell), *constants)
        return self.recorder.edited(cell, edit, *constants)

    def written(self, cell: Cell) -> Changes:
        """Return the written changes; parts are evaluated only if the cell may be among them."""
        if cell in self.changes or not self.families:
            return self.changes
        return merged(each for family in self.families for each in family.values()) | self.changes

    def each(self, names: Iterable[str], part: Callable[[str], Part]) -> Mapping[str, Part]:
        """Return a pointwise definition that evaluates each part at its access."""
        return self.recorder.each(names, part)

    def with_(self, changes: Mapping[Cell, Any]) -> "Conclusion":
        """Return the cells with more changes applied."""
        return Conclusion(self.recorder, {**self.changes, **changes}, self.families)

    def with_each(self, parts: Mapping[str, Changes]) -> "Conclusion":
        """Return the cells with a pointwise definition applied; no changes may follow it."""
        return Conclusion(self.recorder, self.changes, (*self.families, parts))

    def changed(self, since: WritableCells) -> Set[Cell]:  # noqa: ARG002  # all that was written is known
        """Return the written cells."""
        return (
            merged(each for family in self.families for each in family.values()).keys() | self.changes.keys()
        )

    def __eq__(self, other: object) -> bool:
        if not isinstance(other, Conclusion) or self.recorder is not other.recorder:
            return NotImplemented
        return all(self._agrees(other, cell) for cell in sorted(self.changed(self) | other.changed(other)))

    def _agrees(self, other: "Conclusion", cell: Cell) -> bool:
        """Return whether a cell has the same value in both; equal edits suffice."""
        one, two = (each.written(cell).get(cell) for each in (self, other))
        return (isinstance(one, Edited) and one == two) or bool(self.read(cell) == other.read(cell))

    def __hash__(self) -> int:
        return hash(id(self.recorder))  # a written value may equal the original
