"""Decide the temporal properties of a mission, on the edges that an exploration stored."""

from collections.abc import Iterable, Iterator
from dataclasses import replace
from functools import partial
from typing import Final

import numpy as np

from checker.engines.contract import Exploration
from checker.engines.graph import Graph, graph_of
from checker.engines.original_run import lasso_of
from checker.limits import BoundMet
from checker.properties import invariant_vacuity
from checker.properties.findings import MOST_VIOLATIONS, Finding
from checker.properties.inspections import DeadlockFreedom
from checker.properties.temporal.components import Conditions
from checker.properties.temporal.deadlock import Deadlocks
from checker.properties.temporal.decision import Decision, FormulaDecider
from checker.properties.temporal.fairness import EACH_RULE_AND_REQUEST, classes, conditions_of, optional
from checker.properties.temporal.lassos import Lasso
from checker.properties.temporal.served_requests import (
    Pending,
    ProgressSearch,
    Starved,
    owed,
    pending_requests,
)
from checker.properties.temporal.truth import FormulaTruth, Valuation, valuation
from checker.properties.temporal.vacuity import every_formula, is_judged
from checker.steps import Step, step_of
from checker.traces import Trace, replay, to_json
from checker.verdicts import Outcome, Verdict, Violation
from semantics.properties.kinds import PropertyKind
from semantics.properties.property import Property
from semantics.properties.propositions import Proposition, atoms_of
from semantics.properties.temporal import ENVIRONMENTS, Fairness, Now, Steps, Temporal, atoms
from semantics.state.configuration import Configuration
from semantics.successors import expand


def kept_graph(found: Exploration) -> Graph:
    """Return the graph of an exploration."""
    if found.survey is not None:
        return found.survey.graph()
    assert found.edges is not None
    return graph_of(found.edges, len(found.configurations))


def where_true(found: Exploration, propositions: list[Proposition]) -> Valuation:
    """Return the configurations where propositions are true."""
    if found.survey is not None:
        return found.survey.valuation(propositions)
    return valuation(found.configurations, propositions)


def is_still(found: Exploration, formula: Temporal) -> bool:
    """Return whether a formula reads only configurations, and the values it reads never change.

    The answer is False if a bound is met meanwhile: the verdict is known by then, and the remark is dropped.
    """
    asked = tuple(atoms(formula))
    if not all(isinstance(each, Now) for each in asked):
        return False
    parts = tuple(atom for each in asked if isinstance(each, Now) for atom in atoms_of(each.proposition))
    try:
        if found.survey is not None:
            return found.survey.is_still(parts)
        return invariant_vacuity.is_still(found.configurations, parts)
    except BoundMet:
        return False


def where_pending(found: Exploration) -> Pending:
    """Return the configurations in which each request is pending."""
    if found.survey is not None:
        return found.survey.pending()
    return pending_requests(found.configurations)


def deadlock_at(number: int, c: Configuration) -> Finding | None:
    """Return the deadlock at a configuration where no agent can move, None without remaining work."""
    inspection = DeadlockFreedom()
    inspection(number, c, expand(c))
    return next(iter(inspection.collected.first.values()), None)


_RULES, _REQUESTS = EACH_RULE_AND_REQUEST
_WORLD = Fairness(False, Steps(ENVIRONMENTS), (), "environment")
ENOUGH: Final = {
    "weak fairness of rules, requests": (_RULES, _REQUESTS),
    "weak fairness of rules, requests, environment": (_RULES, _REQUESTS, _WORLD),
    "strong fairness of requests and weak fairness of rules, environment": (
        replace(_REQUESTS, strong=True),
        _RULES,
        _WORLD,
    ),
}
"""Usual fairness assumptions as they are written, weaker ones first."""


