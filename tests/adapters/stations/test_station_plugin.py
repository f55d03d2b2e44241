"""Stations in one process, over real loopback links: what they share, and with whom not."""

import asyncio
import json
import time
import zlib
from contextlib import asynccontextmanager, suppress
from dataclasses import replace
from itertools import groupby, pairwise

import pytest
from certificates import Authority
from flown_processes import free_port
from hypothesis import given
from hypothesis import strategies as st
from live_missions import EAST, TOUR, WEST, Run, boat, plan_of
from worlds import World as Told

from adapters.live.live_state import LiveState
from adapters.live.operator_findings import Finding
from adapters.live.plan import Plan
from adapters.live.turn_result import LiveStep, Turn
from adapters.plugin import (
    Aged,
    Believes,
    Broken,
    Delivered,
    Gone,
    HandOver,
    Hold,
    Hosts,
    Presence,
    Refused,
    Rejected,
    Trouble,
    Underway,
    entity_of,
)
from adapters.stations import remote_station
from adapters.stations.entries import Broke, Posted, Took, VehicleSent
from adapters.stations.entries import Said as EntrySaid
from adapters.stations.journal import SCHEMA, Journal, JournalError
from adapters.stations.merge import ABREAST
from adapters.stations.peers import peers_of
from adapters.stations.remote_station import SELDOM
from adapters.stations.station_plugin import Sharing
from physical import PhysicalError, PhysicalProperty, point
from semantics.state.configuration import Label, Transition
from semantics.state.station_partition import Parting, parted

MISSION = "sha256:mission"
VEHICLES = {"uav0": True}


class World(Told):
    """What a station's run is told."""

    ahead = 0.0

    def now(self):
        return time.time() + self.ahead

    def at(self, entity):
        for published in reversed(self.published):
            said = published.property if isinstance(published, Aged) else published
            if said.entity == entity:
                return None if isinstance(said, Gone) else said.geometry.vertices[0]
        return None

    def troubles(self):
        return " | ".join(f"{each.what}: {each.detail}" for each in self.of(Trouble))


class Camera:
    """A plugin that publishes what the test tells it to."""

    name = "camera"

    def __init__(self, owned=()):
        self.owned = owned

    def owns(self, entity):
        return entity in self.owned


class Node:
    """A station: its plugin, its log and its world."""

    def __init__(self, peers, folder, mission=MISSION, ahead=0.0):
        self.peers, self.world = peers, World()
        self.world.ahead = ahead
        self.journal = Journal(folder / f"{peers.own.name}.log", peers.own.name, mission)
        self.sharing = Sharing(peers, self.journal, "tour", mission, VEHICLES)

    def see(self, entity, at, *, owned=False, ago=0.0, channels=(), ttl=60.0):
        said = PhysicalProperty(entity, "Vessel", point(*at), channels=channels, time=self.world.now() - ago)
        self.sharing.publish(Camera((entity,) if owned else ()), self.world, Aged(said, ttl))


@asynccontextmanager
async def running(*nodes):
    tasks = [asyncio.ensure_future(node.sharing.run(node.world)) for node in nodes]
    try:
        await asyncio.sleep(0)
        yield
        for task in tasks:
            assert not task.done(), task.exception()
    finally:
        for task in tasks:
            task.cancel()
            with suppress(asyncio.CancelledError):
                await task


async def until(what, seconds=10.0):
    end = time.monotonic() + seconds
    while not what():
        assert time.monotonic() < end, "it did not come to pass in time"
        await asyncio.sleep(0.02)


def both(names=("gcs0", "gcs1"), tls=None):
    scheme = "tls" if tls else "tcp"
    table = {name: {"connect": [f"{scheme}/127.0.0.1:{free_port()}"]} for name in names}
    return table | ({"tls": tls} if tls else {})


@asynccontextmanager
async def two(folder, **second):
    """Run two stations of one mission; the second may be otherwise."""
    table = both()
    of = lambda name: peers_of(table, name, folder)  # noqa: E731
    nodes = Node(of("gcs0"), folder), Node(of("gcs1"), folder, **second)
    async with running(*nodes):
        yield nodes


