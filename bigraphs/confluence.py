"""Whether the order of instantaneous rules decides what becomes of a state.

Of an instantaneous class the first rule that can be applied is, again and again. The class is confluent if any other
order ends in the same states; then its order says nothing. Here the first states of a system are looked at, and in
each of them every order.
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
from bigraphs.engine.state import Key
from bigraphs.errors import BigraphError
from bigraphs.system import PriorityClass, System

_UNKNOWN: Final = b"?"
"""Where a run ends that is not known yet; no form of a state."""
MOST_REACTIONS: Final = 1_000
"""How many reactions are tried before the search for another outcome is given up."""


class Way(NamedTuple):
    """A rule by which one goes on from a state, and the state in which that ends."""

    rule: str
    outcome: Bigraph


@dataclass(frozen=True, slots=True)
class Divergence:
    """A state in which the order of an instantaneous class matters; `taken` is the way of a run, `other` another."""

    rules: PriorityClass
    state: Bigraph
    taken: Way
    other: Way


@dataclass(frozen=True, slots=True)
class Orders:
    """What was seen of the orders of instantaneous rules; `complete` says whether all were tried in all states."""

    divergence: Divergence | None
    complete: bool


def compare_orders(system: System, most: int = MOST_REACTIONS) -> Orders:
    """Look for two orders of an instantaneous class with two outcomes, in the first states of a system."""
    if not any(each.instantaneous for each in system.classes):
        return Orders(None, complete=True)
    search = _Search(Machine(system), most)
    try:
        found = next(search.divergences(), None)
    except (_Enough, BigraphError):  # what is wrong with an order is said by the run that takes it
        return Orders(None, complete=False)
    return Orders(found, complete=found is None)


class _Enough(Exception):
    """Ends a search that has tried as many reactions as it may."""


class _Choice(NamedTuple):
    """What a rule of a class makes of a state, and that class."""

    rule: str
    number: int
    spot: Spot


_Seen: TypeAlias = tuple[int | None, Key]
"""A state by its canonical form, and the class that is under way in it."""


@dataclass(slots=True)
class _Frame:
    """A state on the way down: the choices that are left in it, the one that was taken last, and where each ended."""

    seen: _Seen
    spot: Spot
    left: Iterator[_Choice]
    by: _Choice | None = None
    ends: list[tuple[_Choice, Key]] = field(default_factory=list)

    def note(self, end: Key | None) -> None:
        """Note where the choice that was taken last ends, if it ends."""
        if end is not None and self.by is not None:
            self.ends.append((self.by, end))


class _Search:
    """One search.

    Attributes:
        ends: For each state that was seen the form of the state in which a run from it ends, None if it does not.
        settled: Those states, by their forms.
    """

    def __init__(self, machine: Machine, most: int) -> None:
        self.machine, self.left = machine, most
        self.ends: dict[_Seen, Key | None] = {}
        self.settled: dict[Key, Spot] = {}

    def divergences(self) -> Iterator[Divergence]:
        """Yield divergences, of the states that are reached first first."""
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
        """Yield the states after this one in which the order matters, depth first; return in which a run ends.

        The first of them is a last one: each of its rules leads on to one outcome.
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
        """Return where a run from a state ends; if that is not known yet, put the state on the path, and say so."""
        seen = number, self.machine.labelling.canonical(spot.state)
        if seen in self.ends:
            return self.ends[seen]
        choices = self.choices(spot, number)
        first = next(choices, None)
        if first is None:
            self.ends[seen] = seen[1]
            self.settled.setdefault(seen[1], spot)
            return seen[1]
        self.ends[seen] = None  # as long as it is under way: what returns to it has no end
        path.append(_Frame(seen, spot, chain((first,), choices)))
        return _UNKNOWN

    def choices(self, spot: Spot, number: int | None) -> Iterator[_Choice]:
        """Yield what each rule makes of a state, that first which a run takes; the class under way goes on first."""
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
