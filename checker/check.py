"""Check a mission: explore it, decide each property, and find shortest traces."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import replace
from typing import TYPE_CHECKING, NamedTuple, Protocol, assert_never

from checker.engines.capabilities import CombinationError, engines, features, require
from checker.engines.choose import explore_by
from checker.engines.contract import Cluster, Engine, Exploration, Keeping, Options, Reporter, ZoneClock
from checker.engines.original_run import in_original_names
from checker.handover import Compilation, Handover
from checker.limits import BoundMet, CheckPart, Limits, Stop, bounded
from checker.properties.assumed_ways import assumed_ways
from checker.properties.coverage import coverage
from checker.properties.findings import MOST_VIOLATIONS, Collected, Finding
from checker.properties.flown_stances import FlownStances
from checker.properties.inspections import (
    Arrival,
    Computation,
    DeadlockFreedom,
    Inspection,
    Invariant,
    LocalConsistency,
    Reachability,
)
from checker.properties.ownership import owned
from checker.properties.races import ControlRaces, StaleObservationRaces
from checker.properties.visited_statements import Visited
from checker.reduction.refusals import Reduction, RefusedError
from checker.traces import Trace, trace_of, trace_to
from checker.verdicts import Outcome, Report, Verdict, Verdicts, Violation
from physical.wordings import counted
from semantics.properties.kinds import PropertyKind
from semantics.properties.property import Property, asks_of_regions, instantiated_region_atoms, watching
from semantics.races.monitor import monitored
from semantics.state.configuration import Configuration
from semantics.state.setting import Control

if TYPE_CHECKING:
    from checker.properties.corridors import Corridors
    from checker.properties.deadlines import Deadlines
    from checker.properties.schedule import Schedule
    from checker.properties.suspected_ways import SuspectedWays
    from checker.properties.temporal.decide import TemporalDecider
    from checker.reduction.reducer import Reduced
    from semantics.properties.propositions import Proposition
    from semantics.regions.suspicions import SuspectedWay, Suspicion

BY_LOOKING: dict[PropertyKind, Callable[[int], Inspection]] = {
    PropertyKind.LOCAL_CONSISTENCY: LocalConsistency,
    PropertyKind.DEADLOCK_FREEDOM: DeadlockFreedom,
    PropertyKind.ARRIVAL: Arrival,
    PropertyKind.COMPUTATION: Computation,
}
"""The inspection for each property that has no proposition of the mission's own."""

PATIENCE = 1.0
"""Seconds after which the fast explorer takes over a mission from the reference explorer (`checker.handover`)."""

LARGE = (Stop.CONFIGURATIONS, Stop.MEMORY)
"""The bounds that the fast explorer may not meet: it takes less memory, and counts zones instead of ticks."""

UNTIMED = "not decided: the mission has no durations; give it a section `timing`"


class Checkable(Protocol):
    """A mission: its initial configuration, its properties, and notes for the report."""

    @property
    def initial(self) -> Configuration:
        """The first configuration."""

    @property
    def properties(self) -> tuple[Property, ...]:
        """The properties to decide."""

    @property
    def notes(self) -> tuple[str, ...]:
        """Additional notes of the report."""


