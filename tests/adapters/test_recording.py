"""The recorded real autopilot: we read it as it is, and our simulated vehicle behaves like it where we rely on it."""

import asyncio
from collections import Counter
from itertools import islice, pairwise
from math import pi, radians
from statistics import median

import pytest
from worlds import DATA, flight

from adapters.mavlink import Craft
from adapters.mavlink.codec import Decoder
from adapters.mavlink.telemetry import Telemetry, absorb
from adapters.mavlink.tlog import positions_of, read_tlog
from adapters.plugin import Follow
from adapters.simulated import Kind, run
from physical import contains, distance, point, read_waypoints
from physical.shape import box

FOLDER = DATA / "mavlink"
PLANE, COPTER = FOLDER / "plane_portimao.tlog", FOLDER / "copter_flight_2015.tlog"

pytestmark = pytest.mark.skipif(not PLANE.exists(), reason=f"no recordings in {FOLDER}; set BIGACTORS_DATA")


@pytest.fixture(scope="module")
def recorded():
    """The messages of the recorded plane, by the clock of the vehicle, which ran ten times faster."""
    log = list(read_tlog(PLANE))
    start = log[0][0]
    return [((time - start) * 10, message) for time, message in log]


@pytest.fixture(scope="module")
def simulated():
    """What our plane says when it flies the same mission."""
    frames, heard = [], []
    stops = [item.point for item in read_waypoints((FOLDER / "portimao.waypoints").read_text())[2:]]

    async def main():
        async with flight(tap=lambda time, raw: frames.append((time, raw))) as f:
            await f.plugin.command(Follow("r1", "uav0", tuple(stops)))
            await f.ended("r1", 900)
            await asyncio.sleep(60)

    run(main())
    for time, raw in frames:
        (message,) = Decoder().feed(raw)
        heard.append((time - frames[0][0], message))
    return heard


def of(log, name):
    return [(time, message) for time, message in log if message.name == name and message.system == 1]


def tracks(log):
    """Our view of the vehicle after each of its messages."""
    known = Telemetry()
    for time, message in log:
        if message.system == 1:
            known = absorb(known, message, time)
            yield time, known


def flown(log):
    """The different positions of the vehicle in the air."""
    found = {}
    for _, known in tracks(log):
        if known.position and known.flying:
            found[known.position.time] = known.position
    return list(found.values())


def test_the_recording_is_read_whole(recorded):
    counts = Counter(message.name for _, message in recorded)
    assert (counts["GLOBAL_POSITION_INT"], counts["HEARTBEAT"], counts["MISSION_ITEM_REACHED"]) == (
        731,
        148,
        3,
    )


def test_positions_before_the_fix_are_left_out():
    found = [known for _, known in positions_of(read_tlog(PLANE), {1: Craft("uav0")})]
    assert 640 < len(found) < 731
    area = box((37.02, -8.59), (36.99, -8.62))
    assert all(contains(area, known.geometry) for known in found)


def test_a_real_quadcopter_is_read_with_its_bad_data_and_its_reboot():
    log = list(islice(read_tlog(COPTER), 20_000))
    found = [known for _, known in positions_of(log, {1: Craft("uav0")})]
    heard = sum(message.name == "GLOBAL_POSITION_INT" for _, message in log)
    assert (
        0.4 * heard < len(found) < 0.5 * heard
    )  # its filter needs 84 s after the fix, and 6 s after the reboot
    assert all(-35.4 < known.geometry.vertices[0][0] < -35.2 for known in found)
    assert all(148 < known.geometry.vertices[0][1] < 150 for known in found)
    assert [known.boots for _, known in tracks(log)][-1] == 1


@pytest.mark.parametrize(
    "name", ["HEARTBEAT", "GLOBAL_POSITION_INT", "SYS_STATUS", "MISSION_CURRENT", "GPS_RAW_INT"]
)
def test_messages_come_at_the_recorded_rates(recorded, simulated, name):
    gaps = [median(b - a for (a, _), (b, _) in pairwise(of(log, name)[30:])) for log in (recorded, simulated)]
    assert gaps[1] == pytest.approx(gaps[0], rel=0.1)


