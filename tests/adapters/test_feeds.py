"""Feeds: AIS, static places, detections and a location service, over real sockets and files."""

import asyncio
import json
import os
import pty
import socket
from contextlib import suppress

import aiohttp.web
import pytest
from hypothesis import given
from json_mutations import mutated
from scale import examples
from worlds import DATA, World, running, simulated, until

from adapters import location, web
from adapters.ais import AisFeed
from adapters.detections import Detections
from adapters.lines import MAX_LINE, Lines
from adapters.location import LocationService
from adapters.naming import NamingService
from adapters.plugin import Aged, Gone, Trouble
from adapters.simulated import run
from adapters.static_places import StaticPlaces
from adapters.typed_json import read_typed
from adapters.web import Listen, serve
from physical import PhysicalError, box, is_word, point, write_geojson, write_plan, write_waypoints
from physical.geojson import read_geojson
from physical.physical_property import PhysicalProperty

VESSEL = rb"!AIVDM,1,1,,B,35VwAv0300QcEQ`EGcpN40jD0PUQ,0*61"
BAD = rb"!AIVDM,1,1,,B,35VwAv0300QcEQ`EGcpN40jD0PUQ,0*62"
PLACE = PhysicalProperty("searchArea0", "Location", box((37.04, -8.59), (36.94, -8.79)))
SPILL = PhysicalProperty("oilSpill0", "OilSpill", box((37.0, -8.7), (36.99, -8.71)))


def names(world):
    return {published.property.entity for published in world.published if isinstance(published, Aged)}


async def wait(seconds=0.05):
    await asyncio.sleep(seconds)


# --- AIS --------------------------------------------------------------------------------------------


@simulated
async def test_ais_comes_by_udp_with_or_without_line_ends():
    world, feed = World(), AisFeed("ais", "udp:0")
    async with running(feed.run(world)):
        await until(lambda: feed.local)
        with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as link:
            link.sendto(VESSEL, feed.local)
            await wait()
            assert names(world) == {"mmsi376427000"}
            link.sendto(VESSEL + b"\r\n" + VESSEL + b"\n", feed.local)
            await wait()
        known = world.published[-1]
        assert len(world.published) == 3
        assert (known.property.source, known.property.kind) == ("ais", "Vessel")
        assert known.property.time == pytest.approx(world.now(), abs=1)
        assert known.time_to_live == 600.0
        assert feed.local[0] == "127.0.0.1"


@simulated
async def test_ais_comes_by_tcp_in_pieces_and_the_connection_is_made_again():
    world = World()
    connections = []

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
    assert len(world.published) == 3


def test_ais_comes_by_a_serial_line():
    master, slave = pty.openpty()
    try:

        async def main():
            world, feed = World(), AisFeed("ais", f"serial:{os.ttyname(slave)}:38400")
            async with running(feed.run(world), report_again()):
                await until(lambda: names(world) == {"mmsi376427000"}, 10)

        async def report_again():
            """Send the sentence again and again, as a vessel does: what comes before the port is open is lost."""
            while True:
                os.write(master, VESSEL + b"\r\n")
                await wait(0.1)

        asyncio.run(main())
    finally:
        os.close(master)
        os.close(slave)


@simulated
async def test_a_recording_is_played_at_the_pace_of_its_times_as_if_heard_now(tmp_path):
    path = tmp_path / "recording.nmea"
    path.write_bytes(
        b"\n".join(rb"\c:%d*%02X\%s" % (time, checksum(b"c:%d" % time), VESSEL) for time in (1000, 1030))
    )
    world, feed = World(), AisFeed("ais", f"file:{path}")
    async with running(feed.run(world)):
        await feed.played.wait()
        first, second = (published.property.time for published in world.published)
        assert second - first == pytest.approx(30, abs=0.1)
        assert second == pytest.approx(world.now(), abs=0.1)


def checksum(text):
    total = 0
    for byte in text:
        total ^= byte
    return total


@simulated
async def test_a_recording_that_is_not_there_says_so():
    with pytest.raises(OSError, match="No such file"):
        await AisFeed("ais", "file:/nowhere/at/all").run(World())