def check(  # noqa: PLR0913 - independent options
    start: Configuration | Checkable,
    properties: Iterable[Property] | None = None,
    limits: Limits | None = None,
    report: Reporter | None = None,
    notes: tuple[str, ...] = (),
    engine: Engine | None = None,
    *,
    violations: int = MOST_VIOLATIONS,
    reduce: Iterable[Reduction] = (),
    keeping: Keeping | None = None,
    cluster: Cluster | None = None,
    threads: int | None = None,
    clock: ZoneClock = ZoneClock.LOCAL,
    times: bool = False,
    ways: bool = False,
    suspected: Iterable[Suspicion] = (),
) -> Report:
    """Explore the reachable configurations and decide the properties.

    An ownership analysis of the text comes first for race-freedom. Where it is inconclusive, a second exploration
    searches with the provenance of observations in each configuration. The report counts configurations without it.

    Args:
        start: A mission, or an initial configuration.
        properties: The properties to decide; by default those of the mission.
        limits: The bounds of the exploration.
        report: Receives the progress.
        notes: Additional notes of the report.
        engine: The engine; by default the quicker one for the mission's size.
        violations: The most violations to show of a property, each different and with a shortest trace.
        reduce: The reductions to apply.
        keeping: Checkpoints and self-checks of the fast explorer; giving them selects that engine.
        cluster: The workers of the engine Ray.
        threads: The most threads of the fast explorer; by default one for each core.
        clock: The clock of a search through zones, for a mission with `timing`.
        times: Whether the report says when flights may begin and end, for a mission with `timing`.
        ways: Whether the report lists the ways of all flights, with their lengths and distances.
        suspected: What the text suggests about ways; the report says what the exploration found, unless it was reduced.

    Raises:
        CombinationError: Two options do not work together, or one with the mission (`checker.engines.capabilities`).
        RefusedError: A reduction is unsound for the mission, or the mission has nothing to reduce. If a reduction is
            unsound for a single property, that property stays undecided unless a violation was found.
        TypeError: A configuration is given without properties.
    """
    initial, asked, notes = _asked(start, properties, notes)
    formulas, reductions = _formulas(asked), tuple(reduce)
    timing = initial.setting.timing is not None
    atomic = initial.setting.control is Control.ATOMIC
    suspicions = () if atomic or reductions else tuple(suspected)
    if ways or asks_of_regions(asked):
        initial = watching(initial, asked, ways=True)
        notes = (*notes, *assumed_ways(initial.setting))
    initial, limits = watching(initial, asked, ways=bool(suspicions)), limits or Limits()
    wanted = features(
        limits, keeping, reductions, cluster=cluster, threads=threads, timing=timing, ways=ways, atomic=atomic
    )
    able = engines(wanted, engine)
    runs = [each for each in asked if each.is_of_runs]
    reducer = _reduced(initial, reductions, formulas, runs) if reductions else None
    kept, crew = keeping or Keeping(), cluster or Cluster()
    options = Options(
        limits, report, reduce=reducer, keeping=kept, cluster=crew, threads=threads, clock=clock
    )

    def run(engine: Engine, limits: Limits) -> Report:
        exploration = replace(options, engine=engine, limits=limits)
        return _Check(initial, asked, exploration, violations, _Extras(times, ways, suspicions)).run(notes)

    impatient = limits.seconds is None or limits.seconds > PATIENCE
    if len(able) == 1 or not impatient:
        return run(able[0], limits)
    with Handover(PATIENCE, Compilation(initial, asked, reductions, threads, times, ways)) as handover:
        tried = run(able[0], replace(limits, overtaken=handover.is_due, uncounted=handover.uncounted))
    stops = {bound.stop for bound in tried.bounds}
    if Stop.OVERTAKEN in stops or (handover.is_waiting and not stops.isdisjoint(LARGE)):
        return run(able[1], replace(limits, spent=limits.spent + min(tried.seconds, PATIENCE)))
    return tried


def _asked(
    start: Configuration | Checkable, properties: Iterable[Property] | None, notes: tuple[str, ...]
) -> tuple[Configuration, tuple[Property, ...], tuple[str, ...]]:
    """Return the initial configuration, the properties and the notes of a check."""
    if not isinstance(start, Configuration):
        asked = start.properties if properties is None else tuple(properties)
        return start.initial, asked, notes or start.notes
    if properties is None:
        raise TypeError("a configuration has no properties: give them too, or a mission")
    return start, tuple(properties), notes


def _formulas(properties: Iterable[Property]) -> list[Proposition]:
    """Return the propositions about configurations that a reduction has to preserve."""
    asked = [each for each in properties if each.kind.has_proposition or each.kind.is_of_time]
    return [formula for each in asked for formula in (each.formula, each.then) if formula is not None]


def _reduced(
    initial: Configuration,
    reductions: Iterable[Reduction],
    formulas: Sequence[Proposition] = (),
    runs: Iterable[Property] = (),
) -> Reduced:
    from checker.reduction.reducer import Reduced  # noqa: PLC0415 - few explorations are reduced

    return Reduced(initial, reductions, formulas, runs)


def _suspected(suspicions: Iterable[Suspicion]) -> SuspectedWays:
    from checker.properties.suspected_ways import SuspectedWays  # noqa: PLC0415 - geometry takes its time to load

    return SuspectedWays(suspicions)


def reductions_of(start: Checkable) -> tuple[Reduction, ...]:
    """Return the reductions that are sound for a mission; they can be combined."""
    timing = start.initial.setting.timing is not None
    formulas = _formulas(start.properties)
    initial, sound = watching(start.initial, start.properties), list[Reduction]()
    for reduction in Reduction:
        try:
            require(features(Limits(), None, [reduction], cluster=None, threads=None, timing=timing))
            _reduced(initial, (reduction,), formulas)
        except (CombinationError, RefusedError):
            continue
        sound.append(reduction)
    return tuple(sound)


