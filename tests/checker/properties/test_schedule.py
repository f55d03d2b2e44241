"""Schedules: how long flights take, when they may begin and end, and when what is asked is first true."""

from dataclasses import replace
from math import inf

import pytest
from checked_missions import load
from timed_missions import SOUTH, with_timing

from checker import Engine, check
from checker.properties.schedule import EventDates
from checker.reports.times import times_json, times_text
from semantics.properties.kinds import PropertyKind
from semantics.properties.property import Property
from semantics.timing.intervals import Interval
from semantics.timing.timing import Motion, Timing
from specs.elaboration import load_mission

TEXT = """BigActor a hosted_at uav0 with_behavior { control(MOVE_HOST_TO south0) control(MOVE_HOST_TO north0) }
control timed
scheduler fcfs"""
MINUTES = Timing(
    60_000,
    motions=(("uav0", Motion((18.0, 25.0))),),
    react=Interval(0, 1),
    lines=(("uav0 flies at 18 m/s to 25 m/s", 7),),
)


def schedule(timing=MINUTES):
    c = with_timing(load(TEXT).initial, timing)
    asked = Property(PropertyKind.TIME, "there", SOUTH)
    found = check(c, [asked], times=True).schedule
    assert found is not None
    return found


@pytest.fixture(scope="module")
def known():
    return schedule()


def test_each_flight_has_its_interval_its_beginnings_and_its_ends(known):
    there, back = known.flights
    assert (there.vehicle, there.agent, there.origin, there.destination) == ("uav0", "a", "north0", "south0")
    assert (back.origin, back.destination, str(back.bound)) == (
        "south0",
        "north0",
        "uav0 flies at 18 m/s to 25 m/s (line 7)",
    )
    assert there.takes == Interval(1, 6)
    assert there.begins == EventDates(0, 2)
    assert there.ends == EventDates(1, 8)
    assert back.begins == EventDates(1, 9)
    assert back.ends == EventDates(2, 15)


def test_a_time_property_has_its_first_and_its_last_moment(known):
    assert [(each.name, each.moments) for each in known.milestones] == [("there", EventDates(1, 8))]


def test_the_table_has_a_line_for_each(known):
    assert list(times_text(known)) == [
        "  times                                takes            begins         ends, is true",
        "    uav0 from north0 to south0, by a   1 min to 6 min   0:00 to 2:00   1:00 to 8:00",
        "    uav0 from south0 to north0, by a   1 min to 6 min   1:00 to 9:00   2:00 to 15:00",
        "    there                                                              1:00 to 8:00",
    ]


def test_what_nothing_bounds_has_no_latest_moment():
    found = schedule(replace(MINUTES, motions=()))
    assert "    uav0 from north0 to south0, by a   any time   0:00 to 2:00    0:00 or later" in times_text(
        found
    )
    data = times_json(found)
    assert data["flights"][0]["takes"] == {"at_least": 0.0, "at_most": None}
    assert data["flights"][0]["ends"] == {"earliest": 0.0, "latest": None}
    assert data["properties"] == [{"name": "there", "may_never": True, "earliest": 0.0, "latest": None}]


def test_a_flight_ends_as_it_began_though_its_origin_drifts_away():
    found = check(load_mission("oil_spill_timed"), engine=Engine.FAST, times=True).schedule
    assert list(times_text(found))[1:5] == [
        "    uav0 from airfield0 to searchArea0, by a   7:28 to 19:50    0:00 to 0:04    7:28 to 19:54",
        "    uav0 from searchArea0 to oilSpill0, by a   at most 13:49    7:28 to 20:12   7:28 to 47:07",
        "    uav0 from oilSpill0 to airfield0, by a     11:49 to 21:44   7:28 to 47:23   19:17 to 1:09:07",
        "    uav0 from searchArea0 to airfield0, by a   11:49 to 21:44   7:28 to 35:36   19:17 to 1:09:07",
    ]


def test_zones_say_what_ticks_say_of_what_nothing_bounds():
    c = with_timing(load(TEXT).initial, replace(MINUTES, motions=()))
    ticks, zones = (
        check(c, [], engine=each, times=True).schedule for each in Engine if each is not Engine.RAY
    )
    assert ticks == zones
    assert [each.ends.latest for each in zones.flights] == [inf, inf]


TWO_CHANNELS = """\
signature standard
world {
  base: Location = circle (37, -8.7) radius 300 m
  uav0: UAV = point (37, -8.7) linked slow, fast
  gcs0: Station = point (37.0001, -8.7) linked slow, fast
}
BigActor a hosted_at uav0 with_behavior { send "x" to b }
BigActor b hosted_at gcs0 with_behavior { react { case "x" => skip } }
control timed
timing {
  agents react within 1 s
  messages over fast take SPAN
}
check {
  time "heard": ended b
}
"""


@pytest.mark.parametrize(
    ("span", "takes"),
    [("1 s to 4 s", Interval(0, 4)), ("at least 2 s", Interval(0)), ("4 s", Interval(0, 4))],
)
def test_a_message_over_several_channels_takes_as_long_as_the_quickest(span, takes, tmp_path):
    file = tmp_path / "two_channels.mission"
    file.write_text(TWO_CHANNELS.replace("SPAN", span), encoding="utf-8")
    mission = load_mission(file)
    found = check(mission.initial, mission.properties, times=True).schedule
    assert [each.takes for each in found.messages] == [takes]
