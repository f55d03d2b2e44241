"""Map the systems on a link to the mission's vehicles, by system id, serial number, or order of arrival.

A pure state machine. A vehicle with a serial number in the mission is asked for it (AUTOPILOT_VERSION) until it
answers. Until then its messages are ignored, since any vehicle can have its system id.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field, replace
from typing import Final

from adapters.mavlink.command import long
from adapters.mavlink.constants import AUTOPILOT_COMPONENT, AUTOPILOT_VERSION, NO_AUTOPILOT, Cmd
from adapters.mavlink.message import MavlinkMessage
from adapters.mavlink.pilot import Pilot

ASK_EVERY: Final = 1.0
"""Seconds between two questions for a serial number."""

VERSION: Final = "AUTOPILOT_VERSION"


@dataclass(frozen=True, slots=True)
class Roster:
    """The reported serial numbers of systems, and the time of the last question to each."""

    serials: Mapping[int, str] = field(default_factory=dict)
    asked: Mapping[int, float] = field(default_factory=dict)


@dataclass(frozen=True, slots=True)
class Found:
    """A message's vehicle: its `pilot` with the system id, None if unknown; `question` is for the sender."""

    roster: Roster
    pilot: Pilot | None = None
    question: MavlinkMessage | None = None
    stranger: bool = False


def find(roster: Roster, pilots: Iterable[Pilot], message: MavlinkMessage, now: float) -> Found:
    """Return the pilot of a message's sender, or the question that would identify it."""
    if message.system == 0 or message.component != AUTOPILOT_COMPONENT:
        return Found(roster)
    everyone = tuple(pilots)
    known = next((pilot for pilot in everyone if pilot.system == message.system), None)
    if known is not None:
        return Found(roster, known)
    if message.name == VERSION:
        roster = replace(roster, serials={**roster.serials, message.system: serial_of(message)})
    elif message.name != "HEARTBEAT" or message["autopilot"] == NO_AUTOPILOT:
        return Found(roster)
    unbound = [pilot for pilot in everyone if pilot.system == 0]
    serial = roster.serials.get(message.system)
    if serial is None and any(pilot.craft.serial for pilot in unbound):
        return _asked(roster, message.system, now)
    fitting = next((pilot for pilot in unbound if _fits(pilot, message.system, serial)), None)
    if fitting is None:
        return Found(roster, stranger=True)
    return Found(roster, replace(fitting, system=message.system))


def serial_of(version: MavlinkMessage) -> str:
    """Return an autopilot's serial number in hexadecimal digits, empty if it has none."""
    long_one = bytes(version["uid2"]).rstrip(b"\0")
    if long_one:
        return long_one.hex().upper()
    return f"{version['uid']:016X}" if version["uid"] else ""


def _fits(pilot: Pilot, system: int, serial: str | None) -> bool:
    craft = pilot.craft
    if craft.serial is None:
        return craft.system is None
    return craft.serial == serial and craft.system in (None, system)


def _asked(roster: Roster, system: int, now: float) -> Found:
    last = roster.asked.get(system)
    if last is not None and now - last < ASK_EVERY:
        return Found(roster)
    roster = replace(roster, asked={**roster.asked, system: now})
    return Found(roster, question=long(Cmd.REQUEST_MESSAGE, system, AUTOPILOT_VERSION))
