"""What a trace sends a vehicle to is written for ground stations, and read again as places."""

import pytest

from physical import box, centroid, circle, distance, read_plan, read_waypoints


@pytest.fixture
def simulated(missions, bigactors):
    def simulate(*more):
        assert bigactors("simulate", "holds.mission", "--json", "run.json", *more)[0] == 0
        return missions

    return simulate


@pytest.mark.parametrize("control", ["atomic", "timed"])
@pytest.mark.parametrize(("name", "read"), [("uav0.plan", read_plan), ("uav0.waypoints", read_waypoints)])
def test_the_waypoints_of_a_trace_are_the_centroids_of_the_places_that_it_goes_to(
    simulated, bigactors, control, name, read
):
    folder = simulated("--control", control)
    code, _, err = bigactors("replay", "run.json", "--control", control, "--waypoints", f"uav0={name}")
    assert code == 0
    assert f"waypoints of uav0 written to {name}" in err
    home, first, *_ = read((folder / name).read_text())
    assert home.point.vertices == ((37.15, -8.7),)
    assert (
        distance(first.point, centroid(box((37.04, -8.59), (36.94, -8.79)))) < 5_000
    )  # beside the spill in it
    assert bigactors("world", name)[0] == 0


@pytest.mark.parametrize(("name", "read"), [("uav0.plan", read_plan), ("uav0.waypoints", read_waypoints)])
def test_what_is_passed_on_the_way_is_written_before_the_place_that_is_gone_to(
    missions, bigactors, name, read
):
    assert bigactors("simulate", "two_gates", "--json", "run.json")[0] == 0
    assert bigactors("replay", "run.json", "--waypoints", f"uav0={name}")[0] == 0
    _, *points = [item.point for item in read((missions / name).read_text())]
    north, south = centroid(circle((37.14, -8.612), 300)), centroid(circle((37.108, -8.612), 300))
    bay, airfield = centroid(box((37.105, -8.57), (37.085, -8.6))), centroid(circle((37.149, -8.584), 900))
    way = [north, south, bay, south, north, airfield]
    assert len(points) == len(way)
    assert all(distance(at, wanted) < 1 for at, wanted in zip(points, way, strict=True))


BANDED = """signature standard
world {{
  around0: Location = box (37.2, -8.7) (37.0, -8.5) altitude 50 m to 500 m
  gate0: Location = circle (37.12, -8.62) radius 300 m altitude 150 m to 400 m
  goal0: Location = circle (37.14, -8.60) radius 500 m {goal}
  uav0: UAV = point (37.10, -8.60) {uav} linked control:uav0
}}
BigActor a hosted_at uav0 with_behavior {{ control(MOVE_HOST_TO goal0{via}) }}
check {{ reachable "there": actually uav0 in goal0 }}
"""

READ_BACK = """signature standard
world {{
  around0: Location = box (37.2, -8.7) (37.0, -8.5) altitude 50 m to 500 m
  gate0: Location = circle (37.12, -8.62) radius 300 m altitude 150 m to 400 m
  goal0: Location = circle (37.14, -8.60) radius 500 m {goal}
  from "route.{suffix}" keep Waypoint as Drifter
  gcs0: Station = point (37.10, -8.61) linked control:gcs0
}}
BigActor a hosted_at gcs0 with_behavior {{ skip }}
check {{ {claims} }}
"""


@pytest.mark.parametrize("suffix", ["waypoints", "plan"])
@pytest.mark.parametrize("via", ["", " VIA gate0"])
@pytest.mark.parametrize(
    "altitudes",
    [
        ("altitude 200 m to 400 m", "altitude 300 m", 300.0),  # a vehicle keeps its altitude
        ("altitude 200 m to 400 m", "", 300.0),
        ("altitude 200 m to 200 m", "", 200.0),
        ("", "", 275.0),  # of the place around it
        ("", "altitude 222.25 m", 222.25),
    ],
)
def test_what_is_written_is_read_back_in_the_goal(missions, bigactors, suffix, via, altitudes):
    goal, uav, height = altitudes
    (missions / "banded.mission").write_text(BANDED.format(goal=goal, uav=uav, via=via))
    assert bigactors("simulate", "banded.mission", "--json", "run.json")[0] == 0
    assert bigactors("replay", "run.json", "--waypoints", f"uav0=route.{suffix}")[0] == 0
    last = 2 if via else 1
    claims = [f'invariant "in the goal": actually waypoint{last} in goal0']
    claims += ['invariant "through the gate": actually waypoint1 in gate0'] if via else []
    back = READ_BACK.format(goal=goal, suffix=suffix, claims=" ".join(claims))
    (missions / "back.mission").write_text(back)
    assert bigactors("check", "back.mission")[0] == 0
    read = read_plan if suffix == "plan" else read_waypoints
    item = read((missions / f"route.{suffix}").read_text())[last]
    assert (item.frame, item.altitude) == (0, height)


def test_without_any_altitude_a_route_is_a_hundred_metres_above_home(missions, bigactors):
    text = BANDED.format(goal="", uav="", via="").replace("altitude 50 m to 500 m", "")
    (missions / "plain.mission").write_text(text)
    assert bigactors("simulate", "plain.mission", "--json", "run.json")[0] == 0
    assert bigactors("replay", "run.json", "--waypoints", "uav0=route.waypoints")[0] == 0
    home, stop = read_waypoints((missions / "route.waypoints").read_text())
    assert (home.frame, home.altitude, stop.frame, stop.altitude) == (0, 0.0, 3, 100.0)
