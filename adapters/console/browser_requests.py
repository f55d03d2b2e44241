"""The requests of a browser: frames of JSON, parsed and never evaluated (docs/reference/console.md)."""

from __future__ import annotations

from typing import Annotated, Any, Final, Literal

from msgspec import UNSET, Meta, Struct, UnsetType
from msgspec.structs import astuple

from adapters.typed_json import read_typed
from physical import PhysicalError
from physical.untrusted_text import MAX_TEXT

SLOWEST: Final = 0.5
FASTEST: Final = 100.0
"""The bounds of the speed: seconds of the recording per second of wall time."""

PROTOCOL: Final = "bigactors.console/1"
MOST_BYTES: Final = 16_384
MOST_ID: Final = 100

Text = Annotated[str, Meta(max_length=MAX_TEXT)]


class Unreadable(ValueError):
    """A frame that is not a known request; the message names the place of the fault."""


class Hello(Struct, frozen=True, tag_field="type", tag="hello"):
    """The first frame: the protocol, the token, and the user's name, which is not checked yet."""

    protocol: str
    token: str
    name: Any = ""


class Seek(Struct, frozen=True, tag_field="type", tag="seek"):
    """Show another time."""

    time: float


class Play(Struct, frozen=True, tag_field="type", tag="play"):
    """Play from the shown time, at a speed."""

    speed: Annotated[float, Meta(ge=SLOWEST, le=FASTEST)]


class Pause(Struct, frozen=True, tag_field="type", tag="pause"):
    """Pause at the shown time."""


class LiveRequest(Struct, frozen=True, tag_field="type", tag="live"):
    """Show the newest moment."""


class Say(Struct, frozen=True):
    """Send an agent a message that the mission allows."""

    agent: Text
    message: Text


class Order(Struct, frozen=True):
    """Order a vehicle, several, or all, to hold or to return."""

    order: Literal["hold", "return"]
    vehicle: Text | Annotated[tuple[Text, ...], Meta(min_length=1)] | None


class GiveBackRequest(Struct, frozen=True):
    """Let the mission command a vehicle again."""

    vehicle: Text


class Acknowledge(Struct, frozen=True):
    """Acknowledge an alert, the number of a finding."""

    alert: Annotated[str, Meta(pattern=r"\A[0-9]{1,9}\Z")]


class Note(Struct, frozen=True):
    """Record a note."""

    text: Text


class RequestedAction(Struct, frozen=True, forbid_unknown_fields=True):
    """One action: start the run that waits for its operator, or another."""

    say: Say | UnsetType = UNSET
    order: Order | UnsetType = UNSET
    give_back: GiveBackRequest | UnsetType = UNSET
    acknowledge: Acknowledge | UnsetType = UNSET
    note: Note | UnsetType = UNSET
    start: bool | UnsetType = UNSET

    def __post_init__(self) -> None:
        if sum(each is not UNSET for each in astuple(self)) != 1 or self.start is False:
            raise ValueError(
                "expected one of 'say', 'order', 'give_back', 'acknowledge', 'note' and 'start' with true"
            )


class Act(Struct, frozen=True, tag_field="type", tag="act"):
    """An action, and the identifier of its answer."""

    id: Annotated[str, Meta(max_length=MOST_ID)]
    action: RequestedAction


Request = Hello | Seek | Play | Pause | LiveRequest | Act


def read_request(text: str) -> Request:
    """Return the request in a frame.

    Raises:
        Unreadable: The frame is not a known request.
    """
    try:
        said = text.encode(errors="surrogatepass")
        request: Request = read_typed(said, MOST_BYTES, Request)  # type: ignore[arg-type]  # a union
    except PhysicalError as error:
        raise Unreadable(f"this is no request: {error.message}: see docs/reference/console.md") from error
    return request
