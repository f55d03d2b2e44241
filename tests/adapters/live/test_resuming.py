"""A run killed with `kill -9` in flight: its recording is read, the vehicle compared, the mission flown to its end."""

import os
import signal
import socket
import subprocess
import sys
import time
from contextlib import contextmanager

import pytest
from live_missions import TOUR, verify

from adapters.recording.mcap_files import RecordingError
from adapters.recording.reading import read_recording
from bigactors.cli import main
from bigactors.recordings import mission_of, open_recording, trace_of

pytestmark = pytest.mark.long

MISSION = (
    "mission tour\n"
    + TOUR
    + """
BigActor a hosted_at uav0 with_behavior {
  control(MOVE_HOST_TO east0)
  observe(CHILDREN(PARENT(HOST)))
  react { case obs => display(obs) }
}
BigActor op hosted_at gcs0 with_behavior { loop { react { case "status" => display("well") } } }
environment { says "status" to op at most 2 times }
"""
)

SIMULATOR = """
import sys
from adapters.simulated import Kind, Simulator, Vehicle, run
address, speed = sys.argv[1:]
vehicle = Vehicle(Kind.COPTER, (37.01, -8.65, 20.0))
run(Simulator(address, [vehicle]).run(), float(speed))
"""


def free_port():
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as found:
        found.bind(("127.0.0.1", 0))
        return found.getsockname()[1]


@contextmanager
def started(*line, stderr=None):
    process = subprocess.Popen(
        [sys.executable, *line],
        env={**os.environ, "PYTHONPATH": os.getcwd()},
        stdout=subprocess.PIPE,
        stderr=stderr,
        text=True,
    )
    try:
        yield process
    finally:
        process.kill()
        process.wait()
        process.stdout.close()


def until(what, seconds=120.0):
    end = time.monotonic() + seconds
    while not what():
        assert time.monotonic() < end, "it did not come to pass in time"
        time.sleep(0.05)


def rules(path):
    try:
        labels = [message.data["label"] for message in read_recording(path).of("steps")]
    except (RecordingError, FileNotFoundError):
        return []  # it has only just begun
    return [label[1:].partition(" ")[0] for label in labels]


def test_a_killed_run_is_resumed_after_its_vehicle_was_compared(tmp_path, capsys):
    mission, verdict = tmp_path / "tour.mission", tmp_path / "tour.verdict.json"
    mission.write_text(MISSION)
    verify(mission, verdict)
    port, first, second = free_port(), tmp_path / "first.mcap", tmp_path / "second.mcap"
    at = f"uav0=udp:127.0.0.1:{port}"
    line = ["-m", "bigactors", "run", str(mission), "--vehicle", at, "--socket", str(tmp_path / "s")]
    with started("-c", SIMULATOR, f"udpout:127.0.0.1:{port}", "40"):
        with started(*line, "--record", str(first)) as run:
            until(lambda: "command" in rules(first))
            assert main(["say", "op", "status", "--socket", str(tmp_path / "s")]) == 0
            assert main(["say", "op", "nonsense", "--socket", str(tmp_path / "s")]) == 2
            run.send_signal(signal.SIGKILL)
            run.wait()
        assert read_recording(first).torn
        assert "commit" not in rules(first)
        resumed = [*line, "--resume", str(first), "--record", str(second)]
        with started(*resumed, "--for", "110") as run:
            until(lambda: "commit" in rules(second))
            assert main(["say", "op", "status", "--socket", str(tmp_path / "s")]) == 0
            run.send_signal(signal.SIGINT)
            shown = run.communicate(timeout=120)[0]
    assert "commit" in shown
    recording = open_recording(str(second))
    trace = trace_of(recording, mission_of(recording))
    assert trace.configurations[-1].structure.logical.parent("uav0") == "east0"
    assert rules(second).count("command") == 1
    assert main(["replay", str(second)]) == 0
    assert "well" not in capsys.readouterr().err
