"""Feeds: AIS, static places and a location service, over real sockets and files."""

import asyncio
import json
import os
import pty
import socket
from collections import Counter
from contextlib import asynccontextmanager, suppress
from functools import reduce
from operator import xor

import aiohttp.web
import pytest
from hypothesis import given
from json_mutations import mutated
from scale import examples
from worlds import DATA, World, answering, running, simulated, until

from adapters import location_feed, web
from adapters.ais import MAX_LINE, AisFeed, Lines
from adapters.location_feed import LocationService
from adapters.naming import NamingService
from adapters.plugin import Aged, Trouble
from adapters.static_places import StaticPlaces
from adapters.typed_json import read_typed
from physical import PhysicalError, box, is_word, point, write_geojson, write_plan, write_waypoints
from physical.physical_property import PhysicalProperty

VESSEL = rb"!AIVDM,1,1,,B,35VwAv0300QcEQ`EGcpN40jD0PUQ,0*61"
BAD = rb"!AIVDM,1,1,,B,35VwAv0300QcEQ`EGcpN40jD0PUQ,0*62"
PLACE = PhysicalProperty("searchArea0", "Location", box((37.04, -8.59), (36.94, -8.79)))
SPILL = PhysicalProperty("oilSpill0", "OilSpill", box((37.0, -8.7), (36.99, -8.71)))


def names(world):
    return {published.property.entity for published in world.published if isinstance(published, Aged)}


def troubles(world):
    found = Counter()
    for report in world.of(Trouble):
        found[report.what] += report.count
    return found


async def wait(seconds=0.05):
    await asyncio.sleep(seconds)


# --- AIS --------------------------------------------------------------------------------------------

COARSE = b"!AIVDM,1,1,,A,K39>JhChGASrwP00,0*50"
FINE = b"!AIVDM,1,1,,A,139>JhOP000eM?@N`o:00001P000,0*53"
BINARY = b"!AIVDM,1,1,,A,85Mwp`1Kf3aCnsNvBWLi=wQuNhA5t43N`5nCuI=p<IBfVqnMgPGs,0*47"


@asynccontextmanager
async def listening(*naming):
    """Run a feed of AIS; yield its world, it, and what sends it lines, one after the other."""
    world, feed = World(), AisFeed("ais", "udp:0", *naming)
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as link:

        async def say(*lines, pause=0.05):
            for line in lines:
                link.sendto(line, feed.local)
                await asyncio.sleep(pause)

        async with running(feed.run(world)):
            await until(lambda: feed.local)
            yield world, feed, say


def stamped(time, line=VESSEL):
    stamp = b"c:%d" % time
    return rb"\%s*%02X\%s" % (stamp, reduce(xor, stamp), line)


@simulated
async def test_ais_comes_by_udp_with_or_without_line_ends():
    async with listening() as (world, feed, say):
        await say(VESSEL)
        assert names(world) == {"mmsi376427000"}
        await say(VESSEL + b"\r\n" + VESSEL + b"\n")
        known = world.published[-1]
        assert len(world.published) == 3
        assert (known.property.source, known.property.kind) == ("ais", "Vessel")
        assert known.property.time == pytest.approx(world.now(), abs=1)
        assert known.time_to_live == 600.0
        assert feed.local[0] == "127.0.0.1"


@simulated
async def test_ais_comes_by_tcp_in_pieces_and_the_connection_is_made_again():
    world, connections = World(), []

    async def receiver(_reader, writer):
        connections.append(writer)
        for piece in (VESSEL[:20], VESSEL[20:], b"\r", b"\n"):
            writer.write(piece)
            await writer.drain()
            await wait(0.01)
        writer.close()

    server = await asyncio.start_server(receiver, "127.0.0.1", 0)
    port = server.sockets[0].getsockname()[1]
    async with server, running(AisFeed("ais", f"tcp:127.0.0.1:{port}").run(world)):
        await until(lambda: len(connections) == 3)
        await wait()
    for each in connections:  # the last receiver may be at work still
        each.close()
        await each.wait_closed()
    assert len(world.published) == 3