def test_the_upload_is_asked_for_in_the_recorded_order(recorded, simulated):
    asked = [
        [message["seq"] for _, message in of(log, "MISSION_REQUEST") if message["mission_type"] == 0]
        for log in (recorded, simulated)
    ]
    assert asked[0] == asked[1] == [0, 1, 2, 3, 4]
    acks = [[message["type"] for _, message in of(log, "MISSION_ACK")] for log in (recorded, simulated)]
    assert acks[0] == acks[1] == [0]


def test_the_upload_comes_after_the_vehicle_says_that_it_is_ready(recorded, simulated):
    for log in (recorded, simulated):
        ready = next(time for time, known in tracks(log) if known.healthy)
        assert 15 < ready < 22
        assert of(log, "MISSION_REQUEST")[0][0] >= ready - 1


def test_the_states_of_the_flight_come_in_the_recorded_order(recorded, simulated):
    orders = []
    for log in (recorded, simulated):
        states = [
            (known.armed, known.active, known.mode == 10)
            for _, known in tracks(log)
            if known.mode is not None
        ]
        armed = [state for state, after in pairwise(states) if state != after] + states[-1:]
        orders.append([state for state in armed if state[2]])
    assert orders[0] == [(True, False, True), (True, True, True)]
    assert orders[1][-2:] == orders[0]


def test_items_are_reached_and_pursued_in_the_recorded_order(recorded, simulated):
    for log in (recorded, simulated):
        assert [message["seq"] for _, message in of(log, "MISSION_ITEM_REACHED")] == [1, 2, 3]
        current = [message["seq"] for _, message in of(log, "MISSION_CURRENT")]
        assert list(dict.fromkeys(current))[-4:] == [1, 2, 3, 4]


def test_the_plane_takes_the_next_waypoint_at_the_recorded_distance(recorded, simulated):
    stop = point(37.006, -8.61)
    nearest = []
    for log in (recorded, simulated):
        time = next(time for time, message in of(log, "MISSION_ITEM_REACHED") if message["seq"] == 2)
        at = [known.position for moment, known in tracks(log) if moment <= time and known.position][-1]
        nearest.append(distance(point(at.latitude, at.longitude), stop))
    assert nearest == [pytest.approx(50, abs=6), pytest.approx(50, abs=6)]


def test_speed_climb_and_turns_are_the_recorded_ones(recorded, simulated):
    measured = []
    for log in (recorded, simulated):
        positions = flown(log)
        cruise = median(at.speed for at in positions if at.height > 70)
        climb = median(at.climb for at in positions if 10 < at.height < 50)
        measured.append((cruise, climb, hardest_turn(positions)))
    (cruise, climb, hard), (our_cruise, our_climb, our_hard) = measured
    assert our_cruise == pytest.approx(cruise, rel=0.03)
    assert our_climb == pytest.approx(climb, rel=0.15)
    assert our_hard == pytest.approx(hard, rel=0.35)


def hardest_turn(positions):
    """Return the rate of turn in degrees a second that is exceeded in 2 % of a cruise."""
    turns = [
        abs((b.course - a.course + 180) % 360 - 180) / (b.time - a.time)
        for a, b in pairwise(positions)
        if a.height > 70 and b.time > a.time
    ]
    return sorted(turns)[int(len(turns) * 0.98)]


def test_the_circle_that_a_place_must_hold_is_one_that_the_recorded_plane_can_fly(recorded):
    """The recording ends before its loiter: its turns say how tight a circle could be."""
    tightest = 22.2 / radians(hardest_turn(flown(recorded)))
    assert 40 < tightest < Kind.PLANE.profile.circle
    assert 2 * pi * Kind.PLANE.profile.circle / 22.2 < 30


def test_our_plane_circles_at_the_radius_that_was_seen_in_guided_mode(simulated):
    centre = point(36.998, -8.6)
    last = [at for at in flown(simulated) if at.time > simulated[-1][0] - 20]
    radii = [distance(point(at.latitude, at.longitude), centre) for at in last]
    assert len(radii) > 50
    assert all(75 < radius < 90 for radius in radii)


def test_the_simulated_plane_says_of_its_mission_what_the_true_one_said(recorded, simulated):
    def said(log):
        texts = (message["text"].partition(" dist")[0] for _, message in of(log, "STATUSTEXT"))
        return [text for text in texts if text.startswith(("Mission: ", "Reached ", "Throttle "))]

    assert sorted(said(simulated)) == sorted(said(recorded))
    assert len(said(recorded)) == 7
