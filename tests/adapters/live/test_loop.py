import asyncio
import json
import stat
import time

import pytest
from live_missions import BETWEEN, EAST, TOUR, WEST, plan_of

from adapters.live.batch import Acknowledging, GivingBack, Noting, Ordering, Saying
from adapters.live.core import started
from adapters.live.loop import LiveRun, NotAsAssumed, NotHeard, PluginFailed
from adapters.live.operator_socket import NobodyListens, acknowledge, listening, order, say, status
from adapters.live.run_watchers import Watcher
from adapters.live.turn_result import Answer
from adapters.plugin import Accepted, Aged, GoTo, HandOver, LinkLost, Refused
from physical import PhysicalProperty, centroid, point
from semantics.live_policy import Fallback

GO = """
BigActor a hosted_at uav0 with_behavior {
  control(MOVE_HOST_TO east0)
  observe(CHILDREN(east0))
  react { case obs => display(obs) }
}
"""


class Vehicle:
    """A vehicle in the same process that goes where it is told, in three steps."""

    name = "autopilot"

    def __init__(self, at=WEST, refuses="", pace=0.02):
        self.at, self.refuses, self.pace = at, refuses, pace
        self.channels = ("control:gcs0",)
        self.told, self.way = [], []

    async def run(self, world):
        self.world = world
        while True:
            if self.way:
                self.at = self.way.pop(0)
            said = PhysicalProperty("uav0", "UAV", point(*self.at), channels=self.channels, time=world.now())
            world.publish(Aged(said, 5.0))
            await asyncio.sleep(self.pace)

    async def command(self, command):
        if self.refuses:
            raise Refused(self.refuses)
        self.told.append(command)
        if isinstance(command, GoTo):
            self.world.report(Accepted(command.request, command.entity, self.world.now()))
            self.way = [BETWEEN, BETWEEN, centroid(command.place).vertices[0]]
        elif isinstance(command, HandOver):
            self.channels = (command.join,)

    def owns(self, entity):
        return entity == "uav0"


class Looker(Watcher):
    def __init__(self):
        self.steps, self.findings, self.arrivals = [], [], 0

    def arrived(self, _heard, _now):
        self.arrivals += 1

    def turned(self, turn, _now):
        self.steps += turn.steps
        self.findings += turn.findings

    def shown(self):
        return [text for step in self.steps for text in step.transition.shown]


def fly(text, vehicle, seconds=3.0, **more):
    looker = Looker()

    async def flying():
        plan = plan_of(text)
        async with LiveRun(plan, started(plan), [vehicle], [looker]) as run:
            await run.begin(1.0, **more)
            return await run.go(seconds=seconds)

    return asyncio.run(flying()), looker


def test_a_mission_flies_to_its_end():
    vehicle = Vehicle()
    ending, looker = fly(TOUR + GO, vehicle)
    assert ending.reason == "the mission has ended"
    assert looker.shown() == ["{east0, uav0}"]
    assert vehicle.at == pytest.approx(EAST, abs=1e-4)
    assert [type(told) for told in vehicle.told] == [GoTo]


def test_a_machine_that_was_suspended_has_the_systems_time_and_finds_nobody_silent(monkeypatch):
    class Suspended(Vehicle):
        """Moves the system's clock on by an hour, which the loop's does not notice."""

        async def run(self, world):
            told = asyncio.create_task(super().run(world))
            await asyncio.sleep(0.1)
            told.cancel()
            began, system = world.now(), time.time
            monkeypatch.setattr(time, "time", lambda: system() + 3_600)
            assert 3_600 <= world.now() - began < 3_660
            await asyncio.sleep(0.2)
            await super().run(world)

    ending, looker = fly(TOUR + GO, Suspended(pace=0.1), seconds=4_000.0)
    assert ending.reason == "the mission has ended"
    (finding,) = looker.findings
    assert finding.message.startswith("this process did not listen for 359")


