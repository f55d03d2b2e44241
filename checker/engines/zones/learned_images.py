"""Learning the images of clocks and windows under exchanges of members."""

from __future__ import annotations

from collections.abc import Hashable, Sequence
from typing import Protocol

import numpy as np

from checker.engines.fast.compiled.arrays import Growing
from checker.engines.fast.model.learner import Learner
from checker.engines.fast.reduce.symmetry_tables import Exchanging
from checker.engines.fast.store.canonicalise import enter_all
from checker.engines.timed.exchanged_clocks import ClockExchange
from checker.engines.zones.clock_images import ClockImages, FormerNames
from checker.reduction.configuration_renaming import mentioned
from checker.reduction.exchanged_times import OF_CLAUSES
from semantics.environment import Says
from semantics.timing.actor_clocks import ActorClock, RunningClock, Sort
from semantics.timing.intervals import ANY_TIME


class ClockNumbers(Protocol):
    """The numbered clocks and windows of a mission.

    Attributes:
        windows: The clause of each window.
        keys: The clock of each number, with its aim.
        restored: For each vehicle with an endurance the numbers of its clocks.
    """

    windows: list[int]
    keys: list[tuple[ActorClock, Hashable]]
    restored: list[tuple[int, int, int]]

    def number(self, running: RunningClock) -> int:
        """Return the number of a clock, a new one at its first use."""


def tables_of(learner: Learner, exchange: ClockExchange) -> Exchanging:
    """Return the tables that replace rows by their representatives."""
    return Exchanging(learner, exchange.symmetry.items)


class LearnedImages:
    """The images of a network's clocks and windows, as they are learned.

    Attributes:
        images: The images in the form that the loops read.
    """

    images: ClockImages

    def __init__(self, network: ClockNumbers, exchange: ClockExchange) -> None:
        self.network = network
        self.exchange = exchange
        self.items = exchange.symmetry.items
        self.roots, self.mentions_from, self.mentions = (Growing(np.int32) for _ in range(3))
        self.found = Growing(np.int32)
        self.found.append(0)
        self.mentions_from.append(0)
        self.edges: dict[tuple[int, int], int] = {}
        self.entered = 0
        self.keys, self.values = np.zeros(1024, np.uint64), np.zeros(1024, np.int32)

    def see(self) -> None:
        """Rebuild the loops' view, with the subjects that are new."""
        for window in self.network.windows[len(self.roots) :]:
            self._add(self._members(ActorClock(Sort.WINDOW, window), None))
        windows = len(self.network.windows)
        for clock, aim in self.network.keys[len(self.roots) - windows :]:
            self._add(self._members(clock, aim))
        self._enter()
        arrays = (self.roots.room, self.mentions_from.room, self.mentions.room)
        self.images = ClockImages(windows, *arrays, self.keys, self.values, self.found.room)

    def scratch(self) -> FormerNames:
        """Return scratch space for one row."""
        sizes = (
            len(self.items.members),
            len(self.network.keys),
            len(self.network.windows),
            len(self.network.restored),
        )
        return FormerNames(*(np.zeros(each, np.int32) for each in sizes))

    def learn(self, place: Sequence[int]) -> None:
        """Learn the images of all subjects under an exchange that replaces each member by another, and back."""
        back = sorted(range(len(place)), key=place.__getitem__)
        for subject in range(len(self.roots)):
            self._learn(subject, place)
            self._learn(subject, back)
        self.see()

    def _learn(self, subject: int, place: Sequence[int]) -> None:
        begin, end = self.mentions_from.room[subject : subject + 2].tolist()
        members = self.mentions.room[begin:end].tolist()
        node = int(self.roots.room[subject])
        for member in members:
            edge = (node, place[member])
            if edge not in self.edges:
                self.edges[edge] = self.found.append(0)
            node = self.edges[edge]
        if self.found.room[node] == 0:
            image = self._image(subject, {member: place[member] for member in members})
            self.found.room[node] = image + 1

    def _image(self, subject: int, moved: dict[int, int]) -> int:
        renaming = self.items.exchanging(moved)
        windows = self.network.windows
        if subject < len(windows):
            image = self.exchange.image(ActorClock(Sort.WINDOW, windows[subject]), renaming)
            assert isinstance(image.of, int)
            return windows.index(image.of)
        clock, aim = self.network.keys[subject - len(windows)]
        running = RunningClock(self.exchange.image(clock, renaming), ANY_TIME, renaming.value(aim))
        return len(windows) + self.network.number(running)

    def _add(self, members: Sequence[int]) -> None:
        self.roots.append(self.found.append(0))
        self.mentions.append(*members)
        self.mentions_from.append(len(self.mentions))

    def _members(self, clock: ActorClock, aim: object) -> tuple[int, ...]:
        """Return the members that a clock mentions."""
        owner, said, first = self.items.owner, clock.of, list[int]()
        if clock.sort in OF_CLAUSES:
            assert isinstance(clock.of, int)
            said = self.exchange.clauses[clock.of]
            if isinstance(said, Says) and said.counter in owner:
                first = [owner[said.counter]]
        names = mentioned((said, aim), self.items.movable)
        return tuple(dict.fromkeys((*first, *(owner[name] for name in names))))

    def _enter(self) -> None:
        """Add new edges to the loops' hash table; a table that grows is filled from scratch."""
        new = list(self.edges.items())[self.entered :] if self.entered < len(self.edges) else []
        if 2 * len(self.edges) > len(self.keys):
            room = 4 * len(self.keys)
            while 2 * len(self.edges) > room:
                room *= 2
            self.keys, self.values = np.zeros(room, np.uint64), np.zeros(room, np.int32)
            new = list(self.edges.items())
        keys = np.array([node << 32 | member for (node, member), _ in new], np.uint64)
        enter_all(self.keys, self.values, keys, np.array([to for _, to in new], np.int32))
        self.entered = len(self.edges)