@pytest.mark.skipif(not DATA.exists(), reason=f"no recordings in {DATA}; set BIGACTORS_DATA")
@simulated
async def test_a_real_recording_is_filtered_by_area_and_kind():
    path = DATA / "ais" / "workum_2020.nmea"

    async def heard(**filters):
        world, feed = World(), AisFeed("ais", f"file:{path}", **filters)
        async with running(feed.run(world)):
            await feed.played.wait()
        return world

    every = await heard()
    vessels = await heard(kinds=["Vessel"])
    marina = box((52.86, 5.72), (52.83, 5.69))
    inside = await heard(area=marina)
    assert len(names(every)) == 30
    assert {published.property.kind for published in vessels.published} == {"Vessel"}
    assert 0 < len(names(vessels)) <= 30
    assert 0 < len(names(inside)) < 30


def test_a_kind_that_is_none_is_the_users_mistake():
    with pytest.raises(PhysicalError, match="no station is of kind 'Submarine'"):
        AisFeed("ais", "udp:0", kinds=["Submarine"])


@simulated
async def test_what_cannot_be_heard_is_counted_and_reported_once_a_second():
    world, feed = World(), AisFeed("ais", "udp:0")
    async with running(feed.run(world)):
        await until(lambda: feed.local)
        with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as link:
            for _ in range(100):
                link.sendto(BAD, feed.local)
        await asyncio.sleep(3)
        (trouble,) = world.of(Trouble)
        assert (trouble.source, trouble.what, trouble.count) == ("ais", "checksum wrong", 100)


@pytest.mark.parametrize(
    ("shift", "what"), [(3600, "time stamp in the future"), (-3600, "time stamp too old")]
)
@simulated
async def test_time_stamps_of_the_future_are_cut_and_those_of_long_ago_dropped(shift, what):
    world, feed = World(), AisFeed("ais", "udp:0")
    async with running(feed.run(world)):
        await until(lambda: feed.local)
        stamp = b"c:%d" % int(world.now() + shift)
        with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as link:
            link.sendto(rb"\%s*%02X\%s" % (stamp, checksum(stamp), VESSEL), feed.local)
        await asyncio.sleep(3)
        assert world.troubles() == {what}
        times = [published.property.time for published in world.published]
        assert len(times) == (shift > 0)
        assert all(time <= world.now() for time in times)


@simulated
async def test_a_transponder_cannot_take_the_name_of_another_entity():
    naming = NamingService({"mavlink:1": "mmsi376427000"})
    world, feed = World(), AisFeed("ais", "udp:0", naming)
    async with running(feed.run(world)):
        await until(lambda: feed.local)
        with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as link:
            link.sendto(VESSEL, feed.local)
        await asyncio.sleep(2)
        assert world.published == []
        assert world.troubles() == {"name-clash"}


@simulated
async def test_the_missions_table_names_a_transponder():
    world, feed = World(), AisFeed("ais", "udp:0", NamingService({"mmsi:376427000": "tanker0"}))
    async with running(feed.run(world)):
        await until(lambda: feed.local)
        with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as link:
            link.sendto(VESSEL, feed.local)
        await wait()
        assert names(world) == {"tanker0"}


COARSE = b"!AIVDM,1,1,,A,K39>JhChGASrwP00,0*50"
FINE = b"!AIVDM,1,1,,A,139>JhOP000eM?@N`o:00001P000,0*53"
BINARY = b"!AIVDM,1,1,,A,85Mwp`1Kf3aCnsNvBWLi=wQuNhA5t43N`5nCuI=p<IBfVqnMgPGs,0*47"


@simulated
async def test_a_coarse_position_does_not_move_who_was_heard_finely():
    world, feed = World(), AisFeed("ais", "udp:0")
    async with running(feed.run(world)):
        await until(lambda: feed.local)
        with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as link:
            for line in (COARSE, FINE, COARSE, FINE, COARSE):
                link.sendto(line, feed.local)
                await wait()
    tens = [round(published.property.geometry.vertices[0][0], 4) for published in world.published]
    assert tens == [53.545, 53.5446, 53.5446]
    assert (
        troubles(world)["position to a tenth of a minute, of a station with a finer one, not read in all"]
        == 2
    )


@simulated
async def test_what_brings_no_position_is_told_by_kind_at_once_and_in_all_at_the_end():
    world, feed = World(), AisFeed("ais", "udp:0")
    async with running(feed.run(world)):
        await until(lambda: feed.local)
        with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as link:
            for line in (BINARY, VESSEL, BINARY, b"$GPGSV,3,1,10*00", b"# a comment", BINARY):
                link.sendto(line, feed.local)
                await wait()
    told = troubles(world)
    assert told["message of type 8, without a position of its sender: such are not read"] == 1
    assert told["message of type 8, without a position of its sender, not read in all"] == 3
    assert told["sentence GPGSV, not read in all"] == 1
    assert len(told) == 4


