"""Request message streams from a vehicle until they arrive."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass, field, replace
from typing import Final

from adapters.mavlink.command import long
from adapters.mavlink.constants import REGULAR, STREAMS, Cmd
from adapters.mavlink.message import MavlinkMessage

MISSED: Final = 5.0
"""Seconds, or periods, without a message after which it is requested."""

ASK_EVERY: Final = 2.0


@dataclass(frozen=True, slots=True)
class Streams:
    """The time of each message's last arrival and of the last request."""

    came: dict[str, float] = field(default_factory=dict)
    asked: float | None = None


def hear(streams: Streams, message: MavlinkMessage, now: float) -> Streams:
    """Record the arrival of a message."""
    return Streams({**streams.came, message.name: now}, streams.asked) if message.name in STREAMS else streams


def tick(
    streams: Streams, system: int, now: float, wanted: Iterable[str] = REGULAR
) -> tuple[Streams, tuple[MavlinkMessage, ...]]:
    """Request all wanted messages that have not come for a while."""
    if streams.asked is not None and now - streams.asked < ASK_EVERY:
        return streams, ()
    missing = [name for name in wanted if _missed(streams.came.get(name), STREAMS[name][1], now)]
    return replace(streams, asked=now), tuple(_question(name, system) for name in missing)


def _missed(came: float | None, period: float, now: float) -> bool:
    return came is None or now - came > max(MISSED, MISSED * period)


def _question(name: str, system: int) -> MavlinkMessage:
    number, period = STREAMS[name]
    return long(Cmd.SET_MESSAGE_INTERVAL, system, number, period * 1e6)
