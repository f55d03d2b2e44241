"""Check a mission: explore it, decide each property, and find shortest traces."""

from collections.abc import Callable, Iterable
from dataclasses import replace

from checker.exploration import INTERRUPTION, Engine, Exploration, Inspect, Limits, Progress, explore
from checker.findings import Collected
from checker.inspections import Computation, DeadlockFreedom, Invariant, LocalConsistency, Reachability
from checker.ownership import owned
from checker.races import ControlRaces, StaleObservationRaces
from checker.reduction.reducer import Reduced, reducing
from checker.reduction.refusals import Reduction
from checker.traces import Trace, trace_to
from checker.verdicts import Outcome, Report, Verdict, Violation
from semantics.configuration import Configuration
from semantics.monitor import monitored
from semantics.propositions import Property

Reporter = Callable[[Progress], None]


def check(  # noqa: PLR0913  # what a user may vary, each by name
    initial: Configuration,
    properties: Iterable[Property],
    limits: Limits | None = None,
    report: Reporter | None = None,
    notes: tuple[str, ...] = (),
    engine: Engine = Engine.LEARNED,
    *,
    reduce: Iterable[Reduction] = (),
) -> Report:
    """Explore everything that is reachable and decide the properties.

    Race-freedom is first looked for in the text (by ownership); where that doesn't settle it, the mission is explored
    once more with what observations rest on remembered. Configurations are counted without that memory.

    Raises:
        RefusedError: A reduction is unsound for the mission, or nothing in it allows one. Properties that it is
            unsound for are not decided, unless something was found against them.
    """
    asked = tuple(properties)
    formulas = [each.formula for each in asked if each.kind in ("invariant", "reachable")]
    reducer = reducing(initial, reduce, formulas)
    return _Check(initial, asked, limits or Limits(), report, engine, reducer).run(notes)