async def test_ais_comes_by_a_serial_line():
    master, slave = pty.openpty()

    async def report_again():
        """Send the sentence again and again, as a vessel does: what comes before the port is open is lost."""
        while True:
            os.write(master, VESSEL + b"\r\n")
            await wait(0.1)

    try:
        world, feed = World(), AisFeed("ais", f"serial:{os.ttyname(slave)}:38400")
        async with running(feed.run(world), report_again()):
            await until(lambda: names(world) == {"mmsi376427000"}, 10)
    finally:
        os.close(master)
        os.close(slave)


async def played(path, **filters):
    world, feed = World(), AisFeed("ais", f"file:{path}", **filters)
    async with running(feed.run(world)):
        await feed.played.wait()
        return world, world.now()


@simulated
async def test_a_recording_is_played_at_the_pace_of_its_times_as_if_heard_now(tmp_path):
    path = tmp_path / "recording.nmea"
    path.write_bytes(b"\n".join(map(stamped, (1000, 1030))))
    world, now = await played(path)
    first, second = (published.property.time for published in world.published)
    assert second - first == pytest.approx(30, abs=0.1)
    assert second == pytest.approx(now, abs=0.1)
    with pytest.raises(OSError, match="No such file"):
        await AisFeed("ais", "file:/nowhere/at/all").run(World())


@pytest.mark.skipif(not DATA.exists(), reason=f"no recordings in {DATA}; set BIGACTORS_DATA")
@simulated
async def test_a_real_recording_is_filtered_by_area_and_kind():
    path = DATA / "ais" / "workum_2020.nmea"
    every, _ = await played(path)
    vessels, _ = await played(path, kinds=["Vessel"])
    inside, _ = await played(path, area=box((52.86, 5.72), (52.83, 5.69)))
    assert len(names(every)) == 30
    assert {published.property.kind for published in vessels.published} == {"Vessel"}
    assert 0 < len(names(vessels)) <= 30
    assert 0 < len(names(inside)) < 30


def test_a_kind_that_is_none_is_the_users_mistake():
    with pytest.raises(PhysicalError, match="no station is of kind 'Submarine'"):
        AisFeed("ais", "udp:0", kinds=["Submarine"])


ME = "mmsi376427000"
HEARD = {
    "a wrong checksum is counted": (lambda _: [BAD] * 100, {}, [], {"checksum wrong": 100}),
    "a time of the future is cut": (
        lambda now: [stamped(now + 3600)],
        {},
        [ME],
        {"time stamp in the future": 1},
    ),
    "one of long ago is dropped": (lambda now: [stamped(now - 3600)], {}, [], {"time stamp too old": 1}),
    "none takes another's name": (lambda _: [VESSEL], {"mavlink:1": ME}, [], {"name-clash": 1}),
    "the table gives names": (lambda _: [VESSEL], {"mmsi:376427000": "tanker0"}, ["tanker0"], {}),
    "loggers": (lambda now: [each(now) for each in LOGGED], {}, [ME] * 3, {}),
}
LOGGED = (
    lambda now: b"%d.5 %s" % (now - 1, VESSEL),
    lambda _: b"%s ( MSG: 1, ppm: 1.9 )" % VESSEL,
    lambda now: b'{"class":"AIS","rxuxtime":%d,"nmea":["%s"]}' % (now, VESSEL),
)


@pytest.mark.parametrize(("said", "table", "found", "told"), HEARD.values(), ids=HEARD)
@simulated
async def test_what_is_heard_is_published_or_reported_once_a_second(said, table, found, told):
    async with listening(NamingService(table)) as (world, _, say):
        await say(*said(int(world.now())), pause=0)
        await asyncio.sleep(3)
        assert [each.property.entity for each in world.published] == found
        assert troubles(world) == told
        assert len(world.reports) == len(told)
        assert all(each.property.time <= world.now() for each in world.published)


