"""The requests of a browser: frames of JSON, parsed and never evaluated (docs/reference/console.md)."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Final

from adapters.console.playhead import FASTEST, SLOWEST
from physical import PhysicalError, is_text, is_word, read_json

PROTOCOL: Final = "bigactors.console/1"
MOST_BYTES: Final = 16_384
MOST_ID: Final = 100


class Unreadable(ValueError):
    """A frame that is not a known request; the message names the expected ones."""


@dataclass(frozen=True, slots=True)
class Hello:
    """The first frame: the protocol, the token, and the user's name; None for an invalid name."""

    protocol: str
    token: str
    name: str | None


@dataclass(frozen=True, slots=True)
class Seek:
    """Show another time."""

    time: float


@dataclass(frozen=True, slots=True)
class Play:
    """Play from the shown time, at a speed."""

    speed: float


@dataclass(frozen=True, slots=True)
class Pause:
    """Pause at the shown time."""


@dataclass(frozen=True, slots=True)
class Live:
    """Show the newest moment."""


@dataclass(frozen=True, slots=True)
class Say:
    """Send an agent a message that the mission allows."""

    agent: str
    message: str


@dataclass(frozen=True, slots=True)
class Order:
    """Order a vehicle, or all, to hold or to return."""

    order: str
    vehicle: str | None


@dataclass(frozen=True, slots=True)
class GiveBack:
    """Let the mission command a vehicle again."""

    vehicle: str


@dataclass(frozen=True, slots=True)
class Acknowledge:
    """Acknowledge an alert."""

    finding: int


@dataclass(frozen=True, slots=True)
class Start:
    """Start a run that waits for its operator."""


Action = Say | Order | GiveBack | Acknowledge | Start


@dataclass(frozen=True, slots=True)
class Act:
    """An action, and the identifier of its answer."""

    id: str
    action: Action


Request = Hello | Seek | Play | Pause | Live | Act


def read_request(text: str) -> Request:
    """Return the request in a frame.

    Raises:
        Unreadable: The frame is not a known request.
    """
    try:
        said = read_json(text.encode(errors="surrogatepass"), MOST_BYTES)
    except PhysicalError as error:
        raise Unreadable(f"this is no JSON: {error.message:.200}") from error
    if not isinstance(said, dict):
        raise Unreadable("a frame is an object with a 'type'")
    return _request(said)


def _request(said: Mapping[str, object]) -> Request:
    match said:
        case {"type": "hello", "protocol": str(protocol), "token": str(token)}:
            name = said.get("name", "")
            return Hello(protocol, token, name if name == "" or is_word(name) else None)
        case {"type": "seek", "time": time} if _is_number(time):
            return Seek(float(time))  # type: ignore[arg-type]  # a number
        case {"type": "play", "speed": speed} if _is_number(speed) and SLOWEST <= speed <= FASTEST:  # type: ignore[operator]
            return Play(float(speed))  # type: ignore[arg-type]  # a number
        case {"type": "pause"}:
            return Pause()
        case {"type": "live"}:
            return Live()
        case {"type": "act", "id": str(name), "action": {**action}} if (
            len(name) <= MOST_ID and len(action) == 1
        ):
            return Act(name, _action(action))
    raise Unreadable(
        "expected 'hello', 'seek' with a 'time', 'play' with a 'speed' from 0.5 to 100, 'pause', 'live', or 'act' with "
        "an 'id' and one 'action'"
    )


def _action(said: Mapping[object, object]) -> Action:
    match said:
        case {"say": {"agent": str(agent), "message": str(message)}} if is_text(agent) and is_text(message):
            return Say(agent, message)
        case {"order": {"order": "hold" | "return" as order, "vehicle": None}}:
            return Order(order, None)
        case {"order": {"order": "hold" | "return" as order, "vehicle": str(vehicle)}} if is_text(vehicle):
            return Order(order, vehicle)
        case {"give_back": {"vehicle": str(vehicle)}} if is_text(vehicle):
            return GiveBack(vehicle)
        case {"acknowledge": {"alert": str(alert)}} if (
            alert.isascii() and alert.isdigit() and len(alert) < 10
        ):
            return Acknowledge(int(alert))
        case {"start": True}:
            return Start()
    raise Unreadable(
        "expected one of 'say' with 'agent' and 'message', 'order' with 'order' (hold or return) and 'vehicle', "
        "'give_back' with 'vehicle', 'acknowledge' with 'alert', 'start' with true"
    )


def _is_number(value: object) -> bool:
    return isinstance(value, int | float) and not isinstance(value, bool) and math.isfinite(value)
