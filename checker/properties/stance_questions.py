"""Questions about stances to configurations, one after another: an inspection that keeps the answers as plain data."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from typing import TYPE_CHECKING, ClassVar

from checker.limits import Bound
from checker.properties.inspections import InTime
from semantics.state.configuration import Configuration
from semantics.state.signature import Name
from semantics.successors import Expansion

if TYPE_CHECKING:
    from semantics.regions.stances import Stance

Pair = tuple[Name, Name]


class StanceQuestions:
    """The stances of entities that are reached, alone and in pairs.

    Attributes:
        alone: The stances of each entity that was asked about.
        together: The stances of each pair that was asked about.
        bounds: The bounds at which an engine stopped asking.
    """

    in_time: ClassVar[InTime] = InTime.ENABLED

    def __init__(self) -> None:
        self.alone: dict[Name, set[Stance]] = {}
        self.together: dict[Pair, set[tuple[Stance, Stance]]] = {}
        self.bounds: list[Bound] = []

    def questions(self) -> Iterator[Callable[[Configuration], object]]:
        """Yield the questions; the answer to each is noted before the next one."""
        yield from ()

    def note(self, answer: object) -> None:
        """Note the answer to a question."""
        from semantics.regions.stances import Stance  # noqa: PLC0415 - geometry takes its time to load

        if isinstance(answer, Stance):
            self.alone.setdefault(answer.entity, set()).add(answer)
        elif isinstance(answer, tuple):
            one, other = answer
            self.together.setdefault((one.entity, other.entity), set()).add((one, other))

    def __call__(self, _: int, c: Configuration, __: Expansion) -> None:
        """Note the stances in a configuration."""
        for question in self.questions():
            self.note(question(c))

    def add(self, part: StanceQuestions) -> None:
        """Add the stances that another worker saw."""
        for vehicle, stances in part.alone.items():
            self.alone.setdefault(vehicle, set()).update(stances)
        for pair, both in part.together.items():
            self.together.setdefault(pair, set()).update(both)
        self.bounds += part.bounds
