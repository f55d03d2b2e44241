"""Strays and bands: a vehicle that leaves its way or its altitudes breaks an assumption, and commits no sooner."""

import pytest
from live_missions import EAST, TOUR, WEST, Run, mission, seen
from pyproj import Geod

from adapters.live.batch import Batch, Heard, Saying
from adapters.live.commanded import Commanded
from adapters.live.core import resumed, watch
from adapters.live.live_state import LiveState
from adapters.live.plan import Plan
from adapters.plugin import Gone, Hold, TakenOver
from adapters.recording.encoding import ways_json
from adapters.recording.mcap_files import Message
from bigactors.recordings import ways_of
from physical import Band
from semantics.live_policy import Fallback, LivePolicy
from semantics.state.requests import FLY

GEOD = Geod(ellps="WGS84")
FLIES = "BigActor a hosted_at uav0 with_behavior { control(MOVE_HOST_TO east0) }"
STRAYS = f"{FLIES} environment {{ UAV strays at most 100 m }}"
POINT = "uav0: UAV = point (37.01, -8.65)"
BANDED = TOUR.replace(POINT, f"{POINT} altitude 100 m to 120 m") + FLIES
CAUSE = "; the mission says: it strays at most 100 m: wind, or another operator"
AHEAD, _, FAR = GEOD.inv(WEST[1], WEST[0], EAST[1], EAST[0])


def on_line(share, aside=0.0):
    """A point of the shortest line to east0's middle, so many metres to its right."""
    east, north, back = GEOD.fwd(WEST[1], WEST[0], AHEAD, FAR * share)
    east, north, _ = GEOD.fwd(east, north, back + 180 + 90, aside)
    return north, east


def flying(text=STRAYS, fallback=Fallback.HOLD, **more):
    run = Run(
        Plan(
            mission(TOUR + text if "signature" not in text else text).initial,
            {"uav0": "autopilot"},
            LivePolicy(fallback),
        )
    )
    run.turn(0.0, seen("uav0", WEST, 0.0, **more))
    return run


def broken(run):
    return run.messages("broken assumption")


def test_a_vehicle_within_its_bound_of_its_way_breaks_nothing():
    run = flying()
    for step, share in enumerate((0.1, 0.3, 0.5)):
        run.turn(1.0 + step, seen("uav0", on_line(share, 99.5), 1.0 + step))
    assert broken(run) == []


def test_a_vehicle_beyond_its_bound_breaks_an_assumption_once_with_the_figure_and_holds():
    run = flying()
    run.turn(1.0, seen("uav0", on_line(0.5, 100.6), 1.0))
    assert broken(run) == [
        "uav0 is 101 m from its way to east0; the mission says: it strays at most 100 m: wind, or another operator"
    ]
    run.turn(2.0, seen("uav0", on_line(0.5, 150.0), 2.0))
    assert len(broken(run)) == 1
    assert [type(each) for each in run.commands[1:]] == [Hold]


def test_where_the_mission_goes_on_each_departure_is_reported():
    run = flying(fallback=Fallback.CONTINUE)
    for now, aside in ((1.0, 120.0), (2.0, 130.0), (3.0, 50.0), (4.0, 111.0)):
        run.turn(now, seen("uav0", on_line(0.5, aside), now))
    assert [each.split(" m ")[0] for each in broken(run)] == ["uav0 is 120", "uav0 is 111"]


def test_it_commits_no_sooner_than_it_is_as_near_to_its_last_point_and_then_stays_so():
    run = flying()
    edge = on_line(1.0 - 0.9 * 900 / FAR, 0.0)
    for now, at in ((1.0, edge), (2.0, on_line(1.0 - 101 / FAR))):
        run.turn(now, seen("uav0", at, now))
        assert "commit" not in run.rules
    run.turn(3.0, seen("uav0", on_line(1.0 - 99.5 / FAR), 3.0))
    assert "commit" in run.rules
    run.turn(4.0, seen("uav0", on_line(1.0, 99.0), 4.0))
    assert broken(run) == []
    run.turn(5.0, seen("uav0", on_line(1.0, 102.0), 5.0))
    assert broken(run) == [
        f"uav0 is 102 m from the point around which it stays in east0{CAUSE}",
    ]


def test_without_strays_it_commits_where_it_enters_the_place():
    run = flying(FLIES)
    run.turn(1.0, seen("uav0", on_line(1.0 - 700 / FAR), 1.0))
    assert "commit" in run.rules


