"""Convert MAVLink frames to messages and back; pymavlink is imported here alone, at the first call.

Only pymavlink's dialect class is used, as a pure codec. `adapters.mavlink.signing` checks signatures: pymavlink
remembers a packet's time stamp before it checks the signature, so one forged packet would silence a vehicle.
"""

from __future__ import annotations

import struct
from dataclasses import dataclass
from functools import cache
from typing import Any, Final

from adapters.mavlink.message import MavlinkMessage
from physical import PhysicalError
from physical.wordings import install_extra

MAX_CHUNK: Final = 65_536
"""Bytes parsed at once; a socket never delivers more."""


V2_HEADER: Final = 10
"""Bytes before the fields of a MAVLink 2 frame."""

NUMBERS_AT: Final = 6
"""Bytes of MISSION_CURRENT before the numbers of mission, fence and rally points."""


class CodecError(PhysicalError):
    """The codec is not installed, or MAVLink has no such message."""


@dataclass(frozen=True, slots=True)
class Garbage:
    """Bytes that are not a message, and the reason."""

    reason: str
    size: int


class Decoder:
    """The frames from one remote address; a frame may come in two chunks."""

    def __init__(self) -> None:
        self._mav = _dialect().MAVLink(None)
        self._mav.robust_parsing = True

    def feed(self, data: bytes) -> list[MavlinkMessage | Garbage]:
        """Return the complete messages; never raises, for any bytes."""
        found = [_heard(each) for each in self._mav.parse_buffer(data[:MAX_CHUNK]) or ()]
        self._forget()
        return [each for each in found if each is not None]

    @property
    def held(self) -> int:
        """The number of bytes that wait for the rest of their frame."""
        return len(self._mav.buf)

    def _forget(self) -> None:
        """Drop the parsed bytes: pymavlink keeps them as long as chunks end inside a frame."""
        if self._mav.buf_index:
            del self._mav.buf[: self._mav.buf_index]
            self._mav.buf_index = 0


class Encoder:
    """The numbered frames of one sender; signed if it has a key (32 bytes)."""

    def __init__(self, system: int, component: int, key: bytes | None = None, link: int = 0) -> None:
        self._mav = _dialect().MAVLink(None, system, component)
        self._mav.signing.secret_key = key
        self._mav.signing.sign_outgoing = key is not None
        self._mav.signing.link_id = link

    def pack(self, message: MavlinkMessage, timestamp: int = 0) -> bytes:
        """Return the frame of a message; `timestamp` is the signature's (see `signing.stamp`).

        Raises CodecError if there is no such message, or a field is missing or does not fit.
        """
        kind = getattr(_dialect(), f"MAVLink_{message.name.lower()}_message", None)
        if kind is None:
            raise CodecError("mavlink-message", f"MAVLink has no message {message.name!r:.60}")
        self._mav.signing.timestamp = timestamp
        try:
            frame = bytes(kind(**message.fields).pack(self._mav))
        except Exception as problem:  # struct.error, TypeError, AttributeError: by the field
            raise CodecError("mavlink-field", f"{message.name} cannot be packed: {problem}") from problem
        self._mav.seq = (self._mav.seq + 1) % 256
        return frame


def _heard(parsed: Any) -> MavlinkMessage | Garbage | None:
    name = parsed.get_type()
    raw = bytes(parsed.get_msgbuf())
    if name == "BAD_DATA":
        return Garbage(_short(str(parsed.reason)), len(parsed.data))
    if name.startswith("UNKNOWN"):  # of another dialect: not an error
        return None
    fields = {field: getattr(parsed, field) for field in parsed.get_fieldnames()}
    if name == "MISSION_CURRENT":
        fields = _numbers(raw) | fields
    return MavlinkMessage(name, fields, parsed.get_srcSystem(), parsed.get_srcComponent(), raw)


def _numbers(raw: bytes) -> dict[str, int]:
    """Return the extension fields of MISSION_CURRENT that older pymavlink dialects omit; zero if not sent."""
    sent = raw[V2_HEADER : V2_HEADER + raw[1]] if raw[:1] == b"\xfd" else b""
    found = struct.unpack_from("<III", sent.ljust(NUMBERS_AT + 12, b"\0"), NUMBERS_AT)
    return dict(zip(("mission_id", "fence_id", "rally_points_id"), found, strict=True))


def _short(reason: str) -> str:
    """Return the constant part of a reason, without the figures of one packet."""
    for known in ("CRC", "prefix", "length", "incompat_flags"):
        if known in reason:
            return f"bad {known}"
    return "bad frame"


@cache
def _dialect() -> Any:
    try:
        from pymavlink.dialects.v20 import ardupilotmega  # noqa: PLC0415 - an extra, imported only when used
    except ImportError as missing:
        hint = install_extra("live")
        raise CodecError("live-extra", "MAVLink needs pymavlink, which is not installed", hint) from missing
    return ardupilotmega
