"""The same flights with ArduPilot's own code: where BIGACTORS_SITL names the folder of its simulators."""

import asyncio
import re
from itertools import groupby
from pathlib import Path

import pytest
from sitl import CRAFT, PROGRAMS, SPEED, autopilot, linked, needs_simulators, tell
from worlds import AREA, HOME, ROUND, until

from adapters.camera.poses import PoseLog
from adapters.live.operator_socket import give_back, order
from adapters.live.run_watchers import Watcher
from adapters.mavlink import Craft
from adapters.mavlink.command import long, set_parameter
from adapters.mavlink.constants import Cmd
from adapters.mavlink.profiles import PLANE
from adapters.mavlink.verified_upload import Sync
from adapters.plugin import Accepted, Arrived, Follow, GoTo, HandOver, Refused, Rejected, Return, Status
from adapters.simulated import run
from bigactors.arguments import parse_arguments
from bigactors.cli import main
from bigactors.commands.run.flight import fly, prepare, record
from bigactors.recordings import open_recording
from physical import box, circle, contains, distance, point

pytestmark = needs_simulators


async def flown(model, tmp_path, *told, craft=CRAFT):
    """Tell one thing after the other, each when the one before has ended."""
    async with linked(model, tmp_path, craft) as (world, plugin):
        for number, each in enumerate(told, 1):
            await plugin.command(each)
            await until(lambda: len([*world.of(Arrived), *world.of(Rejected)]) == number, 1_200)  # noqa: B023
        return world, plugin


@pytest.mark.parametrize("model", PROGRAMS)
def test_the_real_autopilot_goes_to_a_place_within_its_fence_and_is_handed_over(model, tmp_path):
    craft = Craft("uav0", system=1, fence=box((37.05, -8.55), (36.95, -8.65)))
    told = GoTo("r1", "uav0", AREA), HandOver("r2", "uav0", "control:gcs0", "control:gcs1")
    world, plugin = run(flown(model, tmp_path, *told, craft=craft), SPEED)
    assert [report.request for report in world.of(Arrived)] == ["r1", "r2"], world.reports
    assert contains(AREA, world.property("uav0").geometry)
    assert plugin.pilot("uav0").known.fenced
    assert world.property("uav0").channels == ("control:gcs1",)


@pytest.mark.parametrize("model", PROGRAMS)
def test_the_real_autopilot_follows_a_path_and_returns(model, tmp_path):
    path = (point(37.004, -8.604), point(37.008, -8.610))
    world, _ = run(flown(model, tmp_path, Follow("r1", "uav0", path), Return("r2", "uav0")), SPEED)
    assert [report.request for report in world.of(Arrived)] == ["r1", "r2"], world.reports


@pytest.mark.parametrize(("kind", "wind"), [("plane", 0), ("plane", 8)])
def test_the_real_plane_stays_where_it_has_arrived_as_far_out_as_we_reckon(kind, wind, tmp_path):
    centre = (37.01, -8.61)

    async def stays():
        parameters = (("SIM_WIND_SPD", wind), ("SIM_WIND_DIR", 40))
        async with linked(kind, tmp_path, parameters=parameters) as (world, plugin):
            with pytest.raises(Refused, match=r"a circle of 104 m: it circles at 80 m \(WP_LOITER_RAD\)"):
                await plugin.command(GoTo("r0", "uav0", circle(centre, 85)))
            await plugin.command(GoTo("r1", "uav0", circle(centre, 105)))
            await until(lambda: world.of(Arrived, request="r1"), 1_200)
            farthest = 0.0
            for _ in range(200):
                await asyncio.sleep(1)
                farthest = max(farthest, distance(world.property("uav0").geometry, point(*centre)))
            return farthest

    assert 85 < run(stays(), SPEED) < 105


