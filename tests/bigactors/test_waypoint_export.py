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


@pytest.mark.parametrize(
    ("route", "said"),
    [
        ("uav0=x.txt", "a route is written as one of .plan, .waypoints"),
        ("uav9=x.plan", "the mission has no entity 'uav9'"),
        ("base0=x.plan", "nothing sends 'base0' anywhere"),
        ("uav0", "is not VEHICLE=FILE"),
    ],
)
@pytest.mark.usefixtures("simulated")
def test_what_cannot_be_written_as_a_route_is_told(simulated, bigactors, route, said):
    simulated()
    code, _, err = bigactors("replay", "run.json", "--waypoints", route)
    assert code == 2
    assert said in err


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
