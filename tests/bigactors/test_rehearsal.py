"""Rehearsals: missions flown by vehicles that are simulated in the run, with one clock, faster than life."""

import tempfile
from pathlib import Path

import pytest

from adapters.recording.recording_reader import read_recording
from bigactors.cli import main
from specs.missions import shipped_missions

ENDURANCE = shipped_missions()["endurance"].read_text()


@pytest.fixture
def there(monkeypatch):
    """Work in a folder of a short name: the path of a socket has at most 100 bytes."""
    with tempfile.TemporaryDirectory() as name:
        monkeypatch.chdir(name)
        yield Path(name)
        monkeypatch.undo()  # leave the folder before it goes


def rehearsed(text, *more):
    """Fly a mission; return the exit code, the labels of its steps and its findings, each with the time since 1970."""
    Path("m.mission").write_text(text)
    code = main(["run", "m.mission", "--unverified", "--record", "run.mcap", "--socket", "run.sock", *more])
    said = read_recording(Path("run.mcap"))
    steps = [(each.data["label"], each.time) for each in said.of("steps")]
    return code, steps, [(each.data["message"], each.time) for each in said.of("findings")]


PLANE = ("--vehicle=uav0=simulated:plane", "--speed=200", "--for=290")


@pytest.mark.usefixtures("there")
def test_a_mission_with_times_keeps_them_at_any_speed():
    code, steps, findings = rehearsed(ENDURANCE, *PLANE)
    assert findings == []
    assert code == 3  # stopped by --for
    times = {label.partition(" ")[0]: time for label, time in steps}
    assert 200 < times["⟨commit"] - steps[0][1] < 310  # 5.2 km at 18 m/s to 25 m/s


@pytest.mark.usefixtures("there")
def test_a_time_that_is_not_kept_is_reported_at_its_date():
    text = ENDURANCE.replace("18 m/s to 25 m/s", "30 m/s to 40 m/s")
    code, steps, findings = rehearsed(text, *PLANE)
    begun = next(time for label, time in steps if label.startswith("⟨command"))
    ((message, time),) = [each for each in findings if "takes longer" in each[0]]
    assert message.startswith("the flight of uav0 to north0 takes longer than 4 min; the mission says: ")
    assert 240 <= time - begun < 242
    assert code == 1


@pytest.mark.usefixtures("there")
def test_a_simulated_sensor_misses_what_the_mission_lets_it_miss_and_a_rash_scout_believes_it():
    text = shipped_missions()["broken_two_lanes"].read_text()
    fleet = ("--vehicle=uav0=simulated:copter", "--vehicle=ship0=simulated:boat", "--speed=200")
    code, steps, findings = rehearsed(text, *fleet, "--misses=1", "--for=30")
    labels = [label for label, _ in steps]
    assert "⟨sense : OBS(scout, CHILDREN(east0)), missing spill0⟩" in labels
    assert "⟨command : CTR(pilot, MOVE_HOST_TO east0)⟩" in labels
    assert (code, findings) == (3, [])
    assert main(["replay", "run.mcap"]) == 0


ALONE = """\
signature standard
world {
  west0: Location = box (37.02, -8.64) (37.00, -8.66)
  uav0: UAV = point (37.01, -8.65)
}
BigActor a hosted_at uav0 with_behavior { control(MOVE_HOST_TO west0) }
"""


@pytest.mark.usefixtures("there")
def test_a_vehicle_of_a_mission_without_stations_obeys_this_run():
    rehearsed(ALONE, "--vehicle=uav0=simulated:copter", "--speed=200", "--for=5")
    told = [each.data.get("authority") for each in read_recording(Path("run.mcap")).of("status")]
    assert ["this run"] in told
    assert all(each in ([], None, ["this run"]) for each in told)


def test_only_simulated_vehicles_fly_faster_than_life(refused):
    told = refused("run", "endurance", "--unverified", "--vehicle=uav0=udp:127.0.0.1:0", "--speed=8")
    assert "uav0 may be a real vehicle" in told
    assert "--vehicle uav0=simulated:plane" in told
    told = refused("run", "endurance", "--unverified", "--vehicle=uav0=simulated:kite")
    assert "there are plane, copter, rover, boat, px4-plane, px4-copter" in told
    told = refused("run", "endurance", "--unverified", "--vehicle=uav0=simulated:plane", "--misses=0.5")
    assert "the mission lets no observation miss anything" in told
