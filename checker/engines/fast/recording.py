"""Recording: the cells that a rule reads, in order, and those it writes; pointwise parts apart.

A rule is pure and sees cells through `read`, `test` and `each` alone, so one recorded run holds for every
configuration that answers the same questions alike. What is never written is not asked: it is the same everywhere.
"""

from collections.abc import Callable, Iterable, Iterator, Mapping, Set
from dataclasses import dataclass, field
from typing import Any, Protocol

from checker.engines.fast.skeletons import Hole, has_no_holes, put_together, taken_apart
from semantics.behaviours.observations import Fact
from semantics.state.cells import Cell, Changes, Edit, Part, Question, Row, State, merged
from semantics.state.signature import Name


@dataclass(frozen=True, slots=True)
class Ask:
    """What is asked of a column: its value, or (with a question) what a question makes of it, mostly a yes or no.

    Attributes:
        cell: The cell.
        hole: The number of an observation within its value, with whom it is asked about; None for its skeleton.
        question: None where the value itself is asked.
        constants: What the question is asked with.
    """

    cell: Cell
    hole: tuple[int, Name] | None = None
    question: Question | None = None
    constants: tuple[Any, ...] = ()


Asked = dict[Ask, Any]
"""Questions with their answers, in the order in which they were asked first."""


class Source(Protocol):
    """One configuration taken apart: what `Recorder` reads."""

    def skeleton(self, cell: Cell) -> Any:
        """Return the skeleton of a cell's value, None where there is no such cell."""

    def fact(self, cell: Cell, number: int, name: Name) -> Fact:
        """Return what a hole of a cell says of a mobile name."""


@dataclass(frozen=True, slots=True)
class Edited:
    """Stands for what an edit makes of a cell's value, as long as nobody looks at it."""

    cell: Cell
    edit: Edit
    constants: tuple[Any, ...]

    def of(self, value: Any) -> Any:
        """Return what it makes of a value."""
        return self.edit(value, *self.constants)


@dataclass(slots=True)
class Scope:
    """What the rule itself asked, or a part of its conclusion beyond that.

    Attributes:
        asked: The questions with their answers.
        taken: The cells that were taken to be never written, each with how many questions had been asked then.
        known: What was worked out already.
    """

    asked: Asked = field(default_factory=dict)
    taken: dict[Cell, int] = field(default_factory=dict)
    known: dict[Any, Any] = field(default_factory=dict)

    def take(self, cell: Cell) -> None:
        """Note that a cell was taken to be never written."""
        self.taken.setdefault(cell, len(self.asked))


@dataclass(slots=True)
class Recorder:
    """Cells that note what is asked of them.

    Attributes:
        source: The configuration.
        still: The value of each cell that is never written, None for no such cell; cells not here are asked.
        varies: Tells whether a cell is ever written.
        mobile: The names that parts are recorded apart for.
        scopes: That of the rule itself, and then that of the part that is being recorded.
        families: The pointwise definitions that were made.
    """

    source: Source
    still: Row
    varies: Callable[[Cell], bool]
    mobile: frozenset[Name]
    scopes: list[Scope] = field(default_factory=lambda: [Scope()])
    families: list[Any] = field(default_factory=list)

    def read(self, cell: Cell) -> Any:
        """Return the value of a cell, and note its skeleton; what its observations say is noted as it is asked."""
        if not self.varies(cell):
            self.scopes[-1].take(cell)
            return self.still.read(cell)
        skeleton = self._note(Ask(cell), lambda: self.source.skeleton(cell))
        return put_together(skeleton, lambda hole: Heard(self, cell, hole))

    def test(self, cell: Cell, question: Question, *constants: Any) -> bool:
        """Ask a cell, and note the yes or no."""
        if not self.varies(cell):
            self.scopes[-1].take(cell)
            return bool(question(self.still.read(cell), *constants))
        ask = Ask(cell, None, question, constants)
        answer: bool = self._note(ask, lambda: bool(question(self.source.skeleton(cell), *constants)))
        return answer

    def ask(self, cell: Cell, question: Question, *constants: Any) -> Any:
        """Ask a cell, and note the answer."""
        if not self.varies(cell):
            self.scopes[-1].take(cell)
            return question(self.still.read(cell), *constants)
        answer = self._note(
            Ask(cell, None, question, constants), lambda: question(self.source.skeleton(cell), *constants)
        )
        return put_together(answer, lambda hole: Heard(self, cell, hole))

    def edited(self, cell: Cell, edit: Edit, *constants: Any) -> Any:
        """Return what an edit makes of a cell's value, unread where no observation stands in either."""
        is_plain = not taken_apart(constants, self.mobile)[1]
        if is_plain and self.varies(cell) and self.test(cell, has_no_holes):
            return Edited(cell, edit, constants)
        return edit(self.read(cell), *constants)

    def hear(self, cell: Cell, number: int, name: Name) -> Fact:
        """Return what an observation says of a mobile name, and note it."""
        fact: Fact = self._note(Ask(cell, (number, name)), lambda: self.source.fact(cell, number, name))
        return fact

    def each(self, names: Iterable[str], part: Callable[[str], Part]) -> Mapping[str, Part]:
        """Return a pointwise definition whose parts wait until somebody asks for them."""
        family = Pointwise(self, tuple(names), part)
        self.families.append(family)  # what is known of it is kept by its identity
        return family

    def with_(self, changes: Mapping[Cell, Any]) -> "Conclusion":
        """Return the cells with a rule's conclusion over them."""
        return Conclusion(self, dict(changes))

    def with_each(self, parts: Mapping[str, Changes]) -> "Conclusion":
        """Return the cells with the parts of a conclusion over them."""
        return Conclusion(self, {}, (parts,))

    def changed(self, since: State) -> Set[Cell]:  # noqa: ARG002  # it is where everything begins
        """Return that nothing was written."""
        return frozenset()

    def apart(self, part: Callable[[], Part]) -> tuple[Part, Scope]:
        """Return a part with what it asked beyond the rule itself."""
        self.scopes.append(Scope())
        try:
            return part(), self.scopes[-1]
        finally:
            self.scopes.pop()

    def once(self, what: Any, work: Callable[[], Any]) -> Any:
        """Work something out once where it is wanted: what it asks belongs to whoever wanted it."""
        for scope in self.scopes:
            if what in scope.known:
                return scope.known[what]
        self.scopes[-1].known[what] = found = work()
        return found

    def _note(self, ask: Ask, answer: Callable[[], Any]) -> Any:
        for scope in self.scopes:
            if ask in scope.asked:
                return scope.asked[ask]
        self.scopes[-1].asked[ask] = found = answer()
        return found


