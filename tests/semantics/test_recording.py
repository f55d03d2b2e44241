"""Rules see nothing but what they read: what they did once they do wherever the cells that they read agree.

This is what lets a later explorer record the rules and run what it has recorded. The recorder here is the simplest one:
it keeps each run as its reads, its tests and its writes, and looks for a run that agrees before it predicts.
"""

from collections.abc import Iterator
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import pytest

from checker import Limits, explore
from semantics import Control, Scheduler
from semantics.cells import Cell, Changes, Question
from semantics.configuration import Configuration, Label
from semantics.extension import say
from semantics.rules import env
from semantics.successors import steps
from specs.elaboration import Variation, load_mission

MISSIONS = Path(__file__).parents[2] / "specs" / "missions"

Writes = tuple[tuple[Label, tuple[tuple[Cell, Any], ...]], ...]


@dataclass
class Recorder:
    """Cells that note what is asked of them."""

    cells: Any
    reads: dict[Cell, Any] = field(default_factory=dict)
    tests: dict[tuple[Cell, Question, tuple[Any, ...]], bool] = field(default_factory=dict)

    def read(self, cell: Cell) -> Any:
        return self.reads.setdefault(cell, self.cells.read(cell))

    def test(self, cell: Cell, question: Question, *constants: Any) -> bool:
        return self.tests.setdefault((cell, question, constants), self.cells.test(cell, question, *constants))

    def with_(self, changes: Changes) -> "Written":
        return Written(self, dict(changes))


@dataclass
class Written:
    """A conclusion: what was written over recorded cells."""

    recorder: Recorder
    changes: Changes

    def read(self, cell: Cell) -> Any:
        return self.changes[cell] if cell in self.changes else self.recorder.read(cell)

    def test(self, cell: Cell, question: Question, *constants: Any) -> bool:
        if cell in self.changes:
            return question(self.changes[cell], *constants)
        return self.recorder.test(cell, question, *constants)

    def with_(self, changes: Changes) -> "Written":
        return Written(self.recorder, {**self.changes, **changes})


@dataclass(frozen=True)
class Run:
    """One run of an actor's rules: it holds for every configuration that agrees on its reads and tests."""

    reads: dict[Cell, Any]
    tests: dict[tuple[Cell, Question, tuple[Any, ...]], bool]
    writes: Writes

    def agrees(self, c: Configuration) -> bool:
        read = all(c.read(cell) == value for cell, value in self.reads.items())
        return read and all(
            c.test(cell, ask, *more) is answer for (cell, ask, more), answer in self.tests.items()
        )


def actors(c: Configuration) -> Iterator[tuple[Any, Any]]:
    """Yield everyone who may act, with the function from a configuration to the transitions."""
    for a in c.alpha.names():
        yield a, lambda seen, a=a: steps(seen, a)
    for clause in c.setting.environment:
        for rule in (env, say):
            yield (clause, rule), lambda seen, clause=clause, rule=rule: rule(seen, clause)


def record(c: Configuration, act: Any) -> Run:
    recorder = Recorder(c.state)
    found = list(act(Configuration(c.setting, recorder)))
    return Run(recorder.reads, recorder.tests, written(found))


def written(transitions: Any) -> Writes:
    """Return the labels with what is written."""
    return tuple((t.label, tuple(sorted(t.target.state.changes.items(), key=repr))) for t in transitions)


VARIATIONS = [
    Variation(),
    Variation(control=Control.TIMED),
    Variation(scheduler=Scheduler.UNORDERED),
    Variation(scheduler=Scheduler.FCFS, control=Control.TIMED),
]


@pytest.mark.parametrize(
    "name", ["oil_spill", "search_and_deploy", "takeover", "tanker", "surveillance", "nomad"]
)
@pytest.mark.parametrize("variation", VARIATIONS, ids=["as written", "timed", "unordered", "fcfs timed"])
def test_what_the_rules_did_once_they_do_wherever_what_they_read_agrees(name, variation):
    initial = load_mission(MISSIONS / f"{name}.mission", variation).initial
    known: dict[Any, list[Run]] = {}
    predicted = 0
    for c in explore(initial, limits=Limits(configurations=150)).configurations:
        for actor, act in actors(c):
            run = record(c, act)
            alike = [each for each in known.setdefault(actor, []) if each.agrees(c)]
            for each in alike:
                assert each.writes == run.writes
            predicted += bool(alike)
            known[actor] += [] if alike else [run]
    assert predicted > sum(map(len, known.values()))  # otherwise nothing was put to the test