class _Check:
    def __init__(
        self,
        initial: Configuration,
        properties: tuple[Property, ...],
        limits: Limits,
        report: Reporter | None,
        engine: Engine,
        reducer: Reduced | None,
    ) -> None:
        self.initial = initial
        self.properties = properties
        self.limits = limits
        self.report = report
        self.engine = engine
        self.reducer = reducer
        self.deadlock = DeadlockFreedom()
        self.consistency = LocalConsistency()
        self.computation = Computation()
        self.races = ControlRaces()
        self.stale = StaleObservationRaces()
        self.formulas = {
            each: Invariant(each.formula) if each.kind == "invariant" else Reachability(each.formula)
            for each in self.properties
            if each.kind in ("invariant", "reachable")
        }
        asked = any(each.kind == "race_freedom" for each in self.properties)
        self.owned = asked and owned(initial)
        self.searching = asked and not self.owned
        self.remembered: Exploration | None = None

    def run(self, notes: tuple[str, ...]) -> Report:
        races = (self.races,) if self.searching else ()
        inspections: tuple[Inspect, ...] = (self.deadlock, self.consistency, self.computation, *races)
        looking = (*inspections, *self.formulas.values())
        self.found = self.explore(self.initial, looking, self.limits, self.reducer)
        if self.searching and not any(map(self.refused, self.properties)):
            self.remembered = self.search()
        later = self.remembered.bounds if self.remembered else []
        return Report(
            verdicts=tuple(map(self.decide, self.properties)),
            configurations=len(self.found.configurations),
            transitions=self.found.transitions,
            depth=max(self.found.depths),
            bounds=tuple(dict.fromkeys([*self.found.bounds, *later])),
            rules=dict(sorted(self.found.rules.items())),
            notes=notes,
            seconds=self.found.seconds + (self.remembered.seconds if self.remembered else 0.0),
            reduced=tuple(map(str, self.reducer.names)) if self.reducer else (),
            allowed=self.found.allowed,
        )

    def explore(
        self,
        start: Configuration,
        inspections: tuple[Inspect, ...],
        limits: Limits,
        reducer: Reduced | None = None,
    ) -> Exploration:
        return explore(start, inspections, limits, self.report, engine=self.engine, reduce=reducer)

    def search(self) -> Exploration | None:
        """Explore once more, with memory and in the time that is left; None where the user has asked for the end."""
        if INTERRUPTION in self.found.bounds:
            return None
        limits = replace(self.limits, spent=self.limits.spent + self.found.seconds)
        remembered = self.explore(monitored(self.initial), (self.stale,), limits)
        remembered.bounds = [f"{bound}, in the search for stale observations" for bound in remembered.bounds]
        return remembered

    def refused(self, asked: Property) -> str | None:
        """Return why a reduction leaves a property undecided, None where it does not."""
        if asked.kind == "race_freedom" and self.owned:
            return None  # decided without a search
        return self.reducer.refuses(asked) if self.reducer else None

    def decide(self, asked: Property) -> Verdict:
        """Return the verdict on one property: what a reduction may have lost is not said to hold."""
        reason = self.refused(asked)
        if reason is None:
            return self.decided(asked)
        found = self.decided(asked)
        note = f"not decided under this reduction: {reason}"
        return found if found.outcome is Outcome.VIOLATED else Verdict(asked, Outcome.INCOMPLETE, note=note)

    def decided(self, asked: Property) -> Verdict:
        """Return what the exploration says of a property."""
        match asked.kind:
            case "race_freedom":
                return self.decide_races(asked)
            case "reachable":
                return self.decide_reachable(asked)
            case "deadlock_freedom":
                return self.decide_deadlock(asked)
            case "local_consistency":
                return self.verdict(asked, self.consistency.collected)
            case "arrival":
                note = "flights declared to arrive are fair" if self.found.rules["commit"] else ""
                return self.verdict(asked, self.deadlock.arrival, note)
            case "computation":
                return self.verdict(asked, self.computation.collected)
            case _:
                return self.verdict(asked, self.formulas[asked].collected)

    def verdict(self, asked: Property, collected: Collected, note: str = "") -> Verdict:
        """Return the verdict of a property that no finding may speak against."""
        violations = self.violations(collected, self.found)
        outcome = self.outcome(bool(violations), self.found)
        witness = None if violations else self.witness(collected, self.found)
        return Verdict(asked, outcome, violations, collected.count, collected.examined, witness, note)

    def decide_deadlock(self, asked: Property) -> Verdict:
        late = self.deadlock.arrival.first.get("not arrived")
        if late is None:
            return self.verdict(asked, self.deadlock.collected)
        message = _teller(self.found, late.at)(late.message)
        note = f"{message}; declare that it arrives, or check arrival"
        return self.verdict(asked, self.deadlock.collected, note)

    def decide_reachable(self, asked: Property) -> Verdict:
        collected = self.formulas[asked].collected
        if collected.example is not None:
            witness = trace_to(self.found, collected.example)
            return Verdict(asked, Outcome.HOLDS, examined=collected.examined, witness=witness)
        note = f"no reachable configuration satisfies: {asked.formula}" if self.found.complete else ""
        outcome = Outcome.VIOLATED if self.found.complete else Outcome.INCOMPLETE
        return Verdict(asked, outcome, note=note)

    def decide_races(self, asked: Property) -> Verdict:
        if self.owned:
            note = "by ownership, without a search: no agent may write what another's control rests on"
            return Verdict(asked, Outcome.HOLDS, note=note)
        violations = self.violations(self.races.collected, self.found)
        if self.remembered is None:
            outcome = Outcome.VIOLATED if violations else Outcome.INCOMPLETE
            return Verdict(
                asked, outcome, violations, self.races.collected.count, note="not searched to the end"
            )
        control, stale = self.races.collected, self.stale.collected
        violations += self.violations(stale, self.remembered)
        outcome = self.outcome(bool(violations), self.found, self.remembered)
        witness = None if violations else self.witness(stale, self.remembered)
        shortest = tuple(sorted(violations, key=lambda violation: len(violation.trace)))
        count, examined = control.count + stale.count, control.examined + stale.examined
        searched = f"{len(self.remembered.configurations):,}"
        note = f"searched over {searched} configurations with the monitor's memory"
        if outcome is Outcome.HOLDS and not examined:
            note += "; vacuous: no control was ever served"
        return Verdict(asked, outcome, shortest, count, examined, witness, note)

    def outcome(self, violated: bool, *explorations: Exploration) -> Outcome:
        if violated:
            return Outcome.VIOLATED
        return Outcome.HOLDS if all(each.complete for each in explorations) else Outcome.INCOMPLETE

    def violations(self, collected: Collected, found: Exploration) -> tuple[Violation, ...]:
        return tuple(
            Violation(each.kind, told(each.message), trace, tuple(map(told, each.details)))
            for each in collected.first.values()
            for trace, told in [(trace_to(found, each.at, each.by), _teller(found, each.at))]
        )

    def witness(self, collected: Collected, found: Exploration) -> Trace | None:
        if collected.example is None:
            return None
        return trace_to(found, collected.example, collected.example_by)


def _teller(found: Exploration, number: int) -> Callable[[str], str]:
    """Return what puts the names of the run in the place of those of the configuration that stands for its end."""
    reducer = found.reducer
    return str if reducer is None else lambda text: reducer.told(found, number, text)