@simulated
async def test_ais_comes_as_loggers_write_it():
    world, feed = World(), AisFeed("ais", "udp:0")
    async with running(feed.run(world)):
        await until(lambda: feed.local)
        now = int(world.now())
        lines = (
            b"%d.5 %s" % (now - 1, VESSEL),
            b"%s ( MSG: 1, ppm: 1.9 )" % VESSEL,
            b'{"class":"AIS","rxuxtime":%d,"nmea":["%s"]}' % (now, VESSEL),
            VESSEL + FINE,
        )
        with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as link:
            for line in lines:
                link.sendto(line, feed.local)
                await wait()
    assert len(world.published) == 5
    assert troubles(world) == {}


def troubles(world):
    found = {}
    for report in world.reports:
        if isinstance(report, Trouble):
            found[report.what] = found.get(report.what, 0) + report.count
    return found


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


@simulated
async def test_what_is_not_read_of_a_file_of_places_is_reported_by_kind(tmp_path):
    plan = json.loads(write_plan([point(37.0, -8.6)], 100.0))
    plan["rallyPoints"]["points"] = [[37.0, -8.6, 20], [37.1, -8.6, 20]]
    (tmp_path / "survey.plan").write_text(json.dumps(plan))
    world = World()
    async with running(StaticPlaces("places", tmp_path / "survey.plan").run(world)):
        await until(lambda: troubles(world), 5)
    assert troubles(world) == {"survey.plan: 2 x rally point, not read": 1}


@simulated
async def test_places_are_published_and_again_when_their_file_changes(tmp_path):
    path = tmp_path / "places.geojson"
    path.write_text(write_geojson([PLACE, SPILL]))
    world = World()
    async with running(StaticPlaces("places", path).run(world)):
        await wait()
        assert [published.entity for published in world.published] == ["oilSpill0", "searchArea0"]
        world.published.clear()
        moved = SPILL.at(box((37.0, -8.6), (36.99, -8.61)))
        path.write_text(write_geojson([moved]))
        await asyncio.sleep(3)
        assert [(type(item).__name__, item.entity) for item in world.published] == [
            ("Gone", "searchArea0"),
            ("PhysicalProperty", "oilSpill0"),
        ]


@pytest.mark.parametrize(("name", "write"), [("path.plan", write_plan), ("path.waypoints", write_waypoints)])
@simulated
async def test_the_points_of_plans_and_waypoint_files_are_places(tmp_path, name, write):
    path = tmp_path / name
    path.write_text(write((point(37.0, -8.6), point(37.01, -8.61)), 100.0))
    world = World()
    async with running(StaticPlaces("places", path).run(world)):
        await wait()
        assert [known.entity for known in world.published] == ["waypoint0", "waypoint1", "waypoint2"]
        assert world.published[2].geometry == point(37.01, -8.61)
        path.write_bytes(bytes(range(256)))
        await asyncio.sleep(3)
        assert world.troubles() == {"places unreadable"}


@simulated
async def test_places_that_cannot_be_read_any_more_stay_and_are_reported(tmp_path):
    path = tmp_path / "places.geojson"
    path.write_text(write_geojson([PLACE]))
    world = World()
    async with running(StaticPlaces("places", path).run(world)):
        await wait()
        path.write_text("{")
        await asyncio.sleep(3)
        path.unlink()
        await asyncio.sleep(3)
        assert world.published == list(read_geojson(write_geojson([PLACE])))
        assert world.troubles() == {"places unreadable"}


@simulated
async def test_places_that_are_not_there_at_the_start_are_the_users_mistake(tmp_path):
    with pytest.raises(PhysicalError, match="cannot read the places"):
        await StaticPlaces("places", tmp_path / "none.geojson").run(World())


# --- detections -------------------------------------------------------------------------------------


def posting(plugin, path="/detections"):
    return f"http://127.0.0.1:{plugin.port}{path}"


@simulated
async def test_detections_are_posted_and_withdrawn():
    world, plugin = World(), Detections("camera", listen=Listen(0), kinds=["OilSpill"])
    async with running(plugin.run(world)), aiohttp.ClientSession() as session:
        await until(lambda: plugin.port)
        async with session.post(posting(plugin), json=json.loads(write_geojson([SPILL]))) as answer:
            assert (answer.status, await answer.text()) == (200, "1 taken\n")
        (known,) = world.published
        assert (known.property, known.property.source) == (SPILL, "camera")
        async with session.delete(posting(plugin, "/detections/oilSpill0")) as answer:
            assert answer.status == 200
        assert isinstance(world.published[-1], Gone)
        async with session.delete(posting(plugin, "/detections/uav0")) as answer:
            assert answer.status == 404


