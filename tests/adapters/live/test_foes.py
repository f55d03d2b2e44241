"""Whole missions among faults and foes: flown by `bigactors run`'s own loop over sockets, audited by the truth.

Each ends as it should or stops safely, and nothing is committed that the simulated vehicle did not do.
"""

import asyncio
import json
import socket
from collections import deque
from contextlib import suppress
from functools import partial
from pathlib import Path

import aiohttp
import pytest
from audited import PATROL, PLACES, SHUTTLE, airborne, copter, flown_in
from live_missions import EAST
from packets import beat, fixed, position
from pyais.encode import encode_dict
from scale import soak

from adapters.mavlink import signing
from adapters.mavlink.codec import Encoder
from adapters.mavlink.command import long
from adapters.mavlink.constants import Cmd
from adapters.mavlink.message import say
from adapters.mavlink.tlog import read_tlog
from adapters.simulated import Disturbance, Kind, Vehicle
from bigactors.mistakes import Mistake
from physical import PhysicalProperty, box, point, write_geojson

pytestmark = pytest.mark.long


@pytest.fixture
def flying(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    return partial(flown_in, tmp_path)


# --- the link -------------------------------------------------------------------------------------------

BAD = Disturbance(loss=0.3, duplication=0.1, delay=(0.0, 1.0))


@soak  # test_flying has a shorter one
def test_the_oil_spill_mission_completes_though_a_third_is_lost_and_the_rest_comes_late_and_twice(
    flying, tmp_path
):
    (tmp_path / "camera").mkdir()

    async def camera(_flight, _simulator, witness):
        while "commit" not in witness.rules:
            await asyncio.sleep(1.0)
        spill = PhysicalProperty("oilSpill0", "OilSpill", PLACES["oilSpill0"])
        (tmp_path / "camera" / "spill.geojson").write_text(write_geojson([spill]))

    plane = Vehicle(Kind.PLANE, (37.147, -8.582, 20.0))
    feed = "--feed=detections=folder:camera"
    more = [feed, "--time-to-live=detections=5000"]
    flown = flying("spill_watch", plane, *more, disturbance=BAD, foe=camera, seconds=5000)
    assert flown.ended
    assert not flown.broken
    assert flown.witness.rules.count("commit") == 3
    assert flown.inside("airfield0")


def test_blackouts_of_ten_seconds_only_delay_a_mission_that_allows_for_them(flying):
    blackouts = tuple((start, start + 10.0) for start in range(15, 1500, 90))
    flown = flying(PATROL, copter(), disturbance=Disturbance(blackouts=blackouts))
    assert flown.ended
    assert not flown.broken
    assert {"lost link", "link restored"} <= flown.witness.kinds()
    assert flown.inside("west0")


# --- foes -----------------------------------------------------------------------------------------------


def _post(flight, *frames):
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as link:
        for frame in frames:
            link.sendto(frame, flight.plugins[0].local)


async def watchdog(_flight, simulator, witness):
    await airborne(witness)
    simulator.reboot(1, armed=True)


async def jammer(_flight, _simulator, witness):
    await airborne(witness)
    witness.vehicle.fixed = False  # says (0, 0)
    await asyncio.sleep(60)
    witness.vehicle.fixed = True


async def wrong_clock(_flight, simulator, witness):
    """A clock in the past and in the future."""
    await airborne(witness)
    for clock in (0, 1, 2**32 - 1) * 7:
        time = say("SYSTEM_TIME", time_unix_usec=2**60, time_boot_ms=clock)
        simulator._broadcast(witness.vehicle, [time])
        await asyncio.sleep(1)


def there(clock):
    return position(EAST, clock, 120_000, 100_000)


async def other_station(flight, _simulator, _witness):
    encoder = Encoder(253, 190)
    empty = say("MISSION_COUNT", target_system=1, target_component=1, count=0, mission_type=0)
    ack = say("MISSION_ACK", target_system=1, target_component=1, type=0, mission_type=0)
    while True:
        _post(flight, *map(encoder.pack, (beat(6, 8, status=4), long(Cmd.DO_SET_MODE, 1, 1, 0), empty, ack)))
        await asyncio.sleep(0.5)


@pytest.mark.parametrize(
    ("foe", "told"),
    [
        (watchdog, "uav0 is heard again, rebooted"),
        (jammer, ""),
        (wrong_clock, ""),
        (other_station, "second ground station"),
    ],
)
def test_what_leaves_the_vehicle_as_it_was_told_is_said_and_the_mission_is_completed(flying, foe, told):
    flown = flying(SHUTTLE, copter(speedup=3.0 if foe is wrong_clock else 1.0), foe=foe)
    assert flown.ended
    assert told in flown.witness.told()
    assert foe in (watchdog, other_station) or not flown.broken
    assert flown.inside("west0")


def test_forged_unsigned_and_replayed_packets_that_say_it_has_arrived_commit_nothing(flying, tmp_path):
    key = signing.new_key("shuttle")
    signing.save(signing.Signing(key), tmp_path / "key.json")

    async def forger(flight, _simulator, witness):
        await airborne(witness)
        unsigned, forged = Encoder(1, 1), Encoder(1, 1, signing.new_key("guess"))
        for number in range(200):
            _post(flight, unsigned.pack(there(10**9 + number)))
            _post(flight, forged.pack(there(10**9 + number), 10**15 + number))
            _post(flight, *(bytes(frame) for frame in list(heard)[:3]))
            await asyncio.sleep(0.1)
        assert "commit" not in witness.rules

    heard = deque(maxlen=50)
    vehicle = copter(signing=signing.Signing(key))
    log = tmp_path / "r.tlog"

    async def eavesdropper(flight, simulator, witness):
        await airborne(witness, -8.645)
        heard.extend(message.raw for _, message in list(read_tlog(log))[-50:])
        await forger(flight, simulator, witness)

    flown = flying(SHUTTLE, vehicle, f"--key={tmp_path / 'key.json'}", foe=eavesdropper)
    assert flown.ended
    told = flown.witness.told()
    for trouble in ("unsigned packet", "forged signature", "replayed packet"):
        assert trouble in told
    assert signing.load(tmp_path / "key.json").timestamp > 0


def test_a_second_source_that_says_that_it_has_arrived_commits_nothing_and_hears_no_command(flying):
    heard = []

    async def impostor(flight, _simulator, witness):
        await airborne(witness)
        encoder, clock = Encoder(1, 1), 10**7
        with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as link:
            link.setblocking(False)
            while "commit" not in witness.rules:
                clock += 100
                for message in (beat(2, 3, status=4), fixed(), there(clock)):
                    link.sendto(encoder.pack(message), flight.plugins[0].local)
                await asyncio.sleep(0.1)
                with suppress(BlockingIOError):
                    heard.append(link.recv(2_000))

    flown = flying(SHUTTLE, copter(), foe=impostor)  # each commit is held against where the vehicle was
    assert flown.ended
    assert heard == []
    assert flown.witness.told().count("second source of uav0") == 1


# --- names ----------------------------------------------------------------------------------------------


def feature(name, kind, at):
    return json.loads(write_geojson([PhysicalProperty(name, kind, at)]))


def test_a_posted_detection_cannot_take_the_name_of_a_vehicle_or_a_place(flying, tmp_path):
    (tmp_path / "token").write_text("sesame\n")
    answers = []

    async def poster(flight, _simulator, witness):
        camera = flight.plugins[1]
        await airborne(witness)
        headers = {"Authorization": "Bearer sesame"}
        at = f"http://127.0.0.1:{camera.port}/detections"
        async with aiohttp.ClientSession(headers=headers) as session:
            for name, kind in (
                ("uav0", "Spill"),
                ("uav0", "UAV"),
                ("east0", "Location"),
                ("spill0", "Spill"),
            ):
                async with session.post(at, json=feature(name, kind, point(*EAST))) as answer:
                    answers.append((name, answer.status, await answer.text()))

    more = ("--feed=detections=http:0", "--token=token")
    flown = flying(SHUTTLE, copter(), *more, foe=poster, seconds=400)
    assert [status for _, status, _ in answers] == [400, 400, 400, 200]
    assert "name:uav0 would be called uav0, as vehicle:uav0 is" in answers[0][2]
    assert "UAV is not a kind that may be detected" in answers[1][2]
    assert "name:east0 would be called east0, as place:east0 is" in answers[2][2]
    assert "detection refused" in flown.witness.told()
    assert (
        flown.broken
    )  # by spill0, of which the mission says nothing: vehicles return, and nothing is untrue


def test_a_transponder_that_the_table_calls_as_a_vehicle_is_the_users_mistake(flying):
    with pytest.raises(Mistake, match="mmsi:263999001 would be called uav0, as vehicle:uav0 is"):
        flying(SHUTTLE, copter(), "--feed=ais=udp:0", "--name=mmsi:263999001=uav0")
    with pytest.raises(Mistake, match="mmsi:263999001 would be called east0, as place:east0 is"):
        flying(SHUTTLE, copter(), "--feed=ais=udp:0", "--name=mmsi:263999001=east0")


def ais(mmsi, at, heard=None):
    """A position, with the receiver's time in a tag block if one is given."""
    more = {"speed": 0, "course": 0, "heading": 511}
    (line,) = encode_dict(
        {"type": 1, "mmsi": mmsi, "lat": at[0], "lon": at[1], **more}, talker_id="AI", sentence_type="VDM"
    )
    if heard is None:
        return f"{line}\r\n".encode()
    tag = f"c:{heard:.0f}"
    check = 0
    for sign in tag.encode():
        check ^= sign
    return f"\\{tag}*{check:02X}\\{line}\r\n".encode()


def test_positions_from_the_past_and_the_future_neither_move_a_drifter_nor_silence_it(flying):
    """Of long ago: outside of its place, which would break an assumption. Of the future: where it is."""

    async def liar(flight, _simulator, witness):
        feed = flight.plugins[1]
        await airborne(witness)
        with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as link:
            for at, shift in (((37.5, -8.0), -3600), ((37.0111, -8.6511), 3600), ((37.0112, -8.6512), 0)):
                link.sendto(ais(263999001, at, feed._world.now() + shift), feed.local)
                await asyncio.sleep(2)

    more = ("--feed=ais=udp:0", "--name=mmsi:263999001=drifter0")
    flown = flying(SHUTTLE, copter(), *more, foe=liar)
    assert flown.ended
    assert not flown.broken
    told = flown.witness.told()
    assert "time stamp too old" in told
    assert "time stamp in the future" in told
    seen = flown.ending.state.sightings.newest["drifter0"].property.geometry.vertices[0]
    assert seen == pytest.approx((37.0112, -8.6512), abs=1e-5)


async def spoofer(flight, _simulator, witness):
    await airborne(witness)
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as link:
        link.sendto(ais(263999001, (37.011, -8.61)), flight.plugins[1].local)


def places(*corners):
    east = PhysicalProperty("east0", "Location", box(*corners))
    Path("places.geojson").write_text(write_geojson([east]))


async def surveyor(_flight, _simulator, witness):
    await airborne(witness)
    assert not witness.findings
    places((37.0115, -8.6505), (37.0105, -8.6515))  # onto the drifter


LONG_BLACKOUT = {"disturbance": Disturbance(blackouts=((120.0, 130.0),))}


@pytest.mark.parametrize(
    ("line", "how", "told"),
    [
        pytest.param(
            [],
            LONG_BLACKOUT,
            "uav0 is not on control:gcs0 any more; the mission does not let it leave",
            id="blackout",
        ),
        pytest.param(
            ["--feed=ais=udp:0", "--name=mmsi:263999001=drifter0"],
            {"foe": spoofer},
            "drifter0 is in east0; the mission does not let it drift",
            id="a transponder that jumps",
        ),
        pytest.param(
            ["--feed=places=places.geojson"],
            {"foe": surveyor},
            "east0 is in west0 and contains drifter0",
            id="a file of places that changes in flight",
        ),
    ],
)
def test_what_the_mission_does_not_allow_for_breaks_an_assumption_and_the_vehicle_returns(
    flying, line, how, told
):
    places((37.02, -8.60), (37.00, -8.62))
    flown = flying(SHUTTLE, copter(), *line, seconds=600, **how)
    assert flown.broken
    assert told in flown.witness.told()
    assert "commit" not in flown.witness.rules
    assert flown.inside("west0")