def test_a_run_for_some_seconds_takes_them_whoever_sets_the_systems_clock(monkeypatch):
    class Set(Vehicle):
        async def run(self, world):
            system = time.time
            monkeypatch.setattr(time, "time", lambda: system() + 3_600)
            await super().run(world)

    began = time.monotonic()
    ending, _ = fly(TOUR + GO, Set(pace=60.0), seconds=0.5)
    assert ending.reason == "the time is over"
    assert time.monotonic() - began >= 0.5


async def test_a_run_that_is_interrupted_ends_even_if_something_has_just_come_in():
    plan = plan_of(TOUR + GO)
    async with LiveRun(plan, started(plan), [Vehicle(pace=60.0)], []) as run:
        await run.begin(1.0)
        going = asyncio.create_task(run.go(lambda _: False))
        await asyncio.sleep(0.1)
        run.inbox.awake.set()
        going.cancel()
        await asyncio.wait([going], timeout=60.0)
        assert going.cancelled()


def test_what_is_refused_is_reported_and_a_run_with_nothing_else_to_do_ends():
    ending, looker = fly(TOUR + GO, Vehicle(refuses="not armed"))
    assert ending.reason == "all remaining requests were refused"
    assert [finding.kind for finding in looker.findings] == ["refused"]
    assert "commit" not in [step.transition.label.rule for step in looker.steps]


def test_a_hand_over_is_confirmed_by_the_vehicle():
    text = TOUR + "BigActor op hosted_at gcs0 with_behavior { control(HAND uav0 TO gcs1) }"
    ending, looker = fly(text, Vehicle())
    assert ending.state.configuration.structure.logical.links("uav0") == ("control:gcs1",)
    assert looker.findings == []


async def test_a_run_begins_only_when_its_vehicles_are_heard():
    class Silent(Vehicle):
        async def run(self, _world):
            await asyncio.sleep(60)

    plan = plan_of(TOUR + GO)
    async with LiveRun(plan, started(plan), [Silent()]) as run:
        with pytest.raises(NotHeard, match="uav0"):
            await run.begin(0.15)


def test_a_run_begins_only_where_the_mission_says_that_it_does():
    with pytest.raises(NotAsAssumed, match="uav0 is in east0"):
        fly(TOUR + GO, Vehicle(at=EAST))
    ending, looker = fly(TOUR, Vehicle(at=EAST), forced=True)
    assert ending.reason == "the mission has ended"
    assert [each.fallback for each in looker.findings if each.kind == "broken assumption"] == [""]  # it flew


def test_a_plugin_that_fails_ends_the_run_with_its_reason():
    class Failing(Vehicle):
        async def run(self, _world):
            raise OSError("address already in use")

    with pytest.raises(PluginFailed, match="autopilot: address already in use"):
        fly(TOUR, Failing())


def test_reports_are_never_dropped_and_of_positions_the_newest_counts():
    class Chatty(Vehicle):
        async def run(self, world):
            for number in range(500):
                said = PhysicalProperty("uav0", "UAV", point(37.01, -8.65 + number * 1e-6), time=world.now())
                world.publish(PhysicalProperty(**{**_fields(said), "channels": ("control:gcs0",)}))
                world.report(LinkLost("uav0", world.now(), world.now()))
            await asyncio.sleep(60)

    _, looker = fly(TOUR, Chatty(), seconds=0.1, forced=True)
    assert looker.arrivals == 500
    assert len(looker.findings) >= 1


def _fields(said):
    return {name: getattr(said, name) for name in ("entity", "kind", "geometry", "time")}


# --- saying ---------------------------------------------------------------------------------------------


