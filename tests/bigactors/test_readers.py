"""Every reader of files, given files that are almost right: a diagnostic, never a bug of ours."""

import json
import os
from contextlib import suppress
from functools import cache
from pathlib import Path
from tempfile import TemporaryDirectory

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from telemetry import BEAT, log

from adapters.mavlink import signing
from adapters.mavlink.tlog import read_tlog
from adapters.stations.peers import read_peers
from bigactors.cli import main
from bigactors.exits import Exit
from bigactors.mission_lookup import open_mission
from bigactors.mistakes import Mistake
from bigactors.verdict_files import _seal, licence_for
from physical import PhysicalError, PhysicalProperty, box, point, write_geojson, write_plan, write_waypoints
from specs.elaboration import Variation

ROOT = Path(__file__).parents[2]
MISSIONS, EXAMPLES = ROOT / "specs" / "missions", ROOT / "bigraphs" / "examples"
MANY = int(os.environ.get("BIGACTORS_FUZZ", "0")) // 50
DEEP = 3_000
PLACES = (point(37.01, -8.7), point(37.02, -8.71))
WORLD = """signature { kind Location contains UAV  kind UAV driven  kind Vessel driven }
world { from "FILE"  uav0: UAV = point (37.01, -8.7) linked vhf }
BigActor a hosted_at uav0 with_behavior { observe(ALL) }
check { deadlock_freedom }
"""
GROUND = (
    'gcs0 = {connect = ["tcp/127.0.0.1:7447"], hosts = ["uav0"]}\ngcs1 = {connect = ["tcp/127.0.0.1:7448"]}\n'
)


def command(*words):
    """Run a command line; a bug of ours ends the test."""
    assert main([str(word) for word in words]) != Exit.BUG


def checked(path):
    command("check", "--no-traces", "--max-configurations", 50, path)


def from_file(path):
    """Check a mission whose world is read from a file."""
    mission = path.with_suffix(".mission")
    mission.write_text(WORLD.replace("FILE", path.name), encoding="utf-8")
    checked(mission)


@cache
def two_gates():
    return open_mission("two_gates", Variation())


def licensed(path):
    with suppress(Mistake):
        licence_for("two_gates", str(path), two_gates())


def peered(path):
    with suppress(PhysicalError, OSError):
        read_peers(path, "gcs0")


def logged(path):
    with suppress(PhysicalError):
        list(read_tlog(path))


def signed(path):
    with suppress(PhysicalError):
        signing.load(path)


@cache
def made(*line, name):
    """Return a file that a command line writes."""
    with TemporaryDirectory() as folder:
        command(*(word.replace("DIR", folder) for word in line))
        return next(Path(folder).rglob(name)).read_bytes()


def places():
    at = (37.0, 37.01)
    return write_geojson(
        PhysicalProperty(f"p{north}", "Location", box((north, -8.7), (north + 0.005, -8.71))) for north in at
    )


def replayed(path):
    command("replay", path, "--mission", MISSIONS / "broken_deadlock.mission")


FILES = {
    "mission": ((MISSIONS / "two_gates.mission").read_bytes, "x.mission", checked),
    "geojson": (lambda: places().encode(), "x.geojson", from_file),
    "nmea": (lambda: (MISSIONS / "harbour_watch.nmea").read_bytes()[:4_000], "x.nmea", from_file),
    "waypoints": (lambda: write_waypoints(PLACES, 50.0).encode(), "x.waypoints", from_file),
    "plan": (lambda: write_plan(PLACES, 50.0).encode(), "x.plan", from_file),
    "big": ((EXAMPLES / "actors.big").read_bytes, "x.big", lambda path: command("big", "validate", path)),
    "trace": (
        lambda: made("check", "broken_deadlock", "--trace", "DIR", name="trace.json"),
        "trace.json",
        replayed,
    ),
    "verdict": (
        lambda: made("check", "two_gates", "--verdict", "DIR/v.json", name="v.json"),
        "v.json",
        licensed,
    ),
    "peers": (GROUND.encode, "peers.toml", peered),
    "tlog": (lambda: log(*[BEAT] * 5), "x.tlog", logged),
    "key": (lambda: KEY, "x.key", signed),
}
KEY = b'{"key": "' + b"00" * 32 + b'", "timestamp": 7, "streams": {"1.1.0": 9}}'

