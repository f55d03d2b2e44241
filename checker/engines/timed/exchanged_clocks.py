"""The clocks of interchangeable members: an exchange of members exchanges their clocks."""

from __future__ import annotations

from collections import defaultdict, deque
from collections.abc import Callable, Hashable, Iterable, Iterator
from functools import lru_cache
from typing import TypeVar

from checker.reduction.configuration_renaming import Renaming
from checker.reduction.exchanged_times import OF_CLAUSES, renamed_clock
from checker.reduction.symmetry import MissionSymmetry
from semantics.state.signature import Name
from semantics.timing.actor_clocks import ActorClock
from semantics.timing.clocks import ClockUpdate

T = TypeVar("T", bound=Hashable)


class ClockExchange:
    """The exchanges of a mission's members, applied to clocks.

    Attributes:
        symmetry: The exchanges.
        kin: Returns the common name of the clocks that exchanges may replace by each other. Constants of kin are the
            same: a clock's value may go on in any of them.
    """

    def __init__(self, symmetry: MissionSymmetry) -> None:
        self.symmetry = symmetry
        self.clauses = symmetry.initial.setting.environment
        self.kin = lru_cache(maxsize=1 << 14)(self._kin)

    def image(self, clock: ActorClock, renaming: Renaming) -> ActorClock:
        """Return the image of a clock."""
        return renamed_clock(clock, renaming, self.clauses)

    def _kin(self, clock: ActorClock) -> ActorClock:
        if clock.sort in OF_CLAUSES:
            return min(self.orbit(clock, self.image))
        return clock._replace(of=Renaming(*self.symmetry.items.plain).value(clock.of))

    def orbit(self, value: T, image: Callable[[T, Renaming], T]) -> Iterator[T]:
        """Yield the images of a value under all exchanges, the value itself first."""
        found = {value: None}
        waiting = [value]
        while waiting:
            one = waiting.pop(0)
            yield one
            for renaming in self.symmetry.exchanges:
                other = image(one, renaming)
                if other not in found:
                    found[other] = None
                    waiting.append(other)

    def alike(self, name: Name) -> list[Name]:
        """Return the names that exchanges replace a name by, itself first."""
        return list(self.orbit(name, lambda each, renaming: renaming.name(each)))

    def between(self, one: Name, other: Name) -> Renaming:
        """Return an exchange that replaces a name by another one of its orbit."""
        if one == other:
            return Renaming()
        owner = self.symmetry.items.owner
        return self.symmetry.items.exchanging({owner[one]: owner[other], owner[other]: owner[one]})

    def order(
        self, source: Iterable[ActorClock], renaming: Renaming, target: Iterable[ActorClock]
    ) -> list[int]:
        """Return for each clock of an exchanged configuration the index of the original one.

        Equal clocks keep their order: the oldest stays the first.
        """
        indices: dict[ActorClock, deque[int]] = defaultdict(deque)
        for index, clock in enumerate(source):
            indices[self.image(clock, renaming)].append(index)
        return [indices[clock].popleft() for clock in target]


class ExchangedUpdate:
    """The effect of a step on the clocks, if a representative replaces the step's target."""

    def __init__(self, update: ClockUpdate, order: Iterable[int]) -> None:
        self.update = update
        self.order = tuple(order)

    def ages(self, ages: tuple[int, ...]) -> Iterator[tuple[int, ...]]:
        """Yield the ages after the step, in the order of the representative's clocks."""
        return (tuple(each[index] for index in self.order) for each in self.update.ages(ages))