def test_a_vehicle_that_does_not_stand_where_the_mission_has_it_breaks_the_assumption_before_the_start():
    plan = Plan(mission(TOUR + STRAYS).initial, {"uav0": "autopilot"})
    run = Run(plan)
    turn = watch(plan, run.state, Batch((seen("uav0", on_line(-130 / FAR), 0.0),)), 0.0)
    assert [each.message for each in turn.findings] == [
        f"uav0 is 130 m from the point at which the mission has it{CAUSE}",
    ]


def test_a_vehicle_that_was_taken_over_need_not_keep_to_its_way():
    run = flying()
    run.turn(1.0, seen("uav0", on_line(0.5, 500.0), 1.0), reports=[TakenOver("uav0", 1.0, "a pilot")])
    assert broken(run) == []


# --- bands


@pytest.mark.parametrize(
    ("heights", "found"), [((20, 60, 110, 118), []), ((20, 110, 90, 80), ["uav0 is at 90 m"])]
)
def test_a_vehicle_that_leaves_its_band_after_its_climb_breaks_an_assumption(heights, found):
    run = flying(BANDED, altitude=Band(20, 20))
    for now, height in enumerate(heights, start=1):
        run.turn(now, seen("uav0", on_line(0.1 * now), now, altitude=Band(height, height)))
    assert [each.split(" above")[0] for each in broken(run)] == found


def test_a_vehicle_does_not_arrive_below_its_band():
    run = flying(BANDED, altitude=Band(20, 20))
    run.turn(1.0, seen("uav0", EAST, 1.0, altitude=Band(60, 60)))
    assert "commit" not in run.rules
    run.turn(2.0, seen("uav0", EAST, 2.0, altitude=Band(101, 101)))
    assert "commit" in run.rules


# --- one flight at a time


def test_a_vehicle_under_way_that_is_gone_stays_in_transit_so_no_flight_outlives_another():
    """Regions after an arrival rest on it: the vehicle is on its way to the point of the flight that ends."""
    again = """
BigActor a hosted_at uav0 with_behavior { control(MOVE_HOST_TO east0) }
BigActor b hosted_at uav0 with_behavior { react { case "go" => control(MOVE_HOST_TO east0 VIA west0) } }
environment {
  UAV strays at most 100 m
  uav0 vanishes
  uav0 appears at point (37.01, -8.65) linked control:gcs0
  says "go" to b at most once
}
"""
    run = flying(again)
    run.turn(1.0, Heard("autopilot", Gone("uav0", 1.0, "autopilot")), sayings=[Saying("b", "go")])
    for now in (2.0, 900.0):
        run.turn(now)
        assert run.state.configuration.structure.physical.going_to("uav0") == "east0"
    run.turn(901.0, seen("uav0", WEST, 901.0))
    flights = [each for each in run.state.configuration.eta.all() if isinstance(each.request, FLY)]
    assert [each.request.agent for each in flights] == ["a"]


# --- resumed runs


def recorded_ways(run):
    """The ways of a run as its recording has them."""
    return ways_of(
        [Message("ways", 0.0, {"vehicle": name, "way": way}) for name, way in ways_json(run.state).items()]
    )


def test_a_resumed_run_watches_a_vehicle_at_the_point_where_it_stays():
    run = flying()
    run.turn(1.0, seen("uav0", EAST, 1.0))
    assert "commit" in run.rules
    known = LiveState(
        run.state.configuration, run.state.number, commanded=Commanded.resumed(1, recorded_ways(run))
    )
    run.state = resumed(run.plan, known, 2.0)
    run.turn(3.0, seen("uav0", on_line(1.0, 99.0), 3.0))
    assert broken(run) == []
    run.turn(4.0, seen("uav0", on_line(1.0, 103.0), 4.0))
    assert [each.split(" from ")[0] for each in broken(run)] == ["uav0 is 103 m"]


def test_a_resumed_run_watches_a_flight_from_the_point_at_which_it_began():
    run = flying()
    run.turn(1.0, seen("uav0", on_line(0.2), 1.0))
    known = LiveState(
        run.state.configuration, run.state.number, commanded=Commanded.resumed(1, recorded_ways(run))
    )
    run.state = resumed(run.plan, known, 2.0)
    assert [round(each, 6) for each in run.state.commanded.flights["uav0"].begin.vertices[0]] == [*WEST]
    run.turn(3.0, seen("uav0", on_line(0.3, 98.0), 3.0))
    assert broken(run) == []
    run.turn(4.0, seen("uav0", on_line(0.3, 104.0), 4.0))
    assert [each.split(" from ")[0] for each in broken(run)] == ["uav0 is 104 m"]