class TemporalDecider:
    """Decides the temporal properties of one exploration, with shared intermediate results."""

    def __init__(
        self, found: Exploration, properties: Iterable[Property], most: int = MOST_VIOLATIONS
    ) -> None:
        self.found = found
        self.most = most
        self.setting = found.configurations[0].setting
        kept = kept_graph(found)
        self.graph: Graph = kept.total(optional(kept.labels, self.setting.arriving))
        decided = properties if found.reducer is None else map(found.reducer.decided_for, properties)
        asked = (atom for each in decided if each.temporal is not None for atom in atoms(each.temporal))
        propositions = [atom.proposition for atom in asked if isinstance(atom, Now)]
        if is_judged(self.graph):  # part by part
            propositions = [atom for each in propositions for atom in atoms_of(each)]
        truth = FormulaTruth(self.graph, where_true(found, propositions))
        is_kept = every_formula if found.reducer is None else found.reducer.keeps
        self.formulas = FormulaDecider(truth, found.complete, partial(is_still, found), is_kept)

    def decide(self, asked: Property) -> Verdict:
        """Return the verdict on a property; it holds only after a complete exploration."""
        match asked.kind:
            case PropertyKind.LTL:
                return self.linear(asked)
            case PropertyKind.CTL:
                return self.branching(asked)
            case PropertyKind.PROGRESS:
                return self.progress(asked)
            case PropertyKind.DEADLOCK_FREEDOM:
                return self.deadlock(asked)
            case _:
                raise AssertionError(f"{asked.kind} is not about runs")

    # --- linear and branching time

    def linear(self, asked: Property) -> Verdict:
        """Return the verdict on a formula about every fair run."""
        found = self.formulas.linear(self.formula(asked), self.conditions(asked.fairness), asked.ranges)
        if found.run is None or found.outcome is not Outcome.VIOLATED:
            return self.unviolated(asked, found)
        message = f"false{'' if found.run.loop else ', whatever follows'}: {asked.shown}"
        return self.violated(asked, message, found.run, tuple(self.pauses(found.run)))

    def branching(self, asked: Property) -> Verdict:
        """Return the verdict on a formula about the tree of fair runs."""
        found = self.formulas.branching(self.formula(asked), self.conditions(asked.fairness), asked.ranges)
        if found.run is None or found.outcome is not Outcome.VIOLATED:
            return self.unviolated(asked, found)
        shown = tuple(self.pauses(found.run))
        if not len(found.run):
            shown = ("no single run shows it: it is about all continuations",)
        return self.violated(asked, f"false at c0: {asked.shown}", found.run, shown)

    def formula(self, asked: Property) -> Temporal:
        """Return the formula to decide for a property."""
        decided = asked if self.found.reducer is None else self.found.reducer.decided_for(asked)
        assert decided.temporal is not None
        return decided.temporal

    def unviolated(self, asked: Property, found: Decision) -> Verdict:
        """Return the verdict on a formula without a counterexample."""
        return Verdict(
            asked,
            found.outcome,
            examined=found.examined,
            witness=None if found.run is None else self.trace(found.run),
            note=found.note or self.note(asked.fairness),
            remarks=(*self.empty(asked.fairness), *found.remarks),
        )

    def violated(self, asked: Property, message: str, run: Lasso, shown: tuple[str, ...]) -> Verdict:
        """Return the verdict on a violated formula, and whether only unfair runs violate it."""
        assert asked.temporal is not None
        if not asked.fairness and self.found.reducer is None:
            ways = ((words, self.conditions(each)) for words, each in ENOUGH.items())
            enough = self.formulas.enough(asked.temporal, asked.kind is PropertyKind.LTL, ways)
            shown += (f"only unfair runs violate it: it holds under {enough}",) if enough else ()
        violation = Violation(asked.kind, message, self.trace(run), shown)
        note, remarks = self.note(asked.fairness), tuple(self.empty(asked.fairness))
        return Verdict(asked, Outcome.VIOLATED, (violation,), 1, note=note, different=1, remarks=remarks)

    # --- progress

    def progress(self, asked: Property) -> Verdict:
        """Return the verdict on whether every request is served."""
        arriving = self.setting.arriving
        pending = owed(where_pending(self.found), arriving)
        fairness = self.conditions((*EACH_RULE_AND_REQUEST, *asked.fairness))
        progress = ProgressSearch(self.graph, pending, fairness, arriving)
        starved, count = progress.starved()
        note = self.note(asked.fairness, "weak fairness of each rule and request")
        violations = sorted(map(self.violation, starved), key=lambda violation: len(violation.trace))
        outcome = Outcome.VIOLATED if violations else self.unless_violated()
        witness = progress.served() if outcome is Outcome.HOLDS else None
        nothing = self.found.complete and not pending
        empty = ("vacuous: nothing is ever requested",) if nothing else ()
        return Verdict(
            asked,
            outcome,
            tuple(violations),
            count,
            len(pending) - count,
            witness=None if witness is None else self.trace(witness),
            note=note,
            different=count,
            remarks=(*self.empty(asked.fairness), *empty),
        )

    def violation(self, starved: Starved) -> Violation:
        """Return a request that is never served as a violation."""
        request = starved.request
        sort = type(request).__name__
        details = [f"it waits behind {fly}, which need not arrive" for fly in starved.behind]
        if starved.now_and_then:
            details.append(
                "now and then it could be served, but not all the time: only strong fairness serves it"
            )
        elif not details:
            details.append("no step that would serve it is enabled from then on")
        message, trace = f"{request} is never served", self.trace(starved.run)
        return Violation(f"unserved {sort}", message, trace, tuple(details), str(request))

    # --- deadlock under fairness

    def deadlock(self, asked: Property) -> Verdict:
        """Return the verdict on whether fair runs stay for ever although work is left."""
        deadlocks = Deadlocks(self.graph, self.conditions(asked.fairness), self.stuck)
        found = deadlocks.found()
        violations = []
        for each in found[: self.most]:
            trace = self.trace(deadlocks.run(each))
            finding = self.in_original_names(each.finding, trace)
            message = f"{finding.message}, and no promised step leads on"
            violations.append(Violation("deadlock", message, trace, finding.details, finding.subject))
        ends = sum((each.components >= 0 for each in found), np.zeros(self.graph.size, dtype=np.bool_))
        fine = deadlocks.still() & ~ends
        outcome = Outcome.VIOLATED if violations else self.unless_violated()
        led_on = deadlocks.led_on(fine) if outcome is Outcome.HOLDS else None
        return Verdict(
            asked,
            outcome,
            tuple(sorted(violations, key=lambda violation: len(violation.trace))),
            int(ends.sum()),
            int(fine.sum()),
            witness=None if led_on is None else self.trace(led_on),
            note=self.note(asked.fairness),
            different=len(found),
            remarks=tuple(self.empty(asked.fairness)),
        )

    def stuck(self, number: int) -> Finding | None:
        """Return the deadlock at a configuration where no agent can move, None without remaining work."""
        return deadlock_at(number, self.found.configurations[number])

    def in_original_names(self, finding: Finding, trace: Trace) -> Finding:
        """Return a deadlock as it is in the mission's own run, where exchanges changed the names in the finding."""
        if self.found.reducer is None or self.found.reducer.symmetry is None or trace.loop is None:
            return finding
        return deadlock_at(finding.at, trace.configurations[trace.loop]) or finding

    # --- shared parts

    def conditions(self, declared: Iterable[Fairness]) -> Conditions:
        """Return the conditions of fair runs."""
        return conditions_of(declared, self.graph, self.setting.arriving)

    def note(self, declared: tuple[Fairness, ...], *always: str) -> str:
        """Return the fairness assumptions as text."""
        assumed = (*always, *map(str, declared))
        return f"under {' and '.join(assumed)}" if assumed else ""

    def empty(self, declared: tuple[Fairness, ...]) -> Iterator[str]:
        """Yield the assumptions without any step; none if the exploration is incomplete."""
        for each in declared if self.found.complete else ():
            if not any(True for _ in classes(each, self.graph.labels, self.setting.arriving)):
                yield f"{each} covers no step of any run"

    def unless_violated(self) -> Outcome:
        """Return the outcome for a property without a violation."""
        return Outcome.HOLDS if self.found.complete else Outcome.INCOMPLETE

    def pauses(self, lasso: Lasso) -> Iterator[str]:
        """Yield where a run stutters before it goes on; a trace has no step for that."""
        edges = (*lasso.stem, *lasso.loop)
        steps = [self.graph.actions[edge] >= 0 for edge in edges]
        for at, is_step in enumerate(steps):
            if not is_step and any(steps[at:]):
                yield f"it stays at c{sum(steps[:at])} for a moment before it goes on"

    def trace(self, lasso: Lasso) -> Trace:
        """Return a run as a trace, replayed through the rules; stutter steps are left out."""
        stem, loop = ([e for e in edges if self.graph.actions[e] >= 0] for edges in (lasso.stem, lasso.loop))
        stays = lasso.loop or (lasso.stem and self.graph.actions[lasso.stem[-1]] < 0)
        initial, steps, begin = self.run(stem, loop)
        shortest = lasso.shortest and self.found.reducer is None
        trace = Trace(initial, steps, begin if stays else None, shortest)
        if replay(trace.initial, to_json(trace, "", "")) != trace:
            raise AssertionError("the rules do not replay a run that they gave")
        return trace

    def run(self, stem: list[int], loop: list[int]) -> tuple[Configuration, tuple[Step, ...], int]:
        """Return the initial configuration of the mission's run along edges, its steps, and the length of its stem."""
        found, graph = self.found, self.graph
        edges = [
            (int(graph.sources[edge]), graph.labels[graph.actions[edge]], int(graph.targets[edge]))
            for edge in (*stem, *loop)
        ]
        configurations = found.configurations
        if found.reducer is None or found.reducer.symmetry is None:
            steps = (step_of(configurations[a], label, configurations[b]) for a, label, b in edges)
            return configurations[0], tuple(steps), len(stem)
        taken, begin = lasso_of(found, edges[: len(stem)], edges[len(stem) :])
        trace = Trace(configurations[0] if found.start is None else found.start)
        for each in taken:
            trace = trace.extended(each)
        return trace.initial, trace.steps, begin