@simulated
async def test_two_sentences_in_one_line_are_two():
    async with listening() as (world, _, say):
        await say(VESSEL + FINE)
        assert (len(world.published), troubles(world)) == (2, {})


@simulated
async def test_a_coarse_position_does_not_move_who_was_heard_finely():
    async with listening() as (world, _, say):
        await say(COARSE, FINE, COARSE, FINE, COARSE)
    tens = [round(published.property.geometry.vertices[0][0], 4) for published in world.published]
    assert tens == [53.545, 53.5446, 53.5446]
    what = "position to a tenth of a minute, of a station with a finer one: not read, in total"
    assert troubles(world)[what] == 2


@simulated
async def test_what_brings_no_position_is_told_by_kind_at_once_and_in_all_at_the_end():
    async with listening() as (world, _, say):
        await say(BINARY, VESSEL, BINARY, b"$GPGSV,3,1,10*00", b"# a comment", BINARY)
    told = troubles(world)
    assert told["message of type 8, without a position of its sender: not read"] == 1
    assert told["message of type 8, without a position of its sender: not read, in total"] == 3
    assert told["sentence GPGSV: not read, in total"] == 1
    assert len(told) == 4


# --- lines ------------------------------------------------------------------------------------------


def test_lines_come_whole_out_of_any_pieces():
    text = b"one\r\ntwo\n\nthree\n"
    for size in range(1, len(text)):
        lines = Lines()
        found = [line for at in range(0, len(text), size) for line in lines.feed(text[at : at + size])]
        assert found == [b"one", b"two", b"three"]


def test_a_line_without_end_is_handed_on_and_passed_over_to_its_end():
    lines = Lines()
    found = [line for _ in range(100) for line in lines.feed(b"x" * 100)]
    assert lines.held <= MAX_LINE
    assert sum(len(line) > MAX_LINE for line in found) == 1
    assert lines.feed(b"rest\nnext\n") == [b"next"]


# --- static places ----------------------------------------------------------------------------------


@asynccontextmanager
async def placed(path, text):
    """Let a file of places be read; yield the world."""
    path.write_text(text)
    world = World()
    async with running(StaticPlaces("places", path).run(world)):
        await wait()
        yield world


@simulated
async def test_what_is_not_read_of_a_file_of_places_is_reported_by_kind(tmp_path):
    plan = json.loads(write_plan([point(37.0, -8.6)], 100.0))
    plan["rallyPoints"]["points"] = [[37.0, -8.6, 20], [37.1, -8.6, 20]]
    async with placed(tmp_path / "survey.plan", json.dumps(plan)) as world:
        await until(lambda: troubles(world), 5)
    assert troubles(world) == {"survey.plan: 2 x rally point, not read": 1}


@simulated
async def test_places_are_published_and_again_when_their_file_changes_and_stay_when_it_cannot_be_read(
    tmp_path,
):
    path = tmp_path / "places.geojson"
    async with placed(path, write_geojson([PLACE, SPILL])) as world:
        assert [published.entity for published in world.published] == ["oilSpill0", "searchArea0"]
        world.published.clear()
        path.write_text(write_geojson([SPILL.at(box((37.0, -8.6), (36.99, -8.61)))]))
        await asyncio.sleep(3)
        changed = [("Gone", "searchArea0"), ("PhysicalProperty", "oilSpill0")]
        assert [(type(item).__name__, item.entity) for item in world.published] == changed
        assert world.reports == []
        path.write_text("{")
        await asyncio.sleep(3)
        path.unlink()
        await asyncio.sleep(3)
        assert (len(world.published), world.troubles()) == (2, {"places unreadable"})
    with pytest.raises(PhysicalError, match="cannot read the places"):
        await StaticPlaces("places", path).run(World())


@pytest.mark.parametrize(("name", "write"), [("path.plan", write_plan), ("path.waypoints", write_waypoints)])
@simulated
async def test_the_points_of_plans_and_waypoint_files_are_places(tmp_path, name, write):
    async with placed(tmp_path / name, write((point(37.0, -8.6), point(37.01, -8.61)), 100.0)) as world:
        assert [known.entity for known in world.published] == ["waypoint0", "waypoint1", "waypoint2"]
        assert world.published[2].geometry == point(37.01, -8.61)


