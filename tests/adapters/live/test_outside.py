"""What comes from outside, and a disk that is full: neither ends a run that has begun."""

import asyncio
import json
import math
import os
import subprocess
import sys
import time
from collections import Counter
from contextlib import closing
from pathlib import Path
from types import SimpleNamespace

import aiohttp
import pytest
from live_missions import TOUR, WEST, plan_of
from scale import long_ones
from test_loop import GO, Looker, Vehicle
from worlds import World, flight, simulated, until

from adapters.detection_feed import Detections
from adapters.live.batch import Saying
from adapters.live.core import started
from adapters.live.loop import LiveRun
from adapters.mavlink import mavlink_plugin
from adapters.mavlink.codec import Decoder
from adapters.plugin import Aged, Failed, GoTo, Hold, Return, Trouble
from adapters.recording.recording_reader import read_recording
from adapters.recording.writing import Recorder
from adapters.stations.journal import Journal
from adapters.stations.station_plugin import MOST_STRANGERS, Sharing
from adapters.web import Listen
from bigactors.flight_watchers import Log, Tape, Terminal
from physical import PhysicalProperty, Velocity, point
from semantics.live_policy import Fallback, LivePolicy

HEADER = {"mission": "tour", "text": "", "digest": "", "version": "", "verified": False, "vehicles": {}}
STAY = (
    "BigActor a hosted_at uav0 with_behavior { loop { observe(CHILDREN(west0)) react { case obs => skip } } }"
)
HALF = "\ud800"


def vessel(name, **more):
    return PhysicalProperty(name, "Vessel", point(*WEST), **more)


def recorder_at(path):
    return Tape(Recorder(path, HEADER, time.time()), lambda _finding: ())


def fly(text, plugins, watchers, during, seconds=2.5, precautions=None):
    """Fly while something goes on beside, and return how it ended."""

    async def flying():
        plan = plan_of(text, precautions)
        async with LiveRun(plan, started(plan), plugins, watchers) as run:
            await run.begin(2.0)
            beside = asyncio.create_task(during(run))
            ending = await run.go(lambda _: False, seconds=seconds)
            await beside
            return ending

    return asyncio.run(flying())


def messages(path, topic):
    return [message.data for message in read_recording(path, arrivals=True).of(topic)]


def test_half_a_surrogate_pair_from_anywhere_ends_no_run_and_is_recorded_legibly(tmp_path):
    folder = tmp_path / "camera"
    folder.mkdir()
    camera = Detections("camera", listen=Listen(0), folder=folder)
    answers = []
    feature = {"type": "Feature", "properties": {"name": HALF, "kind": "Vessel"}, "geometry": None}

    async def attack(run):
        (Path(os.fsdecode(os.fsencode(folder) + b"/\xff.geojson"))).write_text("no GeoJSON")
        url = f"http://127.0.0.1:{camera.port}/detections"
        async with aiohttp.ClientSession(headers={"Content-Type": "application/json"}) as session:
            body = json.dumps({"type": "FeatureCollection", "features": [feature]})
            async with session.post(url, data=body) as answer:
                answers.append((answer.status, await answer.text()))
            async with session.delete(f"{url}/%ED%A0%80") as answer:
                answers.append((answer.status, await answer.text()))
        answers.append((await run.inbox.say(Saying("a", "\udcff"))).refusal)

    path, looker = tmp_path / "run.mcap", Looker()
    tape = recorder_at(path)
    ending = fly(TOUR + STAY, [Vehicle(), camera], [tape, looker], attack)
    tape.recorder.close("done", time.time())
    assert ending.reason == "the time is over"
    assert [status for status, _ in answers[:2]] == [400, 404]
    assert "half of a surrogate pair" in answers[0][1]
    assert "valid Unicode" in answers[2]
    told = [said["detail"] for said in messages(path, "reports") if said["report"] == "Trouble"]
    assert any("half of a surrogate pair" in each for each in told)
    assert any(each.startswith("\N{REPLACEMENT CHARACTER}.geojson: ") for each in told)