NASTY = st.sampled_from(
    [
        *b'NaN 1e999 -1e999 null true -1 0.5 "" {} [] "\\ud800" "\xed\xa0\x80" "\\u0000" \x00 \xff'.split(
            b" "
        ),
        *(sign * DEEP for sign in (b"[", b"(", b"{", b"-")),
        *(b"[" * depth + b"]" * depth for depth in (150, 500, 700, 850, 950, DEEP)),
        b'{"a":' * DEEP + b"1" + b"}" * DEEP,
        b"1" * 5_000,
        b"-" + b"9" * 300,
    ]
)


def values_in(data):
    """Return where values stand in a text: words, numbers, strings, lists."""
    found, at = [], 0
    while at < len(data):
        end = at + 1
        if data[at : at + 1].isalnum():
            while data[end : end + 1].isalnum() or data[end : end + 1] in (b".", b"_"):
                end += 1
        elif data[at : at + 1] == b'"':
            end = max(data.find(b'"', end), at) + 1
        elif data[at : at + 1] == b"[":
            end = max(data.find(b"]", end), at) + 1
        found.append((at, end))
        at = end
    return [span for span in found if data[span[0] : span[1]].strip()]


@st.composite
def spoilt(draw, data):
    """Return data of which bytes, or a value, were replaced, exchanged, left out or put in."""
    way = draw(st.sampled_from(["value", "value", "value", "exchange", "cut", "bytes", "double"]))
    spans = values_in(data)
    (at, end), (other, last) = (draw(st.sampled_from(spans)) for _ in range(2))
    match way:
        case "value":
            return data[:at] + draw(NASTY) + data[end:]
        case "exchange":
            return data[:at] + data[other:last] + data[end:]
        case "cut":
            return data[:at]
        case "double":
            return data[:at] + data[at:last] * 3 + data[last:]
    return data[:at] + draw(st.binary(max_size=4)) + data[at + draw(st.integers(0, 3)) :]


@pytest.mark.fuzz
@pytest.mark.parametrize("kind", FILES)
@settings(max_examples=max(40, MANY))
@given(draw=st.data())
def test_no_file_is_a_bug_of_ours(kind, draw):
    make, name, read = FILES[kind]
    with TemporaryDirectory() as folder:
        path = Path(folder) / name
        path.write_bytes(draw.draw(spoilt(make())))
        read(path)


@pytest.mark.parametrize("kind", FILES)
@pytest.mark.parametrize(
    "data", [None, b"", b"[" * 100_000, b"{" * 100_000, b'{"a":' * 100_000, b"\x00" * 1_000, b"\xff\xfe"]
)
def test_files_that_are_right_are_read_and_files_that_are_nothing_are_told(kind, data):
    make, name, read = FILES[kind]
    with TemporaryDirectory() as folder:
        path = Path(folder) / name
        path.write_bytes(make() if data is None else data)
        read(path)


@pytest.mark.parametrize("kind", FILES)
def test_a_pipe_that_nobody_writes_into_is_not_waited_for(kind, capsys):
    _, name, read = FILES[kind]
    with TemporaryDirectory() as folder:
        os.mkfifo(Path(folder) / name)
        read(Path(folder) / name)
    told = capsys.readouterr().err
    assert not told or "a pipe" in told


@pytest.mark.parametrize("properties", [[1], [[]], [None], {}, None, "x"])
def test_a_verdict_that_was_sealed_anew_is_no_bug_of_ours(tmp_path, properties):
    path, verdict = tmp_path / "v.json", json.loads(FILES["verdict"][0]())
    verdict |= {"properties": properties}
    path.write_text(json.dumps(verdict | {"seal": _seal(verdict)}))
    assert licence_for("two_gates", str(path), two_gates()).resting == ()
