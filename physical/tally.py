"""Tallies: what was in a file, what a reader took of it, and what it left out, by kind."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from typing import Final

from physical.messages import counted
from physical.physical_property import PhysicalProperty

MAX_KINDS: Final = 100
"""How many kinds are counted apart; a file may have any number of them."""

OTHERS: Final = "of other kinds"

Kinds = tuple[tuple[str, int], ...]
"""Counts by kind, sorted by kind."""


@dataclass(frozen=True, slots=True)
class Tally:
    """The account of a file: every thing in it is in one kind, taken or left out.

    Attributes:
        total: How many things were in the file, counted apart from their kinds.
        one: What a thing is called.
        many: What several are called.
        taken: How many of which kind the reader took.
        left_out: How many of which kind it did not take, and why.
        asides: What is missing of things that were taken.
    """

    total: int = 0
    one: str = "thing"
    many: str = "things"
    taken: Kinds = ()
    left_out: Kinds = ()
    asides: Kinds = ()

    def __str__(self) -> str:
        return "\n".join(self.rows())

    @property
    def adds_up(self) -> bool:
        """Whether the kinds add up to what was in the file."""
        return self.total == sum(count for _, count in (*self.taken, *self.left_out))

    def rows(self) -> tuple[str, ...]:
        """Describe the account: the total and what was taken in the first row, then a row for each kind left out."""
        found = ", ".join(counted(count, kind, _plural(kind)) for kind, count in self.taken)
        head = f"{counted(self.total, self.one, self.many)}" + (f": {found}" if found else "")
        return (head, *self.missing())

    def missing(self) -> tuple[str, ...]:
        """Describe what was not taken, a row for each kind."""
        left = (f"{count:,} x {kind}, not read" for kind, count in self.left_out)
        return (*left, *(f"{count:,} x {kind}" for kind, count in self.asides))

    def summary(self) -> tuple[str, ...]:
        """Describe the account in few rows, for what has many kinds: what was not taken is in one."""
        head = self.rows()[0]
        left = (f"not read: {in_a_line(self.left_out)}",) if self.left_out else ()
        return (head, *left, *(f"{count:,} x {kind}" for kind, count in self.asides))


@dataclass(frozen=True, slots=True)
class Read:
    """What a reader made of a file: properties of entities, and the accounts of what was in it."""

    properties: tuple[PhysicalProperty, ...]
    tallies: tuple[Tally, ...]

    def missing(self) -> tuple[str, ...]:
        """Describe all that was not taken, a row for each kind."""
        return tuple(row for tally in self.tallies for row in tally.missing())


class Counting:
    """Counts what a reader comes across, in bounded memory."""

    def __init__(self) -> None:
        self.taken = Counter[str]()
        self.left_out = Counter[str]()
        self.asides = Counter[str]()

    def take(self, kind: str, count: int = 1) -> None:
        """Count things that are taken."""
        _add(self.taken, kind, count)

    def leave(self, kind: str, count: int = 1) -> None:
        """Count things that are left out."""
        _add(self.left_out, kind, count)

    def note(self, kind: str, count: int = 1) -> None:
        """Count what is missing of things that are taken."""
        _add(self.asides, kind, count)

    @property
    def total(self) -> int:
        """How many things were counted."""
        return self.taken.total() + self.left_out.total()

    def tally(self, total: int, one: str, many: str = "") -> Tally:
        """Return the account of a file with `total` things."""
        listed = (_sorted(each) for each in (self.taken, self.left_out, self.asides))
        return Tally(total, one, many or f"{one}s", *listed)


def _add(counts: Counter[str], kind: str, count: int) -> None:
    counts[kind if kind in counts or len(counts) < MAX_KINDS else OTHERS] += count


def _plural(kind: str) -> str:
    """Return a kind with its first word, a noun, in the plural.

    >>> _plural("part of a message")
    'parts of a message'
    """
    noun, space, rest = kind.partition(" ")
    return f"{noun}s{space}{rest}"


def _sorted(counts: Mapping[str, int]) -> Kinds:
    return tuple(sorted((kind, count) for kind, count in counts.items() if count))


def in_a_line(kinds: Iterable[tuple[str, int]], most: int = 12) -> str:
    """Return counts by kind in a line: those that say why first, then the most frequent.

    >>> in_a_line([("ATTITUDE", 2), ("HEARTBEAT", 10), ("GPS_RAW_INT without a fix", 1)])
    '1 x GPS_RAW_INT without a fix, 10 x HEARTBEAT, 2 x ATTITUDE'
    """
    ordered = sorted(kinds, key=lambda each: (" " not in each[0], -each[1], each[0]))
    shown = [f"{count:,} x {kind}" for kind, count in ordered[:most]]
    more = sum(count for _, count in ordered[most:])
    return ", ".join([*shown, *([f"{more:,} {OTHERS}"] if more else [])])
