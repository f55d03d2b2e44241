"""Plans and tasks as pure functions: what is done next, and how a task ends, without a vehicle."""

from dataclasses import replace

import pytest

from adapters.mavlink import Autopilot, pilot
from adapters.mavlink.constants import Cmd, MissionType, Result
from adapters.mavlink.items import route
from adapters.mavlink.message import say
from adapters.mavlink.next_step import FollowsCommand, Load, StepInput, Tell, Wait, next_step
from adapters.mavlink.pilot import Pilot
from adapters.mavlink.profiles import BOAT, COPTER, PLANE, ROVER, profile_of
from adapters.mavlink.task import PATIENCE
from adapters.mavlink.telemetry import Telemetry, VehiclePosition
from adapters.mavlink.vehicle_identities import Craft, Stations
from adapters.plugin import (
    Accepted,
    Arrived,
    Follow,
    GiveBack,
    GoTo,
    HandOver,
    Hold,
    Refused,
    Rejected,
    Return,
)
from physical import PhysicalError, box, point, waypoint

AREA = box((37.015, -8.61), (37.005, -8.625))
THERE = GoTo("r1", "uav0", AREA)
AT = VehiclePosition(37.0, -8.6, 20.0, 0.0, 0.0, 0.0, 0.0, 0.0)
READY = Telemetry(
    heard=0.0, mode=0, armed=False, active=False, position=AT, healthy=True, current=0, authority=255
)


NOTHING = dict.fromkeys(MissionType, ())
"""Read back, and empty."""


def step(profile, command=THERE, on_board=None, begun=False, **known):
    known = replace(READY, profile=profile, **known)
    on_board = NOTHING if on_board is None else on_board
    vehicle = StepInput(1, known, profile, on_board, None, profile.circle, 100.0, begun)
    return next_step(command, 254, vehicle)


def told(found):
    """The command that a step tells, and its second parameter where that is a mode."""
    number = found.message.fields.get("command")
    return (Cmd(number), found.message.fields.get("param2")) if number == Cmd.DO_SET_MODE else Cmd(number)


@pytest.mark.parametrize("profile", [PLANE, COPTER, ROVER, BOAT])
def test_nothing_is_sent_before_the_vehicle_knows_where_it_is_and_is_ready(profile):
    assert step(profile, position=None) == Wait("it has no position yet")
    assert step(profile, healthy=False) == Wait("it is not ready to be armed yet")
    assert step(profile, healthy=None) == Wait("it is not ready to be armed yet")


def test_a_plane_on_the_ground_loads_a_mission_begins_it_changes_its_mode_arms_and_climbs():
    load = step(PLANE)
    assert isinstance(load, Load)
    assert [item.command for item in load.items] == [Cmd.WAYPOINT, Cmd.TAKEOFF, Cmd.LOITER_UNLIMITED]
    assert [item.z for item in load.items[1:]] == [100.0, 100.0]
    loaded = {"on_board": NOTHING | {load.kind: load.items}}
    assert told(step(PLANE, **loaded)) == Cmd.SET_MISSION_CURRENT
    begun = loaded | {"begun": True}
    assert told(step(PLANE, **begun)) == (Cmd.DO_SET_MODE, PLANE.auto)
    assert told(step(PLANE, **begun, mode=PLANE.auto)) == Cmd.ARM_DISARM
    assert step(PLANE, **begun, mode=PLANE.auto, armed=True) == Wait("it takes off")
    flying = begun | {"armed": True, "active": True, "mode": PLANE.auto}
    assert step(PLANE, **flying, current=1) == Wait("it climbs")
    assert told(step(PLANE, **flying, current=2)) == Cmd.REPOSITION


def test_a_copter_changes_its_mode_arms_takes_off_and_is_sent_when_it_has_climbed():
    assert told(step(COPTER)) == (Cmd.DO_SET_MODE, COPTER.guided)
    guided = {"mode": COPTER.guided}
    assert told(step(COPTER, **guided)) == Cmd.ARM_DISARM
    climb = step(COPTER, **guided, armed=True)
    assert (told(climb), climb.message["param7"]) == (Cmd.TAKEOFF, 10.0)
    flying = guided | {"armed": True, "active": True}
    assert step(COPTER, **flying, position=replace(AT, height=7.9, climb=2.0)) == Wait("it climbs")
    assert told(step(COPTER, **flying, position=replace(AT, height=8.0, climb=2.0))) == Cmd.REPOSITION
    assert told(step(COPTER, **flying, position=replace(AT, height=3.0))) == Cmd.REPOSITION