async def test_an_entry_of_the_log_that_was_dropped_is_told(tmp_path):
    before = Node(peers_of(both(), "gcs0", tmp_path), tmp_path)
    before.journal.add([Broke("it rains", 1.0)])
    before.journal.close()
    path = tmp_path / "gcs0.log"
    path.write_bytes(path.read_bytes()[:-5])
    gcs0, told = (
        Node(before.peers, tmp_path),
        f"damaged log: {path}:3: the last entry was dropped: it is torn",
    )
    async with running(gcs0):
        await until(lambda: told in gcs0.world.troubles())


async def test_what_one_sees_all_know_and_the_newest_counts(tmp_path):
    async with two(tmp_path) as (gcs0, gcs1):
        gcs0.see("boat0", WEST)
        await until(lambda: gcs1.world.at("boat0") == WEST)
        gcs1.see("boat0", EAST)
        await until(lambda: gcs0.world.at("boat0") == EAST)
        gcs0.see("boat0", WEST, ago=30.0)  # somebody heard it late
        await asyncio.sleep(0.3)
        assert gcs0.world.at("boat0") == gcs1.world.at("boat0") == EAST


async def test_who_comes_late_gets_the_history_also_of_a_station_that_was_restarted(tmp_path):
    table = both()
    gcs0 = Node(peers_of(table, "gcs0", tmp_path), tmp_path)
    async with running(gcs0):
        for number in range(1_200):
            gcs0.see(f"boat{number}", WEST if number % 2 else EAST)
    again, gcs1 = (Node(peers_of(table, name, tmp_path), tmp_path) for name in ("gcs0", "gcs1"))
    assert again.journal.last == gcs0.journal.last
    async with running(again, gcs1):
        again.see("boat7", EAST)
        await until(lambda: len(gcs1.sharing.merge.words) == 1_200)
        await until(lambda: gcs1.world.at("boat7") == EAST)
        assert gcs1.world.at("boat9") == WEST


async def test_a_parcel_comes_again_until_it_is_taken_and_the_acknowledgement_ends_it(tmp_path):
    parcels = [{"Parcel": ["op1", [f"m{number}"], None]} for number in (1, 2)]
    async with two(tmp_path) as (gcs0, gcs1):
        gcs0.sharing._add([Posted("gcs1", number, parcel) for number, parcel in enumerate(parcels, 1)])
        await until(lambda: len(gcs1.world.of(Delivered)) >= 4)
        told = [(each.number, each.parcel) for each in gcs1.world.of(Delivered)]
        assert told[:4] == [(1, parcels[0]), (2, parcels[1])] * 2
        gcs1.sharing._add([Took("gcs0", 2)])
        gcs1.sharing.others["gcs0"].drop(2)
        await until(lambda: gcs0.journal.waiting("gcs1") == 0)
        before = len(gcs1.world.of(Delivered))
        await asyncio.sleep(1.2)
        assert len(gcs1.world.of(Delivered)) == before

    again = Node(gcs0.peers, tmp_path)
    assert again.journal.sent("gcs1") == 2
    again.journal.close()


async def test_who_is_reached_and_when_each_was_heard_is_told_on_change_and_seldom(tmp_path):
    table = both()
    gcs0, gcs1 = (Node(peers_of(table, name, tmp_path), tmp_path) for name in ("gcs0", "gcs1"))
    async with running(gcs0):
        await until(lambda: gcs0.world.of(Presence))
        async with running(gcs1):
            await until(lambda: len([each for each in gcs0.world.of(Presence) if each.reached]) > 1)
        await until(lambda: gcs0.world.of(Presence)[-1].reached is False, 15.0)
    told = gcs0.world.of(Presence)
    reached = [reached for reached, _ in groupby(each.reached for each in told)]
    assert reached in ([None, True, False], [False, True, False], [None, False, True, False])
    assert {each.station for each in told} == {"gcs1"}
    assert told[0].heard is None
    assert told[-1].heard >= told[-2].heard
    for before, after in pairwise(told):
        assert before.reached != after.reached or after.time - before.time >= SELDOM


async def test_stations_that_believe_otherwise_for_a_while_say_so_until_they_agree(tmp_path, monkeypatch):
    monkeypatch.setattr(remote_station, "SETTLED", 1.5)
    west = plan_of(TOUR).first
    east = west.with_(west.structure.logical.nesting("uav0", "east0"))
    async with two(tmp_path) as (gcs0, gcs1):
        gcs0.sharing._logical = gcs1.sharing._logical = west.structure.logical
        agreed = lambda: [each.agrees for each in gcs0.world.of(Presence)][-1:]  # noqa: E731
        await until(lambda: agreed() == [True])
        gcs1.sharing._logical = east.structure.logical
        await until(lambda: agreed() == [False])
        assert gcs0.world.troubles().count("the L of gcs1 differs from ours") == 1
        gcs0.sharing._logical = east.structure.logical
        await until(lambda: agreed() == [True])


