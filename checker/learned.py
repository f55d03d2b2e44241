"""Learned trees: the rules are run once for each way in which they look at cells, and then remembered.

A rule reads cells and nothing else, and it is pure. So one recorded run holds for every configuration that answers
the same questions alike. The runs of one actor (an agent with all its rules, or a clause of the environment) make a
decision tree: inner nodes ask a cell, leaves hold what follows, as labels and writes. No rule is written a second
time, and nothing in `semantics/` knows of it.
"""

from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass, field
from functools import partial
from typing import Any

from semantics.cells import Cell, Changes, Part, Question, State, Written, merged
from semantics.configuration import Configuration, Label, Transition
from semantics.eta import Pending
from semantics.expressions import Fault
from semantics.signature import Name
from semantics.successors import Expansion, by_clause, expansion_of, steps

Actor = Name | int
"""An agent, or a clause of the environment by its number."""

Act = Callable[[Configuration], Iterable[Transition | Fault]]


@dataclass(frozen=True, slots=True)
class Ask:
    """What is asked of a cell: its value, or (with a question) a yes or no."""

    cell: Cell
    question: Question | None = None
    constants: tuple[Any, ...] = ()

    def of(self, cells: State) -> Any:
        """Return the answer."""
        if self.question is None:
            return cells.read(self.cell)
        return cells.test(self.cell, self.question, *self.constants)


class Recorder:
    """Cells that note, in order, what is asked of them for the first time."""

    def __init__(self, cells: State) -> None:
        self.cells = cells
        self.answers: dict[Ask, Any] = {}

    def read(self, cell: Cell) -> Any:
        """Return the value of a cell, and note it."""
        return self._note(Ask(cell))

    def test(self, cell: Cell, question: Question, *constants: Any) -> bool:
        """Ask a cell, and note the yes or no."""
        answer: bool = self._note(Ask(cell, question, constants))
        return answer

    def each(self, names: Iterable[str], part: Callable[[str], Part]) -> Mapping[str, Part]:
        """Return what a pointwise definition says of each name."""
        return {name: part(name) for name in names}

    def with_each(self, parts: Mapping[str, Changes]) -> Written:
        """Return the cells with what each part of a conclusion writes."""
        return self.with_(merged(parts.values()))

    def with_(self, changes: Mapping[Cell, Any]) -> Written:
        """Return the cells with a rule's conclusion over them."""
        return Written(self, dict(changes))

    def _note(self, ask: Ask) -> Any:
        if ask not in self.answers:
            self.answers[ask] = ask.of(self.cells)
        return self.answers[ask]


@dataclass(frozen=True, slots=True)
class Learned:
    """One transition as a leaf holds it."""

    label: Label
    changes: Changes
    shown: tuple[str, ...]
    served: Pending | None


@dataclass(slots=True)
class Leaf:
    """What follows: transitions, and faults in the place of what they hinder."""

    steps: tuple[Learned | Fault, ...]


@dataclass(slots=True)
class Inner:
    """A question with what follows from each answer that was met so far."""

    ask: Ask
    branches: dict[Any, "Node"] = field(default_factory=dict)


Node = Inner | Leaf


class LearningError(Exception):
    """A rule asked something else though all its questions were answered alike: a bug, for rules are pure."""


class Learner:
    """Expands configurations by what was learned, and learns where that doesn't reach.

    Attributes:
        runs: How many times an actor's rules were run in Python.
        walks: How many times they were asked for.
    """

    def __init__(self) -> None:
        self.roots: dict[Actor, Node] = {}
        self.runs = 0
        self.walks = 0

    def expand(self, c: Configuration) -> Expansion:
        """Return everything that a configuration allows; the same as `semantics.successors.expand`."""
        by_agents = [step for a in c.alpha.names() for step in self._follow(a, c, partial(steps, a=a))]
        around: list[Transition] = []
        for number, clause in enumerate(c.setting.environment):
            followed = self._follow(number, c, partial(by_clause, clause=clause))
            around += (step for step in followed if isinstance(step, Transition))
        return expansion_of(c, by_agents, around)

    def _follow(self, actor: Actor, c: Configuration, act: Act) -> list[Transition | Fault]:
        self.walks += 1
        leaf = self._walk(self.roots.get(actor), c.state) or self._learn(actor, c, act)
        return [
            each
            if isinstance(each, Fault)
            else Transition(
                each.label, Configuration(c.setting, c.state.with_(each.changes)), each.shown, each.served
            )
            for each in leaf.steps
        ]

    def _walk(self, node: Node | None, cells: State) -> Leaf | None:
        while isinstance(node, Inner):
            node = node.branches.get(node.ask.of(cells))
        return node

    def _learn(self, actor: Actor, c: Configuration, act: Act) -> Leaf:
        self.runs += 1
        recorder = Recorder(c.state)
        leaf = Leaf(tuple(map(learned, act(Configuration(c.setting, recorder)))))
        answers = list(recorder.answers.items())
        if not answers:
            self.roots[actor] = leaf
            return leaf
        node = self.roots.setdefault(actor, Inner(answers[0][0]))
        for number, (ask, answer) in enumerate(answers):
            if not isinstance(node, Inner) or node.ask != ask:
                raise LearningError(f"{actor} asked {ask.cell} out of turn")
            after = answers[number + 1 :]
            node = node.branches.setdefault(answer, Inner(after[0][0]) if after else leaf)
        return leaf


def learned(step: Transition | Fault) -> Learned | Fault:
    """Return a recorded step as a leaf holds it."""
    if isinstance(step, Fault):
        return step
    assert isinstance(step.target.state, Written)
    return Learned(step.label, step.target.state.changes, step.shown, step.served)
