"""Whole flights of `bigactors run` in which vehicles leave their ways or come near each other."""

import asyncio
import math
from dataclasses import replace

import pytest
from audited import copter, flown_with
from live_missions import BESIDE, TOUR, TWO
from pyproj import Geod
from scale import long_ones

from adapters.live.run_watchers import Watcher
from adapters.recording.recording_reader import read_recording
from adapters.simulated import Kind, Vehicle, run
from bigactors.arguments import parse_arguments
from bigactors.cli import main
from bigactors.commands.run.flight import prepare, record
from bigactors.flight_watchers import Terminal
from bigactors.mistakes import Mistake
from bigactors.recordings import open_recording

GEOD = Geod(ellps="WGS84")
GO = "BigActor a hosted_at uav0 with_behavior { control(MOVE_HOST_TO east0) }\n"
STRAYS = f"mission tour {TOUR}{GO}environment {{ uav0 strays at most MOST uav0 arrives }}\ncontrol timed"
NEAR = f"""mission near {TWO}{GO}environment {{ uav0 arrives }}
control timed
timing {{ tick 1 s uav0 flies at 5 m/s to 12 m/s uav1 flies at 5 m/s to 12 m/s }}
live {{ on broken property: RESPONSE }}
check {{ invariant "apart": uav0 at least 60 m from uav1 }}
"""


def prepared(folder, text, *more, seconds=200):
    path = folder / "flown.mission"
    path.write_text(text)
    line = ["run", str(path), "--unverified", "--vehicle=uav0=udp:127.0.0.1:0", f"--socket={folder / 's'}"]
    return prepare(parse_arguments([*line, f"--record={folder / 'r.mcap'}", f"--for={seconds}", *more]))


class Findings(Watcher):
    """A watcher that keeps what is reported."""

    def __init__(self):
        self.all = []

    def turned(self, turn, _now):
        self.all += turn.findings


def flight(asked, vehicle, beside=lambda _: ()):
    """Fly, record and print; return what was reported, with times."""
    terminal, found = Terminal(asked.resting), Findings()
    with record(asked) as tape:
        run(flown_with(asked, vehicle, (terminal, tape, found), beside=beside))
    return terminal, found.all


def gust(vehicle, metres_a_second, seconds):
    """Blow a vehicle to the south, once it is on its way."""

    async def blow(_simulator):
        while vehicle.body.longitude < -8.645:
            await asyncio.sleep(0.5)
        for _ in range(int(seconds * 10)):
            south = vehicle.body.latitude - metres_a_second / 10 / 111_000
            vehicle.body = replace(vehicle.body, latitude=south)
            await asyncio.sleep(0.1)

    return lambda simulator: (blow(simulator),)


def off_line(at):
    """Metres from the shortest line between the middles of west0 and east0, by small steps along it."""
    ahead, _, length = GEOD.inv(-8.65, 37.01, -8.61, 37.01)
    lines = (GEOD.fwd(-8.65, 37.01, ahead, length * i / 4000)[:2] for i in range(4001))
    return min(GEOD.inv(east, north, at[1], at[0])[2] for east, north in lines)


def test_a_vehicle_that_is_blown_off_its_way_breaks_strays_and_holds(tmp_path, capsys):
    vehicle = copter()
    terminal, found = flight(
        prepared(tmp_path, STRAYS.replace("MOST", "40 m")), vehicle, gust(vehicle, 15.0, 8.0)
    )
    assert terminal.broken
    (broken,) = (each for each in found if each.kind == "broken assumption")
    assert "from its way to east0; the mission says: it strays at most 40 m" in broken.message
    figure = int(broken.message.split(" m ")[0].split()[-1])
    heard = read_recording(tmp_path / "r.mcap", arrivals=True).of("arrivals")
    at = [
        each.data["ring"][0] for each in heard if each.data["entity"] == "uav0" and each.time <= broken.time
    ][-1]
    assert figure == pytest.approx(off_line([each / 1e7 for each in at]), abs=1.0)
    assert "confirmed: uav0 holds, as the mission ordered" in capsys.readouterr().err
    assert main(["replay", str(tmp_path / "r.mcap")]) == 0
    assert f"broken assumption: {broken.message}" in capsys.readouterr().err


@pytest.mark.long
def test_a_vehicle_in_calm_air_keeps_to_its_way_and_commits(tmp_path, capsys):
    terminal, _ = flight(prepared(tmp_path, STRAYS.replace("MOST", "40 m"), seconds=500), copter())
    assert not terminal.broken
    assert "⟨commit" in capsys.readouterr().out


def test_a_plane_whose_circle_is_wider_than_it_may_stray_is_refused_before_take_off(tmp_path):
    vehicle = Vehicle(Kind.PLANE, (37.01, -8.65, 20.0))
    with pytest.raises(Mistake) as error:
        flight(prepared(tmp_path, STRAYS.replace("MOST", "100 m")), vehicle)
    assert "uav0 strays at most 100 m, and flies circles of 160 m across" in str(error.value)
    assert not vehicle.armed


def drift(first, second):
    """Let the second vehicle drift to the first, at 12 m/s, once that takes off."""

    async def come(_simulator):
        while not first.armed:
            await asyncio.sleep(0.5)
        metres = math.inf
        while metres > 20:
            here, there = second.body, first.body
            azimuth, _, metres = GEOD.inv(here.longitude, here.latitude, there.longitude, there.latitude)
            east, north, _ = GEOD.fwd(here.longitude, here.latitude, azimuth, 1.2)
            second.body = replace(here, latitude=north, longitude=east)
            await asyncio.sleep(0.1)

    return lambda simulator: (come(simulator),)


@pytest.mark.parametrize("response", [*long_ones("continue"), "hold"])
def test_two_vehicles_that_come_near_break_their_distance_at_once(tmp_path, capsys, response):
    first, second = copter(), Vehicle(Kind.COPTER, (*BESIDE, 20.0), system=2)
    asked = prepared(
        tmp_path, NEAR.replace("RESPONSE", response), "--vehicle=uav1:2=udp:127.0.0.1:0", seconds=90
    )
    terminal, found = flight(asked, [first, second], drift(first, second))
    (broken,) = (each for each in found if each.kind == "broken property")
    assert terminal.property_broken
    assert not terminal.broken
    figure = int(broken.message.split("come within ")[1].split(" m ")[0])
    one, other = (degrees(each) for each in broken.message.split("; from ")[1].split(" to "))
    assert figure == pytest.approx(GEOD.inv(one[1], one[0], other[1], other[0])[2], abs=2.0)
    assert 60 - 12 * 1.5 < figure < 60
    told = capsys.readouterr()
    assert told.err.count("broken property: invariant 'apart' is broken: uav0 may come within") == 1
    assert ("vehicles hold, as the mission says" in told.err) == (response == "hold")
    recorded = [each.data for each in open_recording(str(tmp_path / "r.mcap")).of("findings")]
    assert broken.message in [each["message"] for each in recorded]


def degrees(text):
    """Degrees as they are printed: (37.01000, -8.65000)."""
    return tuple(float(each) for each in text.strip("()").split(", "))
