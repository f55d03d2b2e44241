"""Mutable facts for the fold: it writes into copies, so that the frozen facts of others never change; and ticks."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator, Mapping, MutableMapping
from dataclasses import fields
from typing import Any, Final, TypeVar

from adapters.console.console_view import Json
from adapters.console.facts import (
    ControllingStations,
    Facts,
    Link,
    OrderState,
    Run,
    SeenEntity,
    Shape,
    Standing,
    Trail,
    VehicleCommand,
)

Value = TypeVar("Value")

MOST_VEHICLES: Final = 1_000
"""The most vehicles in a table of facts; the oldest are dropped."""


class Table(MutableMapping[str, Value]):
    """A mapping that is copied before the first write."""

    __slots__ = ("_owned", "_values")

    def __init__(self, values: Mapping[str, Value]) -> None:
        self._values = values
        self._owned: dict[str, Value] | None = None

    def __getitem__(self, key: str) -> Value:
        return self._values[key]

    def get(self, key: str, default: Any = None) -> Any:
        """Return a value; this is as fast as in a dict."""
        return self._values.get(key, default)

    def __setitem__(self, key: str, value: Value) -> None:
        self._own()[key] = value

    def __delitem__(self, key: str) -> None:
        del self._own()[key]

    def __iter__(self) -> Iterator[str]:
        return iter(self._values)

    def __len__(self) -> int:
        return len(self._values)

    def bounded(self, most: int) -> None:
        """Drop the oldest values above a number."""
        while len(self._values) > most:
            del self[next(iter(self._values))]

    def whole(self) -> Mapping[str, Value]:
        """Return the values; the table must not be written afterwards."""
        return self._values

    def _own(self) -> dict[str, Value]:
        if self._owned is None:
            self._values = self._owned = dict(self._values)
        return self._owned


class Draft:
    """Mutable facts, with the attributes of `Facts`.

    `changed` is true once a message is taken in.
    """

    changed: bool

    run: Run | None
    begin: float | None
    time: float
    ended: str | None
    broken_off: bool
    step: int
    standing: Standing | None
    seen: Table[SeenEntity]
    shapes: Table[Shape]
    trails: Table[Trail]
    links: Table[Link]
    orders: Table[VehicleCommand]
    hand_overs: Table[VehicleCommand]
    status: Table[Json]
    words: Table[Json]
    taken: Table[str]
    standing_orders: Table[OrderState]
    rebinds: Table[tuple[str, str]]
    stopped: Table[str]
    authority: Table[ControllingStations]
    deadlines: Table[float]
    flights: Table[Json]
    ways: Table[Json]
    invariants: Table[Json]
    failed: frozenset[str]
    steps: Table[Json]
    ticks: Table[Json]
    ticked: int
    alerts: Table[Json]
    found: int
    actions: Table[Json]
    acted: int
    stations: Table[Json]
    preflight: Table[Json]

    def __init__(self, facts: Facts) -> None:
        self.changed = False
        for name in _NAMES:
            value = getattr(facts, name)
            setattr(self, name, Table(value) if isinstance(value, dict) else value)

    def end(self, reason: str, *, broken_off: bool = True) -> None:
        """Note the end of the run, unless it is known; `broken_off`: the recording itself gives no reason."""
        if self.ended is None:
            self.ended, self.broken_off, self.changed = reason, broken_off, True

    def facts(self) -> Facts:
        """Return the frozen facts; the draft must not be used afterwards."""
        return Facts(**{name: _whole(getattr(self, name)) for name in _NAMES})


def _whole(value: Any) -> Any:
    return value.whole() if isinstance(value, Table) else value


_NAMES = tuple(each.name for each in fields(Facts))


MOST_TICKS: Final = 2_000


def tick(draft: Draft, time: float, sort: str) -> None:
    """Add a tick; above `MOST_TICKS`, every second tick of the commonest sort is dropped."""
    draft.ticked += 1
    draft.ticks[str(draft.ticked)] = (time, sort)
    if len(draft.ticks) > MOST_TICKS:
        ((commonest, _),) = Counter(said for _, said in draft.ticks.values()).most_common(1)
        numbers = [number for number, (_, said) in draft.ticks.items() if said == commonest]
        for number in numbers[1::2]:
            del draft.ticks[number]
