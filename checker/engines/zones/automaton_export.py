"""A mission's timed automaton in a form for other model checkers: one process, whose edges are the steps.

Their clocks are global and start at 0, and a location can't be entered in violation of its invariant. So an initial
committed location sets clocks that don't start at 0, and entry past a deadline leads to an urgent copy of the location.
UPPAAL copies no clocks, so a continuing clock keeps its name. A location has one copy for each naming of its clocks;
there are several only where equal requests are pending.
"""

from __future__ import annotations

from collections import Counter, defaultdict
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from itertools import count, islice
from typing import Final, NamedTuple

from checker.engines.timed.zone_answers import ZoneTimes
from checker.engines.zones.observers import Meter, Observer, ObserverClock
from checker.engines.zones.timed_automaton import Constraint, Edge, TimedAutomaton
from checker.engines.zones.timed_automaton_of import Network
from semantics.properties.kinds import PropertyKind
from semantics.properties.property import Property
from semantics.timing.actor_clocks import ActorClock

FIRST: Final = "first"
"""The initial location; no time passes in it."""

WRONG: Final = "wrong"
"""The location that is reachable exactly if the property is violated."""


class ExportedLocation(NamedTuple):
    """A location: its name and invariant, or that it is urgent."""

    name: str
    invariant: tuple[str, ...] = ()
    is_urgent: bool = False


class ExportedEdge(NamedTuple):
    """An edge.

    Attributes:
        source, target: The names of its locations.
        event: A short name of its step: the step's number in its configuration.
        words: The label of its step, as in traces.
        guard: A conjunction of comparisons of clocks with constants.
        sets: The assignments to clocks.
    """

    source: str
    target: str
    event: str
    words: str = ""
    guard: tuple[str, ...] = ()
    sets: tuple[tuple[str, int], ...] = ()


class ExportedAutomaton(NamedTuple):
    """A timed automaton.

    Attributes:
        name: The mission's name.
        asked: The property of `WRONG`.
        clocks: The names of its clocks.
        places: Its locations, without `FIRST` and `WRONG`.
        steps: Its edges.
    """

    name: str
    asked: Property | None
    clocks: tuple[str, ...]
    places: tuple[ExportedLocation, ...]
    steps: tuple[ExportedEdge, ...]


def model_of(times: ZoneTimes, asked: Property | None, name: str) -> ExportedAutomaton:
    """Return a mission's automaton; with a deadline or an endurance, `WRONG` is reachable exactly if it is violated.

    Raises:
        ValueError: The property is of another kind.
    """
    network = times.network
    if asked is None or asked.kind is PropertyKind.ENDURANCE:
        locations = range(len(network.automaton))
        wrong = {at: tuple(times.exhaustion(at).values()) for at in locations} if asked else {}
        walk = _Walk(network, network.automaton, locations, wrong)
        return _model(name, asked, walk, network.first, network.first_ages)
    if asked.kind is not PropertyKind.WITHIN:
        raise ValueError("only deadlines and endurance are exported")
    awaited = asked.formula if asked.then is None else asked.then
    rule = times.waiting(None if asked.then is None else asked.formula, awaited)
    observer = Observer(network, rule, Meter(asked.bound + 1, goal=(ObserverClock.ON, asked.bound + 1)))
    goals = ((at, observer.automaton.location(at).goal) for at in range(len(observer.automaton)))
    late = {at: [goal] for at, goal in goals if goal is not None}
    walk = _Walk(network, observer.automaton, observer.locations.tolist(), late)
    return _model(name, asked, walk, 0, observer.first_ages())


def _model(
    name: str, asked: Property | None, walk: _Walk, location: int, ages: Sequence[int]
) -> ExportedAutomaton:
    first = walk.place(location, [""] * len(ages))
    sets = tuple((clock, age) for clock, age in zip(first.names, ages, strict=True) if age)
    steps = (ExportedEdge(FIRST, walk.spots[first], "begin", sets=sets), *walk.steps())
    clocks = sorted({clock for spot in walk.spots for clock in spot.names}, key=lambda each: int(each[1:]))
    return ExportedAutomaton(name, asked, tuple(clocks), tuple(walk.places()), steps)


class _Spot(NamedTuple):
    """A location with the names of its clocks, and whether it is the copy for entry past a deadline."""

    at: int
    names: tuple[str, ...]
    is_late: bool = False


