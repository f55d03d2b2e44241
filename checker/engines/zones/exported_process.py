"""A timed automaton as a process of other model checkers, with the names of its clocks.

Their clocks start at 0. So until its first reset, a clock with a greater age at the start is compared with constants
that are smaller by this age. A location can't be entered in violation of its invariant. So entry past a deadline leads
to a copy of the location in which no time passes. They copy no clocks, so a continuing clock keeps its name. A location
has one copy for each naming of its clocks; there are several only where equal requests are pending.
"""

from __future__ import annotations

from collections import Counter, defaultdict
from collections.abc import Callable, Hashable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from itertools import chain, count, islice
from typing import Final, NamedTuple

from checker.engines.zones.local_automata import LocalAutomaton
from checker.engines.zones.timed_automaton import Constraint, Edge, TimedAutomaton

WRONG: Final = "wrong"
"""The location that is reachable exactly if the property is violated."""


class ExportedLocation(NamedTuple):
    """A location: its name and invariant, or that no time passes in it."""

    name: str
    invariant: tuple[str, ...] = ()
    is_urgent: bool = False


class ExportedEdge(NamedTuple):
    """An edge.

    Attributes:
        source, target: The names of its locations.
        event: The name of its event: a step, by its number in its configuration, or a step of several processes.
        words: The label of its step, as in traces.
        guard: A conjunction of comparisons of clocks with constants.
        resets: The clocks that begin anew.
    """

    source: str
    target: str
    event: str
    words: str = ""
    guard: tuple[str, ...] = ()
    resets: tuple[str, ...] = ()


class ExportedProcess(NamedTuple):
    """A process.

    Attributes:
        name: Its name.
        clocks: The names of its clocks.
        places: Its locations, without `WRONG`; it begins in the first one.
        steps: Its edges.
    """

    name: str
    clocks: tuple[str, ...]
    places: tuple[ExportedLocation, ...]
    steps: tuple[ExportedEdge, ...]

    @property
    def can_be_wrong(self) -> bool:
        """Whether it has the location `WRONG`."""
        return any(step.target == WRONG for step in self.steps)


class _Spot(NamedTuple):
    """A copy of a location.

    Attributes:
        at: The location.
        names: The names of its clocks.
        begun: The age of each clock at the start, as long as it was not reset.
        is_late: Whether it is the copy for entry past a deadline.
    """

    at: int
    names: tuple[str, ...]
    begun: tuple[int, ...]
    is_late: bool = False

    def compared(self, test: Constraint) -> tuple[str, ...] | None:
        """Return a constraint on a clock in words, None if it is never satisfied."""
        clock, least, most = test
        name, age = self.names[clock - 1], self.begun[clock - 1]
        if 0 <= most < age:
            return None
        lower = (f"{name} >= {least - age}",) if least > age else ()
        return lower if most < 0 else (*lower, f"{name} <= {most - age}")


