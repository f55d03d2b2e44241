"""Models of a user's own: explore anything that says its successors, and decide properties of what was found.

A model has an `initial` state and `successors(state)`. States are any hashable values, compared by `==`.
"""

from __future__ import annotations

from collections.abc import Callable, Hashable, Iterable, Iterator, Mapping
from dataclasses import dataclass, field, replace
from functools import cached_property
from itertools import pairwise
from typing import TYPE_CHECKING, Generic, NamedTuple, Protocol, TypeVar

from checker.engines.breadth_first import BreadthFirst
from checker.engines.contract import Options
from checker.limits import Bound, BoundMet, Limits, bounded, look
from checker.verdicts import Outcome
from semantics.state.configuration import Configuration, Label
from semantics.successors import successors

if TYPE_CHECKING:
    from collections import Counter

    from checker.engines.edges import Edges
    from checker.engines.graph import Graph
    from checker.properties.temporal.lassos import Lasso

State = TypeVar("State", bound=Hashable)

OFTEN = 1024
"""The number of states between two looks at the bounds."""


class Model(Protocol[State]):
    """What an exploration needs to know."""

    @property
    def initial(self) -> State:
        """The first state."""

    def successors(self, state: State) -> Iterable[tuple[str | Label, State]]:
        """Return the transitions from a state: of each the label and the state after it.

        A label is the name of a rule; a `Label(rule, agent)` names its group of rules too, such as a process.
        """


class ModelStep(NamedTuple, Generic[State]):
    """A step of a run: its label, "" where a run stays in a state without transitions, and the state after it."""

    label: str
    state: State


@dataclass(frozen=True, slots=True)
class ModelVerdict(Generic[State]):
    """The verdict on a property of a model.

    Attributes:
        outcome: The outcome; *incomplete* if the visited states do not decide it.
        run: The evidence from the initial state: a shortest run to a state that violates the property or is asked for,
            or the counterexample or witness of a formula. None if no single run shows it.
        loop: The number of steps before those that repeat for ever; None for a run that ends, or goes on anyhow.
        note: Why a formula is undecided, or the fairness under which it would hold.
        remarks: Reasons why a true formula may be vacuous.
    """

    outcome: Outcome
    run: tuple[ModelStep[State], ...] | None = None
    loop: int | None = None
    note: str = ""
    remarks: tuple[str, ...] = ()