@pytest.mark.parametrize(
    "spoilt",
    [
        vessel(HALF),
        PhysicalProperty("boat0", HALF, point(*WEST)),
        vessel("boat0", channels=("a" * 201,)),
        vessel("boat0", carried_by=""),
        vessel("boat0", time=math.nan),
        vessel("boat0", velocity=Velocity(math.inf, 0)),
        Aged(vessel("boat0"), math.nan),
    ],
)
def test_what_a_plugin_publishes_is_looked_at_where_it_enters(tmp_path, spoilt):
    class Careless(Vehicle):
        name, owns = "careless", lambda _self, _entity: False

        async def run(self, world):
            await asyncio.sleep(0.1)
            world.publish(spoilt)
            world.report(Trouble("careless", world.now(), HALF, "a" * 1_000_000))
            await asyncio.sleep(60)

    looker = Looker()
    tape = recorder_at(tmp_path / "run.mcap")
    fly(TOUR + STAY, [Vehicle(), Careless()], [tape, looker], _nothing, seconds=0.4)
    tape.recorder.close("done", time.time())
    told = [finding.message for finding in looker.findings]
    assert len(told) == 2
    assert len(told[0]) < 2_100
    assert told[1].startswith("feeds: unusable property: 'careless': ")
    assert not [each for each in messages(tmp_path / "run.mcap", "arrivals") if each["plugin"] == "careless"]


# --- a full disk ------------------------------------------------------------------------------------------

FULL = """
import json, resource, sys
sys.path[:0] = ["tests/adapters/live", "tests/adapters", "tests"]
from test_outside import on_a_full_disk
from semantics.live_policy import Fallback
print(json.dumps(on_a_full_disk(sys.argv[1], Fallback(sys.argv[2]))))
"""


def on_a_full_disk(path, fallback):
    """Fly until nothing more can be written; return what the vehicle was told, and what was found."""
    import resource  # noqa: PLC0415 - in a process of its own

    vehicle, looker = Vehicle(), Looker()
    tape, terminal = recorder_at(Path(path)), Terminal(lambda _finding: ())

    async def fill(_run):
        room = Path(path).stat().st_size + 20_000
        resource.setrlimit(resource.RLIMIT_FSIZE, (room, resource.RLIM_INFINITY))
        await asyncio.sleep(0.5)
        vehicle.pace = 0.0005  # positions fill the disk

    moves = "control(MOVE_HOST_TO east0) control(MOVE_HOST_TO west0)"
    loop = f"BigActor a hosted_at uav0 with_behavior {{ loop {{ {moves} }} }}"
    precautions = LivePolicy(fallback)
    ending = fly(TOUR + loop, [vehicle], [tape, looker, terminal], fill, 2.5, precautions)
    told = [type(each).__name__ for each in vehicle.told]
    return {
        "reason": ending.reason,
        "told": told,
        "found": [(each.kind, each.fallback, each.message) for each in looker.findings],
        "broken": terminal.broken,
        "suspended": ending.state.overrides.suspended,
    }


@pytest.mark.parametrize(("fallback", "last"), [("return", Return), *long_ones(("continue", GoTo))])
def test_a_full_disk_ends_no_run_the_vehicle_does_what_the_mission_says(tmp_path, fallback, last):
    path = tmp_path / "run.mcap"
    line = [sys.executable, "-c", FULL, str(path), fallback]
    ended = subprocess.run(
        line, capture_output=True, text=True, env={**os.environ, "PYTHONPATH": "."}, check=True
    )
    found = json.loads(ended.stdout.splitlines()[-1])
    assert found["reason"] == "the time is over"
    assert [(kind, then) for kind, then, _ in found["found"]] == [("failed", fallback)]
    assert found["found"][0][2] == f"{path} fails: File too large"
    assert found["told"][-1] == last.__name__
    assert found["broken"]
    assert found["suspended"] == (fallback != "continue")
    recording = read_recording(path)
    assert recording.torn
    on_file = [message.data["command"] for message in recording.of("commands")]
    if fallback == "continue":
        assert found["told"][: len(on_file)] == on_file
    else:  # what was not recorded was not sent: the fallback alone
        *sent, _ = found["told"]
        assert sent == on_file[: len(sent)]
        assert len(on_file) <= len(sent) + 1  # the disk may be full just before a sending


async def _nothing(_run):
    pass


