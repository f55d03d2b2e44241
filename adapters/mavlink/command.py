"""The command protocol: repeat a command until the vehicle's state shows it; a pure state machine.

An ACK can be lost, duplicated, or belong to an earlier attempt, and acceptance is not execution. So a command is sent
again until the caller sees its effect, or a final refusal.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Any, Final

from adapters.mavlink.constants import Cmd, MavFrame, Result
from adapters.mavlink.message import MavlinkMessage, say

AGAIN: Final = 1.5
"""Seconds before a command is sent again."""

IN_PROGRESS: Final = 5.0
"""Seconds before a command is sent again, if the vehicle reports it as in progress."""

_FINAL: Final = {Result.DENIED, Result.UNSUPPORTED}


@dataclass(frozen=True, slots=True)
class RepeatedMessage:
    """A message that is sent repeatedly; `answer` is the vehicle's last."""

    message: MavlinkMessage
    sent: float | None = None
    attempts: int = 0
    answer: int | None = None

    @property
    def refusal(self) -> str | None:
        """The vehicle's final refusal, if any."""
        if self.answer not in _FINAL:
            return None
        return f"the vehicle refuses {self.what}: {Result(self.answer).name.lower()}"

    @property
    def objection(self) -> str:
        """The vehicle's last answer, if it was no acceptance."""
        if self.answer in (None, Result.ACCEPTED, Result.IN_PROGRESS):
            return ""
        known = self.answer in tuple(Result)
        return Result(self.answer).name if known else f"MAV_RESULT {self.answer}"

    @property
    def what(self) -> str:
        """The command's name for people."""
        number = self.message.fields.get("command")
        return self.message.name if number is None else Cmd(number).name


def tick(telling: RepeatedMessage, now: float) -> tuple[RepeatedMessage, tuple[MavlinkMessage, ...]]:
    """Send it, unless it was sent just before."""
    patience = IN_PROGRESS if telling.answer == Result.IN_PROGRESS else AGAIN
    if telling.sent is not None and now - telling.sent < patience:
        return telling, ()
    message = telling.message
    if "confirmation" in message.fields:
        message = replace(message, fields={**message.fields, "confirmation": min(telling.attempts, 255)})
    return replace(telling, sent=now, attempts=telling.attempts + 1), (message,)


def hear(telling: RepeatedMessage, message: MavlinkMessage) -> RepeatedMessage:
    """Take the vehicle's answer to us."""
    asked = telling.message.fields.get("command")
    if message.name != "COMMAND_ACK" or asked is None or message["command"] != asked or not telling.attempts:
        return telling
    return replace(telling, answer=message["result"])


def long(command: Cmd, system: int, *parameters: float) -> MavlinkMessage:
    """Return a COMMAND_LONG with its parameters; missing ones are 0."""
    padded = (*parameters, *(0.0,) * (7 - len(parameters)))
    numbered: dict[str, Any] = {f"param{i}": float(value) for i, value in enumerate(padded, 1)}
    return say(
        "COMMAND_LONG",
        target_system=system,
        target_component=1,
        command=int(command),
        confirmation=0,
        **numbered,
    )


NAN: Final = float("nan")
"""A single object: two would differ, and so would two equal messages."""


ANYWHERE: Final = 2**31 - 1
"""The coordinate in COMMAND_INT that means none."""


def reposition(
    system: int, x: int, y: int, height: tuple[float, MavFrame], circle: float, *, enters: bool
) -> MavlinkMessage:
    """Return the command to go to a point (1e-7 degree, metres in a frame), and circle there.

    Outside guided mode the vehicle refuses it, unless the command `enters` guided mode.
    """
    return say(
        "COMMAND_INT",
        target_system=system,
        target_component=1,
        frame=int(height[1]),
        command=int(Cmd.REPOSITION),
        current=0,
        autocontinue=0,
        param1=-1.0,  # the vehicle's own speed
        param2=float(enters),
        param3=circle,
        param4=NAN,  # the vehicle's own heading
        x=x,
        y=y,
        z=height[0],
    )


def stop(system: int) -> MavlinkMessage:
    """Return the command to stay at the current position: it has no target."""
    return reposition(system, ANYWHERE, ANYWHERE, (NAN, MavFrame.SEA_LEVEL), NAN, enters=True)


def take_off(system: int, height: tuple[float, MavFrame]) -> MavlinkMessage:
    """Return the command to take off at the current position, to a height in a frame."""
    metres, frame = height
    rest = 0.0 if frame is MavFrame.HOME else NAN  # PX4 would take off towards (0, 0)
    return long(Cmd.TAKEOFF, system, *(6 * [rest]), metres)


def begin_with(system: int, index: int, *, by_command: bool) -> MavlinkMessage:
    """Return the message that makes an item of the mission the current one."""
    if by_command:
        return long(Cmd.SET_MISSION_CURRENT, system, index)
    return say("MISSION_SET_CURRENT", target_system=system, target_component=1, seq=index)


def set_parameter(system: int, name: str, value: float) -> MavlinkMessage:
    """Return the message that sets a parameter; the PARAM_VALUE in answer is the state."""
    return say(
        "PARAM_SET",
        target_system=system,
        target_component=1,
        param_id=name.encode("ascii"),
        param_value=float(value),
        param_type=9,
    )


def read_parameter(system: int, name: str) -> MavlinkMessage:
    """Return the message that asks for a parameter."""
    return say(
        "PARAM_REQUEST_READ",
        target_system=system,
        target_component=1,
        param_id=name.encode("ascii"),
        param_index=-1,
    )
