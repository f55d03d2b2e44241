"""Where a vehicle is put, and when it has arrived: no verified mission breaks on arrival."""

from dataclasses import replace

import pytest
from audited import flown_with
from live_missions import TOUR, Run, mission, plan_of, seen
from scale import long_ones
from test_flying import options_of

from adapters.live.surroundings import spots
from adapters.mavlink.constants import Cmd, MissionType
from adapters.mavlink.items import OnboardItem
from adapters.plugin import Accepted, GoTo
from adapters.simulated import Kind, Vehicle, run
from bigactors.commands.run.flight import prepare
from bigactors.flight_watchers import Terminal
from bigactors.mistakes import Mistake
from physical import circle, contains, overlaps, point, waypoint

BAY = """mission bay
signature {
  kind Location contains Location, UAV, Station
  kind Slick contains UAV
  kind UAV driven
  kind Station
}
world {
  field0: Location = circle (37.0, -8.6) radius 900 m
  bay0: Location = circle (37.015, -8.6) radius 600 m
  SLICK
  gcs0: Station = point (37.001, -8.601) linked control:gcs0
  uav0: UAV = point (37.0, -8.6) linked control:gcs0
}
BigActor a hosted_at uav0 with_behavior {
  control(MOVE_HOST_TO bay0)
  loop { react { case "look" => display("here") } }
}
environment { says "look" to a at most once MORE }
live { on broken assumption: return }
"""
NEAR = "slick0: Slick = circle (37.0165, -8.6) radius 120 m"
"""The point that the model takes, the centre of bay0, is 47 m from its border."""


def bay(folder, slick, more="", seconds="360", radius="600"):
    path = folder / "bay.mission"
    path.write_text(
        BAY.replace("SLICK", slick).replace("MORE", more).replace("radius 600", f"radius {radius}")
    )
    return options_of(str(path), folder, "--unverified", "--for", seconds)


def flight(asked, vehicle):
    flight = prepare(asked)
    terminal = Terminal(flight.resting)
    return run(flown_with(flight, vehicle, (terminal,))), terminal


def at_home(kind=Kind.PLANE, **more):
    return Vehicle(kind, (37.0, -8.6, 20.0), **more)


@pytest.mark.parametrize("kind", [Kind.PLANE, *long_ones(Kind.COPTER)])
def test_a_vehicle_circles_in_its_place_and_out_of_the_smaller_places_in_it(tmp_path, capsys, kind):
    vehicle = at_home(kind, wind=(5.0, 6.2))
    _, terminal = flight(bay(tmp_path, NEAR), vehicle)
    assert "⟨commit" in capsys.readouterr().out
    assert not terminal.broken
    at, room = point(vehicle.target.latitude, vehicle.target.longitude), 104.0 if kind is Kind.PLANE else 5.0
    around = circle(at.vertices[0], room)
    assert contains(circle((37.015, -8.6), 600), around)
    assert not overlaps(circle((37.0165, -8.6), 120), around)


@pytest.mark.parametrize(("wind", "broken"), [*long_ones(((5.0, 6.2), False)), ((12.0, 9.0), True)])
def test_a_plane_that_the_wind_carries_out_of_its_place_breaks_an_assumption_that_says_so(
    tmp_path, capsys, wind, broken
):
    vehicle = at_home(wind=wind)
    _, terminal = flight(bay(tmp_path, "", seconds="240", radius="105"), vehicle)
    told = capsys.readouterr()
    assert "⟨commit" in told.out
    assert terminal.broken == broken
    reason = "uav0 is in none of the places; it was not sent there, and has left its place"
    assert (reason in told.err) == broken
    assert vehicle.mode == (vehicle.kind.profile.home if broken else vehicle.kind.profile.guided)


def test_a_mission_without_control_authority_flies_a_vehicle_that_obeys_some_station(tmp_path, capsys):
    asked = bay(tmp_path, "")
    path = tmp_path / "bay.mission"
    path.write_text(path.read_text().replace(" linked control:gcs0", ""))
    _, terminal = flight(asked, at_home(Kind.COPTER))
    assert "⟨commit" in capsys.readouterr().out
    assert not terminal.broken


@pytest.mark.parametrize(
    ("slick", "more", "widest"),
    [
        pytest.param("slick0: Slick = circle (37.0151, -8.6) radius 430 m", "", "90", id="nested"),
        pytest.param(
            "slick0: Slick = circle (37.1, -8.6) radius 100 m",
            "slick0 drifts among circle (37.0151, -8.6) radius 430 m",
            "90",
            id="it may drift there",
        ),
    ],
)
def test_a_place_without_room_beside_the_places_in_it_is_refused_before_take_off_with_the_figures(
    tmp_path, slick, more, widest
):
    with pytest.raises(Mistake, match="bay0 leaves too little room") as error:
        flight(bay(tmp_path, slick, more), at_home())
    assert error.value.place.endswith("bay.mission:16")
    assert f"crosses no border has {widest} m" in str(error.value)
    assert "the plane needs a circle of 104 m: it circles at 80 m" in str(error.value)