@dataclass(slots=True)
class ProcessWriter:
    """The conversion of an automaton into a process.

    Attributes:
        local: The automaton.
        subjects: What each of its clocks measures.
        clock, event: The beginning of the names of clocks, and of events.
        words: The label of a step of a location.
        spots: The reached locations, with their names.
        met: The number of copies of each of the automaton's locations, in time or late.
        names: The possible names of each clock.
    """

    local: LocalAutomaton
    subjects: Sequence[Hashable]
    clock: str
    event: str
    words: Callable[[int, int], str] = lambda location, step: ""  # noqa: ARG005 - no words are known
    spots: dict[_Spot, str] = field(default_factory=dict)
    met: Counter[tuple[int, bool]] = field(default_factory=Counter)
    names: Mapping[Hashable, tuple[str, ...]] = field(init=False)

    def __post_init__(self) -> None:
        locations = [Counter(self.clocks(at)) for at in range(len(self.automaton))]
        self.names = _named(locations, self.clock)

    @property
    def automaton(self) -> TimedAutomaton:
        """The automaton."""
        return self.local.automaton

    def process(self) -> ExportedProcess:
        """Return the process."""
        self.place(self.local.first, [""] * len(self.local.ages), self.local.ages)
        steps, places = list(self.steps()), tuple(self.places())
        texts = chain(*(step.guard for step in steps), *(place.invariant for place in places))
        compared = {text.split()[0] for text in texts}
        names = dict.fromkeys(name for several in self.names.values() for name in several if name in compared)
        kept = (
            step._replace(resets=tuple(each for each in step.resets if each in compared)) for step in steps
        )
        return ExportedProcess(self.local.name, tuple(names), places, tuple(dict.fromkeys(kept)))

    def clocks(self, at: int) -> tuple[Hashable, ...]:
        """Return what a location's clocks measure."""
        return tuple(self.subjects[each] for each in self.automaton.location(at).clocks)

    def place(self, at: int, kept: Sequence[str], begun: Sequence[int], *, is_late: bool = False) -> _Spot:
        """Return a location with the names of its continuing clocks; the others (`""`) get free names."""
        names = list(kept)
        for rank, (name, clock) in enumerate(zip(kept, self.clocks(at), strict=True)):
            names[rank] = name or next(each for each in self.names[clock] if each not in names)
        spot = _Spot(at, tuple(names), tuple(begun), is_late)
        if spot not in self.spots:
            known = self.met[at, is_late]
            self.met[at, is_late] += 1
            self.spots[spot] = f"{'u' if is_late else 'l'}{at}{f'_{known}' if known else ''}"
        return spot

    def steps(self) -> Iterator[ExportedEdge]:
        """Yield the edges of all reached locations."""
        done = 0
        while done < len(self.spots):
            for spot in list(self.spots)[done:]:
                yield from self._steps(spot)
                done += 1

    def _steps(self, spot: _Spot) -> Iterator[ExportedEdge]:
        for edge in self.automaton.out(spot.at):
            yield from self._step(spot, edge)
        for test in self.local.wrong.get(spot.at, ()):
            yield ExportedEdge(self.spots[spot], WRONG, WRONG, guard=spot.compared(test) or ())

    def _step(self, spot: _Spot, edge: Edge) -> Iterator[ExportedEdge]:
        tests = [spot.compared(test) for test in edge.tests]
        if None in tests:
            return
        kept = [spot.names[one - 1] if one else "" for one in edge.sources]
        begun = [spot.begun[one - 1] if one else 0 for one in edge.sources]
        ways = [(False, tests)]
        if not self.stands(edge.target):
            ways += [(True, [*tests, late]) for late in self._too_late(spot, edge)]
        for is_late, guard in ways:
            target = self.place(edge.target, kept, begun, is_late=is_late)
            yield ExportedEdge(
                self.spots[spot],
                self.spots[target],
                f"{self.event}{edge.step}",
                self.words(spot.at, edge.step),
                tuple(text for each in guard for text in each or ()),
                tuple(name for name, old in zip(target.names, kept, strict=True) if not old),
            )

    def _too_late(self, spot: _Spot, edge: Edge) -> Iterator[tuple[str, ...]]:
        """Yield for each deadline after an edge that may have passed that it has."""
        before = {} if spot.is_late else dict(self.automaton.location(spot.at).deadlines)
        for clock, most in self.automaton.location(edge.target).deadlines:
            one = edge.sources[clock - 1]
            if one and before.get(one, most + 1) > most:
                yield (f"{spot.names[one - 1]} > {most - spot.begun[one - 1]}",)

    def stands(self, at: int) -> bool:
        """Return whether a location is urgent."""
        return any(most < 0 for _, most in self.automaton.location(at).deadlines)

    def places(self) -> Iterator[ExportedLocation]:
        """Yield the reached locations."""
        for spot, name in self.spots.items():
            if spot.is_late or self.stands(spot.at):
                yield ExportedLocation(name, is_urgent=True)
            else:
                deadlines = self.automaton.location(spot.at).deadlines
                bounds = (
                    f"{spot.names[clock - 1]} <= {most - spot.begun[clock - 1]}" for clock, most in deadlines
                )
                yield ExportedLocation(name, tuple(bounds))


def _named(locations: Sequence[Counter[Hashable]], begin: str) -> dict[Hashable, tuple[str, ...]]:
    """Return the names of each clock, as many as ever run at once, given the counts of clocks in each location.

    Clocks that never run together may share a name, so names are few.
    """
    most: Counter[Hashable] = Counter()
    beside: defaultdict[Hashable, set[Hashable]] = defaultdict(set)
    for each in locations:
        most |= each
        for clock in each:
            beside[clock].update(each)
    numbers: dict[Hashable, list[int]] = {}
    for clock, others in beside.items():
        taken = {number for other in others for number in numbers.get(other, ())}
        numbers[clock] = list(islice((each for each in count() if each not in taken), most[clock]))
    return {clock: tuple(f"{begin}{each}" for each in found) for clock, found in numbers.items()}