@pytest.mark.parametrize(
    ("body", "kind", "status"),
    [
        (b"{", "application/json", 400),
        (write_geojson([PLACE]).encode(), "application/json", 400),  # of a kind that nobody expects
        (write_geojson([SPILL]).encode(), "text/plain", 415),  # as a web page could
        (b"[" * 500_000, "application/json", 400),
        (b" " * 1_040_000, "application/json", 413),
    ],
)
@simulated
async def test_what_is_no_detection_is_refused(body, kind, status):
    world, plugin = World(), Detections("camera", listen=Listen(0), kinds=["OilSpill"])
    async with running(plugin.run(world)), aiohttp.ClientSession() as session:
        await until(lambda: plugin.port)
        async with session.post(posting(plugin), data=body, headers={"Content-Type": kind}) as answer:
            assert answer.status == status
        assert world.published == []


POST = b"POST /detections HTTP/1.1\r\nHost: localhost\r\nContent-Type: application/json\r\n"


async def told(port, *parts):
    """Send a request in parts, and return the status of the answer; none where none comes within a moment."""
    reader, writer = await asyncio.open_connection("127.0.0.1", port)
    for part in parts:
        writer.write(part)
        await asyncio.sleep(0.1)
    try:
        return int((await asyncio.wait_for(reader.readline(), 0.3)).split()[1])
    except TimeoutError:
        return None
    finally:
        writer.close()
        await asyncio.sleep(0.1)


@pytest.mark.parametrize(
    ("parts", "status"),
    [
        ([b"POST /detections HTTP/1.1\r\nContent-Length: 0\r\n\r\n"], 400),
        ([POST + b"Content-Length: -5\r\n\r\n"], 400),
        ([POST + b"Content-Length: 99999999999999\r\n\r\n[", b"["], 413),
        ([POST + b"Content-Length: 1000\r\n\r\n["], None),  # and leaves
        ([POST + b"Content-Encoding: gzip\r\nContent-Length: 2\r\n\r\n[]"], 400),
        ([POST + b"Transfer-Encoding: chunked\r\n\r\nzz\r\n[]"], 400),
    ],
)
def test_what_a_client_gets_wrong_is_told_it_and_not_logged(parts, status, caplog):
    async def main():
        world, plugin = World(), Detections("camera", listen=Listen(0))
        async with running(plugin.run(world)):
            await until(lambda: plugin.port)
            assert await told(plugin.port, *parts) == status
        assert world.published == []

    run(main())
    assert [record.getMessage() for record in caplog.records if record.levelname == "ERROR"] == []


def test_a_bug_that_a_request_meets_is_logged_with_its_traceback(caplog):
    async def bug(_method, _path, _body):
        raise ZeroDivisionError

    async def main():
        async with serve(bug, Listen(0)) as port:
            assert await told(port, POST + b"Content-Length: 2\r\n\r\n[]") == 500

    run(main())
    assert [record.exc_info[0] for record in caplog.records if record.exc_info] == [ZeroDivisionError]


@simulated
async def test_a_detection_cannot_take_the_name_of_a_vehicle_and_a_token_is_asked_for():
    world, naming = World(), NamingService({"mavlink:1": "oilSpill0"})
    plugin = Detections("camera", listen=Listen(0, token="secret"), naming=naming)
    document = json.loads(write_geojson([SPILL]))
    async with running(plugin.run(world)), aiohttp.ClientSession() as session:
        await until(lambda: plugin.port)
        async with session.post(posting(plugin), json=document) as answer:
            assert answer.status == 401
        headers = {"Authorization": "Bearer secret"}
        async with session.post(posting(plugin), json=document, headers=headers) as answer:
            assert answer.status == 400
            assert "oilSpill0" in await answer.text()
        assert world.published == []