@pytest.mark.parametrize("profile", [ROVER, BOAT])
def test_what_drives_takes_off_in_no_way(profile):
    assert told(step(profile)) == (Cmd.DO_SET_MODE, profile.guided)
    assert told(step(profile, mode=profile.guided)) == Cmd.ARM_DISARM
    assert told(step(profile, mode=profile.guided, armed=True, active=True)) == Cmd.REPOSITION


FLYING = {"armed": True, "active": True, "mode": PLANE.guided, "current": 2}


def test_it_is_on_its_way_when_it_tells_the_target_and_there_when_it_is_inside():
    assert isinstance(step(PLANE, **FLYING, target=(37.0, -8.6)), Tell)
    assert step(PLANE, **FLYING, target=(37.01, -8.6175)) == FollowsCommand(done=False)
    inside = replace(AT, latitude=37.01, longitude=-8.612, height=100.0)
    assert step(PLANE, **FLYING, target=(37.01, -8.6175), position=inside) == FollowsCommand(done=True)


def test_modes_alone_hold_and_return_and_authority_alone_hands_over():
    assert told(step(PLANE, Hold("r", "uav0"))) == (Cmd.DO_SET_MODE, PLANE.hold)
    assert told(step(PLANE, Return("r", "uav0"))) == (Cmd.DO_SET_MODE, PLANE.home)
    assert step(PLANE, Return("r", "uav0"), mode=PLANE.home, armed=True, home=(38.0, -8.6)) == FollowsCommand(
        done=False
    )
    assert step(PLANE, Return("r", "uav0"), mode=PLANE.home, armed=True, home=(37.0, -8.6)) == FollowsCommand(
        done=True
    )
    hand_over = HandOver("r", "uav0", "control:gcs0", "control:gcs1")
    assert step(PLANE, hand_over).message["param_value"] == 254
    assert step(PLANE, hand_over, authority=254) == FollowsCommand(done=True)


@pytest.mark.parametrize(
    ("kind", "name"),
    [(1, "plane"), (20, "plane"), (2, "copter"), (13, "copter"), (10, "rover"), (11, "boat")],
)
def test_kinds_come_from_the_heartbeat(kind, name):
    assert profile_of(kind, 3).kind == name
    assert profile_of(kind, 8) is None


# --- tasks ------------------------------------------------------------------------------------------


def begun(command=Hold("r1", "uav0"), **known):  # noqa: B008 - a value
    """A pilot that has been told something, and the time at which it began."""
    state = Pilot(Craft("uav0"), Stations({"gcs0": 255, "gcs1": 254}, ("gcs0",)), 1)
    state = replace(state, known=replace(READY, profile=PLANE, **known))
    return pilot.command(state, command, 0.0).pilot


def ticked(state, start, end, alive=True):
    """Let time pass; return the pilot, what was sent and what was reported."""
    sent, reports = [], []
    for tenth in range(round(start * 10), round(end * 10)):
        now = tenth / 10
        if alive:
            state = replace(state, known=replace(state.known, heard=now, beat=now))
        outcome = pilot.tick(state, now)
        state, sent, reports = outcome.pilot, sent + list(outcome.sent), reports + list(outcome.reports)
    return state, sent, reports


def ended(reports):
    return [report for report in reports if isinstance(report, Accepted | Arrived | Rejected)]


def of(sent, command):
    return [message for message in sent if message.fields.get("command") == command]


def test_a_step_that_is_never_taken_is_told_again_and_again_and_then_rejected_with_the_last_words():
    _, sent, reports = ticked(begun(words=((0.0, "Mode change failed"),)), 0, PATIENCE + 2)
    assert 25 < len(of(sent, Cmd.DO_SET_MODE)) < 35
    (end,) = ended(reports)
    assert (
        end.reason
        == "it was commanded to change to LOITER, and did not obey in 45 s; its last words: 'Mode change failed'"
    )