@dataclass(frozen=True)
class ModelExploration(Generic[State]):
    """The states of a model, in the order of discovery; the first is the initial one.

    Attributes:
        states: The states.
        origins: For each state the number of its predecessor on a shortest path; the initial one has its own.
        depth: The greatest distance from the initial state.
        transitions: The number of transitions from the expanded states.
        rules: The number of transitions by each rule.
        bounds: The bounds that were met; empty for a complete exploration.
        seconds: The duration.
        edges: The transitions.
        limits: The limits, which hold for the decision of a formula, too.
    """

    states: list[State]
    origins: list[int]
    depth: int
    transitions: int
    rules: Counter[str]
    bounds: list[Bound]
    seconds: float
    edges: Edges = field(repr=False)
    limits: Limits = field(repr=False)

    def __repr__(self) -> str:
        return (
            f"<ModelExploration states={len(self.states)} transitions={self.transitions} depth={self.depth} "
            f"complete={self.complete}>"
        )

    @property
    def complete(self) -> bool:
        """Whether all reachable states were visited."""
        return not self.bounds

    @cached_property
    def graph(self) -> Graph:
        """The transitions as arrays: compressed sparse rows over the numbers of states."""
        from checker.engines.graph import graph_of  # noqa: PLC0415 - numpy takes its time to load

        return graph_of(self.edges, len(self.states))

    def run_to(self, number: int) -> tuple[ModelStep[State], ...]:
        """Return a shortest run from the initial state to a state, given by its number."""
        path = [number]
        while path[-1]:
            path.append(self.origins[path[-1]])
        return tuple(self._step(*pair) for pair in pairwise(reversed(path)))

    def _step(self, source: int, target: int) -> ModelStep[State]:
        starts, edges = self.graph.starts, self.edges
        edge = next(
            each for each in range(starts[source], starts[source + 1]) if edges.targets[each] == target
        )
        return ModelStep(self._label(edges.actions[edge]), self.states[target])

    def _label(self, action: int) -> str:
        return self.graph.labels[action].rule if action >= 0 else ""

    def always(self, predicate: Callable[[State], bool]) -> ModelVerdict[State]:
        """Decide whether a predicate is true in every reachable state."""
        return self._found(Outcome.VIOLATED, lambda number: not predicate(self.states[number]))

    def reachable(self, predicate: Callable[[State], bool]) -> ModelVerdict[State]:
        """Decide whether a predicate is true in some reachable state."""
        return self._found(Outcome.HOLDS, lambda number: predicate(self.states[number]))

    def no_deadlock(self, ended: Callable[[State], bool] = lambda _: False) -> ModelVerdict[State]:
        """Decide whether every reachable state has a transition, unless the model has `ended` there."""
        graph = self.graph

        def is_stuck(number: int) -> bool:
            has_none = graph.starts[number] == graph.starts[number + 1] and not graph.open[number]
            return bool(has_none) and not ended(self.states[number])

        return self._found(Outcome.VIOLATED, is_stuck)

    def _found(self, outcome: Outcome, is_it: Callable[[int], bool]) -> ModelVerdict[State]:
        """Return an outcome with a run to the first state that shows it, or else the other outcome."""
        number = next(filter(is_it, range(len(self.states))), None)
        if number is not None:
            return ModelVerdict(outcome, self.run_to(number))
        other = {Outcome.HOLDS: Outcome.VIOLATED, Outcome.VIOLATED: Outcome.HOLDS}[outcome]
        return ModelVerdict(other if self.complete else Outcome.INCOMPLETE)

    def ltl(self, formula: str, **predicates: Callable[[State], bool]) -> ModelVerdict[State]:
        """Decide a formula about every run, over predicates by their names, rules and groups of rules.

        The syntax is a mission's (docs/reference/temporal.md): `under weak fairness of eat: [] (hungry -> <> fed)`.

        Raises:
            NotationError: The formula has a mistake; the error has its place.
        """
        return self._decided("ltl", formula, predicates)

    def ctl(self, formula: str, **predicates: Callable[[State], bool]) -> ModelVerdict[State]:
        """Decide a formula about the tree of runs, such as `AG EF home`; else as `ltl`."""
        return self._decided("ctl", formula, predicates)

    def _decided(
        self, logic: str, formula: str, predicates: Mapping[str, Callable[[State], bool]]
    ) -> ModelVerdict[State]:
        import numpy as np  # noqa: PLC0415 - it takes its time to load

        from checker.properties.temporal.claim_decider import ClaimDecider  # noqa: PLC0415
        from checker.properties.temporal.claim_text import ClaimWords  # noqa: PLC0415 - numpy, too

        size = len(self.states)
        rules = dict.fromkeys(label.rule for label in self.graph.labels)
        groups = dict.fromkeys(label.agent for label in self.graph.labels if label.agent is not None)
        words = ClaimWords(tuple(predicates), tuple(rules | groups), rules)
        try:
            with bounded(replace(self.limits, spent=self.limits.spent + self.seconds)):
                values = {
                    name: np.fromiter(self._values(holds), dtype=np.bool_, count=size)
                    for name, holds in predicates.items()
                }
                decider = ClaimDecider(self.graph, values, self.complete, words)
                found = decider.decide(logic, formula)
        except BoundMet as met:
            return ModelVerdict(Outcome.INCOMPLETE, note=f"not decided: {met.bound} was met")
        run = None if found.run is None else self._run(decider.graph, found.run)
        loop = len(found.run.stem) if found.run is not None and found.run.loop else None
        return ModelVerdict(found.outcome, run, loop, found.note, found.remarks)

    def _values(self, predicate: Callable[[State], bool]) -> Iterator[bool]:
        for number, state in enumerate(self.states):
            if number % OFTEN == 0:
                look()
            yield predicate(state)

    def _run(self, graph: Graph, lasso: Lasso) -> tuple[ModelStep[State], ...]:
        edges = (*lasso.stem, *lasso.loop)
        return tuple(
            ModelStep(self._label(graph.actions[each]), self.states[graph.targets[each]]) for each in edges
        )


def explore_model(model: Model[State], options: Options) -> ModelExploration[State]:
    """Visit the reachable states of a model, breadth-first, within the limits of some options."""
    search, labels = BreadthFirst(model.initial, options), dict[str | Label, Label]()
    assert search.edges is not None

    def expand(number: int, state: State) -> None:
        for label, target in model.successors(state):
            search.follow(number, labels.setdefault(label, _label_of(label)), target)

    search.run(expand)
    return ModelExploration(
        search.states,
        search.origins,
        search.depths[-1],
        search.transitions,
        search.rules,
        search.bounds,
        search.seconds,
        search.edges,
        options.limits,
    )


def _label_of(label: str | Label) -> Label:
    return label if isinstance(label, Label) else Label(str(label), str(label))


@dataclass(frozen=True, slots=True)
class MissionModel:
    """A mission as a model: its states are configurations, its transitions those of the rules.

    Attributes:
        initial: The initial configuration.
    """

    initial: Configuration

    def successors(self, state: Configuration) -> Iterable[tuple[Label, Configuration]]:
        """Yield the transitions that the rules allow."""
        return ((each.label, each.target) for each in successors(state))
