"""What `bigactors run` and `say` refuse, and how they say it."""

import os
import signal
import socket
import stat
import subprocess
import sys
import tempfile
import time
from dataclasses import replace
from pathlib import Path

import pytest
from processes import begun

from adapters.live.live_state import LiveState
from adapters.live.loop import Ending
from adapters.live.operator_findings import Finding
from adapters.live.overrides import Overrides
from adapters.live.turn_result import Turn
from adapters.plugin import TakenOver
from adapters.recording.writing import Recorder
from bigactors.arguments import parse_arguments
from bigactors.cli import main
from bigactors.commands.replay.foreign_recordings import watched
from bigactors.commands.run.flight import conclude, prepare, record
from bigactors.flight_watchers import Terminal
from bigactors.mission_lookup import open_mission
from bigactors.mistakes import Mistake
from bigactors.pictures.scene import palette_of
from bigactors.recordings import open_recording
from bigactors.sockets import folder, only_socket, socket_of
from specs.elaboration import Variation

WATCHED = str(Path(__file__).parents[2] / "specs/missions/harbour_watch.nmea")
UAV = "--vehicle=uav0=udp:127.0.0.1:0"

DESK = """
mission desk
signature { kind Station }
world { gcs0: Station = point (37.05, -8.63) }
BigActor op hosted_at gcs0 with_behavior { loop { react { case "status" => display("well") } } }
environment { says "status" to op at most 2 times }
"""
"""A mission without vehicles: its run begins at once."""


@pytest.fixture
def there(monkeypatch):
    """Work in a folder of a short name: the path of a socket has at most 100 bytes."""
    with tempfile.TemporaryDirectory() as name:
        here = Path(name).resolve()
        monkeypatch.chdir(here)
        monkeypatch.setenv("XDG_RUNTIME_DIR", str(here / "runtime"))
        (here / "runtime").mkdir(mode=0o700)
        yield here
        monkeypatch.undo()  # leave the folder before it goes


@pytest.mark.usefixtures("there")
@pytest.mark.parametrize(
    ("kind", "option"),
    [
        (socket.SOCK_DGRAM, "--vehicle=uav0=udp:127.0.0.1:{}"),
        (socket.SOCK_STREAM, "--vehicle=uav0=tcpin:127.0.0.1:{}"),
        (socket.SOCK_DGRAM, "--feed=ais=udp:127.0.0.1:{}"),
        (socket.SOCK_STREAM, "--feed=detections=tcpin:127.0.0.1:{}"),
    ],
)
def test_a_port_in_use_is_told_with_the_remedy(refused, kind, option):
    with socket.socket(socket.AF_INET, kind) as other:
        other.bind(("127.0.0.1", 0))
        if kind == socket.SOCK_STREAM:
            other.listen()
        given = option.format(other.getsockname()[1])
        vehicle = [] if given.startswith("--vehicle") else [UAV]
        told = refused("run", "oil_spill", "--unverified", *vehicle, given)
    assert told.endswith(": something else listens there: end it, or give another port\n")
    assert "Errno" not in told


@pytest.mark.parametrize("feed", ["ais", "places"])
def test_a_feed_from_a_pipe_is_refused(there, refused, feed):
    os.mkfifo(there / "feed.geojson")
    told = refused("run", "oil_spill", "--unverified", UAV, f"--feed={feed}=file:feed.geojson")
    assert "feed.geojson: " in told
    assert "this is a pipe, not a file: save its content to a file, and give that" in told


def test_a_vehicle_that_is_not_heard_ends_the_run_which_leaves_no_recording(there, capsys):
    line = ["run", "oil_spill", UAV, "--unverified", "--wait", "0.2", "--record", "run.mcap"]
    for _ in range(2):  # the name is free for the next one
        assert main(line) == 2
        told = capsys.readouterr().err
        assert "nothing was verified of this run" in told
        assert "nothing was heard of uav0" in told
        assert not (there / "run.mcap").exists()
    assert not list((there / "runtime" / "bigactors").iterdir())


def recorded(*line):
    """Record the beginning of a run, and no step of it."""
    flight = prepare(parse_arguments(line))
    with record(flight):
        flight.start.begun = True


@pytest.mark.usefixtures("there")
def test_a_run_without_a_verdict_is_replayed_as_such(capsys):
    recorded("run", "oil_spill", UAV, "--unverified", "--record", "run.mcap")
    capsys.readouterr()
    assert main(["replay", "run.mcap"]) == 0
    shown = capsys.readouterr()
    assert "nothing was verified of this run" in shown.err
    assert "0 steps replayed on oil_spill" in shown.out


