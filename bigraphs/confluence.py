"""Whether the result depends on the order of instantaneous rules.

A run applies the first applicable rule of an instantaneous class, repeatedly. The class is confluent if every other
order ends in the same states; then the order of its rules has no effect. The search tries all orders in the first
states of a system, up to a limit.
"""

from __future__ import annotations

from collections import deque
from collections.abc import Generator, Iterator
from dataclasses import dataclass, field
from itertools import chain
from typing import Final, NamedTuple, TypeAlias

from bigraphs.bigraph import Bigraph
from bigraphs.engine.decoding import to_bigraph
from bigraphs.engine.machine import Machine
from bigraphs.engine.occurrences import Spot
from bigraphs.engine.state_arrays import Key
from bigraphs.errors import BigraphError
from bigraphs.system import PriorityClass, System

_UNKNOWN: Final = b"?"
"""The outcome of a run that is not yet known; it is not the form of any state."""
MOST_REACTIONS: Final = 1_000
"""The number of tried reactions at which the search gives up."""


class Way(NamedTuple):
    """The first rule of a run from a state, and the final state of that run."""

    rule: str
    outcome: Bigraph


@dataclass(frozen=True, slots=True)
class Divergence:
    """A state in which the order of an instantaneous class matters.

    `taken` is the first rule and the outcome of a run; `other` is an alternative with another outcome.
    """

    rules: PriorityClass
    state: Bigraph
    taken: Way
    other: Way


@dataclass(frozen=True, slots=True)
class Orders:
    """The result of the search; `complete` is whether it tried every order in every state."""

    divergence: Divergence | None
    complete: bool


def compare_orders(system: System, most: int = MOST_REACTIONS) -> Orders:
    """Search the first states of a system for two orders of an instantaneous class with different outcomes."""
    if not any(each.instantaneous for each in system.classes):
        return Orders(None, complete=True)
    search = _Search(Machine(system), most)
    try:
        found = next(search.divergences(), None)
    except (_Enough, BigraphError):  # the run that takes a faulty order reports the error
        return Orders(None, complete=False)
    return Orders(found, complete=found is None)


class _Enough(Exception):
    """Ends a search at its limit of reactions."""


class _Choice(NamedTuple):
    """A rule of a class, the number of the class, and the state that the rule leads to."""

    rule: str
    number: int
    spot: Spot


_Seen: TypeAlias = tuple[int | None, Key]
"""A state by its canonical form, and the class that runs in it."""


@dataclass(slots=True)
class _Frame:
    """A state on the current path: its remaining choices, the last choice, and the outcome of each earlier one."""

    seen: _Seen
    spot: Spot
    left: Iterator[_Choice]
    by: _Choice | None = None
    ends: list[tuple[_Choice, Key]] = field(default_factory=list)

    def note(self, end: Key | None) -> None:
        """Record the outcome of the last choice, if it terminates."""
        if end is not None and self.by is not None:
            self.ends.append((self.by, end))


class _Search:
    """A search for divergences.

    Attributes:
        ends: The form of the final state for each visited state; None for a run without end.
        settled: The final states, by their forms.
    """

    def __init__(self, machine: Machine, most: int) -> None:
        self.machine, self.left = machine, most
        self.ends: dict[_Seen, Key | None] = {}
        self.settled: dict[Key, Spot] = {}

    def divergences(self) -> Iterator[Divergence]:
        """Yield divergences, in breadth-first order of their states."""
        waiting = deque([self.machine.first()])
        expanded: set[Key] = set()
        while waiting:
            key = yield from self.orders(waiting.popleft())
            if key is not None and key not in expanded:
                expanded.add(key)
                spot = self.settled[key]
                for reaction, found in self.machine.enabled(spot):
                    self.count()
                    waiting += self.machine.results(spot, reaction, [found])

    def orders(self, start: Spot) -> Generator[Divergence, None, Key | None]:
        """Yield divergences after this state, depth first; return the form of the final state of a run.

        The first divergence is minimal: each of its rules leads to exactly one outcome.
        """
        path: list[_Frame] = []
        if (ended := self.enter(start, None, path)) is not _UNKNOWN:
            return ended
        while True:
            frame = path[-1]
            frame.by = next(frame.left, None)
            if frame.by is not None:
                ended = self.enter(frame.by.spot, frame.by.number, path)
                if ended is not _UNKNOWN:
                    frame.note(ended)
                continue
            if len({end for _, end in frame.ends}) > 1:
                yield self.divergence(frame)
            ended = self.ends[frame.seen] = frame.ends[0][1] if frame.ends else None
            path.pop()
            if not path:
                return ended
            path[-1].note(ended)

    def enter(self, spot: Spot, number: int | None, path: list[_Frame]) -> Key | None:
        """Return the outcome of a run from a state; if unknown, push the state on the path and return `_UNKNOWN`."""
        seen = number, self.machine.labelling.canonical(spot.state)
        if seen in self.ends:
            return self.ends[seen]
        choices = self.choices(spot, number)
        first = next(choices, None)
        if first is None:
            self.ends[seen] = seen[1]
            self.settled.setdefault(seen[1], spot)
            return seen[1]
        self.ends[seen] = None  # while the state is on the path: a run that returns to it has no end
        path.append(_Frame(seen, spot, chain((first,), choices)))
        return _UNKNOWN

    def choices(self, spot: Spot, number: int | None) -> Iterator[_Choice]:
        """Yield the results of each rule in a state, the choice of a run first; the running class continues first."""
        classes = self.machine.classes
        if number is None or not any(True for _ in spot.enabled(classes[number][0])):
            number = self.machine.urgent(spot)
        for reaction, live in spot.enabled(classes[number][0]) if number is not None else ():
            targets = self.machine.results(spot, reaction, live)
            first = self.machine.outlines.least([target.state for target in targets])
            for target in (targets[first], *targets[:first], *targets[first + 1 :]):
                self.count()
                yield _Choice(reaction.label, number or 0, target)

    def count(self) -> None:
        self.left -= 1
        if self.left < 0:
            raise _Enough

    def divergence(self, frame: _Frame) -> Divergence:
        taken = frame.ends[0]
        other = next(each for each in frame.ends if each[1] != taken[1])
        ways = [Way(choice.rule, to_bigraph(self.settled[end].state)) for choice, end in (taken, other)]
        rules = self.machine.system.classes[taken[0].number]
        return Divergence(rules, to_bigraph(frame.spot.state), *ways)
