"""A transition system as a Markov model: the common part of PRISM's and Storm's files.

A BRS becomes a decision process in which every transition is a choice of its own. A deadlock state gets a loop and the
label `deadlock`, since these checkers require a successor of every state. In an incomplete system, an unexpanded state
gets a loop and the label `unexpanded`: nothing is decided beyond it.
"""

from __future__ import annotations

import re
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from enum import Enum
from itertools import groupby
from typing import Final, NamedTuple

from bigraphs.system import System, SystemKind
from bigraphs.transitions import Transition, TransitionSystem


class MarkovKind(Enum):
    """The kinds of Markov model."""

    DTMC = "dtmc"
    CTMC = "ctmc"
    MDP = "mdp"


KINDS = {
    SystemKind.BRS: MarkovKind.MDP,
    SystemKind.PBRS: MarkovKind.DTMC,
    SystemKind.SBRS: MarkovKind.CTMC,
    SystemKind.NBRS: MarkovKind.MDP,
}


class MatrixEntry(NamedTuple):
    """One entry of the matrix; `choice` counts from 0 in each state, `action` may be empty."""

    source: int
    choice: int
    target: int
    weight: float
    action: str
    reward: float


@dataclass(frozen=True, slots=True)
class Markov:
    """A Markov model: its moves sorted by source and choice, its labels with their states, and state rewards."""

    kind: MarkovKind
    states: int
    moves: tuple[MatrixEntry, ...]
    labels: tuple[tuple[str, tuple[int, ...]], ...]
    rewards: tuple[tuple[int, float], ...]

    @property
    def choices(self) -> int:
        """Count the choices of all states."""
        return len({(move.source, move.choice) for move in self.moves})


def to_markov(system: TransitionSystem) -> Markov:
    """Return the Markov model of a transition system."""
    moves = tuple(_moves(system))
    stuck = _stuck(system)
    loops = tuple(MatrixEntry(state, 0, state, 1.0, "", 0.0) for state in stuck)
    return Markov(
        KINDS[system.kind],
        len(system),
        tuple(sorted((*moves, *loops), key=lambda move: (move.source, move.choice, move.target))),
        tuple(_labels(system, stuck)),
        tuple(_rewards(system)),
    )


def _stuck(system: TransitionSystem) -> list[int]:
    return [state for state in range(len(system)) if not system.leaving(state)]


def _moves(system: TransitionSystem) -> Iterator[MatrixEntry]:
    rewards = {action.name: float(action.reward) for action in system.system.actions}
    for source, group in groupby(system.transitions(), key=lambda each: each.source):
        outgoing = list(group)
        for choice, each in zip(choices_of(system.kind, outgoing), outgoing, strict=True):
            if system.kind is SystemKind.BRS:
                yield MatrixEntry(source, choice, each.target, 1.0, label_name("_".join(each.rules)), 0.0)
                continue
            action = each.action or ""
            yield MatrixEntry(
                source, choice, each.target, each.weight, label_name(action), rewards.get(action, 0.0)
            )


def choices_of(kind: SystemKind, outgoing: Sequence[Transition]) -> list[int]:
    """Return for each transition of a state the number of its choice.

    In a BRS each transition is a choice of its own. Otherwise each action is a choice, numbered by its name.
    """
    if kind is SystemKind.BRS:
        return list(range(len(outgoing)))
    actions = sorted({each.action or "" for each in outgoing})
    return [actions.index(each.action or "") for each in outgoing]


def _labels(system: TransitionSystem, stuck: list[int]) -> Iterator[tuple[str, tuple[int, ...]]]:
    yield "init", (0,)
    yield "deadlock", tuple(state for state in stuck if state < system.expanded)
    if not system.complete:
        yield "unexpanded", tuple(range(system.expanded, len(system)))
    for number, name in enumerate(label_names(system.system)):
        yield name, tuple(system.states_with(number))


def _rewards(system: TransitionSystem) -> Iterator[tuple[int, float]]:
    """Yield each state with a reward, and the sum of its predicates' rewards."""
    earning = [
        (float(predicate.reward), system.labels[number])
        for number, predicate in enumerate(system.system.predicates)
        if predicate.reward
    ]
    for state in range(len(system)):
        total = sum(reward for reward, holds in earning if holds[state])
        if total:
            yield state, total


OWN_LABELS: Final = ("init", "deadlock", "unexpanded")


def label_names(system: System) -> list[str]:
    """Return the labels of a system's predicates in exported files, all distinct."""
    taken, names = set(OWN_LABELS), list[str]()
    for predicate in system.predicates:
        name = label_name(predicate.label)
        while name in taken:
            name += "_"
        taken.add(name)
        names.append(name)
    return names


def label_name(text: str) -> str:
    """Return a label in the syntax of PRISM and Storm.

    >>> label_name('at(1,"west")')
    'at_1_west'
    """
    return re.sub(r"\W+", "_", text).strip("_")


def number(value: float) -> str:
    """Return the shortest text that reads back as the same number, without a point for an integer.

    >>> number(0.1), number(2.0)
    ('0.1', '2')
    """
    return repr(int(value)) if value == int(value) and abs(value) < 1e15 else repr(value)