DENTED = TOUR.replace(
    "east0: Location = box (37.02, -8.60) (37.00, -8.62)",
    "east0: Location = polygon (37.00, -8.62) (37.00, -8.58) (37.02, -8.58) (37.005, -8.6) (37.02, -8.62)",
)
GO = "BigActor a hosted_at uav0 with_behavior { control(MOVE_HOST_TO east0) }"
HORN, EDGE = (37.017, -8.6185), (37.012, -8.612)


def test_a_vehicle_has_not_arrived_while_a_dent_of_its_place_is_on_its_way():
    run = Run(plan_of(DENTED + GO), willing=False)
    run.turn(0.0, seen("uav0", (37.01, -8.65), 0.0))
    (goes,) = run.commands
    shows = Accepted(goes.request, "uav0", 1.0, goes.place, point(37.017, -8.5815))  # in the other horn
    run.turn(1.0, seen("uav0", HORN, 1.0), reports=[shows])
    assert "commit" not in run.rules
    run.turn(2.0, seen("uav0", EDGE, 2.0))
    assert "commit" not in run.rules
    run.turn(3.0, seen("uav0", (37.003, -8.6), 3.0))
    assert run.rules[-1] == "commit"


def test_what_a_vehicle_shows_of_where_its_place_was_counts_for_nothing():
    run = Run(plan_of(DENTED + GO), willing=False)
    run.turn(0.0, seen("uav0", (37.01, -8.65), 0.0))
    (goes,) = run.commands
    east = circle((37.01, -8.61), 900)
    moved = seen("east0", (37.01, -8.61), 1.0, "places", "Location", ())
    moved = type(moved)("places", type(moved.published)("east0", "Location", east, time=1.0, source="places"))
    run.turn(1.0, moved)
    (_, renewed) = run.commands
    assert isinstance(renewed, GoTo)
    assert renewed.place == east
    here = seen("uav0", (37.01, -8.611), 2.0)
    run.turn(2.0, here, reports=[Accepted(goes.request, "uav0", 2.0, goes.place, waypoint(goes.place))])
    assert "commit" not in run.rules
    run.turn(3.0, reports=[Accepted(goes.request, "uav0", 3.0, east, waypoint(east))])
    assert run.rules[-1] == "commit"


def test_wherever_the_others_may_be_there_is_a_spot_to_be_looked_at():
    drifts = "slick0 drifts among circle (37.0151, -8.6) radius 200 m"
    text = BAY.replace("SLICK", NEAR.replace("37.0165", "37.1")).replace("MORE", drifts)
    found = [*spots(mission(text).initial, "uav0", "bay0")]
    bay0 = circle((37.015, -8.6), 600)
    assert [place for place, _ in found] == [bay0, bay0]
    inside = sorted(bool(around.inside) for _, around in found)
    assert inside == [False, True]  # the slick comes over the vehicle, or the vehicle comes beside the slick


def test_a_vehicle_that_stands_where_something_may_come_over_it_alone_is_not_as_the_mission_says():
    """The mission has it at the point of the model, which the slick does not reach."""
    listed = "environment { slick0 drifts among circle (37.012, -8.652) radius 100 m }"
    slick = (
        "kind Slick contains UAV kind Station }\nworld {\n  slick0: Slick = circle (37.1, -8.6) radius 100 m"
    )
    text = TOUR.replace("kind Station\n}\nworld {", slick) + GO + listed
    run = Run(plan_of(text))
    run.turn(0.0, seen("uav0", (37.0101, -8.6501), 0.0))
    assert run.kinds() == []
    run = Run(plan_of(text))
    run.turn(0.0, seen("uav0", (37.012, -8.652), 0.0))
    assert run.findings[0].message == (
        "uav0 is seen at point(37.012, -8.652), the mission has it at point(37.01, -8.65): "
        "slick0, where the mission lists it, holds uav0 at one of the two points only"
    )


FOREIGN = (
    OnboardItem(Cmd.WAYPOINT, 0, 0),
    *(OnboardItem(Cmd.WAYPOINT, 370_500_000 + n, -86_000_000, 100.0) for n in (0, 9)),
)


@pytest.mark.parametrize("takes", [False, True])
def test_a_run_asks_before_it_commands_a_vehicle_that_flies_somebodys_mission(tmp_path, capsys, takes):
    options = bay(tmp_path, "", seconds="60")
    options.take_over = takes
    vehicle = at_home(armed=True, mode=Kind.PLANE.profile.auto)
    vehicle.body, vehicle.time = replace(vehicle.body, height=100.0), 0.0
    vehicle.store.items[MissionType.MISSION] = FOREIGN
    if takes:
        assert flight(options, vehicle)[0].state.number > 0
        assert "command" in capsys.readouterr().out
    else:
        with pytest.raises(Mistake, match="uav0 is under way already, in AUTO") as error:
            flight(options, vehicle)
        assert "--take-over" in str(error.value)
