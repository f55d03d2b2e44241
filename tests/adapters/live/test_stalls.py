"""A run that is stopped for seven seconds (SIGSTOP) and goes on: its own stall is nobody's silence."""

import signal
import socket
import time

import pytest
from flown_processes import SIMULATOR, free_port, started
from live_missions import TOUR
from pyais.encode import encode_dict

pytestmark = pytest.mark.long

MISSION = (
    "mission tour\n"
    + TOUR
    + """
BigActor op hosted_at gcs0 with_behavior { loop { react { case "status" => display("well") } } }
environment { says "status" to op at most once }
live { on broken assumption: hold }
"""
)

STOPPED = 7.0
WHERE = {"type": 1, "mmsi": 263999001, "lat": 37.03, "lon": -8.63}
(BOAT,) = encode_dict(WHERE, talker_id="AI", sentence_type="VDM", radio_channel="A")


def test_a_run_that_is_stopped_finds_nobody_silent_when_it_goes_on(tmp_path):
    mission, record, shown = tmp_path / "tour.mission", tmp_path / "run.mcap", tmp_path / "shown"
    mission.write_text(MISSION)
    vehicle, ais = free_port(), free_port()
    line = ["-m", "bigactors", "run", str(mission), "--unverified", "--socket", str(tmp_path / "s")]
    line += ["--vehicle", f"uav0=udp:127.0.0.1:{vehicle}", "--feed", f"ais=udp:127.0.0.1:{ais}"]
    line += ["--name", "mmsi:263999001=boat0", "--record", str(record)]
    line += ["--time-to-live", "ais=4", "--time-to-live", "vehicles=4"]
    with (
        started("-c", SIMULATOR, f"udpout:127.0.0.1:{vehicle}", "20"),
        shown.open("w") as errors,
        started(*line, stderr=errors) as run,
        socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as transponder,
    ):

        def heard_for(seconds):
            end = time.monotonic() + seconds
            while time.monotonic() < end:
                transponder.sendto(BOAT.encode(), ("127.0.0.1", ais))
                time.sleep(0.5)

        assert "begins" in run.stdout.readline()
        heard_for(3)
        run.send_signal(signal.SIGSTOP)
        time.sleep(STOPPED)  # the vehicle speaks on; of the vessel nothing waits to be read
        run.send_signal(signal.SIGCONT)
        heard_for(2)
        run.send_signal(signal.SIGINT)
        run.wait(timeout=120)
    told = shown.read_text()
    assert "this process did not listen for" in told
    assert "nothing was heard of uav0" not in told
    assert "is not seen any more" not in told
    assert "broken assumption" not in told
