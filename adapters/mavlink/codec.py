"""Convert MAVLink frames to messages and back: the only file that imports pymavlink, and only when called.

Of pymavlink its dialect class alone is used, as a pure codec. Signatures of what arrives are not left to it: it
remembers the time stamp of a packet before it has checked the signature, so that one forged packet silences a vehicle
(`adapters.mavlink.signing` checks them).
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cache
from typing import Any, Final

from adapters.mavlink.message import Message
from physical import PhysicalError

MAX_CHUNK: Final = 65_536
"""Bytes parsed at once; what a socket gives is never more."""


class CodecError(PhysicalError):
    """The codec is not there, or was given what MAVLink has no message for."""


@dataclass(frozen=True, slots=True)
class Garbage:
    """Bytes that are no message, and why."""

    reason: str
    size: int


class Decoder:
    """One stream of frames: of one remote address, because half a frame belongs to who sent its other half."""

    def __init__(self) -> None:
        self._mav = _dialect().MAVLink(None)
        self._mav.robust_parsing = True

    def feed(self, data: bytes) -> list[Message | Garbage]:
        """Return what is complete by now; never raises on what a stranger sends."""
        found = [_heard(each) for each in self._mav.parse_buffer(data[:MAX_CHUNK]) or ()]
        self._forget()
        return [each for each in found if each is not None]

    @property
    def held(self) -> int:
        """How many bytes wait for the rest of their frame."""
        return len(self._mav.buf)

    def _forget(self) -> None:
        """Drop what was parsed: pymavlink keeps it as long as chunks end amid a frame."""
        if self._mav.buf_index:
            del self._mav.buf[: self._mav.buf_index]
            self._mav.buf_index = 0


class Encoder:
    """One sender's frames, numbered; signed if it has a key (32 bytes)."""

    def __init__(self, system: int, component: int, key: bytes | None = None, link: int = 0) -> None:
        self._mav = _dialect().MAVLink(None, system, component)
        self._mav.signing.secret_key = key
        self._mav.signing.sign_outgoing = key is not None
        self._mav.signing.link_id = link

    def pack(self, message: Message, timestamp: int = 0) -> bytes:
        """Return the frame of a message; `timestamp` is the signature's (see `signing.stamp`).

        Raises CodecError where there is no such message, or a field is missing or does not fit.
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


def _heard(parsed: Any) -> Message | Garbage | None:
    name = parsed.get_type()
    raw = bytes(parsed.get_msgbuf())
    if name == "BAD_DATA":
        return Garbage(_short(str(parsed.reason)), len(parsed.data))
    if name.startswith("UNKNOWN"):  # of another dialect: nothing wrong with it
        return None
    fields = {field: getattr(parsed, field) for field in parsed.get_fieldnames()}
    return Message(name, fields, parsed.get_srcSystem(), parsed.get_srcComponent(), raw)


def _short(reason: str) -> str:
    """Return the part of a reason that is alike in all packets of the kind."""
    for known in ("CRC", "prefix", "length", "incompat_flags"):
        if known in reason:
            return f"bad {known}"
    return "bad frame"


@cache
def _dialect() -> Any:
    try:
        from pymavlink.dialects.v20 import ardupilotmega  # noqa: PLC0415 - an extra: nobody pays who flies nothing
    except ImportError as missing:
        hint = "install the extra: pip install 'bigactors[live]'"
        raise CodecError("live-extra", "MAVLink needs pymavlink, which is not installed", hint) from missing
    return ardupilotmega