class _Extras(NamedTuple):
    """What a report has besides verdicts."""

    times: bool
    ways: bool
    suspicions: tuple[Suspicion, ...]


class _Check:
    def __init__(
        self,
        initial: Configuration,
        properties: tuple[Property, ...],
        options: Options,
        most: int,
        extras: _Extras,
    ) -> None:
        self.initial = initial
        self.times = extras.times
        self.suspected = _suspected(extras.suspicions) if extras.suspicions else None
        self.flown = FlownStances(initial, instantiated_region_atoms(properties)) if extras.ways else None
        self.properties = properties
        self.options = options
        self.most = most
        self.visited = Visited()
        self.inspections = {kind: make(most) for kind, make in BY_LOOKING.items()}
        self.races = ControlRaces(most)
        self.stale = StaleObservationRaces(most)
        self.formulas = {
            each: Invariant(each.formula, each.shown)
            if each.kind is PropertyKind.INVARIANT
            else Reachability(each.formula)
            for each in self.properties
            if each.kind.has_proposition
        }
        asked = any(each.kind is PropertyKind.RACE_FREEDOM for each in self.properties)
        self.owned = asked and owned(initial)
        self.searching = asked and not self.owned
        self.remembered: Exploration | None = None
        self.temporal = tuple(
            each for each in self.properties if each.is_of_runs and self.refused(each) is None
        )
        self.decider: TemporalDecider | None = None
        self.deadlines: Deadlines | None = None
        self.unscheduled: tuple[str, ...] = ()

    def run(self, notes: tuple[str, ...]) -> Report:
        """Explore, and decide the properties."""
        races = (self.races,) if self.searching else ()
        stances = (each for each in (self.flown, self.suspected) if each is not None)
        everything = (self.visited, *self.inspections.values(), *races, *self.formulas.values(), *stances)
        options = self.options
        self.found = explore_by(self.initial, everything, replace(options, edges=bool(self.temporal)))
        if self.found.times is not None and self.initial.setting.timing is not None:
            from checker.properties.deadlines import Deadlines  # noqa: PLC0415 - few missions speak of time

            self.deadlines = Deadlines(self.found, self.found.times, self.initial.setting.timing)
        if self.searching:
            self.remembered = self.search()
        later = self.remembered.bounds if self.remembered else []
        seconds = self.found.seconds + (self.remembered.seconds if self.remembered else 0.0)
        limits, spent = options.limits, options.limits.spent + seconds - self.compiling()
        with bounded(replace(limits, spent=spent, overtaken=None)):
            verdicts = Verdicts(map(self.decide, self.properties))
            schedule = self.schedule()
            corridors = self.corridors()
            suspected = self.suspected_ways()
        return Report(
            verdicts=verdicts,
            configurations=self.found.size,
            transitions=self.found.transitions,
            depth=self.found.depth,
            bounds=tuple(dict.fromkeys([*self.found.bounds, *later])),
            rules=dict(sorted(self.found.rules.items())),
            notes=(*notes, *(self.deadlines.notes() if self.deadlines else ()), *self.unscheduled),
            seconds=seconds,
            coverage=coverage(
                self.initial, self.visited, complete=self.found.complete and not options.reduce
            ),
            reduced=tuple(map(str, options.reduce.names)) if options.reduce else (),
            allowed=self.found.allowed,
            schedule=schedule,
            corridors=corridors,
            suspected=suspected,
            flights=self.deadlines.longest_flights() if self.deadlines else (),
        )

    def compiling(self) -> float:
        """Return the seconds that both explorations spent on compiling loops."""
        return self.found.compiling + (self.remembered.compiling if self.remembered else 0.0)

    def schedule(self) -> Schedule | None:
        """Return the earliest and latest dates of flights, if they were requested and time doesn't stop."""
        if not self.times or self.deadlines is None:
            return None
        try:
            return None if self.deadlines.stop is not None else self.deadlines.schedule(self.properties)
        except BoundMet as met:
            self.unscheduled = (f"the times of flights were not computed: {met.bound}",)
            return None

    def corridors(self) -> Corridors | None:
        """Return the ways of flights with their distances, if they were requested."""
        if self.flown is None:
            return None
        from checker.properties.corridors import measured  # noqa: PLC0415 - geometry takes its time to load

        assert self.initial.setting.regions is not None
        return measured(self.initial.setting.regions, self.flown, complete=self.found.complete)

    def suspected_ways(self) -> Mapping[Suspicion, SuspectedWay | None]:
        """Return what the exploration found of each suspicion."""
        facts = self.initial.setting.regions
        if self.suspected is None or facts is None:
            return {}
        return self.suspected.decided(facts, complete=self.found.complete)

    def search(self) -> Exploration | None:
        """Search for stale observations with the monitor's memory, in the remaining time.

        Return None after an interruption.
        """
        if any(bound.stop is Stop.INTERRUPTION for bound in self.found.bounds):
            return None
        options, start, reduce = self.options, monitored(self.initial), None
        limits = replace(
            options.limits, spent=options.limits.spent + self.found.seconds - self.found.compiling
        )
        if options.reduce is not None and options.reduce.putting_off:  # symmetry loses the owner of a memory
            reduce = _reduced(start, [Reduction.POR])
        remembered = explore_by(start, (self.stale,), replace(options, limits=limits, reduce=reduce))
        remembered.bounds = [bound.met_in(CheckPart.SEARCHING) for bound in remembered.bounds]
        return remembered

    def refused(self, asked: Property) -> str | None:
        """Return why a reduction leaves a property undecided, None where it decides it."""
        if asked.kind is PropertyKind.RACE_FREEDOM and self.owned:
            return None  # decided without a search
        return self.options.reduce.refuses(asked) if self.options.reduce else None

    def decide(self, asked: Property) -> Verdict:
        """Return the verdict on one property; *holds* is undecided where the reduction is unsound for the property."""
        if self.deadlines is not None:
            return self.deadlines.judge(asked, self.decided)
        reason = self.refused(asked)
        if reason is None:
            return self.decided(asked)
        undecided = Verdict(asked, Outcome.INCOMPLETE, note=f"not decided under this reduction: {reason}")
        if asked.kind is PropertyKind.DEADLOCK_FREEDOM:  # without any deadlock, no fair run has one
            literal = self.decide_deadlock(asked)
            return literal if literal.outcome is Outcome.HOLDS else undecided
        if asked.is_of_runs:  # a violating run of the reduced search may be no run of the mission
            return undecided
        found = self.decided(asked)
        return found if found.outcome is Outcome.VIOLATED else undecided

    def decided(self, asked: Property) -> Verdict:
        """Return the verdict of the exploration on a property."""
        match asked.kind:
            case PropertyKind.RACE_FREEDOM:
                return self.decide_races(asked)
            case PropertyKind.REACHABLE:
                return self.decide_reachable(asked)
            case PropertyKind.INVARIANT:
                return self.decide_invariant(asked)
            case PropertyKind.DEADLOCK_FREEDOM:
                literal = self.decide_deadlock(asked)
                fair = asked.fairness and literal.outcome is Outcome.VIOLATED
                return self.decide_temporal(asked) if fair else literal
            case PropertyKind.ARRIVAL:
                note = "flights declared to arrive are fair" if self.found.rules["commit"] else ""
                return self.verdict(asked, self.collected(asked.kind), note)
            case PropertyKind.LOCAL_CONSISTENCY | PropertyKind.COMPUTATION:
                return self.verdict(asked, self.collected(asked.kind))
            case PropertyKind.LTL | PropertyKind.CTL | PropertyKind.PROGRESS:
                return self.decide_temporal(asked)
            case PropertyKind.WITHIN | PropertyKind.ENDURANCE | PropertyKind.TIME:
                if self.deadlines is None:
                    return Verdict(asked, Outcome.INCOMPLETE, note=UNTIMED)
                return self.deadlines.decide(asked)
            case _:
                assert_never(asked.kind)

    def collected(self, kind: PropertyKind) -> Collected:
        """Return the findings of the inspection for a kind of property."""
        return self.inspections[kind].collected

    def decide_temporal(self, asked: Property) -> Verdict:
        from checker.properties.temporal.decide import TemporalDecider  # noqa: PLC0415 - numpy takes its time to load

        try:
            if self.decider is None:
                self.decider = TemporalDecider(self.found, self.temporal, self.most)
            return self.decider.decide(asked)
        except BoundMet as met:
            return Verdict(asked, Outcome.INCOMPLETE, note=f"not decided: {met.bound} was met")
        except MemoryError:
            return Verdict(asked, Outcome.INCOMPLETE, note="not decided: there is not enough memory")

    def verdict(self, asked: Property, collected: Collected, note: str = "") -> Verdict:
        """Return the verdict on a property that any finding violates."""
        violations = self.violations(collected, self.found)
        outcome = self.outcome(bool(violations), self.found)
        witness = None if violations else self.witness(collected, self.found)
        return Verdict(
            asked,
            outcome,
            violations,
            collected.count,
            collected.examined,
            witness,
            note,
            collected.different,
            self.vacuous(asked, outcome, collected.examined),
        )

    def decide_deadlock(self, asked: Property) -> Verdict:
        collected = self.collected(asked.kind)
        late = next(iter(self.collected(PropertyKind.ARRIVAL).first.values()), None)
        if late is None:
            return self.verdict(asked, collected)
        message = _teller(self.found, late)(late.message)
        note = f"{message}; declare that it arrives, or check arrival"
        return self.verdict(asked, collected, note)

    def decide_invariant(self, asked: Property) -> Verdict:
        looked = self.formulas[asked]
        verdict = self.verdict(asked, looked.collected)
        if verdict.outcome is not Outcome.HOLDS or not isinstance(looked, Invariant):
            return verdict
        return replace(verdict, remarks=looked.valuations.remarks(asked.ranges))

    def decide_reachable(self, asked: Property) -> Verdict:
        collected = self.formulas[asked].collected
        if collected.example is not None:
            witness = trace_to(self.found, collected.example)
            remarks = () if witness.steps else ("it is true from the start",)
            examined = collected.examined
            return Verdict(asked, Outcome.HOLDS, examined=examined, witness=witness, remarks=remarks)
        note = f"no reachable configuration satisfies: {asked.shown}" if self.found.complete else ""
        outcome = Outcome.VIOLATED if self.found.complete else Outcome.INCOMPLETE
        return Verdict(asked, outcome, note=note)

    def decide_races(self, asked: Property) -> Verdict:
        if self.owned:
            note = "by ownership, without a search: no agent may change anything that another's control depends on"
            served = self.witness(self.collected(PropertyKind.LOCAL_CONSISTENCY), self.found)
            return Verdict(asked, Outcome.HOLDS, witness=served, note=note)
        violations = self.violations(self.races.collected, self.found)
        if self.remembered is None:
            outcome = Outcome.VIOLATED if violations else Outcome.INCOMPLETE
            count, different = self.races.collected.count, self.races.collected.different
            note = "not searched to the end"
            return Verdict(asked, outcome, violations, count, note=note, different=different)
        control, stale = self.races.collected, self.stale.collected
        violations += self.violations(stale, self.remembered)
        outcome = self.outcome(bool(violations), self.found, self.remembered)
        witness = None if violations else self.witness(stale, self.remembered)
        shown = _shown(violations, self.most)
        different = control.different + stale.different
        count, examined = control.count + stale.count, control.examined + stale.examined
        searched = counted(len(self.remembered.configurations), "configuration")
        reduced = ", reduced by por" if self.remembered.reducer else ""
        note = f"searched over {searched} with the monitor's memory{reduced}"
        remarks = self.vacuous(asked, outcome, examined)
        return Verdict(asked, outcome, shown, count, examined, witness, note, different, remarks)

    def vacuous(self, asked: Property, outcome: Outcome, examined: int) -> tuple[str, ...]:
        """Return the remark on a vacuous verdict: the property holds and nothing was examined."""
        meaning = asked.kind.about.vacuous
        return (f"vacuous: {meaning}",) if meaning and outcome is Outcome.HOLDS and not examined else ()

    def outcome(self, violated: bool, *explorations: Exploration) -> Outcome:
        if violated:
            return Outcome.VIOLATED
        return Outcome.HOLDS if all(each.complete for each in explorations) else Outcome.INCOMPLETE

    def violations(self, collected: Collected, found: Exploration) -> tuple[Violation, ...]:
        return tuple(
            Violation(
                each.kind,
                told(each.message),
                trace,
                (*map(told, each.details), *trace.told_race),
                told(each.subject),
                collected.alike(each),
            )
            for each in collected.chosen()
            for trace, told in [(trace_of(found, each), _teller(found, each))]
        )

    def witness(self, collected: Collected, found: Exploration) -> Trace | None:
        if collected.example is None:
            return None
        return trace_to(found, collected.example, collected.example_by)


def _shown(violations: tuple[Violation, ...], most: int) -> tuple[Violation, ...]:
    """Return the shortest violations of two explorations, one of each kind before a second of any kind."""
    shortest = sorted(violations, key=lambda violation: len(violation.trace))
    firsts = list({each.kind: each for each in reversed(shortest)}.values())
    kept = sorted(firsts, key=shortest.index) + [each for each in shortest if each not in firsts]
    return tuple(each for each in shortest if each in kept[:most])


def _teller(found: Exploration, finding: Finding) -> Callable[[str], str]:
    """Return a function that replaces the names of a representative by those of the unreduced run to a finding."""
    return lambda text: in_original_names(found, finding.at, text, finding.by)