# --- location service -------------------------------------------------------------------------------

DRIFTER = {"name": "drifter0", "kind": "Drifter", "latitude": 37.0, "longitude": -8.7}


async def located(document, status=200, **options):
    """Ask a service that answers with a document, for three seconds."""

    async def answer(_request):
        body = document if isinstance(document, bytes) else json.dumps(document).encode()
        return aiohttp.web.Response(body=body, status=status, content_type="application/json")

    world = World()
    async with answering(answer) as url, running(LocationService("cloud", url, **options).run(world)):
        await asyncio.sleep(3)
    return world


@simulated
async def test_a_location_service_is_asked_again_and_again():
    entity = DRIFTER | {"altitude": 0, "speed": 0.4, "course": 480, "channels": ["sat"]}
    world = await located({"entities": [entity]})
    assert len(world.published) >= 2
    known = world.published[0].property
    assert (known.entity, known.kind, known.geometry) == ("drifter0", "Drifter", point(37.0, -8.7))
    assert (known.velocity.speed, known.velocity.course, known.channels) == (0.4, 120, ("sat",))


@pytest.mark.parametrize(
    ("document", "what"),
    [
        (b"{", "answer unreadable"),
        (b"[" * 100_000, "answer unreadable"),
        ({"entities": 5}, "answer unreadable"),
        ({"entities": [5]}, "entity refused"),
        ({"entities": [DRIFTER | {"latitude": 91}]}, "entity refused"),
        ({"entities": [DRIFTER | {"latitude": "37"}]}, "entity refused"),
        ({"entities": [DRIFTER | {"altitude": 10**299}]}, "entity refused"),
        ({"entities": [DRIFTER | {"altitude": 10**300}]}, "answer unreadable"),
        ({"entities": [DRIFTER | {"name": "\x1b[31m"}]}, "entity refused"),
        ({"entities": [DRIFTER | {"channels": 1}]}, "entity refused"),
        ({"entities": [DRIFTER | {"time": 9e9}]}, "entity refused"),
        ({"entities": [DRIFTER | {"time": 1}]}, "time stamp too old"),
        (b"x" * 2_000_000, "no answer"),
    ],
)
@simulated
async def test_an_answer_that_cannot_be_used_is_reported(document, what):
    world = await located(document)
    assert world.published == []
    assert world.troubles() == {what}


FULL = DRIFTER | {"altitude": 0, "speed": 0.4, "course": 120, "time": 1e9, "channels": ["sat"]}


@examples(300)
@given(mutated([{"entities": [FULL, DRIFTER]}]))
def test_an_answer_with_a_fault_is_read_or_refused_and_so_is_each_of_its_entities(body):
    with suppress(PhysicalError):
        for entry in read_typed(body, web.MAX_BODY, location_feed._Answer).entities:
            with suppress(PhysicalError):
                found = location_feed._property(entry, 1e9, "cloud")
                assert is_word(found.entity)
                assert is_word(found.kind)
                assert all(map(is_word, found.channels))
                assert found.time <= 1e9


@simulated
async def test_a_location_cannot_take_the_name_of_a_vehicle():
    naming = NamingService(own={"vehicle:uav0": "uav0"})
    world = await located({"entities": [DRIFTER | {"name": "uav0"}, DRIFTER]}, naming=naming)
    assert names(world) == {"drifter0"}
    assert "name:uav0 would be called uav0, as vehicle:uav0 is" in world.of(Trouble)[0].detail


@simulated
async def test_a_service_that_is_not_there_or_fails_is_reported():
    world = await located({}, status=500)
    assert world.troubles() == {"no answer"}
    world = World()
    async with running(LocationService("cloud", "http://127.0.0.1:1/").run(world)):
        await asyncio.sleep(2)
    assert world.troubles() == {"no answer"}
