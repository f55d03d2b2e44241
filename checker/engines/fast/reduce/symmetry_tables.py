"""Symmetry tables for the compiled loops: the items of interchangeable members, and their images under exchanges.

An *entry* is an item: the code of one column, or the codes of all columns of a cell if an exchange may reorder its
observations. The *shape* of an entry is the item with its members replaced by the first ones of their classes. Entries
of one shape share their *moves*: a move is a shape with the members that replace those, and is learned once.
"""

from collections.abc import Iterator, Sequence
from threading import local
from typing import Any

import numpy as np

from checker.engines.fast.compiled.arrays import Growing
from checker.engines.fast.model.columns import Packing, Writes
from checker.engines.fast.model.learner import Learner
from checker.engines.fast.store.canonicalise import (
    ENTRY,
    FIXED,
    LISTED,
    TARGET,
    UNKNOWN,
    WHOLE,
    Exchanges,
    RowScratch,
    enter_all,
)
from checker.recording.value_templates import holes, split_value
from checker.reduction.member_items import Items, Member, Place, Roles
from checker.reduction.representatives import MOST_ORDERS
from semantics.state.cell_values import AGENTS, NAMES

MOST_ARGUMENTS = 1 << 16
"""A bound on a quarter of the arguments of a miss: twice the columns of a row, and its members."""


class SymmetryScratch(local):
    """One thread's scratch space for the representatives of rows (see `RowScratch`)."""

    def __init__(self, active: int, places: int, members: int, words: int) -> None:
        super().__init__()
        self.room = RowScratch(
            np.zeros(3 * active, np.int32),
            np.zeros(places, np.int64),
            np.zeros(members, np.uint64),
            np.zeros(members, np.uint64),
            np.zeros(members, np.int32),
            np.zeros(members, np.int32),
            np.zeros(members, np.int32),
            np.zeros(members, np.int32),
            np.zeros(LISTED + 2 * active + members + 2, np.int32),
            np.zeros(1, np.int64),
            np.zeros(words, np.uint64),
        )