async def test_a_clock_that_is_off_is_measured_and_said_and_what_is_too_far_ahead_does_not_count(tmp_path):
    async with two(tmp_path, ahead=6.5) as (gcs0, gcs1):
        gcs1.see("boat0", EAST)
        await until(lambda: "the clock of gcs1: it is +6.5 s off" in gcs0.world.troubles())
        await until(lambda: "the clock of gcs0: it is -6.5 s off" in gcs1.world.troubles())
        await until(lambda: "time stamp in the future: gcs1 reports boat0" in gcs0.world.troubles())
        assert gcs0.world.at("boat0") is None
        await until(lambda: gcs0.world.at("boat0") == EAST)  # once it is only five seconds ahead


async def test_where_bigactors_are_and_what_broke_all_know(tmp_path):
    text = TOUR + "BigActor op0 hosted_at gcs0 with_behavior { skip }"
    part = parted(
        plan_of(text).first, Parting("gcs0", {"gcs0": "gcs0", "uav0": "gcs0", "gcs1": "gcs1"}, {}, {})
    )
    broke = Finding("broken assumption", "boat0", "boat0 is in east0", 1.0)
    other = replace(broke, message="at gcs1: it rains", elsewhere=True)
    moved = LiveStep(1, part, Transition(Label("migrate", "op0"), part), 0, None, 1.0, 1.0)
    async with two(tmp_path) as (gcs0, gcs1):
        gcs0.sharing.turned(Turn(LiveState(part)), time.time())
        await until(lambda: [each.host for each in gcs1.world.of(Hosts)] == ["gcs0"])
        there = LiveState(part.with_(part.alpha.hosting("op0", "uav0")))
        gcs0.sharing.turned(Turn(there, steps=(moved,), findings=(broke, other)), time.time())
        await until(lambda: [each.host for each in gcs1.world.of(Hosts)] == ["gcs0", "uav0"])
        await until(lambda: gcs1.world.of(Broken))
        assert [each.assumption for each in gcs1.world.of(Broken)] == ["boat0 is in east0"]
        assert gcs0.world.of(Broken) == gcs0.world.of(Hosts) == []


async def test_of_a_vehicle_only_its_own_links_speak(tmp_path):
    async with two(tmp_path) as (gcs0, gcs1):
        gcs0.see("uav0", EAST)  # an AIS transponder that calls itself so
        gcs0.see("boat0", WEST)
        await until(lambda: gcs1.world.at("boat0") == WEST)
        assert gcs1.world.at("uav0") is None


async def test_a_vehicle_is_not_seen_before_a_link_tells_whom_it_obeys(tmp_path):
    """It answers only that link: the other hears where it is, and whoever begins then should not take it for lost."""
    async with two(tmp_path) as (gcs0, gcs1):
        gcs1.see("uav0", WEST, owned=True)
        gcs1.see("boat0", WEST)
        await until(lambda: gcs0.world.at("boat0") == WEST)
        assert gcs0.world.at("uav0") is gcs1.world.at("uav0") is None
        gcs0.see("uav0", WEST, owned=True, channels=("control:gcs0",))
        await until(lambda: gcs1.world.at("uav0") == WEST)
        gcs0.sharing._add([VehicleSent("uav0", "east0", time.time())])
        await until(lambda: [each.to for each in gcs1.world.of(Underway)] == ["east0"])
        await asyncio.sleep(ABREAST)  # while its own link hears it, that counts
        gcs1.see("uav0", EAST, owned=True)
        await until(lambda: gcs0.world.at("uav0") == EAST)
        for node in (gcs0, gcs1):
            said = [each.property for each in node.world.published]
            assert {each.channels for each in said if each.entity == "uav0"} == {("control:gcs0",)}
        with pytest.raises(Refused, match="another station's"):
            await gcs0.sharing.command(Underway("uav0", 0.0, ""))


