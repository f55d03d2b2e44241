"""The requests of the studio's page: frames of JSON, parsed and never evaluated."""

from __future__ import annotations

from typing import Annotated, Any, Final

from msgspec import Meta, Struct

from adapters.typed_json import read_typed

PROTOCOL: Final = "bigactors.studio/1"
MOST_TEXT: Final = 1 << 20
"""The most characters of a mission's text in the studio."""

MOST_BYTES: Final = 32 << 20
"""The most bytes of a frame."""

MissionText = Annotated[str, Meta(max_length=MOST_TEXT)]
Short = Annotated[str, Meta(max_length=200)]


MOST_CORNERS: Final = 1_000

Latitude = Annotated[float, Meta(ge=-90, le=90)]
Longitude = Annotated[float, Meta(ge=-180, le=180)]
Position = tuple[Latitude, Longitude]
Word = Annotated[str, Meta(min_length=1, max_length=200)]


class LspFrame(Struct, frozen=True, tag_field="type", tag="lsp"):
    """A message to the language server."""

    message: dict[str, Any]


class TextFrame(Struct, frozen=True, tag_field="type", tag="text"):
    """The text as it is at a pause, with its number: what is known of an earlier text is out of date."""

    text: MissionText
    number: int


class SaveFrame(Struct, frozen=True, tag_field="type", tag="save"):
    """Save a text over the file with a digest; with the empty digest, over whatever is there."""

    text: MissionText
    over: Short


class BeginFrame(Struct, frozen=True, tag_field="type", tag="begin"):
    """Begin a mission with a name, from the text of a shipped mission, or from the template if that is empty."""

    name: Short
    source: Short


class ExploreFrame(Struct, frozen=True, tag_field="type", tag="explore"):
    """A request to the exploration of the newest text, with a number for its answer."""

    id: int
    request: dict[str, Any]


class Reshape(Struct, frozen=True, tag_field="edit", tag="reshape"):
    """Give an entity other points, and a circle another radius in metres."""

    name: Word
    points: Annotated[tuple[Position, ...], Meta(min_length=1, max_length=MOST_CORNERS)]
    radius: Annotated[float, Meta(gt=0, le=1e7)] | None = None


class Add(Struct, frozen=True, tag_field="edit", tag="add"):
    """Add an entity of a kind: its shape is about `size` metres across."""

    kind: Word
    shape: Annotated[str, Meta(pattern="^(point|circle|box|polygon)$")]
    at: Position
    size: Annotated[float, Meta(gt=0, le=1e7)]


class WorldFrame(Struct, frozen=True, tag_field="type", tag="world"):
    """What a text places on the map, and the changes of the text for an edit there."""

    id: int
    text: MissionText
    edit: Reshape | Add | None = None


class DropFrame(Struct, frozen=True, tag_field="type", tag="drop"):
    """A file of places that is dropped on the map, in base 64."""

    id: int
    text: MissionText
    name: Short
    content: str


class FlyFrame(Struct, frozen=True, tag_field="type", tag="fly"):
    """Fly the mission's file with simulated vehicles."""

    id: int


Request = LspFrame | TextFrame | SaveFrame | BeginFrame | ExploreFrame | WorldFrame | DropFrame | FlyFrame


def read_request(text: str) -> Request:
    """Return the request in a frame; raises PhysicalError if it is none."""
    said = text.encode(errors="surrogatepass")
    request: Request = read_typed(said, MOST_BYTES, Request)  # type: ignore[arg-type]  # a union
    return request