class Exchanging:
    """The symmetry tables of a mission; they grow with learning.

    Attributes:
        exchanges: The tables in the form that the loops read.
        ahead: Whether new codes are learned before a row needs them.
    """

    exchanges: Exchanges

    def __init__(self, learner: Learner, items: Items, *, ahead: bool = True) -> None:
        self.learner = learner
        self.items = items
        self.ahead = ahead
        self.entries: list[dict[int, int]] = []
        self.shapes: dict[tuple[Place, Any], int] = {}
        self.homes: dict[int, tuple[tuple[Place, Any], tuple[Member, ...]]] = {}
        self.ways: dict[tuple[int, int], int] = {}
        self.payload = Growing(np.int32)
        self.payload.append(UNKNOWN)
        self.shape, self.mentions_from = Growing(np.int32), Growing(np.int32)
        self.who, self.roles, self.own = Growing(np.int32), Growing(np.uint64), Growing(np.uint64)
        self.writes_from, self.writes, self.numbers = Growing(np.int32), Growing(np.int32), Growing(np.uint64)
        self.shape.append(UNKNOWN, UNKNOWN)  # for UNKNOWN and FIXED
        self.mentions_from.append(0, 0, 0)
        self.own.append(0, 0)
        self.writes_from.append(0, 0)
        self.numbers.append(0)
        self.where: Packing | None = None
        self.entered = 0
        self.keys, self.values = np.zeros(1024, np.uint64), np.zeros(1024, np.int32)

    # --- tables for the loops -----------------------------------------------------------------------------------------

    def see(self, where: Packing) -> None:
        """Rebuild the loops' tables from everything learned so far."""
        if where is not self.where:
            self._take_columns(where)
        self._enter_ways()
        members = np.array(self.items.class_of, np.int32)
        self.exchanges = Exchanges(
            *self.columns,
            self.shape.room,
            self.mentions_from.room,
            self.who.room,
            self.roles.room,
            self.own.room,
            self.keys,
            self.values,
            self.payload.room,
            self.writes_from.room,
            self.writes.room,
            self.numbers.room,
            members,
            MOST_ORDERS,
        )

    def snapshot(self) -> Exchanges:
        """Return the tables with copies of those that learning changes in place."""
        shown = self.exchanges
        return shown._replace(
            entries=shown.entries.copy(),
            keys=shown.keys.copy(),
            values=shown.values.copy(),
            payload=shown.payload.copy(),
        )

    def _take_columns(self, where: Packing) -> None:
        """Collect the columns that have bits, and allocate the entries of their codes."""
        self.where, columns = where, self.learner.columns
        self.entries += [{} for _ in range(len(columns) - len(self.entries))]
        places = [column.place for column in columns.all]
        active = np.flatnonzero(where.mask).tolist()
        active.sort(key=lambda number: len(places[number]))
        skeleton = [columns.numbers[place[:1]] for place in places]
        holes_of: list[list[int]] = [[] for _ in places]
        for number in active:
            if len(places[number]) > 1:
                holes_of[skeleton[number]].append(number)
        widths = [
            min(mask + 1, 2 * size) for mask, size in zip(where.mask.tolist(), columns.sizes, strict=True)
        ]
        begins = np.cumsum([0, *widths])
        self.columns = (
            np.array(active, np.int32),
            np.array(skeleton, np.int32),
            np.cumsum([0, *map(len, holes_of)]).astype(np.int32),
            np.array([number for each in holes_of for number in each], np.int32),
            begins.astype(np.int32),
            np.array(widths, np.int32),
            np.zeros(begins[-1], np.int32),
        )
        for number, known in enumerate(self.entries):
            for code, entry in known.items():
                self._show(number, code, entry)
        self._desk = SymmetryScratch(len(active), len(places), len(self.items.members), where.words)

    @property
    def desk(self) -> RowScratch:
        """The scratch space of this thread."""
        return self._desk.room

    def _show(self, number: int, code: int, entry: int) -> None:
        *_, begins, widths, entries = self.columns
        if code < widths[number]:
            entries[begins[number] + code] = entry
        else:
            self.where = None  # the table of entries is too small

    def _enter_ways(self) -> None:
        """Add new edges of the trie to the loops' hash table; a table that grows is filled from scratch."""
        new = list(self.ways.items())[self.entered :] if self.entered < len(self.ways) else []
        if 2 * len(self.ways) > len(self.keys):
            room = 4 * len(self.keys)
            while 2 * len(self.ways) > room:
                room *= 2
            self.keys, self.values, new = (
                np.zeros(room, np.uint64),
                np.zeros(room, np.int32),
                list(self.ways.items()),
            )
        keys = np.array([node << 32 | number for (node, number), _ in new], np.uint64)
        enter_all(self.keys, self.values, keys, np.array([to for _, to in new], np.int32))
        self.entered = len(self.ways)

    # --- learning -------------------------------------------------------------------------------------------------

    @property
    def missed(self) -> list[tuple[int, int, int, int]]:
        """The entry or move at which the loop stopped, in records of four numbers.

        The first record has -1 - kind, the subject and the number of arguments. The others have the arguments.
        """
        kind, what, count = self.desk.unknown[:LISTED].tolist()
        listed = [*self.desk.unknown[LISTED : LISTED + count].tolist(), 0, 0, 0]
        return [(-1 - kind, what, count, 0), *zip(*[iter(listed[: -(-count // 4) * 4])] * 4, strict=True)]

    def learn(self) -> None:
        """Learn the entry or move at which the loop stopped."""
        kind, what, count = self.desk.unknown[:LISTED].tolist()
        self._learn(kind, what, self.desk.unknown[LISTED : LISTED + count].tolist())

    def learn_again(self, first: Sequence[int], others: Iterator[Sequence[int]]) -> None:
        """Learn an entry or move that tables of the same mission `missed`.

        Raises:
            ValueError: They can't have missed it.
        """
        kind, what, count = -1 - first[0], first[1], first[2]
        if kind > TARGET or not 0 <= count <= 4 * MOST_ARGUMENTS:
            raise ValueError("it learned an exchange of no kind")
        listed = [number for _ in range(-(-count // 4)) for number in next(others, ())][:count]
        if len(listed) != count or min((what, *listed)) < 0:
            raise ValueError("it learned an exchange of nothing")
        try:
            self._learn(kind, what, listed)
        except Exception as error:
            raise ValueError(f"it learned no exchange: {type(error).__name__}: {error}") from error

    def _learn(self, kind: int, what: int, listed: list[int]) -> None:
        if kind == ENTRY:
            self._learn_codes(what, listed[0])
        elif kind == WHOLE:
            self._learn_whole(what, listed[:-1], listed[-1])
        else:
            self._move(int(self.shape.room[what]), listed)

    def _learn_codes(self, number: int, code: int) -> None:
        """Learn the entry of a code and, `ahead`, of all new codes of skeletons: these are few, and most occur."""
        self._learn_code(number, code)
        for other, column in enumerate(self.learner.columns.all[: len(self.entries) if self.ahead else 0]):
            if len(column.place) == 1:
                for each in range(1, len(column.values)):
                    if each not in self.entries[other]:
                        self._learn_code(other, each)

    def _learn_code(self, number: int, code: int) -> None:
        column = self.learner.columns.all[number]
        place, value = column.place, column.values[code]
        if len(place) == 1 and self.items.is_whole(place[0], value):
            entry = -self._node()
        elif place[0] in (AGENTS, NAMES) or not (roles := self.items.roles(place, value)):
            entry = FIXED
        else:
            entry = self._entry(place, value, roles)
        self.entries[number][code] = entry
        self._show(number, code, entry)

    def _learn_whole(self, number: int, listed: Sequence[int], code: int) -> None:
        columns = self.learner.columns
        codes = dict(zip(listed[::2], listed[1::2], strict=True))
        place = columns.all[number].place
        value = columns.whole(place[0], columns.all[number].values[code], codes)
        node = -self.entries[number][code]
        for each in listed:
            node = self._way(node, each)
        self.payload.room[node] = self._entry(place, value, self.items.roles(place, value))

    def _entry(self, place: Place, value: Any, roles: Roles) -> int:
        """Return the number of a new entry; if it mentions at most one member, learn all its moves."""
        first, met = self.items.begins, [0] * len(self.items.classes)
        homes = []
        for member, _ in roles:
            number = self.items.class_of[member]
            homes.append(first[number] + met[number])
            met[number] += 1
        home = self.items.exchanging({member: to for (member, _), to in zip(roles, homes, strict=True)})
        at_home = self.items.renamed(home, place, value)
        is_new = at_home not in self.shapes
        if is_new:
            self.shapes[at_home] = self._node()
            self.homes[self.shapes[at_home]] = at_home, tuple(homes)
        shape = self.shapes[at_home]
        for member, role in roles:
            self.who.append(member)
            self.roles.append(role)
        self.mentions_from.append(len(self.who))
        self.own.append(self.items.number(place, value))
        if is_new and len(roles) < 2:
            number = self.items.class_of[homes[0]] if homes else 0
            for member in range(first[number], first[number + 1]) if homes else ():
                self._move(shape, [member])
            if not homes:
                self._move(shape, [])
        return self.shape.append(shape)

    def _move(self, shape: int, members: Sequence[Member]) -> None:
        """Learn the image of a shape for other members."""
        (place, value), homes = self.homes[shape]
        exchange = self.items.exchanging(dict(zip(homes, members, strict=True)))
        place, value = self.items.renamed(exchange, place, value)
        node = shape
        for member in members:
            node = self._way(node, member)
        for number, code in self._codes(place, value):
            self.writes.append(number, code)
        self.payload.room[node] = self.numbers.append(self.items.number(place, value))
        self.writes_from.append(len(self.writes))

    def _codes(self, place: Place, value: Any) -> Writes:
        """Return the columns and codes of an item; a cell that no rule has written so far becomes varying."""
        learner, cell = self.learner, place[0]
        columns = learner.columns
        if cell not in learner.varying:
            learner.varying.add(cell)
            learner.forget_those(learner.taken, cell)
        columns.number((cell,))
        families: tuple[Any, ...] = ()
        if len(place) == 3:
            deep = place[1] + 1
        else:
            value, families = split_value(value, columns.mobile)
            deep = sum(1 for _ in holes(value))
        if columns.dig(cell, deep):
            learner.forget_those(learner.writers, cell)
        told: dict[Place, Any] = {place: value}
        for number, family in enumerate(families):
            told |= {(cell, number, name): family[name] for name in columns.mobile.intersection(family)}
        return [
            (columns.number(each), columns.all[columns.number(each)].code(fact))
            for each, fact in told.items()
        ]

    def _node(self) -> int:
        return self.payload.append(UNKNOWN)

    def _way(self, node: int, number: int) -> int:
        if (node, number) not in self.ways:
            self.ways[node, number] = self._node()
        return self.ways[node, number]