class Pointwise(Mapping[str, Part]):
    """A pointwise definition: each part is worked out where it is asked for."""

    def __init__(self, recorder: Recorder, names: tuple[str, ...], part: Callable[[str], Part]) -> None:
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


class Heard(Mapping[Name, Fact]):
    """What an observation in a cell says: of whoever is mobile it is asked only where somebody wants to know."""

    def __init__(self, recorder: Recorder, cell: Cell, hole: Hole) -> None:
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
    """Cells with what a rule writes: changes, and families of parts that are worked out where they are asked for."""

    __slots__ = ("changes", "families", "recorder")

    def __init__(
        self, recorder: Recorder, changes: Changes, families: tuple[Mapping[str, Changes], ...] = ()
    ) -> None:
        self.recorder = recorder
        self.changes = changes
        self.families = families

    def read(self, cell: Cell) -> Any:
        """Return what was written, else what was there."""
        written = self.written(cell)
        value = written[cell] if cell in written else self.recorder.read(cell)
        return value.of(self.recorder.read(cell)) if isinstance(value, Edited) else value

    def test(self, cell: Cell, question: Question, *constants: Any) -> bool:
        """Ask what was written, else what was there."""
        if cell in self.written(cell):
            return bool(question(self.read(cell), *constants))
        return self.recorder.test(cell, question, *constants)

    def ask(self, cell: Cell, question: Question, *constants: Any) -> Any:
        """Ask what was written, else what was there."""
        if cell in self.written(cell):
            return question(self.read(cell), *constants)
        return self.recorder.ask(cell, question, *constants)

    def edited(self, cell: Cell, edit: Edit, *constants: Any) -> Any:
        """Return what an edit makes of what was written, else of what was there."""
        if cell in self.written(cell):
            return edit(self.read(cell), *constants)
        return self.recorder.edited(cell, edit, *constants)

    def written(self, cell: Cell) -> Changes:
        """Return what was written, as far as a cell may be among it."""
        if cell in self.changes or not self.families:
            return self.changes
        return merged(each for family in self.families for each in family.values()) | self.changes

    def each(self, names: Iterable[str], part: Callable[[str], Part]) -> Mapping[str, Part]:
        """Return a pointwise definition."""
        return self.recorder.each(names, part)

    def with_(self, changes: Mapping[Cell, Any]) -> "Conclusion":
        """Return the cells with more written over them."""
        return Conclusion(self.recorder, {**self.changes, **changes}, self.families)

    def with_each(self, parts: Mapping[str, Changes]) -> "Conclusion":
        """Return the cells with the parts of a pointwise definition written over them, and nothing else after."""
        return Conclusion(self.recorder, self.changes, (*self.families, parts))

    def changed(self, since: State) -> Set[Cell]:  # noqa: ARG002  # all that was written is known
        """Return the cells that were written."""
        return (
            merged(each for family in self.families for each in family.values()).keys() | self.changes.keys()
        )

    def __eq__(self, other: object) -> bool:
        if not isinstance(other, Conclusion) or self.recorder is not other.recorder:
            return NotImplemented
        return all(self._agrees(other, cell) for cell in sorted(self.changed(self) | other.changed(other)))

    def _agrees(self, other: "Conclusion", cell: Cell) -> bool:
        """Tell whether a cell has one value in both: the same edit has, whatever it is made of."""
        one, two = (each.written(cell).get(cell) for each in (self, other))
        return (isinstance(one, Edited) and one == two) or bool(self.read(cell) == other.read(cell))

    def __hash__(self) -> int:
        return hash(id(self.recorder))  # what is written may be what was there