async def test_what_a_peer_claims_of_a_vehicle_takes_it_from_nobody_whose_link_it_obeys(tmp_path):
    """A station with a certificate lies: it has the vehicle, from later on, and elsewhere; or it is gone."""
    lie = PhysicalProperty("uav0", "UAV", point(*EAST), channels=("control:gcs1",), time=0.0)
    async with two(tmp_path) as (gcs0, gcs1):
        gcs0.see("uav0", WEST, owned=True, channels=("control:gcs0",))
        await until(lambda: gcs1.world.at("uav0") == WEST)
        for published in (replace(lie, time=time.time() + 4), Gone("uav0", time.time() + 4.5, "gcs1")):
            gcs1.sharing._add([EntrySaid(published, time.time() + 1_000, owned=True)])
            gcs1.see("boat0", WEST if published is lie else EAST)
            await asyncio.sleep(0.5)
            gcs0.see("uav0", WEST, owned=True, channels=("control:gcs0",))
        await until(lambda: gcs0.world.at("boat0"))

    said = [each for each in gcs0.world.published if entity_of(each) == "uav0"]
    assert {each.property.channels for each in said} == {("control:gcs0",)}
    assert gcs0.world.at("uav0") == WEST


class Link(Camera):
    """The link of a vehicle, which refuses what a station tells that it does not know to have the authority."""

    def __init__(self):
        super().__init__(("uav0",))
        self.obeys, self.told = "control:gcs0", []

    async def command(self, command):
        if self.obeys != "control:gcs1":
            raise Refused(f"it obeys {self.obeys}")
        self.told.append(command)

    async def run(self, world):
        while True:
            said = PhysicalProperty("uav0", "UAV", point(*WEST), channels=(self.obeys,), time=world.now())
            world.publish(Aged(said, 60.0))
            await asyncio.sleep(0.02)


@pytest.mark.parametrize("learns", [True, False])
async def test_a_command_waits_for_the_link_to_learn_that_the_vehicle_was_handed_to_us(
    tmp_path, monkeypatch, learns
):
    monkeypatch.setattr("adapters.stations.shared_plugin.LASTING", 1.0)
    link = Link()
    async with two(tmp_path) as (gcs0, gcs1):
        shared = gcs1.sharing.sharing(link)
        task = asyncio.ensure_future(shared.run(gcs1.world))
        gcs0.see("uav0", WEST, owned=True, channels=("control:gcs0",))
        await until(lambda: gcs1.sharing.merge.holds("uav0", time.time()))
        gcs0.sharing.commanded(HandOver("op0-1", "uav0", "control:gcs0", "control:gcs1"))
        gcs0.see("uav0", WEST, owned=True, channels=("control:gcs1",))
        await until(lambda: gcs1.sharing.lags("uav0"))
        await shared.command(Hold("op1-1", "uav0"))
        await asyncio.sleep(0.2)
        assert link.told == gcs1.world.of(Rejected) == []
        if learns:
            link.obeys = "control:gcs1"
            await until(lambda: link.told == [Hold("op1-1", "uav0")])
        else:
            await until(
                lambda: [each.reason for each in gcs1.world.of(Rejected)] == ["it obeys control:gcs0"]
            )
        task.cancel()
        with suppress(asyncio.CancelledError):
            await task


async def test_what_is_written_into_l_all_have(tmp_path):
    text = TOUR + "BigActor op0 hosted_at gcs0 with_behavior { observe(CHILDREN(east0)) }"
    run = Run(Plan(parted(plan_of(text).first, Parting("gcs0", {"gcs0": "gcs0", "gcs1": "gcs1"}, {}, {}))))
    run.turn(0.0, boat(EAST, 0.0))
    seen_by_op0 = run.turn(1.0)
    async with two(tmp_path) as (gcs0, gcs1):
        gcs0.sharing.turned(replace(seen_by_op0, steps=tuple(run.steps)), time.time())
        await until(lambda: gcs1.world.of(Believes))
        told = [(each.node, each.slot, each.names) for each in gcs1.world.of(Believes)]
        assert ("boat0", "parent", ("east0",)) in told


async def test_who_flies_another_mission_is_not_listened_to(tmp_path):
    async with two(tmp_path, mission="sha256:other") as (gcs0, gcs1):
        gcs1.see("boat0", EAST)
        await until(lambda: "another mission: gcs1 flies another mission" in gcs0.world.troubles())
        assert gcs0.world.at("boat0") is None
        assert gcs0.sharing.others["gcs1"].begun is None