async def test_only_the_user_may_say_something_to_a_run(tmp_path):
    async def listener(said):
        return Answer(said, "" if said.message == "go" else f"{said.agent} is not told {said.message}")

    path = tmp_path / "run.sock"
    async with listening(path, listener):
        assert stat.S_IMODE(path.stat().st_mode) == 0o600
        assert [await say(path, "op", word) for word in ("go", "stop")] == ["", "op is not told stop"]
    assert not path.exists()
    with pytest.raises(NobodyListens, match="no mission runs"):
        await say(path, "op", "go")


LINES = [
    (b'{"agent": "op", "message": "go"}', Saying("op", "go")),
    (b'{"agent": "op", "message": "go", "by": "Ana"}', Saying("op", "go", "Ana")),
    (b'{"give_back": "uav0", "at": ""}', GivingBack("uav0")),
    (b'{"give_back": "uav0", "by": "Ana"}', GivingBack("uav0", "", "Ana")),
    (b'{"order": "hold", "vehicle": "uav0", "by": ""}', Ordering(Fallback.HOLD, "uav0")),
    (b'{"order": "return", "vehicle": null, "by": "Ana"}', Ordering(Fallback.RETURN, None, "Ana")),
    (b'{"acknowledge": 3, "by": "Ana"}', Acknowledging(3, "Ana")),
    (b'{"order": "hold", "vehicle": ["uav0", "uav1"]}', Ordering(Fallback.HOLD, ("uav0", "uav1"))),
    (b'{"note": "a boat waits", "by": "Ana"}', Noting("a boat waits", "Ana")),
]
NONSENSE = [
    b'{"order": "continue", "vehicle": "uav0"}',
    b'{"order": "hold"}',
    b'{"order": "hold", "vehicle": 7}',
    b'{"order": "hold", "vehicle": "uav0", "by": 7}',
    b'{"order": "hold", "vehicle": "uav0", "by": "a\\nb"}',
    b'{"order": "hold", "vehicle": "uav0", "by": "' + b"a" * 201 + b'"}',
    b'{"order": "hold", "vehicle": "' + b"a" * 2_001 + b'"}',
    b'{"order": "hold", "vehicle": []}',
    b'{"order": "hold", "vehicle": ["uav0", 7]}',
    b'{"note": 7}',
    b'{"acknowledge": true}',
    b'{"acknowledge": "3"}',
    b'{"give_back": "uav0", "at": 5}',
    *(b"hello", b"[]", b'{"agent": 1}', b"[" * 5000),
]


async def test_each_word_of_an_operator_is_understood_and_nothing_else(tmp_path):
    path, heard, answers = tmp_path / "run.sock", [], []

    async def listener(said):
        heard.append(said)
        return Answer(said, left_out={"uav1": "it is in RTL"} if isinstance(said, Ordering) else {})

    async with listening(path, listener, lambda: "well"):
        for line in (*(line for line, _ in LINES), *NONSENSE):
            reader, writer = await asyncio.open_unix_connection(path)
            writer.write(line + b"\n")
            answers.append(json.loads(await reader.readline()))
            writer.close()
        assert await order(path, "hold", None, "Ana") == ("", {"uav1": "it is in RTL"}, ())
        assert (await acknowledge(path, 3), await status(path)) == ("", "well")
    assert heard == [*(said for _, said in LINES), Ordering(Fallback.HOLD, None, "Ana"), Acknowledging(3)]
    assert [answer["refusal"] for answer in answers[: len(LINES)]] == [""] * len(LINES)
    assert all("this is no request" in answer["refusal"] for answer in answers[len(LINES) :])
    assert answers[4] == {"refusal": "", "left_out": {"uav1": "it is in RTL"}}


async def test_what_listens_and_does_not_tell_how_it_stands_is_said(tmp_path):
    async def serve(reader, writer):
        await reader.readline()
        writer.write(b'{"refusal": "this is no saying"}\n')
        writer.close()

    async with await asyncio.start_unix_server(serve, tmp_path / "s"):
        with pytest.raises(NobodyListens, match="a version that reports no status"):
            await status(tmp_path / "s")
