"""The state of a vehicle's link: lost after a silence, then restored, or restarted by a reboot."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Final

from adapters.mavlink.telemetry import Telemetry
from adapters.plugin import LinkLost, LinkRestored

SILENCE: Final = 5.0
"""Seconds: the time of five heartbeats, and of many positions."""


@dataclass(frozen=True, slots=True)
class LinkState:
    """The last reported state of a vehicle's link: whether it is lost, and the vehicle's number of boots."""

    lost: bool = False
    boots: int = 0


def watch(
    link: LinkState, entity: str, known: Telemetry, now: float
) -> tuple[LinkState, LinkLost | LinkRestored | None]:
    """Return the current link, and the report of a change."""
    if known.heard is None:
        return link, None
    silent = now - known.heard > SILENCE
    if silent and not link.lost:
        return replace(link, lost=True), LinkLost(entity, now, known.heard)
    if known.boots != link.boots:
        return LinkState(boots=known.boots), LinkRestored(entity, now, rebooted=True)
    if link.lost and not silent:
        return replace(link, lost=False), LinkRestored(entity, now)
    return link, None