@pytest.mark.parametrize(
    ("number", "shell"),
    [
        (signal.SIGINT, ()),
        (signal.SIGHUP, ()),
        (signal.SIGTERM, ("sh", "-c", "trap '' INT; exec \"$@\"", "sh")),  # a script's background job
    ],
    ids=["SIGINT", "SIGHUP", "SIGTERM without SIGINT"],
)
def test_a_run_that_is_asked_to_end_closes_its_recording(there, number, shell):
    (there / "desk.mission").write_text(DESK)
    line = ["run", "desk.mission", "--unverified", "--record", "run.mcap"]
    with begun(
        [*shell, sys.executable, "-um", "bigactors", *line],
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
    ) as run:
        assert "desk begins" in run.stdout.readline()
        run.send_signal(number)
        told = run.communicate(timeout=120)[1]
    assert run.returncode == 3
    assert "interrupted: vehicles go on with their last command" in told
    recording = open_recording("run.mcap")
    assert not recording.torn
    assert [message.data for message in recording.of("end")] == [{"reason": "interrupted"}]


def test_a_recording_ends_with_the_reason_of_its_run(there):
    (there / "desk.mission").write_text(DESK)
    assert main(["run", "desk.mission", "--unverified", "--for", "1", "--record", "run.mcap"]) == 3
    assert [message.data for message in open_recording("run.mcap").of("end")] == [
        {"reason": "the time is over"}
    ]


def test_a_run_that_is_asked_to_end_before_it_begins_leaves_no_recording(there):
    line = ["run", "oil_spill", UAV, "--unverified", "--record", "run.mcap"]
    with begun([sys.executable, "-m", "bigactors", *line], stderr=subprocess.PIPE, text=True) as run:
        until = time.monotonic() + 120
        while not (there / "run.mcap").exists():
            assert time.monotonic() < until, "it was not there in time"
            time.sleep(0.05)
        time.sleep(0.5)
        run.send_signal(signal.SIGTERM)
        told = run.communicate(timeout=120)[1]
    assert run.returncode == 3
    assert "interrupted" in told
    assert not (there / "run.mcap").exists()


def test_sockets_lie_in_a_folder_of_the_users_own(there):
    assert stat.S_IMODE(folder().stat().st_mode) == 0o700
    path = socket_of("oil spill/../x", None)
    assert path.parent == there / "runtime" / "bigactors"
    path.touch()
    assert only_socket(None) == path
    (path.parent / "other.sock").touch()
    with pytest.raises(Mistake, match="2 missions run here"):
        only_socket(None)
    os.chmod(path.parent, 0o755)
    with pytest.raises(Mistake, match="not this user's alone"):
        folder()


def test_a_path_too_long_for_a_socket_is_a_mistake():
    with pytest.raises(Mistake, match="at most 100 bytes"):
        socket_of("m", "/tmp/" + "x" * 200)


def test_what_is_no_recording_is_a_mistake(there, refused):
    (there / "x.mcap").write_bytes(b"\x89MCAP0\r\n" + b"x" * 100)
    assert "no recording" in refused("replay", "x.mcap")


def test_an_ais_recording_of_others_is_shown_in_the_places_of_a_mission(capsys, refused):
    path = WATCHED
    assert "--mission" in refused("replay", path)
    assert main(["replay", path, "--mission", "harbour_watch"]) == 0
    shown = capsys.readouterr()
    assert "⟨env : mmsi244999004 is seen in basin0, marina0⟩" in shown.out
    assert "78 positions, 4 changes of the bigraph" in shown.out


def test_a_recording_of_others_is_shown_step_by_step_as_traces_are(there, capsys, refused):
    path = WATCHED
    assert main(["show", "harbour_watch", "--trace", path, "--step", "2", "--output", "c2.svg"]) == 0
    assert (there / "c2.svg").exists()
    capsys.readouterr()
    assert "has no destinations" in refused(
        "replay", path, "--mission", "harbour_watch", "--waypoints", "uav0=x.plan"
    )


WATCH = """
signature { kind Location contains Location, Vessel, UAV  kind Vessel  kind UAV driven }
world { quay0: Location = box (52.9, 5.72) (52.8, 5.6)  uav0: UAV = point (52.85, 5.65) }
BigActor a hosted_at uav0 with_behavior { observe(ALL) }
"""


@pytest.mark.parametrize(
    ("more", "said"),
    [
        ("--output x.html", "mmsi244999008"),
        ("--output x.svg", "mmsi244999008"),
        ("--lanes --output x.png", "mmsi244999008"),
        (f"--against {WATCHED}", "they are the same"),
    ],
)
def test_a_trace_in_which_the_first_of_a_kind_appears_is_shown(there, capsys, more, said):
    (there / "watch.mission").write_text(WATCH, encoding="utf-8")
    assert main(["show", "watch.mission", "--trace", WATCHED, *more.split()]) == 0
    assert said in capsys.readouterr().out