@pytest.mark.parametrize(
    ("host", "status"),
    [
        ("127.0.0.1", 200),
        ("localhost:8080", 200),
        ("LOCALHOST", 200),
        ("[::1]:8080", 200),
        ("evil.example", 421),
        ("127.0.0.1.evil.example:8080", 421),
        ("192.0.2.7", 421),
        ("", 421),
    ],
)
@simulated
async def test_a_page_whose_name_was_made_to_stand_for_this_machine_can_do_nothing(host, status):
    world, plugin = World(), Detections("camera", listen=Listen(0))
    async with running(plugin.run(world)), aiohttp.ClientSession(headers={"Host": host}) as session:
        await until(lambda: plugin.port)
        async with session.post(posting(plugin), json=json.loads(write_geojson([SPILL]))) as answer:
            assert answer.status == status
        async with session.delete(posting(plugin, "/detections/oilSpill0")) as answer:
            assert answer.status == status
        assert len(world.published) == (2 if status == 200 else 0)


@simulated
async def test_what_another_source_has_named_cannot_be_withdrawn_by_a_detection():
    world, naming = World(), NamingService()
    naming.name("name:drifter0")  # a location service has it
    plugin = Detections("camera", listen=Listen(0), naming=naming)
    async with running(plugin.run(world)), aiohttp.ClientSession() as session:
        await until(lambda: plugin.port)
        async with session.delete(posting(plugin, "/detections/drifter0")) as answer:
            assert answer.status == 404
        assert world.published == []


@simulated
async def test_detections_are_read_from_a_folder_when_a_file_is_new_or_changed(tmp_path):
    world = World()
    async with running(Detections("camera", folder=tmp_path).run(world)):
        await wait()
        (tmp_path / "one.geojson").write_text(write_geojson([SPILL]))
        (tmp_path / "bad.geojson").write_text("{")
        await asyncio.sleep(3)
        assert names(world) == {"oilSpill0"}
        assert len(world.published) == 1
        assert world.troubles() == {"detection unreadable"}


# --- location service -------------------------------------------------------------------------------

DRIFTER = {"name": "drifter0", "kind": "Drifter", "latitude": 37.0, "longitude": -8.7}


async def located(document, status=200, **options):
    """Ask a service that answers with a document, for three seconds."""

    async def answer(_request):
        body = document if isinstance(document, bytes) else json.dumps(document).encode()
        return aiohttp.web.Response(body=body, status=status, content_type="application/json")

    application = aiohttp.web.Application()
    application.router.add_get("/", answer)
    runner = aiohttp.web.AppRunner(application, access_log=None)
    await runner.setup()
    site = aiohttp.web.TCPSite(runner, "127.0.0.1", 0)
    await site.start()
    world = World()
    plugin = LocationService("cloud", f"http://127.0.0.1:{runner.addresses[0][1]}/", **options)
    async with running(plugin.run(world)):
        await asyncio.sleep(3)
    await runner.cleanup()
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
        for entry in read_typed(body, web.MAX_BODY, location._Answer).entities:
            with suppress(PhysicalError):
                found = location._property(entry, 1e9, "cloud")
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


# --- floods -------------------------------------------------------------------------------------------


def test_half_requests_take_neither_all_connections_nor_much_time(monkeypatch, caplog):
    """Who sends half a request makes room for others, and is cut off in time."""
    monkeypatch.setattr(web, "IN_TIME", 1.0)

    async def main():
        world, plugin = World(), Detections("camera", listen=Listen(0))
        async with running(plugin.run(world)), aiohttp.ClientSession() as session:
            await until(lambda: plugin.port)
            halves = []
            for _ in range(3 * web.MOST_CONNECTIONS):
                reader, writer = await asyncio.open_connection("127.0.0.1", plugin.port)
                writer.write(POST + b"Content-Le")
                halves.append((reader, writer))
            async with session.post(posting(plugin), json=json.loads(write_geojson([SPILL]))) as answer:
                assert answer.status == 200
            await asyncio.sleep(1.5)
            assert all([await _has_ended(reader) for reader, _ in halves])
            for _, writer in halves:
                writer.close()

    run(main())
    assert caplog.records == []


async def _has_ended(reader):
    try:
        return not await asyncio.wait_for(reader.read(), 0.5)
    except ConnectionResetError:
        return True


@simulated
async def test_each_request_has_a_connection_of_its_own():
    world, plugin = World(), Detections("camera", listen=Listen(0))
    async with running(plugin.run(world)):
        await until(lambda: plugin.port)
        reader, writer = await asyncio.open_connection("127.0.0.1", plugin.port)
        writer.write(POST + b"Content-Length: 2\r\n\r\n[]" + POST + b"Content-Length: 2\r\n\r\n[]")
        assert (await asyncio.wait_for(reader.read(), 5.0)).count(b"HTTP/1.1") == 1
        writer.close()