def test_patience_does_not_run_while_the_vehicle_is_not_heard():
    _, _, reports = ticked(begun(), 0, 300, alive=False)
    assert ended(reports) == []


def test_a_final_no_ends_it_at_once():
    state, _, _ = ticked(begun(), 0, 1)
    refusal = say("COMMAND_ACK", command=int(Cmd.DO_SET_MODE), result=int(Result.DENIED))
    outcome = pilot.hear(state, replace(refusal, system=1, component=1), 1.0)
    assert [report.reason for report in outcome.reports] == ["the vehicle refuses DO_SET_MODE: denied"]
    assert ticked(outcome.pilot, 1, 20)[2] == []


def test_an_acceptance_confirms_nothing():
    state, _, _ = ticked(begun(), 0, 1)
    accepted = say("COMMAND_ACK", command=int(Cmd.DO_SET_MODE), result=int(Result.ACCEPTED))
    outcome = pilot.hear(state, replace(accepted, system=1, component=1), 1.0)
    assert outcome.reports == ()
    state = replace(outcome.pilot, known=replace(outcome.pilot.known, mode=PLANE.hold))
    assert [type(report) for report in ended(ticked(state, 1.1, 1.5)[2])] == [Arrived]


def under_way():
    there = replace(READY, **FLYING, target=(37.01, -8.6175), profile=PLANE)
    state, _, reports = ticked(replace(begun(THERE), known=there), 0, 1)
    assert [type(report) for report in ended(reports)] == [Accepted]
    return state


def test_a_place_that_moves_on_does_not_take_a_vehicle_back_from_who_took_it_over():
    state, _, _ = ticked(replace(under_way(), known=replace(under_way().known, mode=5)), 1, 20)
    for told in (replace(THERE, place=box((37.02, -8.61), (37.01, -8.625))), Hold("r2", "uav0")):
        with pytest.raises(Refused, match="it was taken over: it is in FBWA"):
            pilot.command(state, told, 20.0)
    given = pilot.command(state, GiveBack("r3", "uav0"), 20.0).pilot
    assert pilot.command(given, replace(THERE, request="r4"), 20.0).pilot.moving.command.request == "r4"


def test_everything_is_said_by_the_station_that_has_the_authority_but_who_that_is_each_asks():
    """A vehicle that obeys the other station answers nobody else, and its one answer to the hand-over may be lost."""

    stations = Stations({"gcs0": 255, "gcs1": 254}, ("gcs0", "gcs1"))
    state = replace(begun(), stations=stations)
    handed = replace(state, known=replace(state.known, authority=254))
    for each, speaker in ((state, 255), (handed, 254)):
        said = ticked(each, 0, 2)[1]
        asked = {message.system for message in said if message.name == "PARAM_REQUEST_READ"}
        assert asked == {254, 255}
        assert {message.system for message in said if message.name != "PARAM_REQUEST_READ"} == {speaker}


@pytest.mark.parametrize(
    ("command", "why"),
    [
        (HandOver("r", "uav0", "control:gcs0", "control:nobody"), "no control channel"),
        (HandOver("r", "uav0", "control:gcs1", "control:gcs0"), "not on control:gcs1"),
        (HandOver("r", "uav0", "wifi", "control:gcs1"), "not on wifi"),
        (GoTo("r", "uav0", box((37.001, -8.6), (37.0, -8.601)), name="the yard"), "the yard is too small"),
    ],
)
def test_what_cannot_be_is_refused_at_once(command, why):
    with pytest.raises(Refused, match=why):
        begun(command)


def test_a_circle_that_leaves_the_fence_is_refused_although_its_centre_does_not():
    fence = box((37.0055, -8.61), (36.9, -8.7))
    state = replace(begun(), craft=Craft("uav0", fence=fence))
    path = (point(37.0, -8.62), point(37.005, -8.62))
    for command in (GoTo("r", "uav0", path[1]), Follow("r", "uav0", path)):
        with pytest.raises(Refused, match=r"a circle of 104 m around point\(37\.005, .*\) leaves the fence"):
            pilot.command(state, command, 1.0)
    with pytest.raises(Refused, match="outside the fence"):
        pilot.command(state, GoTo("r", "uav0", point(37.1, -8.62)), 1.0)
    pilot.command(state, GoTo("r", "uav0", point(37.0, -8.62)), 1.0)


