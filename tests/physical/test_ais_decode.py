import builtins
import subprocess
import sys

import pytest
from hypothesis import given
from hypothesis import strategies as st
from pyais.encode import encode_dict

from physical import ais_decode
from physical.ais_decode import decode, type_of
from physical.ais_reports import AisError, PositionReport, StaticReport
from physical.nmea import DecodingFailure, checksum, parse_sentence, part_of


def parts_of(**fields):
    return tuple(part_of(parse_sentence(text.encode())) for text in encode_dict(fields, sentence_type="VDM"))


def payload(text, fill=0):
    """One part around a payload."""
    body = b"AIVDM,1,1,,A,%s,%d" % (text, fill)
    return (part_of(parse_sentence(b"!" + body + b"*%02X" % checksum(body))),)


def only(parts):
    (report,), reason = decode(parts, 5.0)
    assert reason is None
    return report


def bits(text, width):
    """Armour a string of bits in whole characters."""
    assert len(text) == width
    codes = [int(text[start : start + 6].ljust(6, "0"), 2) for start in range(0, width, 6)]
    return payload(bytes(code + 48 + 8 * (code >= 40) for code in codes), -width % 6)


def number(value, width):
    return f"{value % 2**width:0{width}b}"


def test_a_position_is_reported_in_the_units_of_ais():
    fields = {
        "type": 1,
        "mmsi": 244660274,
        "lat": 52.97,
        "lon": -5.41,
        "speed": 4.5,
        "course": 90.5,
        "heading": 88,
    }
    assert only(parts_of(**fields)) == PositionReport(5.0, 1, 244660274, 52.97, -5.41, 4.5, 90.5, 88.0)


@pytest.mark.parametrize("msg_type", [1, 2, 3, 4, 9, 11, 18])
def test_every_message_with_a_position_reports_it(msg_type):
    report = only(parts_of(msg_type=msg_type, mmsi=244660274, lat=-33.5, lon=151.25))
    assert (report.msg_type, report.lat, report.lon) == (msg_type, -33.5, 151.25)


@pytest.mark.parametrize(("said", "altitude"), [(0, 0.0), (600, 600.0), (4094, 4094.0), (4095, None)])
def test_an_aircraft_reports_its_altitude(said, altitude):
    report = only(parts_of(type=9, mmsi=111232512, lat=52.0, lon=5.0, alt=said))
    assert report.altitude == altitude
    assert only(parts_of(type=1, mmsi=244660274, lat=52.0, lon=5.0)).altitude is None


@pytest.mark.parametrize(("lat", "lon"), [(91, 181), (91, 5), (52, 181)])
def test_what_is_not_available_is_no_position(lat, lon):
    assert decode(parts_of(type=1, mmsi=244660274, lat=lat, lon=lon), None) == (
        (),
        DecodingFailure.NOT_AVAILABLE,
    )


@pytest.mark.parametrize(("msg_type", "speed"), [(1, 102.3), (18, 102.3), (9, 1023), (27, 63)])
def test_what_is_not_available_is_no_speed_course_or_heading(msg_type, speed):
    course = 511 if msg_type == 27 else 360
    report = only(
        parts_of(
            type=msg_type, mmsi=244660274, lat=1, lon=2, speed=speed, course=course, heading=511, status=0
        )
    )
    assert (report.sog_kn, report.cog_deg, report.heading_deg) == (None, None, None)


@pytest.mark.parametrize(("lat", "lon"), [(-33.85, -151.2), (58.9, 11.0), (0.0, 0.0)])
def test_message_17_is_scaled_to_degrees_and_signed(lat, lon):
    where = number(round(lon * 600), 18) + number(round(lat * 600), 17)
    report = only(bits(OF_17 + where + number(0, 5), 80))
    assert (report.lat, report.lon) == pytest.approx((lat, lon))
    assert report.coarse


def test_message_27_is_coarse():
    report = only(parts_of(type=27, mmsi=244660274, lat=-52.5, lon=5.25, speed=12, course=200, status=0))
    assert (report.lat, report.lon, report.sog_kn, report.cog_deg) == (-52.5, 5.25, 12, 200)
    assert report.coarse


def test_message_5_tells_name_and_type_of_ship():
    parts = parts_of(type=5, mmsi=244660274, shipname="KOKMEEUW", ship_type=52)
    assert len(parts) == 2
    assert only(parts) == StaticReport(5.0, 5, 244660274, "KOKMEEUW", 52)