@pytest.mark.parametrize(
    ("where", "error", "told"),
    [
        ("run", OSError("no such device"), "no such device"),
        ("run", KeyError("forgotten"), "'forgotten'"),
        ("command", KeyError("forgotten"), "'forgotten'"),
    ],
)
def test_a_plugin_that_fails_in_flight_makes_vehicles_do_what_the_mission_says(where, error, told, caplog):
    class Wrong(Vehicle):
        name, owns = "radar", lambda _self, entity: entity == "boat0"

        async def run(self, _world):
            await asyncio.sleep(0.2)
            if where == "run":
                raise error
            await asyncio.sleep(60)

        async def command(self, _command):
            raise error

    async def tell(run):
        await asyncio.sleep(0.2)
        if where == "command":
            run._commands.put_nowait(Hold("x", "boat0"))

    vehicle, looker = Vehicle(), Looker()
    ending = fly(TOUR + STAY, [vehicle, Wrong()], [looker], tell, 0.6, LivePolicy(Fallback.RETURN))
    assert ending.state.overrides.suspended
    assert [type(told) for told in vehicle.told] == [Return]
    assert [finding.message for finding in looker.findings] == [f"radar fails: {told}"]
    is_a_bug = "a bug of bigactors or of the plugin radar" in caplog.text
    assert is_a_bug == isinstance(error, KeyError)


@pytest.mark.parametrize("stream", ["stdout", "stderr"])
def test_an_output_that_cannot_be_written_ends_no_run(monkeypatch, capfd, stream):
    """What is not written stays in the stream's buffer, so a stream of its own takes the place of pytest's."""
    vehicle = Vehicle(refuses="not armed")
    terminal = Terminal(lambda _finding: ())
    with open("/dev/full", "w") as full:
        monkeypatch.setattr(sys, stream, full)
        ending = fly(TOUR + GO, [vehicle], [terminal], _nothing, 0.5)
        monkeypatch.undo()
    assert ending.reason == "all remaining requests were refused"
    assert not terminal.broken
    told = capfd.readouterr()
    assert "No space left on device" in told.err or stream == "stderr"


@simulated
async def test_a_telemetry_log_that_is_full_is_said_once_and_the_link_goes_on():
    full = Log(Path("/dev/full"))
    async with flight(tap=full) as f:
        await until(lambda: f.world.property("uav0"))
        (failed,) = f.world.of(Failed)
        assert (failed.source, failed.reason) == ("/dev/full", "No space left on device")
    full.close()


@simulated
async def test_of_a_flood_of_packets_so_many_are_logged_and_the_rest_counted(monkeypatch):
    monkeypatch.setattr(mavlink_plugin, "MOST_LOGGED", 3)
    heard = []
    async with flight(
        tap=lambda time, frame: heard.append((int(time), Decoder().feed(frame)[0].system))
    ) as f:
        await until(lambda: any(each.what == "not logged" for each in f.world.of(Trouble)))
        await f.plugin.command(Hold("r1", "uav0"))
    of_the_vehicle = Counter(second for second, system in heard if system == 1)
    assert max(of_the_vehicle.values()) == 3
    assert any(system != 1 for _, system in heard)  # all that is said is logged


@simulated
async def test_a_flood_at_a_station_leaves_room_for_what_its_other_feeds_tell(tmp_path):
    world, ais, camera = World(), Vehicle(), Vehicle()
    ais.name, camera.name = "ais", "camera"
    with closing(Journal(tmp_path / "gcs0.log", "gcs0", "sha256:0")) as journal:
        station = Sharing(SimpleNamespace(others={}), journal, "tour", "sha256:0", {}, {"boat0"})
        station._world = world
        for number in range(MOST_STRANGERS + 5):
            station.publish(ais, world, vessel(f"mmsi{number}", time=1.0))
        station.publish(ais, world, vessel("boat0", time=1.0))
        station.publish(camera, world, vessel("spill0", time=1.0))
        assert journal.word(("said", "boat0")) is not None
        assert journal.word(("said", "spill0")) is not None
        assert len(list(journal.entries())) == MOST_STRANGERS + 2
        assert len(world.published) == MOST_STRANGERS + 7


@simulated
async def test_a_station_whose_log_is_full_tells_nobody_and_sees_its_own_world(tmp_path):
    world, log = World(), tmp_path / "gcs0.log"
    journal = Journal(log, "gcs0", "sha256:0")
    station = Sharing(SimpleNamespace(others={"gcs1": None}), journal, "tour", "sha256:0", {})
    station._world = world
    station.publish(Vehicle(), world, vessel("boat0"))
    journal._file.close()
    with open("/dev/full", "ab") as journal._file:
        for _ in range(2):
            station.publish(Vehicle(), world, vessel("boat0", time=world.now() + 1))
        station.close()
    assert len(world.published) == 3
    (failed,) = world.of(Failed)
    assert (failed.source, failed.reason) == (str(log), "No space left on device")
    with closing(Journal(log, "gcs0", "sha256:0")) as again:
        assert again.word(("said", "boat0")) is not None
