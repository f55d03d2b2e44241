"""Moves that name what they pass: the vehicle gets a mission, flies it, and what is committed is true."""

import asyncio

import pytest
from audited import LOOK, PLACES, flown_in
from live_missions import EAST, TOUR, flying, known_of, seen

from adapters.live.batch import Heard
from adapters.live.core import resumed
from adapters.mavlink.constants import Cmd, MissionType
from adapters.mavlink.items import e7
from adapters.plugin import Arrived, Follow
from adapters.simulated import Disturbance, Kind, Vehicle
from physical import PhysicalProperty, box, circle, contains, point, waypoint
from semantics.live_policy import Fallback, LivePolicy

AIRFIELD = (37.147, -8.582, 20.0)
GATES = ("northGate0", "southGate0")
WAY_OUT = (*GATES, "bay0")
WAY_BACK = ("southGate0", "northGate0", "airfield0")


@pytest.fixture
def folder(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    return tmp_path


class Log:
    """The missions that a vehicle was given, in their order."""

    def __init__(self):
        self.missions = []

    async def keep(self, _flight, _simulator, witness):
        while True:
            items = witness.vehicle.store.items.get(MissionType.MISSION)
            if items and items not in self.missions[-1:]:
                self.missions.append(items)
            await asyncio.sleep(LOOK)


def passed(witness):
    """Return which gates the vehicle was over, and when its flights were committed, in that order."""
    events = []
    for number, (_, at, _) in enumerate(witness.truth):
        events += ["commit"] * witness.commits.count(number)
        over = [gate for gate in GATES if contains(PLACES[gate], point(*at))]
        events += [gate for gate in over if [gate] != events[-1:]]
    return [*events, *["commit"] * witness.commits.count(len(witness.truth))]


def spots(items):
    """Return where a mission goes, its home and its take-off left out."""
    return [(item.x, item.y) for item in items[1:] if item.command != Cmd.TAKEOFF]


@pytest.mark.long
@pytest.mark.parametrize("loss", [0.0, 0.3])
def test_a_plane_flies_round_the_town_by_the_gates_that_its_mission_names(folder, loss):
    log, plane = Log(), Vehicle(Kind.PLANE, AIRFIELD)
    flown = flown_in(
        folder, "two_gates", plane, disturbance=Disturbance(loss=loss), foe=log.keep, seconds=4000
    )
    assert flown.ended, flown.witness.told()
    assert not flown.broken
    told = [[e7(waypoint(PLACES[name])) for name in way] for way in (WAY_OUT, WAY_BACK)]
    assert [spots(items) for items in log.missions] == told
    assert passed(flown.witness) == [*GATES, "commit", *reversed(GATES), "commit"]
    assert not any(contains(PLACES["town0"], point(*at)) for _, at, _ in flown.witness.truth)
    assert flown.logical.parent("uav0") == "airfield0"


# --- what is told, and when it is done ------------------------------------------------------------------

WORLD = TOUR.replace(
    "  gcs0: Station",
    """  gate0: Location = box (37.06, -8.64) (37.05, -8.65)
  gate1: Gate = circle (37.055, -8.61) radius 300 m
  gcs0: Station""",
).replace(
    "kind Location contains Location,", "kind Gate contains UAV\n  kind Location contains Location, Gate,"
)
GO = "BigActor a hosted_at uav0 with_behavior { control(MOVE_HOST_TO east0 VIA gate0, gate1) }"
DRIFT = "environment { gate1 drifts among circle (37.065, -8.61) radius 300 m }"


def shape(name, ring, time):
    said = PhysicalProperty(name, "Location" if name == "east0" else "Gate", ring, time=time, source="places")
    return Heard("places", said)


def under_way(text=WORLD + GO):
    return flying(text, LivePolicy(Fallback.CONTINUE))


def came(run, now):
    return Arrived(run.commands[-1].request, "uav0", now)


def test_the_order_is_to_follow_the_waypoints_of_what_is_passed_and_then_into_the_destination():
    (told,) = under_way().commands
    gate0 = waypoint(box((37.06, -8.64), (37.05, -8.65)))
    path = (gate0, point(37.055, -8.61), box((37.02, -8.60), (37.00, -8.62)))
    assert told == Follow(told.request, "uav0", path, None, "east0")


def test_a_vehicle_that_comes_through_its_destination_on_its_way_has_not_arrived():
    run = under_way()
    run.turn(1.0, seen("uav0", EAST, 1.0))
    assert "commit" not in run.rules
    run.turn(2.0, seen("uav0", (37.055, -8.61), 2.0))
    run.turn(3.0, seen("uav0", EAST, 3.0), reports=[came(run, 3.0)])
    assert run.rules[-1] == "commit"
    assert run.state.commanded.flights == {}


@pytest.mark.parametrize("ours", [True, False])
def test_that_a_way_is_behind_a_vehicle_is_no_arrival_where_it_was_not_seen_in_its_destination(ours):
    run = under_way()
    run.turn(1.0, reports=[came(run, 1.0)] * ours + [Arrived("another-1", "uav0", 1.0)])
    assert "commit" not in run.rules
    run.turn(2.0, seen("uav0", EAST, 2.0))
    assert ("commit" in run.rules) == ours


@pytest.mark.parametrize(("name", "moved"), [("gate1", 1), ("east0", 2)])
def test_a_way_is_told_again_when_any_of_it_has_moved(name, moved):
    run = under_way(WORLD + GO + DRIFT)
    (first,) = run.commands
    run.turn(1.0, reports=[came(run, 1.0)])
    where = circle((37.065, -8.61), 300)
    run.turn(2.0, shape(name, where, 2.0))
    again = run.commands[-1]
    assert again.request == first.request
    assert [a == b for a, b in zip(first.path, again.path, strict=True)] == [n != moved for n in range(3)]
    assert waypoint(again.path[moved]) == waypoint(where)
    run.turn(3.0, seen("uav0", waypoint(again.path[-1]).vertices[0], 3.0))
    assert "commit" not in run.rules  # what was behind it was the path as it had been
    run.turn(4.0, reports=[came(run, 4.0)])
    assert run.rules[-1] == "commit"


def test_a_way_that_is_resumed_is_told_once_more():
    run = under_way()
    again = resumed(run.plan, known_of(run.state), 5.0)
    (order,) = again.commanded.flights.values()
    assert order.command.path == run.commands[0].path
    assert not order.through
