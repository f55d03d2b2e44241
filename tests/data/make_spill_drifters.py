"""Encode `spill_watch.nmea`, which the live demonstration replays: two invented drifters, nothing of it received.

Run it to write the file anew; a test checks that this gives the same bytes. Fifty minutes from 2014-09-25 10:00:00
UTC, a position of each drifter every 30 s, and the receiver's own time before them.
"""

from datetime import UTC, datetime, timedelta
from functools import reduce
from operator import xor
from pathlib import Path

from pyais.encode import encode_dict

PATH = Path(__file__).parents[2] / "specs" / "missions" / "spill_watch.nmea"
START = datetime(2014, 9, 25, 10, tzinfo=UTC)
MINUTES = 50

HEADING = b"""\
# SYNTHETIC: encoded by tests/data/make_spill_drifters.py, never received.
# Drifters and their numbers are invented. Fifty minutes from 2014-09-25 10:00:00 UTC, off Portimao.
"""

DRIFTERS = ((263999001, 37.020, -8.630, -1.2e-6, -2.0e-6), (263999002, 37.000, -8.660, 0.8e-6, -2.5e-6))
"""MMSI, latitude, longitude, and the degrees by which both change in a second."""


def encode():
    """Return the whole recording."""
    lines = [line for second in range(0, 60 * MINUTES, 30) for line in _moment(second)]
    return HEADING + b"".join(line + b"\n" for line in lines)


def _moment(second):
    yield _rmc(START + timedelta(seconds=second))
    for mmsi, lat, lon, north, east in DRIFTERS:
        fields = {"type": 18, "mmsi": mmsi, "lat": lat + north * second, "lon": lon + east * second}
        motion = {"speed": 0.4, "course": 240.0, "heading": 511, "second": second % 60}
        for sentence in encode_dict(
            {**fields, **motion}, talker_id="AI", sentence_type="VDM", radio_channel="B"
        ):
            yield sentence.encode("ascii")


def _rmc(now):
    body = f"GPRMC,{now:%H%M%S}.00,A,3709.00000,N,00835.00000,W,0.000,,{now:%d%m%y},,,A".encode("ascii")
    return b"$" + body + b"*%02X" % reduce(xor, body, 0)


if __name__ == "__main__":
    PATH.write_bytes(encode())