def test_the_real_plane_tells_how_it_lies_where_its_home_is_and_that_it_returns(tmp_path):
    log, banks = PoseLog(), []
    craft = Craft("uav0", system=1, streams=("ATTITUDE",))

    async def flown_home():
        async with linked("plane", tmp_path, craft, listeners={"uav0": log.hear}) as (world, plugin):
            await plugin.command(GoTo("r1", "uav0", circle((37.01, -8.61), 300)))
            await until(lambda: world.of(Arrived, request="r1"), 1_200)
            await asyncio.sleep(60)  # until it circles
            for _ in range(100):
                await asyncio.sleep(0.5)
                banks.append(log.at(log.until).roll)
            assert world.property("uav0").geometry.vertices[0] == pytest.approx(
                (log.at(log.until).latitude, log.at(log.until).longitude), abs=1e-3
            )
            assert not world.of(Status)[-1].returning
            await plugin.command(Return("r2", "uav0"))
            await until(lambda: world.of(Status)[-1].returning, 60)
            return world.of(Status)[-1].home

    assert run(flown_home(), SPEED) == pytest.approx(HOME[:2], abs=1e-4)
    assert 10 < sorted(banks)[len(banks) // 2] < 50, banks  # clockwise, so its right wing is low


@pytest.mark.parametrize("model", ["quad", "rover"])
def test_the_real_autopilots_own_circle_is_told_and_what_it_does_not_hold_refused(model, tmp_path):
    async def refused():
        async with linked(model, tmp_path, parameters=[("FENCE_ENABLE", 1), ("FENCE_RADIUS", 300)]) as (
            _,
            plugin,
        ):
            assert "keeps within 300 m around home" in "".join(plugin.remarks())
            with pytest.raises(Refused, match="its circle fence of 300 m around home does not hold"):
                await plugin.command(GoTo("r1", "uav0", AREA))

    run(refused(), SPEED)


@pytest.mark.parametrize("model", PROGRAMS)
def test_a_hand_over_amid_an_upload_to_the_real_autopilot_begins_it_anew(model, tmp_path):
    path = tuple(point(37.002 + 0.0001 * n, -8.604) for n in range(100))

    async def handed():
        async with linked(model, tmp_path) as (world, plugin):
            doing = lambda: plugin.pilot("uav0").moving.doing  # noqa: E731
            await until(lambda: plugin.pilot("uav0").known.healthy)
            await plugin.command(Follow("r1", "uav0", path))
            await until(lambda: isinstance(doing(), Sync) and doing().reached[2] >= 30, 60, 0.005)
            await plugin.command(HandOver("r2", "uav0", "control:gcs0", "control:gcs1"))
            await until(lambda: [*world.of(Accepted, request="r1"), *world.of(Rejected)], 200)
            assert [report.request for report in world.of(Arrived)] == ["r2"]
            assert world.of(Rejected) == []

    run(handed(), SPEED)


MISSION = """
mission tour
signature { kind Location contains Location, UAV, Station kind UAV driven kind Station }
world {
  field0: Location = circle (37.0, -8.6) radius 900 m
  area0: Location = box (37.03, -8.61) (37.01, -8.64)
  gcs0: Station = point (37.001, -8.601) linked control:gcs0
  gcs1: Station = point (37.002, -8.601) linked control:gcs1
  uav0: UAV = point (37.0, -8.6) linked control:gcs0
}
BigActor a hosted_at uav0 with_behavior {
  control(MOVE_HOST_TO area0)
  observe(CHILDREN(PARENT(HOST)))
  react { case obs => send "there" to op }
}
BigActor op hosted_at gcs0 with_behavior { react { case "there" => control(HAND uav0 TO gcs1) } }
environment { uav0 arrives }
"""


def flown_by_run(mission, model, tmp_path, foe=None, seconds=1200):
    """Fly a mission that was checked as `bigactors run` does; return how it ended, and what was seen of it."""
    Path("flown.mission").write_text(mission)
    checked = ["check", "--no-traces", "--control", "timed", "--verdict", "v.json", "flown.mission"]
    assert main(checked) == 0
    line = ["run", "flown.mission", "--verdict=v.json", "--vehicle=uav0:1=udp:127.0.0.1:0", "--socket=s"]
    flight = prepare(parse_arguments([*line, "--record=r.mcap", f"--for={seconds}", "--wait=180"]))
    seen = Seen()

    async def fly_it():
        task = asyncio.ensure_future(fly(flight, (tape, seen)))
        await until(lambda: flight.plugins[0].local)
        seen.port = port = flight.plugins[0].local[1]
        with autopilot(model, port, tmp_path) as process:
            beside = None if foe is None else asyncio.ensure_future(foe(seen, process))
            ending = await task
            if beside is not None and beside.done():
                beside.result()
            return ending, flight.plugins[0].pilot("uav0").known

    with record(flight) as tape:
        return *run(fly_it(), SPEED), seen


class Seen(Watcher):
    """What a run has come to."""

    def __init__(self):
        self.rules, self.findings = [], []

    def turned(self, turn, _now):
        self.rules += [step.transition.label.rule for step in turn.steps]
        self.findings += turn.findings

    async def leg(self, number):
        """Wait until the vehicle is on its way from the place of its so-many-th commit."""
        await until(lambda: self.rules.count("commit") == number, 1_200)
        await asyncio.sleep(5.0)

    def elsewhere(self):
        """The addresses from which something speaks for the vehicle that is not believed."""
        return re.findall(
            r"give-back uav0 --at (\S+)", "".join(finding.message for finding in self.findings)
        )[-1:]

    def kinds(self):
        return {finding.kind for finding in self.findings}


@pytest.mark.parametrize("model", PROGRAMS)
def test_a_verified_mission_flies_the_real_autopilot(model, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    ending, _, _ = flown_by_run(MISSION, model, tmp_path)
    assert ending.reason == "the mission has ended"
    logical = ending.state.configuration.structure.logical
    assert (logical.parent("uav0"), logical.links("uav0")) == ("area0", ("control:gcs1",))


LOW = {"BATT_FS_LOW_ACT": 1, "BATT_LOW_TIMER": 1, "BATT_LOW_VOLT": 30}


def low_battery(number):
    async def foe(seen, _process):
        await seen.leg(number)
        tell(255, *(set_parameter(1, name, value) for name, value in LOW.items()))

    return foe


async def other_station(seen, _process):
    await seen.leg(1)
    tell(253, long(Cmd.DO_SET_MODE, 1, 1, PLANE.home))


@pytest.mark.parametrize(
    ("foe", "legs", "words"),
    [
        (low_battery(1), 1, "Battery 1 is low"),
        (low_battery(3), 3, "Battery 1 is low"),
        (other_station, 1, ""),
    ],
    ids=["over its destination", "to where the mission ends", "by another station"],
)
def test_a_real_plane_that_flies_home_unasked_arrives_nowhere_and_is_not_called_back(
    foe, legs, words, tmp_path, monkeypatch
):
    monkeypatch.chdir(tmp_path)
    ending, known, seen = flown_by_run(ROUND, "plane", tmp_path, foe, 1_200)
    assert ending.reason == "the time is over"
    assert seen.rules.count("commit") == legs
    assert "it is in RTL, by itself or by a command from elsewhere" in ending.state.overrides.taken["uav0"]
    assert words in ending.state.overrides.taken["uav0"]
    assert known.mode == PLANE.home
    home = circle((37.0, -8.6), 300.0)
    assert contains(home, point(known.position.latitude, known.position.longitude))


def test_a_real_plane_that_an_operator_gives_back_flies_its_mission_to_the_end(tmp_path, monkeypatch):
    async def operator(seen, process):
        await low_battery(1)(seen, process)
        await until(lambda: "taken over" in seen.kinds())
        await asyncio.sleep(30.0)
        assert (await give_back(Path("s"), "uav0")).refusal == ""

    monkeypatch.chdir(tmp_path)
    ending, _, seen = flown_by_run(ROUND, "plane", tmp_path, operator, 1_800)
    assert ending.reason == "the mission has ended"
    assert seen.kinds() - {"trouble"} == {"taken over", "given back"}


@pytest.mark.parametrize(("model", "modes"), [("plane", ["LOITER", "RTL"]), ("rover", ["HOLD", "RTL"])])
def test_a_real_vehicle_holds_and_returns_as_an_operator_orders(model, modes, tmp_path, monkeypatch):
    async def operator(seen, _process):
        await until(lambda: "command" in seen.rules)
        await asyncio.sleep(60.0)
        for number, what in enumerate(("hold", "return"), 1):
            assert await order(Path("s"), what, "uav0", "Ana") == ("", {}, ())
            await until(lambda: [each.kind for each in seen.findings].count("confirmed") == number, 120)  # noqa: B023
            await asyncio.sleep(20.0)

    monkeypatch.chdir(tmp_path)
    ending, _, seen = flown_by_run(ROUND, model, tmp_path, operator, 300)
    assert ending.reason == "the time is over"
    assert ending.state.overrides.taken == {"uav0": "sent home by the operator (Ana)"}
    assert seen.kinds() - {"trouble"} == {"ordered", "confirmed"}
    recording = open_recording("r.mcap")
    states = [message.data for message in recording.of("status")]
    assert [mode for mode, _ in groupby(each["mode"] for each in states)][-2:] == modes
    assert states[-1]["authority"] == ["gcs0"]
    assert states[-1]["battery"]["volts"] > 10
    assert 0 <= states[-1]["heading"] < 360
    texts = {message.data["text"] for message in recording.of("said")}
    assert "Throttle armed" in texts


def test_a_real_plane_that_boots_anew_on_the_ground_where_it_was_to_go_has_not_arrived(tmp_path, monkeypatch):
    async def killer(seen, process):
        await seen.leg(3)
        process.kill()
        process.wait()
        await asyncio.sleep(8.0)
        with autopilot("plane", seen.port, tmp_path):
            while "taken over" not in seen.kinds():
                await asyncio.sleep(5.0)
                for there in seen.elsewhere():  # it speaks from another port now
                    await give_back(Path("s"), "uav0", there)
            await asyncio.sleep(1_000.0)

    monkeypatch.chdir(tmp_path)
    ending, known, seen = flown_by_run(ROUND, "plane", tmp_path, killer, 700)
    assert ending.reason == "the time is over"
    assert seen.rules.count("commit") == 3
    assert known.armed is False
    assert ending.state.overrides.taken["uav0"].startswith("it has booted anew and is disarmed")
