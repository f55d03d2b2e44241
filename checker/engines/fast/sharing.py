"""Sharing: what was learned of one agent, or of one part of a transition, as it is known of those that are like it."""

from collections.abc import Iterator, Mapping, Sequence, Set
from dataclasses import dataclass, field
from typing import Any, Final, NamedTuple, Protocol

from checker.engines.fast.columns import Columns
from checker.engines.fast.lessons import Kin, Lesson, Lessons, NoImage, Outcome, Stage, mentioned
from checker.engines.fast.likeness import Likeness
from checker.engines.fast.recording import Ask, Asked
from semantics.state.cells import Cell, Row
from semantics.state.signature import Name

WRITTEN: Final = object()
"""Stands for what a cell holds that is written somewhere."""


class Source(Protocol):
    """One configuration."""

    def code(self, number: int) -> int:
        """Return the code of a column."""


class Learned(NamedTuple):
    """What a run of rules says, or what is known of it without one.

    Attributes:
        asked: What was asked, with the answers.
        codes: For each value that was read its code.
        taken: The cells that were taken to be never written, each with how many questions had been asked then.
        flags: Of the leaf.
        outcomes: The transitions.
    """

    asked: Asked
    codes: dict[Ask, int]
    taken: Mapping[Cell, int]
    flags: int
    outcomes: Sequence[Outcome]


@dataclass(slots=True)
class Sharing:
    """What those that are alike have learned.

    Attributes:
        likeness: Who is alike.
        columns, varying, still: Those of the learner.
        lessons: By some rules, and the first of those that are alike, what is known of these.
        forgotten: How many times something was not what it had been taken for: then all that is shared is.
    """

    likeness: Likeness
    columns: Columns
    varying: Set[Cell]
    still: Row
    lessons: dict[tuple[Any, Name], Lessons] = field(default_factory=dict)
    forgotten: int = 0

    def kin_of(self, rules: Any, agent: object) -> Kin | None:
        """Return what some rules are known to do for those that are like an agent; None where nobody is."""
        found = self.likeness.agents.get(agent) if isinstance(agent, str) else None
        if found is None:
            return None
        first, exchange = found
        return Kin(self.lessons.setdefault((rules, first), Lessons()), exchange)

    def known(self, kin: Kin | None, source: Source) -> Learned | None:
        """Return what those that are alike found where their cells gave the same answers, under one's own names."""
        if kin is None:
            return None
        exchange, back = kin.exchange, kin.exchange.inverse
        asked, codes = dict[Ask, Any](), dict[Ask, int]()

        def answer(ask: Ask) -> Any:
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
        """Return what a lesson takes to be never written; raises NoImage where anything is not as it takes it to be."""
        for cell, value in lesson.taken.items():
            if cell in self.varying or self.still.read(cell) != value:
                raise NoImage
        for cell, depth in lesson.depths.items():
            if cell not in self.varying or self.columns.holes.get(cell, 0) != depth:
                raise NoImage
        return dict.fromkeys((*lesson.still, *lesson.taken), 0)

    def teach(self, kin: Kin | None, found: Learned) -> None:
        """Let those that are alike know what one of them found, where it has an image."""
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
                Stage(
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
            return  # the first of them would ask otherwise
        kin.lessons.begin(self.forgotten)
        kin.lessons.learn(stages, lesson)


def _stages(found: Learned, about: Set[Cell]) -> Iterator[tuple[list[Cell], Ask | None, Any]]:
    """Yield before each question, and at the end, the cells of some that had been taken since the one before."""
    taken: list[list[Cell]] = [[] for _ in range(len(found.asked) + 1)]
    for cell, asked in found.taken.items():
        taken[asked] += [cell] if cell in about else []
    for cells, (ask, said) in zip(taken, found.asked.items(), strict=False):
        yield cells, ask, said
    yield taken[-1], None, None