def test_kinds_keep_their_colours_when_the_first_of_one_appears(there):
    (there / "watch.mission").write_text(WATCH, encoding="utf-8")
    mission = open_mission("watch.mission", Variation())
    shown = watched(WATCHED, mission, {})
    first, last = (palette_of(shown.trace.configurations[step]).kinds for step in (0, -1))
    assert first == last
    assert sorted(first) == ["Location", "UAV", "Vessel"]


TAKEN = {"uav0": "it is in RTL"}


@pytest.mark.parametrize(
    ("reason", "taken", "broken", "code", "more"),
    [
        ("the mission has ended", {}, False, 0, ""),
        ("the mission has ended", {}, True, 1, "; an assumption was broken"),
        ("all remaining requests were refused", {}, False, 3, ""),
        ("the time is over", TAKEN, False, 3, "; uav0 was taken over: it is in RTL"),
        ("the mission has ended", TAKEN, False, 3, "; uav0 was taken over: it is in RTL"),
    ],
)
def test_the_last_line_and_the_exit_code_say_how_a_run_ended(capsys, reason, taken, broken, code, more):
    state = LiveState(open_mission("oil_spill", Variation()).initial, 7, overrides=Overrides(taken))
    assert conclude(Ending(reason, state), broken=broken) == code
    assert capsys.readouterr().out == f"{reason} after 7 steps{more}\n"


BREACH = Finding("broken assumption", "boat0", "boat0 is seen in east0", 1.0, "return")
RESUMED = """\
broken assumption, before it was resumed: boat0 is seen in east0; vehicles return, as the mission says
late, before it was resumed: CTR(a, MOVE_HOST_TO p) waits for 9 s; vehicles hold, as the mission says
  it goes on once the world is as the mission assumes again, or with --unverified
taken over: uav0: it is in RTL; this run does not command it until `bigactors give-back uav0`
"""


@pytest.mark.usefixtures("there")
def test_a_run_that_is_resumed_says_what_broke_before_and_who_is_taken_over(capsys):
    line = ["run", "oil_spill", UAV, "--unverified", "--wait", "0.2"]
    recorded(*line, "--record", "first.mcap")
    recorder = Recorder(Path("broken.mcap"), open_recording("first.mcap").run, 0.0)
    late = Finding("late", "a", "CTR(a, MOVE_HOST_TO p) waits for 9 s", 2.0, "hold")
    trouble = Finding("trouble", "ais", "ais: bad checksum", 2.0)
    state = LiveState(open_mission("oil_spill", Variation()).initial)
    recorder.turn(Turn(state, findings=(BREACH, trouble, late, BREACH)), 2.0, lambda _: ())
    recorder.report(TakenOver("uav0", 3.0, "it is in RTL"), 3.0)
    recorder.close("killed", 4.0)
    recorded(*line, "--resume", "broken.mcap", "--record", "second.mcap")
    for before in ("broken.mcap", "second.mcap"):
        capsys.readouterr()
        assert main([*line, "--resume", before, "--record", "third.mcap"]) == 2  # no vehicle is heard
        assert RESUMED in capsys.readouterr().err


@pytest.mark.usefixtures("there")
def test_a_run_that_goes_on_from_a_recording_without_a_beginning_says_that_its_clocks_begin_anew(capsys):
    line = ["run", "oil_spill_timed", UAV, "--unverified", "--wait", "0.2"]
    recorded(*line, "--record", "first.mcap")  # as one that was killed before it began
    assert "clocks" not in capsys.readouterr().err
    assert main([*line, "--resume", "first.mcap"]) == 2
    said = "the recording lacks the start of the mission: all clocks begin anew"
    assert said in capsys.readouterr().err


def test_a_run_that_goes_on_from_a_broken_one_is_broken():
    terminal = Terminal(lambda _: ())
    terminal.goes_on([BREACH], TAKEN)
    assert terminal.broken
    terminal.goes_on([replace(BREACH, kind="late")], {})
    assert not terminal.broken


def test_a_telemetry_log_that_is_a_symbolic_link_is_not_written_through(there, refused):
    (there / "precious").write_text("mine")
    (there / "run.tlog").symlink_to(there / "precious")
    assert "run.tlog: this is a symbolic link" in refused(
        "run", "oil_spill", "--unverified", UAV, "--record=run.mcap"
    )
    assert (there / "precious").read_text() == "mine"
    assert not (there / "run.mcap").exists()
