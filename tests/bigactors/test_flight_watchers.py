"""The terminal of a flight tells what vehicles do, now and then, and says everything else as before."""

import io
import itertools
import sys
from dataclasses import replace

import pytest

from adapters.live.batch import Batch, Heard
from adapters.live.commanded import Commanded, GivenCommand
from adapters.live.core import advance, started
from adapters.live.fresh_placements import Sighting, Sightings
from adapters.live.live_state import LiveState
from adapters.live.overrides import Fate, Overrides, StandingOrder
from adapters.live.plan import Plan
from adapters.plugin import Accepted, Battery, Follow, GoTo, Hold, Status
from bigactors.flight_watchers import EVERY, SELDOM, Terminal
from bigactors.mission_lookup import open_mission
from bigactors.vehicle_lines import vehicle_line, vehicles_line
from physical import PhysicalProperty, box, point
from semantics.state.setting import Control, Scheduler
from specs.elaboration import Variation

LIVE = Variation(Scheduler.FCFS, Control.TIMED)
UAV = "uav0"


@pytest.fixture(scope="module")
def first():
    return open_mission("oil_spill", LIVE).initial


def seen(at, time=0.0):
    said = PhysicalProperty(UAV, "UAV", point(*at), channels=("control:gcs0",), time=time, source="autopilot")
    return Sighting(said, time, time + 60)


def going(**more):
    east = box((37.02, -8.60), (37.00, -8.62))
    return Commanded({UAV: GivenCommand(GoTo("a-1", UAV, east, name="east0"), "a", 0.0, **more)})


def near():
    return Sightings({UAV: seen((37.01, -8.65))})


def test_a_line_says_where_a_vehicle_is_going_how_far_it_is_and_what_it_says_of_itself(first):
    said = Status(UAV, 9.0, "autopilot", 9.5, "GUIDED", True, Battery(81, 12.2))
    state = LiveState(first, sightings=near(), commanded=going())
    assert vehicle_line(UAV, state, said, 10.0) == (
        "uav0 is on its way to east0, 2.7 km away, GUIDED, battery 81 %"
    )
    way = Follow("a-1", UAV, (point(37.0, -8.0), point(37.01, -8.65)), name="west0")
    followed = replace(state, commanded=Commanded({UAV: GivenCommand(way, "a", 0.0, refused=True)}))
    assert vehicle_line(UAV, followed, None, 10.0) == "uav0 has refused to go to west0, 0 m away"


def test_a_line_says_who_holds_a_vehicle_and_since_when_it_is_silent(first):
    order = StandingOrder(Hold("operator-1", UAV), "Ana", Fate.CONFIRMED)
    lost = Sightings(lost=frozenset({UAV}))
    state = LiveState(first, sightings=lost, commanded=going(), overrides=Overrides({UAV: order.reason}))
    parent = first.structure.logical.parent(UAV)
    said = Status(UAV, 2.0, "autopilot", 2.0, "LOITER", False, Battery(None, 11.9))
    assert vehicle_line(UAV, state, said, 14.2) == (
        "uav0 held by the operator (Ana), has not arrived in east0, "
        "LOITER, disarmed, battery 11.9 V, not heard for 12 s"
    )
    landed = replace(state, commanded=Commanded())
    assert vehicle_line(UAV, landed, None, 14.2).endswith(f"(Ana), is in {parent}, not heard")


@pytest.mark.parametrize("fallen", [{"suspended": True}, {"grounded": frozenset({"a"})}])
def test_a_line_says_of_a_flight_that_was_given_up_nothing_of_its_way(first, fallen):
    state = LiveState(first, sightings=near(), commanded=going(), overrides=Overrides(**fallen))
    assert vehicle_line(UAV, state, None, 10.0) == "uav0 has given up its flight to east0"


def test_one_line_tells_of_few_vehicles_and_first_of_those_that_need_it(first):
    names = [f"uav{n}" for n in range(9)]
    taken = Overrides({"uav5": "it is in RTL"})
    state = LiveState(first, sightings=Sightings(lost=frozenset({"uav7"})), overrides=taken)
    line = vehicles_line(names, state, {}, 0.0)
    assert [each.split()[0] for each in line.split(" | ")] == ["uav7", "uav5", "uav0", "uav1", "and"]
    assert line.endswith(" | and 5 more")


def fly(terminal, first, seconds, every):
    """A vehicle that stands where it is, told of in turns."""
    plan = Plan(first, {UAV: "autopilot"})
    state = started(plan)
    for k in range(int(seconds / every) + 1):
        now = k * every
        at = Heard("autopilot", seen((37.147, -8.582), now).property)
        turn = advance(plan, state, Batch((at,), (Accepted("pilot-1", UAV, now),)), now)
        state = turn.state
        terminal.turned(turn, now)
    return state


def test_where_there_is_no_terminal_a_line_a_minute_breaks_a_long_silence(first, capsys):
    fly(Terminal(lambda _: (), (UAV,)), first, 600.0, 5.0)
    lines = [line for line in capsys.readouterr().out.splitlines() if " uav0 " in line and "⟨" not in line]
    times = [float(line.split(" s ")[0]) for line in lines]
    assert 9 <= len(times) <= 10
    assert all(after - before >= SELDOM for before, after in itertools.pairwise(times))


def test_a_terminal_has_one_line_in_one_place_that_is_cleared_before_anything_else(
    first, monkeypatch, capsys
):
    class Screen(io.StringIO):
        def isatty(self):
            return True

    screen = Screen()
    monkeypatch.setattr(sys, "stderr", screen)
    monkeypatch.setattr("bigactors.flight_watchers.time.monotonic", iter(range(10**6)).__next__)
    terminal = Terminal(lambda _: (), (UAV,))
    fly(terminal, first, 600.0, 5.0)
    terminal.ends()
    drawn = screen.getvalue()
    assert drawn.count("uav0 is on its way") > 600 / 5 * EVERY * 0.9
    assert drawn.endswith(" \r")
    assert "\n" not in drawn.replace("\n", "", drawn.count(":"))
    assert " uav0 is " not in capsys.readouterr().out
