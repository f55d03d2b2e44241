"""Sharing: the use and the recording of lessons among interchangeable agents and parts."""

from collections.abc import Iterator, Mapping, Sequence, Set
from dataclasses import dataclass, field
from typing import Any, Final, NamedTuple, Protocol

from checker.engines.fast.model.columns import Columns
from checker.engines.fast.model.interchangeable import Likeness
from checker.engines.fast.model.rule_cache import (
    CachedOutcome,
    Kin,
    Lesson,
    Lessons,
    LessonStage,
    NoImage,
    mentioned,
)
from checker.recording.access_recording import Asked, ColumnQuestion
from semantics.state.cell_values import Cell, Row
from semantics.state.signature import Name

WRITTEN: Final = object()
"""The stand-in for the value of a varying cell."""


class CodeSource(Protocol):
    """One configuration, given by its codes."""

    def code(self, number: int) -> int:
        """Return the code of a column."""


class Learned(NamedTuple):
    """The result of a run of rules, or of a shared lesson in its place.

    Attributes:
        asked: The questions with their answers.
        codes: The code of each value read.
        taken: The cells assumed constant, each with the number of questions asked before.
        flags: The flags of the leaf.
        outcomes: The transitions.
    """

    asked: Asked
    codes: dict[ColumnQuestion, int]
    taken: Mapping[Cell, int]
    flags: int
    outcomes: Sequence[CachedOutcome]


@dataclass(slots=True)
class SharedLessons:
    """The lessons of all classes of interchangeable agents.

    Attributes:
        likeness: The interchangeable agents and parts.
        columns, varying, still: Those of the learner.
        lessons: The lessons by rules and the first agent of a class.
        forgotten: The number of wrong assumptions so far; each of them voids all lessons.
    """

    likeness: Likeness
    columns: Columns
    varying: Set[Cell]
    still: Row
    lessons: dict[tuple[Any, Name], Lessons] = field(default_factory=dict)
    forgotten: int = 0

    def kin_of(self, rules: Any, agent: object) -> Kin | None:
        """Return the lessons of some rules for the class of an agent; None if the agent is not interchangeable."""
        found = self.likeness.agents.get(agent) if isinstance(agent, str) else None
        if found is None:
            return None
        first, exchange = found
        return Kin(self.lessons.setdefault((rules, first), Lessons()), exchange)

    def known(self, kin: Kin | None, source: CodeSource) -> Learned | None:
        """Return the result of a shared lesson for a configuration, in the agent's own names; None if there is none."""
        if kin is None:
            return None
        exchange, back = kin.exchange, kin.exchange.inverse
        asked, codes = dict[ColumnQuestion, Any](), dict[ColumnQuestion, int]()

        def answer(ask: ColumnQuestion) -> Any:
            image = back.ask(ask)
            if image.cell not in self.varying:
                raise NoImage
            number = self.columns.asked(image)
            code = source.code(number)
            said = self.columns.all[number].value(code)
            if image.question is None:
                codes[image] = code
            else:
                said = image.question(said, *image.constants)
            asked[image] = said
            return exchange.answer(image, said)

        def holds(cell: Cell) -> Any:
            image = back.cell(cell)
            return WRITTEN if image in self.varying else exchange.value(image, self.still.read(image))

        try:
            kin.lessons.begin(self.forgotten)
            lesson = kin.lessons.find(answer, holds)
            own = None if lesson is None else lesson.image(back)
            return None if own is None else Learned(asked, codes, self._still(own), own.flags, own.outcomes)
        except NoImage:
            return None

    def _still(self, lesson: Lesson) -> dict[Cell, int]:
        """Return the cells that a lesson assumes constant; raises NoImage if one of its assumptions is wrong."""
        for cell, value in lesson.taken.items():
            if cell in self.varying or self.still.read(cell) != value:
                raise NoImage
        for cell, depth in lesson.depths.items():
            if cell not in self.varying or self.columns.holes.get(cell, 0) != depth:
                raise NoImage
        return dict.fromkeys((*lesson.still, *lesson.taken), 0)

    def teach(self, kin: Kin | None, found: Learned) -> None:
        """Record the result of a run for its class, if it has an image."""
        if kin is None:
            return
        try:
            written = {place[0] for each in found.outcomes for place, _ in each.writes}
            about = {cell for cell in found.taken if self.likeness.mentions_any(cell)}
            lesson = Lesson(
                found.flags,
                tuple(found.outcomes),
                frozenset(found.taken).difference(about),
                {cell: self.still.read(cell) for cell in about},
                {cell: self.columns.holes.get(cell, 0) for cell in written},
                mentioned(found.asked, found.outcomes),
            ).image(kin.exchange)
            stages = [
                LessonStage(
                    tuple(
                        sorted(
                            (kin.exchange.cell(cell), lesson.taken[kin.exchange.cell(cell)]) for cell in taken
                        )
                    ),
                    None if ask is None else kin.exchange.ask(ask),
                    None if ask is None else kin.exchange.answer(ask, said),
                )
                for taken, ask, said in _stages(found, about)
            ]
        except NoImage:
            return
        asked = (each.ask.cell for each in stages if each.ask is not None)
        if not self.varying.isdisjoint(lesson.taken) or any(cell not in self.varying for cell in asked):
            return  # the first agent of the class would ask other questions
        kin.lessons.begin(self.forgotten)
        kin.lessons.learn(stages, lesson)


def _stages(found: Learned, about: Set[Cell]) -> Iterator[tuple[list[Cell], ColumnQuestion | None, Any]]:
    """Yield each question with the relevant cells assumed constant since the previous one; at the end, None."""
    taken: list[list[Cell]] = [[] for _ in range(len(found.asked) + 1)]
    for cell, asked in found.taken.items():
        taken[asked] += [cell] if cell in about else []
    for cells, (ask, said) in zip(taken, found.asked.items(), strict=False):
        yield cells, ask, said
    yield taken[-1], None, None
