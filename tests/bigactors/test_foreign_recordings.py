"""Recordings of others in a mission's places: what is shown, what does not count and why."""

import json

import pytest

pytest.importorskip("pyais")
pytest.importorskip("pymavlink")

from telemetry import FIX, log, position

from physical.nmea import checksum

PLACES = """signature standard
world {
  inner0: Location = box (47.401, 8.541) (47.399, 8.539)
  uav0: UAV = point (47.400, 8.540) altitude 0 m to 500 m linked control:uav0
}
BigActor a hosted_at uav0 with_behavior { skip }
"""
HARBOUR = """signature standard
world {
  harbour0: Location = box (53.545, 9.925) (53.535, 9.935)
  ship0: Vessel = point (53.5402, 9.9302) linked control:ship0
}
BigActor a hosted_at ship0 with_behavior { skip }
"""
FINE = b"!AIVDM,1,1,,A,139>JhOP000eM?@N`o:00001P000,0*53"
COARSE = b"!AIVDM,1,1,,A,K39>JhChGASrwP00,0*50"


def tagged(time, sentence):
    body = b"c:%d" % time
    return b"\\%s*%02X\\%s" % (body, checksum(body), sentence)


@pytest.fixture
def replayed(missions, bigactors):
    def replay(name, content, mission=PLACES, named="mavlink:1=uav0"):
        (missions / name).write_bytes(content)
        (missions / "places.mission").write_text(mission)
        return bigactors("replay", name, "--mission", "places.mission", "--name", named)

    return replay


def test_a_damaged_log_is_shown_and_its_damage_is_told(replayed):
    code, out, _ = replayed(
        "x.tlog", log(FIX, position(1000)) + bytes(4096) + log(FIX, position(2000)) + b"\0\0"
    )
    assert code == 0
    assert "x.tlog: 2 positions, " in out
    assert "x.tlog: 6 messages and damaged stretches: 2 positions" in out
    assert "2 x damaged stretch" in out
    assert "x.tlog: 4,098 x byte in damaged stretches" in out


@pytest.mark.parametrize(
    ("content", "why"),
    [
        (log(FIX, FIX), "2 x GPS_RAW_INT: the positions that count are those of GLOBAL_POSITION_INT"),
        (
            log(FIX, position(1000), component=0),
            "1 x GLOBAL_POSITION_INT of component 0 of system 1, which is no autopilot",
        ),
        (log(position(1000)), "1 x GLOBAL_POSITION_INT without a GPS fix"),
    ],
)
def test_a_log_that_shows_no_position_is_refused_with_what_was_in_it(replayed, content, why):
    code, _, err = replayed("x.tlog", content)
    assert code == 2
    assert "it shows no position" in err
    assert why in err


def test_a_log_of_another_vehicle_is_refused_with_its_number(replayed):
    code, _, err = replayed("x.tlog", log(FIX, position(1000)), named="mavlink:7=uav0")
    assert code == 2
    assert "1 x GLOBAL_POSITION_INT of system 1, which is not named here" in err


def test_a_coarse_position_does_not_move_a_moored_ship(replayed):
    lines = [tagged(1772596000 + n, FINE if n % 2 else COARSE) for n in range(1, 10)]
    code, out, _ = replayed("x.nmea", b"\n".join(lines), HARBOUR, "mmsi:211000001=ship0")
    assert code == 0
    assert "x.nmea: 5 positions, 0 changes of the bigraph" in out
    assert "not read: 4 x position to a tenth of a minute, of a station with a finer one" in out


@pytest.mark.parametrize("before", [b"1772596000.883 ", b"2026-03-04T03:57:10.000Z ", b"", b"\\s:rABC*7B\\"])
@pytest.mark.parametrize("name", ["x.nmea", "x.log"])
def test_a_recording_is_known_however_its_logger_writes_it(replayed, name, before):
    code, out, _ = replayed(name, before + FINE + b"\n", HARBOUR, "mmsi:211000001=ship0")
    assert code == 0
    assert f"{name}: 1 position, 0 changes of the bigraph" in out


def test_a_recording_without_a_position_is_refused_with_what_was_in_it(replayed):
    code, _, err = replayed("x.nmea", b"$GPGSV,3,1,10*00\nnoise\n", HARBOUR)
    assert code == 2
    assert "it shows no position; 2 sentences and other lines; " in err
    assert "1 x line without a sentence, 1 x sentence GPGSV" in err


def test_a_trace_is_no_recording_of_others_whatever_texts_are_in_it(missions, bigactors):
    trace = {"mission": "places.mission", "note": FINE.decode()}
    (missions / "places.mission").write_text(HARBOUR)
    (missions / "run.json").write_text(json.dumps(trace))
    code, _, err = bigactors("replay", "run.json")
    assert code != 0
    assert "position" not in err


@pytest.mark.usefixtures("missions")
def test_a_recording_that_is_drawn_is_accounted_for_too(missions, bigactors):
    (missions / "places.mission").write_text(HARBOUR)
    (missions / "x.nmea").write_bytes(FINE + b"\nnoise\n")
    code, _, err = bigactors(
        "show", "places.mission", "--trace", "x.nmea", "--name", "mmsi:211000001=ship0", "--output", "x.svg"
    )
    assert code == 0
    assert "x.nmea: not read: 1 x line without a sentence" in err
