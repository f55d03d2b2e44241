"""Encode `harbour_watch.nmea`, which the mission of that name reads: invented vessels, not a word of it ever received.

Run it to write the file anew; a test checks that this gives the same bytes. Two minutes from 2020-04-07
21:40:33 UTC around a restricted basin of 200 m by 200 m (`BASIN`): three vessels lie in it, one (`GLASAAL`)
is heard inside from second 103 on, four stay outside. There are a buoy and a base station, the receiver's own
time and position, and damaged lines.
"""

from dataclasses import dataclass
from datetime import UTC, datetime, timedelta
from functools import reduce
from math import cos, radians, sin
from operator import xor
from pathlib import Path

from pyais.encode import encode_dict

PATH = Path(__file__).parents[2] / "specs" / "missions" / "harbour_watch.nmea"
START = datetime(2020, 4, 7, 21, 40, 33, tzinfo=UTC)
SECONDS = 120

BASIN = ((52.83910, 5.71050), (52.84090, 5.71350))
"""Two opposite corners (latitude, longitude) of the restricted basin."""

HEADING = b"""\
# SYNTHETIC: encoded by tests/data/make_synthetic_harbour.py, never received.
# Vessels and their numbers are invented. Two minutes from 2020-04-07 21:40:33 UTC.
# Restricted basin, 200 m by 200 m: from 52.8391, 5.7105 to 52.8409, 5.7135.
"""


@dataclass(frozen=True, slots=True)
class Vessel:
    """Where a vessel is at the start, in degrees, and how it moves, in knots and degrees."""

    mmsi: int
    ais_class: str
    name: str
    ship_type: int
    lat: float
    lon: float
    knots: float
    course: float


VESSELS = (
    Vessel(244999001, "A", "KOKMEEUW", 52, 52.84020, 5.71130, 0.0, 0.0),
    Vessel(244999002, "B", "SPIERING", 37, 52.83950, 5.71280, 0.0, 0.0),
    Vessel(244999003, "B", "DRIEHOEK", 36, 52.84050, 5.71310, 0.1, 45.0),
    Vessel(244999004, "A", "GLASAAL", 31, 52.84000, 5.70710, 4.5, 90.0),
    Vessel(211999005, "A", "NORDLICHT", 70, 52.83500, 5.70400, 7.2, 350.0),
    Vessel(219999006, "B", "SVANE", 36, 52.84180, 5.71700, 2.0, 200.0),
    Vessel(232999007, "B", "PUFFIN", 37, 52.83830, 5.71500, 0.0, 0.0),
    Vessel(244999008, "A", "ZEEDUIVEL", 30, 52.84400, 5.70200, 0.0, 0.0),
)
BASE_STATION = {"type": 4, "mmsi": 2449990, "lat": 52.83880, "lon": 5.71000}
BUOY = {
    "type": 21,
    "mmsi": 992449991,
    "name": "NOORDERHOEK 1",
    "aid_type": 24,
    "lat": 52.84000,
    "lon": 5.70550,
}

REFUSED = {"type": 1, "mmsi": 244999008, "lat": 91, "lon": 181, "course": 360, "heading": 511}
"""A position that is *not available*."""


def _closed(start, body):
    """Put the start delimiter before a sentence and the checksum behind it."""
    return start + body + b"*%02X" % reduce(xor, body, 0)


# Damaged in six ways: checksum, alphabet, length, end, a part whose other is missing, no sentence at all.
DAMAGED = (
    b"!AIVDM,1,1,,A,13aaSFOP000HhhHNClr>4?v1P000,0*00",
    _closed(b"!", b"AIVDM,1,1,,B,13aaSFOP000Hhh[]Clr>4?v1P000,0"),
    _closed(b"!", b"AIVDM,1,1,,B,13aaSFOP000Hhh,0"),
    b"!AIVDM,1,1,,B,13aaSFOP000HhhHNCl",
    _closed(b"!", b"AIVDM,2,2,7,A,88888888880,2"),
    b"\xff\xfe\x00\x17 noise",
)


def encode():
    """Return the whole recording."""
    lines = [line for second in range(SECONDS) for line in _second(second)]
    return HEADING + b"".join(line + b"\n" for line in lines)


def _second(second):
    """List what is heard in one second: the receiver's own time first."""
    yield _rmc(START + timedelta(seconds=second))
    if second % 10 == 5:
        yield from _sentences(BASE_STATION | _date(second))
    if second % 60 == 20:
        yield from _sentences(BUOY)
    for place, vessel in enumerate(VESSELS):
        yield from _vessel(second, place, vessel)
    if second % 20 == 19:
        yield DAMAGED[second // 20]
    if second == 50:
        yield from _sentences(REFUSED)


def _vessel(second, place, vessel):
    """Report the position each 10 s (class A) or 30 s (class B), and once the name."""
    if second % (10 if vessel.ais_class == "A" else 30) == place:
        yield from _sentences(_position(vessel, second))
    if second == 30 + 2 * place:
        yield from _static(vessel, place)


def _position(vessel, second):
    lat, lon = _moved(vessel, second)
    motion = {"speed": vessel.knots, "course": vessel.course or 360, "heading": 511, "second": second % 60}
    return {
        "type": 1 if vessel.ais_class == "A" else 18,
        "mmsi": vessel.mmsi,
        "lat": lat,
        "lon": lon,
        **motion,
    }


def _static(vessel, place):
    known = {
        "mmsi": vessel.mmsi,
        "shipname": vessel.name,
        "ship_type": vessel.ship_type,
        "callsign": f"SYN{place}",
    }
    if vessel.ais_class == "A":
        yield from _sentences({"type": 5, "destination": "NOORDERHOEK", **known}, sequence=place)
    else:
        yield from _sentences({"type": 24, "partno": 0, **known})
        yield from _sentences({"type": 24, "partno": 1, **known})


def _moved(vessel, seconds):
    """Sail on a plane: the harbour is small."""
    metres, course = vessel.knots * 1852 / 3600 * seconds, radians(vessel.course)
    north, east = metres * cos(course), metres * sin(course)
    return vessel.lat + north / 111_280, vessel.lon + east / (111_320 * cos(radians(vessel.lat)))


def _date(second):
    now = START + timedelta(seconds=second)
    return {key: getattr(now, key) for key in ("year", "month", "day", "hour", "minute", "second")}


def _sentences(fields, sequence=None):
    channel = "AB"[fields["mmsi"] % 2]
    encoded = encode_dict(fields, talker_id="AI", sentence_type="VDM", radio_channel=channel, seq_id=sequence)
    return [sentence.encode("ascii") for sentence in encoded]


def _rmc(now):
    body = f"GPRMC,{now:%H%M%S}.00,A,5250.32800,N,00542.60000,E,0.000,,{now:%d%m%y},,,A"
    return _closed(b"$", body.encode("ascii"))


if __name__ == "__main__":
    PATH.write_bytes(encode())
