"""The decoder of one AIS message, by pyais, into reports: the only file that imports pyais, and only when called.

It uses only `decode` of pyais; the stream classes block, and have lost multi-part messages. Messages without a position
or static data (binary data, acknowledgements, channel management) are not decoded.
"""

from collections.abc import Callable
from functools import cache
from typing import Protocol, cast

from physical.ais_reports import HIGHEST_ALTITUDE, AisError, PositionReport, Report, StaticReport
from physical.nmea import DecodingFailure, Fragment
from physical.wordings import install_extra

POSITIONS = frozenset({1, 2, 3, 4, 9, 11, 17, 18, 19, 21, 27})
"""The message types with the position of the sender."""

AIRCRAFT_POSITION = 9

STATICS = frozenset({5, 19, 21, 24})
"""The message types with static data of the sender."""

_TYPES = range(1, 28)
# The last bit that is read from each message type: pyais reads past the end of shorter messages.
_NEEDED_BITS = {1: 137, 2: 137, 3: 137, 4: 134, 5: 240, 9: 128, 11: 134, 17: 75}
_NEEDED_BITS |= {18: 133, 19: 271, 21: 219, 24: 48, 27: 94}
_HIGHEST_MMSI = 999_999_999
# Speed is in tenths of a knot, except in knots from aircraft and over long range; each has its own "not available".
_NO_SPEED = {9: 1023.0, 27: 63.0}


class _Message(Protocol):
    """The fields of a pyais message; only position messages have coordinates."""

    msg_type: int
    mmsi: int
    lat: float
    lon: float


def type_of(parts: tuple[Fragment, ...]) -> int:
    """Return the message type, 0 to 63, which is the first character of the payload."""
    code = parts[0].payload[0] - 48
    return code - 8 if code > 40 else code


def decode(
    parts: tuple[Fragment, ...], time: float | None
) -> tuple[tuple[Report, ...], DecodingFailure | None]:
    """Decode one message from all its parts, in order: its reports, and the reason if some or all are missing.

    Raises:
        AisError: If pyais is not installed.
    """
    msg_type = type_of(parts)
    if msg_type not in _TYPES:
        return (), DecodingFailure.UNKNOWN
    if msg_type not in _NEEDED_BITS:
        return (), None
    if sum(part.bits for part in parts) < _NEEDED_BITS[msg_type]:
        return (), DecodingFailure.TRUNCATED
    pyais_decode = _pyais_decode()
    try:
        message = pyais_decode(*(part.raw for part in parts))
    except Exception:  # pyais raises arbitrary errors for hostile payloads; none may end a feed
        return (), DecodingFailure.UNDECODABLE
    return _reports(message, time) if message.mmsi <= _HIGHEST_MMSI else ((), DecodingFailure.UNDECODABLE)


@cache
def _pyais_decode() -> Callable[..., _Message]:
    try:
        from pyais import decode as pyais_decode  # noqa: PLC0415 - an optional dependency, imported only for AIS
    except ImportError as missing:
        hint = install_extra("ais")
        raise AisError("ais-extra", "reading AIS needs pyais, which is not installed", hint) from missing
    return cast("Callable[..., _Message]", pyais_decode)


def _reports(message: _Message, time: float | None) -> tuple[tuple[Report, ...], DecodingFailure | None]:
    if message.msg_type not in POSITIONS:
        return _static(message, time), None
    position = _position(message, time)
    static = _static(message, time) if message.msg_type in STATICS else ()
    return (*position, *static), None if position else DecodingFailure.NOT_AVAILABLE


def _position(message: _Message, time: float | None) -> tuple[PositionReport, ...]:
    lat, lon = _coordinates(message)
    if abs(lat) > 90 or abs(lon) > 180:  # 91 and 181 mean "not available"
        return ()
    sog, cog, heading = _motion(message)
    return (
        PositionReport(time, message.msg_type, message.mmsi, lat, lon, sog, cog, heading, _altitude(message)),
    )


def _altitude(message: _Message) -> float | None:
    """Return the altitude of an aircraft; 4095 means "not available"."""
    altitude = getattr(message, "alt", None) if message.msg_type == AIRCRAFT_POSITION else None
    return None if altitude is None or altitude > HIGHEST_ALTITUDE else float(altitude)


def _coordinates(message: _Message) -> tuple[float, float]:
    if message.msg_type != 17:
        return message.lat, message.lon
    return _tenth_of_a_minute(message.lat, 17), _tenth_of_a_minute(message.lon, 18)


def _tenth_of_a_minute(tenths: float, width: int) -> float:
    """Return a coordinate of message 17 in degrees; pyais gives it unsigned and in tenths of its unit."""
    raw = round(10 * tenths)
    return (raw - (raw >> (width - 1) << width)) / 600


def _motion(message: _Message) -> tuple[float | None, float | None, float | None]:
    sog, cog = getattr(message, "speed", None), getattr(message, "course", None)
    heading = getattr(message, "heading", None)
    return (
        None if sog is None or sog >= _NO_SPEED.get(message.msg_type, 102.3) else sog,
        _angle(cog),
        _angle(heading),
    )


def _angle(degrees: float | None) -> float | None:
    """Return an angle in [0, 360); 360, 511 and all values between mean "not available"."""
    return None if degrees is None or degrees >= 360 else float(degrees)


def _static(message: _Message, time: float | None) -> tuple[StaticReport, ...]:
    name = getattr(message, "shipname", None) or getattr(message, "name", None) or ""
    extension = getattr(message, "name_ext", None) or ""
    text = f"{name}{extension}".split("@", 1)[0].strip()
    code = getattr(message, "ship_type", None)  # 0 means "not available"
    return (StaticReport(time, message.msg_type, message.mmsi, text or None, int(code) if code else None),)