@dataclass(slots=True)
class _Walk:
    """The conversion of an automaton into a model.

    Attributes:
        network: The mission's automaton.
        automaton: That automaton, or the one with an observer's clock.
        locations: The mission's location behind each of the automaton's.
        wrong: The clock constraints that violate the property in each location.
        spots: The reached locations, with their names.
        met: The number of copies of each of the automaton's locations, in time or late.
        names: The possible names of each clock; None stands for an observer's.
    """

    network: Network
    automaton: TimedAutomaton
    locations: Sequence[int]
    wrong: Mapping[int, Sequence[Constraint]]
    spots: dict[_Spot, str] = field(default_factory=dict)
    met: Counter[tuple[int, bool]] = field(default_factory=Counter)
    names: Mapping[ActorClock | None, tuple[str, ...]] = field(init=False)

    def __post_init__(self) -> None:
        self.names = _named([Counter(self.clocks(at)) for at in range(len(self.automaton))])

    def clocks(self, at: int) -> tuple[ActorClock | None, ...]:
        """Return the measured subjects of a location's clocks."""
        measured = self.network.clocks(self.locations[at])
        return (*measured, *([None] if len(self.automaton.location(at).clocks) > len(measured) else []))

    def place(self, at: int, kept: Sequence[str], *, is_late: bool = False) -> _Spot:
        """Return a location with the names of its continuing clocks; the others (`""`) get free names."""
        names = list(kept)
        for rank, (name, clock) in enumerate(zip(kept, self.clocks(at), strict=True)):
            names[rank] = name or next(each for each in self.names[clock] if each not in names)
        spot = _Spot(at, tuple(names), is_late)
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
        for clock, least, _ in self.wrong.get(spot.at, ()):
            yield ExportedEdge(self.spots[spot], WRONG, WRONG, guard=(f"{spot.names[clock - 1]} >= {least}",))

    def _step(self, spot: _Spot, edge: Edge) -> Iterator[ExportedEdge]:
        tests = [
            f"{spot.names[clock - 1]} {relation} {bound}"
            for clock, least, most in edge.tests
            for relation, bound, says in ((">=", least, least > 0), ("<=", most, most >= 0))
            if says
        ]
        kept = [spot.names[one - 1] if one else "" for one in edge.sources]
        ways = [(False, tests)]
        if not self.stands(edge.target):
            late = [f"{spot.names[one - 1]} > {most}" for one, most in self._too_late(spot, edge)]
            ways += [(True, [*tests, each]) for each in late]
        for is_late, guard in ways:
            target = self.place(edge.target, kept, is_late=is_late)
            sets = tuple((name, 0) for name, old in zip(target.names, kept, strict=True) if not old)
            yield ExportedEdge(
                self.spots[spot],
                self.spots[target],
                f"s{edge.step}",
                self._words(spot.at, edge.step),
                tuple(guard),
                sets,
            )

    def _too_late(self, spot: _Spot, edge: Edge) -> list[tuple[int, int]]:
        """Return the clocks that may be past a deadline after an edge, with its bound."""
        before = {} if spot.is_late else dict(self.automaton.location(spot.at).deadlines)
        after = [
            (edge.sources[clock - 1], most) for clock, most in self.automaton.location(edge.target).deadlines
        ]
        return [(one, most) for one, most in after if one and before.get(one, most + 1) > most]

    def stands(self, at: int) -> bool:
        """Return whether a location is urgent."""
        return any(most < 0 for _, most in self.automaton.location(at).deadlines)

    def _words(self, at: int, step: int) -> str:
        situation = self.network.situation(self.network.place(self.locations[at]).number)
        return str(situation.steps[step].transition.label)

    def places(self) -> Iterator[ExportedLocation]:
        """Yield the reached locations."""
        for spot, name in self.spots.items():
            if spot.is_late or self.stands(spot.at):
                yield ExportedLocation(name, is_urgent=True)
            else:
                deadlines = self.automaton.location(spot.at).deadlines
                yield ExportedLocation(
                    name, tuple(f"{spot.names[clock - 1]} <= {most}" for clock, most in deadlines)
                )


def _named(locations: Sequence[Counter[ActorClock | None]]) -> dict[ActorClock | None, tuple[str, ...]]:
    """Return the names of each clock, as many as ever run at once, given the counts of clocks in each location.

    Clocks that never run together may share a name, so names are few.
    """
    most: Counter[ActorClock | None] = Counter()
    beside: defaultdict[ActorClock | None, set[ActorClock | None]] = defaultdict(set)
    for each in locations:
        most |= each
        for clock in each:
            beside[clock].update(each)
    numbers: dict[ActorClock | None, list[int]] = {}
    for clock, others in beside.items():
        taken = {number for other in others for number in numbers.get(other, ())}
        numbers[clock] = list(islice((each for each in count() if each not in taken), most[clock]))
    return {clock: tuple(f"x{each}" for each in found) for clock, found in numbers.items()}
