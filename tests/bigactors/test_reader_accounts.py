"""Every reader's account adds up to what was in the file, counted here without it."""

import io
import json

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

pytest.importorskip("pyais")
pytest.importorskip("pymavlink")

from geojson import collection, feature
from telemetry import BEAT, FIX, log, position

from adapters.mavlink.tlog import THINGS, messages_in, positions_of
from adapters.mavlink.vehicle_identities import Craft
from physical.ais_recording import read_recording
from physical.ais_world import seen_at
from physical.file_account import MAX_KINDS, Counting, FileAccount, in_a_line
from physical.place_files import read_place_file

SENTENCES = (
    b"!AIVDM,1,1,,A,139>JhOP000eDI0NW>`00001P000,0*60",
    b"!AIVDM,1,1,,A,K39>JhChGASrwP00,0*50",
    b"!AIVDM,1,1,,A,91b3ktBF1J0eM;PN`dH0I0000000,0*27",
    b"!AIVDM,1,1,,A,85Mwp`1Kf3aCnsNvBWLi=wQuNhA5t43N`5nCuI=p<IBfVqnMgPGs,0*47",
    b"!AIVDM,2,1,9,B,55R3Vn82=ILTQ3KKS>1<D60Dq@E918U<F222221J1`?164vc03S1CCAD,0*2A",
    b"!AIVDM,2,2,9,B,`88888888888880,2*76",
    b"!AIVDM,1,1,,A,139>JhOP000eDI0NW>`00001P000,0*61",
    b"!AIVDM,1,1,,A,,0*26",
    b"$GPZDA,120000.00,04,03,2026,00,00*64",
    b"$GPGSV,3,1,10*00",
)
BEFORE = [
    *b"|1772596000.883 |\\c:1772596000*50\\|\\c:1772596000*51\\|\\g:1-2-7,c:1772596000*00\\".split(b"|")
]
LINES = (b"# comment", b"noise", b"Dear reader,")


@st.composite
def recordings(draw):
    """Lines of a recording, and how many things are in them."""
    lines, things = [], 0
    for _ in range(draw(st.integers(0, 25))):
        if draw(st.booleans()):
            some = draw(st.lists(st.sampled_from(SENTENCES), min_size=1, max_size=3))
            lines.append(draw(st.sampled_from(BEFORE)) + b"".join(some))
            things += len(some)
        else:
            lines.append(draw(st.sampled_from((*LINES, b""))))
            things += lines[-1] != b""
    return b"\n".join(lines), things


@settings(deadline=None)
@given(recordings())
def test_of_ais(recording):
    data, things = recording
    read = seen_at(read_recording(data))
    lines, positions = read.tallies
    assert (lines.total, lines.adds_up, positions.adds_up) == (things, True, True)
    assert positions.total == dict(lines.taken).get("position", 0)
    assert dict(positions.taken).get("station", 0) == len(read.properties)


ITEM = st.tuples(
    st.integers(0, 12), st.integers(0, 300) | st.sampled_from([5001, 5003, 5100]),
    st.sampled_from([(0, 0), (47.4, 8.5)]), st.integers(-5, 900),
)  # fmt: skip


@given(st.lists(ITEM, max_size=10))
def test_of_waypoint_files(items):
    rows = [
        f"{n}\t0\t{f}\t{c}\t0\t0\t0\t0\t{lat}\t{lon}\t{alt}\t1"
        for n, (f, c, (lat, lon), alt) in enumerate(items)
    ]
    read = read_place_file(".waypoints", "\n".join(["QGC WPL 110", *rows]).encode())
    (tally,) = read.tallies
    assert (tally.total, tally.adds_up) == (len(items), True)
    assert sum(count for _, count in tally.taken) == len(read.properties)


def simple(item):
    frame, command, where, altitude = item
    return {
        "type": "SimpleItem",
        "frame": frame,
        "command": command,
        "params": [0, 0, 0, None, *where, altitude],
    }


SCAN = {"type": "ComplexItem", "complexItemType": "StructureScan"}


@given(st.lists(ITEM, max_size=6), st.lists(ITEM, max_size=4), *[st.integers(0, 3)] * 3)
def test_of_plans(items, inner, scans, circles, points):
    survey = {"type": "ComplexItem", "TransectStyleComplexItem": {"Items": [simple(item) for item in inner]}}
    plan = {
        "fileType": "Plan",
        "mission": {
            "plannedHomePosition": [47.4, 8.5, 400],
            "items": [*map(simple, items), survey, *[SCAN] * scans],
        },
        "geoFence": {"circles": [{"inclusion": False}] * circles},
        "rallyPoints": {"points": [[47.4, 8.5, 20]] * points},
    }
    read = read_place_file(".plan", json.dumps(plan).encode())
    (tally,) = read.tallies
    things = 1 + len(items) + len(inner) + scans + circles + points
    assert (tally.total, tally.adds_up) == (things, True)
    assert sum(count for _, count in tally.taken) == len(read.properties)


@given(st.integers(0, 5), st.booleans(), st.integers(0, 3))
def test_of_geojson(count, high, others):
    more, at = {f"x{other}": 1 for other in range(others)}, [8, 53, 12] if high else [8, 53]
    features = [feature(f"a{n}", "Buoy", at, **more) for n in range(count)]
    read = read_place_file(".geojson", collection(*features).encode())
    (tally,) = read.tallies
    assert (tally.total, tally.adds_up, len(read.properties)) == (count, True, count)
    assert sum(number for _, number in tally.asides) == count * (others + high)


MESSAGES = st.tuples(
    st.sampled_from([BEAT, FIX, None]), st.sampled_from([1, 2]), st.sampled_from([0, 1]), st.booleans()
)


@settings(deadline=None)
@given(st.lists(MESSAGES, min_size=1, max_size=25))
def test_of_telemetry_logs(messages):
    parts, stretches = [], 0
    for number, (message, system, component, damaged) in enumerate(messages, 1):
        said = message or position(number * 100)
        parts.append(log(said, system=system, component=component, start=1.7e9 + number))
        if damaged:
            parts.append(b"\xff" * 20)
            stretches += 1
    counting = Counting()
    read = messages_in(io.BytesIO(b"".join(parts)), counting)
    found = list(positions_of(read, {1: Craft("uav0", "UAV", 1)}, counting))
    tally = counting.tally(counting.total, *THINGS)
    assert tally.total == len(messages) + stretches
    assert dict(tally.taken).get("position", 0) == len(found)
    assert dict(tally.left_out).get("damaged stretch", 0) == stretches


def test_kinds_are_bounded_and_still_add_up():
    counting = Counting()
    for number in range(5 * MAX_KINDS):
        counting.leave(f"sentence X{number}")
    tally = counting.tally(5 * MAX_KINDS, "line")
    assert (len(tally.left_out), tally.adds_up) == (MAX_KINDS + 1, True)


def test_an_account_is_told_in_rows():
    tally = FileAccount(
        5, "line", "lines", (("position", 1),), (("comment", 3), ("noise", 1)), (("time missing", 1),)
    )
    assert tally.rows() == (
        "5 lines: 1 position",
        "3 x comment, not read",
        "1 x noise, not read",
        "1 x time missing",
    )
    assert tally.summary() == ("5 lines: 1 position", "not read: 3 x comment, 1 x noise", "1 x time missing")
    assert in_a_line([(f"K{number}", number) for number in range(1, 16)]).endswith("4 x K4, 6 of other kinds")
