"""Urgent troubles of a vehicle for the operator: no position, a moved home, a refusal to arm."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Final

from adapters.mavlink.telemetry import REFUSES_TO_ARM, Telemetry
from adapters.plugin import Trouble

BLIND: Final = 5.0
"""Seconds without a valid position before it is reported."""

NO_POSITION: Final = "no position"
HOME_MOVED: Final = "home moved"


@dataclass(frozen=True, slots=True)
class FaultState:
    """The start of a vehicle's time without a valid position, and the reported troubles."""

    blind: float | None = None
    reported: frozenset[str] = frozenset()


def look(
    before: FaultState, entity: str, known: Telemetry, now: float, *, lost: bool
) -> tuple[FaultState, tuple[Trouble, ...]]:
    """Report the new and the ended troubles of a vehicle, each once."""
    if lost:
        return before, ()
    told = bool(known.fixes) or known.estimate is not None
    placed = known.position is None or known.is_placed(now) or not told
    blind = None if placed else now if before.blind is None else before.blind
    found = frozenset(_found(known, blind, now))
    if not known.armed:  # a vehicle repeats a reason every 30 s; it is reported once
        found |= {each for each in before.reported if each.startswith(REFUSES_TO_ARM)}
    after = FaultState(blind, found)
    return after, tuple(Trouble(entity, now, *words) for words in _words(before, after, known, now))


def _found(known: Telemetry, blind: float | None, now: float) -> Iterator[str]:
    if blind is not None and now - blind >= BLIND:
        yield NO_POSITION
    if known.armed and known.home_moved:
        yield HOME_MOVED
    yield from known.unready(now)


def _words(before: FaultState, after: FaultState, known: Telemetry, now: float) -> Iterator[tuple[str, str]]:
    come, gone = after.reported - before.reported, before.reported - after.reported
    if NO_POSITION in come:
        yield NO_POSITION, f"{known.lacks(now)}; its position is unknown"
    if NO_POSITION in gone:
        yield "position again", "its position is valid again"
    if HOME_MOVED in come:
        told = f"{known.home_moved}, by itself or by a command from elsewhere; `return` leads there"
        yield HOME_MOVED, f"{told}, and heights of the mission stay above the home before"
    for text in sorted(come):
        if text.startswith(REFUSES_TO_ARM):
            yield "not ready", f"it cannot be armed: {text!r}"
