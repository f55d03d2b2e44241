"""Tallies: the content of a file by kind, as far as a reader took it or left it out."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from typing import Final

from physical.physical_property import PhysicalProperty
from physical.wordings import counted

MAX_KINDS: Final = 100
"""The largest number of separately counted kinds; a file may have any number of them."""

OTHERS: Final = "of other kinds"

Kinds = tuple[tuple[str, int], ...]
"""Counts by kind, sorted by kind."""


@dataclass(frozen=True, slots=True)
class FileAccount:
    """The account of a file: every thing in it belongs to one kind, taken or left out.

    Attributes:
        total: The number of things in the file, counted independently of their kinds.
        one: The noun for a thing.
        many: The plural.
        taken: The number of things taken, by kind.
        left_out: The number of things left out, by kind, with the reason in the kind.
        asides: The number of missing parts of taken things, by kind.
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
        """Whether the kinds add up to the total."""
        return self.total == sum(count for _, count in (*self.taken, *self.left_out))

    def rows(self) -> tuple[str, ...]:
        """Return the account as rows: the total and the taken kinds first, then a row for each kind left out."""
        found = ", ".join(counted(count, kind, _plural(kind)) for kind, count in self.taken)
        head = f"{counted(self.total, self.one, self.many)}" + (f": {found}" if found else "")
        return (head, *self.missing())

    def missing(self) -> tuple[str, ...]:
        """Return a row for each kind left out."""
        left = (f"{count:,} x {kind}, not read" for kind, count in self.left_out)
        return (*left, *(f"{count:,} x {kind}" for kind, count in self.asides))

    def summary(self) -> tuple[str, ...]:
        """Return the account in few rows, for a file of many kinds: one row has all kinds left out."""
        head = self.rows()[0]
        left = (f"not read: {in_a_line(self.left_out)}",) if self.left_out else ()
        return (head, *left, *(f"{count:,} x {kind}" for kind, count in self.asides))


@dataclass(frozen=True, slots=True)
class Read:
    """The result of a reader: properties of entities, and the accounts of the file's content."""

    properties: tuple[PhysicalProperty, ...]
    tallies: tuple[FileAccount, ...]

    def missing(self) -> tuple[str, ...]:
        """Return a row for each kind left out."""
        return tuple(row for tally in self.tallies for row in tally.missing())


class Counting:
    """Counts the findings of a reader, in bounded memory."""

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
        """Count missing parts of taken things."""
        _add(self.asides, kind, count)

    @property
    def total(self) -> int:
        """The number of counted things."""
        return self.taken.total() + self.left_out.total()

    def tally(self, total: int, one: str, many: str = "") -> FileAccount:
        """Return the account of a file with `total` things."""
        listed = (_sorted(each) for each in (self.taken, self.left_out, self.asides))
        return FileAccount(total, one, many or f"{one}s", *listed)


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
    """Return counts by kind in a line: those with a reason first, then the most frequent.

    >>> in_a_line([("ATTITUDE", 2), ("HEARTBEAT", 10), ("GPS_RAW_INT without a fix", 1)])
    '1 x GPS_RAW_INT without a fix, 10 x HEARTBEAT, 2 x ATTITUDE'
    """
    ordered = sorted(kinds, key=lambda each: (" " not in each[0], -each[1], each[0]))
    shown = [f"{count:,} x {kind}" for kind, count in ordered[:most]]
    more = sum(count for _, count in ordered[most:])
    return ", ".join([*shown, *([f"{more:,} {OTHERS}"] if more else [])])