async def test_a_port_in_use_is_said(tmp_path):
    gcs0 = Node(peers_of(both(), "gcs0", tmp_path), tmp_path)
    (tmp_path / "other").mkdir()
    second = Node(gcs0.peers, tmp_path / "other")
    async with running(gcs0):
        with pytest.raises(PhysicalError, match=r"gcs0 cannot listen at tcp/127\.0\.0\.1"):
            await second.sharing.run(second.world)
    second.journal.close()


# --- mutual TLS -----------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("signer", "common_name", "hears", "heard"),
    [
        ("ca", "gcs1", True, True),
        ("other", "gcs1", False, False),
        ("ca", "mallory", False, False),
        ("ca", "gcs2", True, False),  # a station, but another one than it says
    ],
)
async def test_who_has_another_authority_or_another_name_gets_nothing_and_is_not_heard(
    tmp_path, signer, common_name, hears, heard
):
    authorities = {name: Authority(tmp_path, name) for name in ("ca", "other")}
    authorities["ca"].sign("gcs0", "gcs0")
    authorities[signer].sign(common_name, "gcs1")
    authorities["ca"].sign("gcs2", "gcs2")
    table = both(
        ("gcs0", "gcs1", "gcs2"), {"ca": "ca.pem", "certificate": "{station}.pem", "key": "{station}.key"}
    )
    gcs0, gcs1 = (Node(peers_of(table, name, tmp_path), tmp_path) for name in ("gcs0", "gcs1"))
    async with running(gcs0, gcs1):
        gcs0.see("boat0", WEST)
        gcs1.see("boat1", EAST)
        if heard:
            await until(lambda: gcs1.world.at("boat0") == WEST and gcs0.world.at("boat1") == EAST)
        else:
            await until(lambda: "gcs1 is not reached" in gcs0.world.troubles())
            assert gcs1.world.at("boat0") == (WEST if hears else None)
            assert gcs0.world.at("boat1") is None


# --- a log that somebody has altered, and given new checksums -------------------------------------------

ENTRIES = [
    {"n": 1, "sent": "uav0", "to": "east0", "time": 1.0},
    {"n": 2, "hosted": "op0", "host": "gcs0", "time": 1.0},
    {"n": 3, "believed": "uav0", "slot": "parent", "names": ["east0"], "time": 1.0},
    {"n": 4, "to": "gcs1", "index": 1, "parcel": {"Parcel": []}, "knows": {"gcs1": 3}, "time": 2.0},
    {"n": 5, "took": "gcs1", "index": 1},
    {"n": 6, "broke": "it rains", "time": 2.0},
    {"n": 7, "entity": "uav0", "kind": "UAV", "at": {"ring": [[370000000, -86500000]]}, "time": 1.0}
    | {"altitude": [1.0, 2], "channels": ["c"], "by": "ship", "velocity": [1, 2.5]}
    | {"since": 1.0, "owned": True, "ttl": 60.0, "clock": 7},
    {"n": 8, "entity": "uav0", "time": 1.0, "gone": True, "since": 1.0, "owned": False},
]
SEALED = [{"log": SCHEMA, "station": "gcs0", "mission": MISSION}, {"last": 5, "sent": {"gcs1": 1}}, *ENTRIES]
ODD = [
    *(None, True, -1, 0, 1, 10**15, 10**30, 1e300, "", "gcs0", "gcs1", "nobody", "uav0"),
    *([], [[]], {}, {"a": 1}),
]


@given(st.data())
def test_a_log_that_was_altered_and_sealed_again_ends_in_no_traceback(tmp_path_factory, data):
    folder = tmp_path_factory.mktemp("sealed")
    lines = json.loads(json.dumps(SEALED))
    for _ in range(data.draw(st.integers(1, 3))):
        line = data.draw(st.sampled_from(lines))
        key = data.draw(st.sampled_from([*line, "to", "sent", "took"]))
        line[key] = data.draw(st.sampled_from(ODD))
    found, told = 0, b""
    for line in lines:
        text = json.dumps(line).encode()
        found = zlib.crc32(text, found)
        told += b"%08x %s\n" % (found, text)
    (folder / "gcs0.log").write_bytes(told)
    try:
        node = Node(peers_of(both(), "gcs0", folder), folder)
    except JournalError:
        return
    node.sharing._world = node.world
    for entry in node.journal.entries():
        node.sharing._take(entry)
    node.sharing._deliver()
    node.sharing.close()