def test_message_24_tells_the_name_in_part_a_and_the_type_of_ship_in_part_b():
    assert only(parts_of(type=24, partno=0, mmsi=244660274, shipname="SPIERING")).name == "SPIERING"
    second = only(parts_of(type=24, partno=1, mmsi=244660274, ship_type=37))
    assert (second.name, second.ship_type) == (None, 37)


def test_message_19_tells_where_and_what_its_sender_is():
    fields = {"type": 19, "mmsi": 244660274, "lat": 1, "lon": 2, "shipname": "SVANE", "ship_type": 36}
    (position, static), reason = decode(parts_of(**fields), None)
    assert (position.lat, static.name, static.ship_type, reason) == (1, "SVANE", 36, None)


def test_the_name_of_a_buoy_goes_on_in_its_extension():
    fields = {
        "type": 21,
        "mmsi": 992446001,
        "lat": 1,
        "lon": 2,
        "name": "NOORDERHOEK NUMBER 1",
        "name_ext": "23",
    }
    (_, static), _ = decode(parts_of(**fields), None)
    assert static.name == "NOORDERHOEK NUMBER 123"


def test_a_buoy_without_a_position_still_has_its_name():
    fields = {"type": 21, "mmsi": 992446001, "lat": 91, "lon": 181, "name": "NOORDERHOEK"}
    (static,), reason = decode(parts_of(**fields), None)
    assert (static.name, reason) == ("NOORDERHOEK", DecodingFailure.NOT_AVAILABLE)


OF_17 = number(17, 6) + number(0, 2) + number(2655619, 30) + number(0, 2)
OF_24 = number(24, 6) + "00" + number(244660274, 30)
WITHOUT_REPORT = {
    "message 17 without a position": (
        bits(OF_17 + number(181 * 600, 18) + number(91 * 600, 17) + number(0, 5), 80),
        DecodingFailure.NOT_AVAILABLE,
    ),
    "neither position nor name": (payload(b"802R5Ph0BkAgoPNC"), None),
    "a number beyond nine digits": (
        bits(number(1, 6) + "00" + "1" * 30 + "0" * 130, 168),
        DecodingFailure.UNDECODABLE,
    ),
    "a third part of message 24": (bits(OF_24 + "10" + "0" * 128, 168), DecodingFailure.UNDECODABLE),
    **{
        f"no type {first}": (payload(bytes([first]) + b"0" * 27), DecodingFailure.UNKNOWN)
        for first in b"0LMNOPw"
    },
}


@pytest.mark.parametrize("what", WITHOUT_REPORT)
def test_what_reports_nothing_has_its_reason(what):
    parts, reason = WITHOUT_REPORT[what]
    assert decode(parts, None) == ((), reason)


def test_a_message_cut_before_its_heading_is_too_short():
    whole = parts_of(type=1, mmsi=244660274, lat=52.97, lon=5.41)[0].payload
    assert decode(payload(whole[:23]), None)[0]
    assert decode(payload(whole[:22]), None) == ((), DecodingFailure.TRUNCATED)


@pytest.mark.parametrize("first", b"678:;<=>?@BDFGHIJ")
def test_the_type_is_the_first_character_of_the_payload(first):
    assert type_of(payload(bytes([first]) + b"0" * 27)) in range(6, 27)


def test_reading_without_pyais_names_the_extra(monkeypatch):
    real = builtins.__import__

    def without_pyais(name, *rest, **more):
        if name.startswith("pyais"):
            raise ImportError(name)
        return real(name, *rest, **more)

    ais_decode._pyais_decode.cache_clear()
    monkeypatch.delitem(sys.modules, "pyais")
    monkeypatch.setattr(builtins, "__import__", without_pyais)
    with pytest.raises(AisError, match=r"\.\[ais\]"):
        decode(payload(b"1" + b"0" * 27), None)


ARMOUR = "".join(map(chr, (*range(48, 88), *range(96, 120))))


@given(st.text(ARMOUR, min_size=1, max_size=220), st.integers(0, 5))
def test_no_payload_raises_and_every_position_is_on_the_earth(text, fill):
    reports, reason = decode(payload(text.encode(), fill), None)
    assert reports or reason or type_of(payload(text.encode())) in range(1, 28)
    for report in reports:
        if isinstance(report, PositionReport):
            assert abs(report.lat) <= 90
            assert abs(report.lon) <= 180
            assert isinstance(report.lat, float)


def test_pyais_is_imported_only_when_something_is_decoded():
    program = "import sys, physical.ais_world; sys.exit('pyais' in sys.modules)"
    assert subprocess.run([sys.executable, "-c", program], check=False).returncode == 0