@pytest.mark.parametrize("count", [0, 501])
def test_a_path_has_points_and_not_too_many(count):
    with pytest.raises(Refused, match=f"this one {count}"):
        begun(Follow("r", "uav0", (point(37.0, -8.62),) * count))


def test_at_a_point_it_is_there_when_it_circles_it():
    at = point(37.01, -8.6175)
    inside = replace(AT, latitude=37.01, longitude=-8.6184, height=100.0)
    known = FLYING | {"target": at.vertices[0], "position": inside}
    assert step(PLANE, GoTo("r", "uav0", at), **known) == FollowsCommand(done=True)


def linked(*crafts):
    return Autopilot("autopilot", "udp:0", crafts)


@pytest.mark.parametrize(
    "made",
    [
        lambda: Stations({"gcs0": 255, "gcs1": 255}, ("gcs0",)),
        lambda: Stations({"gcs0": 0}, ("gcs0",)),
        lambda: Stations({"gcs0": 255}, ("gcs1",)),
        lambda: Stations({}, ()),
        lambda: linked(Craft("uav0", system=255)),
        lambda: linked(Craft("uav0", system=0)),
        lambda: linked(Craft("uav0", system=1), Craft("uav1", system=1)),
        lambda: linked(Craft("uav0"), Craft("uav1")),
        lambda: linked(Craft("uav0", system=1), Craft("uav0", system=2)),
        lambda: linked(Craft("uav0", serial="2F"), Craft("uav1", serial="2F")),
    ],
)
def test_stations_and_vehicles_that_cannot_be_told_apart_are_the_users_mistake(made):
    with pytest.raises(PhysicalError):
        made()


WAY = (point(37.004, -8.604), point(37.008, -8.61), AREA)
ON_ITS_WAY = {"armed": True, "active": True, "mode": PLANE.auto, "current": 3}


def aboard(way):
    items = route(tuple(map(waypoint, way)), 100.0, takeoff=True)
    return NOTHING | {MissionType.MISSION: items}


def test_a_way_that_has_moved_is_told_from_the_item_that_it_is_at_until_that_is_acknowledged():
    state = begun(Follow("r1", "uav0", WAY), **ON_ITS_WAY)
    state = replace(state, on_board=aboard(WAY), moving=replace(state.moving, begun=True, passed=1))
    state, sent, _ = ticked(state, 0, 2)
    assert of(sent, Cmd.SET_MISSION_CURRENT) == []
    moved = (*WAY[:2], box((37.025, -8.61), (37.015, -8.625)))
    state = pilot.command(state, Follow("r1", "uav0", moved), 2.0).pilot
    state, sent, reports = ticked(replace(state, on_board=aboard(moved)), 2, 7)
    assert {message["param1"] for message in of(sent, Cmd.SET_MISSION_CURRENT)} == {3.0}
    assert len(of(sent, Cmd.SET_MISSION_CURRENT)) == 4  # that it is at item 3 shows nothing
    assert ended(reports) == []
    yes = say("COMMAND_ACK", command=int(Cmd.SET_MISSION_CURRENT), result=int(Result.ACCEPTED))
    state = pilot.hear(state, replace(yes, system=1, component=1), 7.0).pilot
    _, sent, reports = ticked(state, 7, 20)
    assert [type(report) for report in ended(reports)] == [Accepted]
    assert of(sent, Cmd.SET_MISSION_CURRENT) == []


def test_an_upload_that_gets_no_further_is_given_up():
    _, sent, reports = ticked(replace(begun(Follow("r1", "uav0", WAY)), on_board=NOTHING), 0, PATIENCE + 10)
    assert any(message.name == "MISSION_COUNT" for message in sent)
    (end,) = ended(reports)
    assert end.reason == "the mission could not be confirmed on board in 45 s"
