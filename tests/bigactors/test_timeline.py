"""`check --times` and `show --timeline`: when flights begin and end, as tables, JSON, pictures and pages."""

import json
import re

import pytest
from test_json import validator

from bigactors.pictures.timeline import draw_timeline, groups_of, marks
from checker.properties.schedule import EventDates, Milestone, PossibleFlight, Schedule
from semantics.timing.bounds import WrittenBound
from semantics.timing.intervals import Interval

INFINITE = float("inf")
TABLE = """\
  times                                   takes           begins          ends, is true
    uav0 from east0 to west0, by first    35 s to 14:15   0:00 to 0:10    0:35 to 14:25
    uav0 from west0 to east0, by second   25 s to 14:05   0:35 to 14:30   1:00 to 28:35
    in the west                                                           0:35 to 14:25
"""


@pytest.mark.parametrize("more", [(), ("--engine", "fast")], ids=["by ticks", "by zones"])
def test_a_check_says_when_flights_begin_and_end(done, more):
    out = done("check", "race_in_time", "--times", "--no-traces", *more)
    assert TABLE in out


def test_the_times_and_the_critical_path_are_in_the_json(bigactors, tmp_path):
    path = tmp_path / "report.json"
    bigactors("check", "broken_race_in_time", "--times", "--json", str(path), "--no-traces")
    report = json.loads(path.read_text())
    validator("report").validate(report)
    west, _ = report["times"]["flights"]
    assert (west["from"], west["to"], west["line"]) == ("east0", "west0", 33)
    assert west["takes"] == {"at_least": 35.0, "at_most": 855.0}
    (first,) = report["times"]["properties"]
    assert (first["name"], first["earliest"], first["may_never"]) == ("in the west", 35.0, False)


def test_a_mission_without_times_is_told_so(bigactors):
    assert "it has no times" in bigactors("check", "oil_spill", "--times", "--no-traces")[2]
    code, _, said = bigactors("show", "oil_spill", "--timeline")
    assert code == 2
    assert "write a section timing" in said


@pytest.mark.parametrize("name", ["times.svg", "times.html"])
def test_who_flies_when_is_drawn(bigactors, tmp_path, name):
    path = tmp_path / name
    code, out, _ = bigactors("show", "race_in_time", "--timeline", "--output", str(path))
    assert (code, out) == (0, TABLE)
    words = re.sub(r"<[^>]*>", "|", path.read_text())
    for word in ("uav0", "west0 → east0", "25 s to 14:05, by second", "in the west", "25:00"):
        assert f"|{word}|" in words


def test_a_message_under_way_is_drawn(bigactors, tmp_path):
    path = tmp_path / "relay.svg"
    bigactors("show", "relay_timed", "--timeline", "--output", str(path))
    words = re.sub(r"<[^>]*>", "|", path.read_text())
    assert all(f"|{word}|" in words for word in ("messages", "eye → desk", "told"))


def bar(takes, begins, ends):
    flight = PossibleFlight("uav0", "a", "west0", "east0", takes, begins, ends, WrittenBound())
    ((_, (found,)),) = groups_of(Schedule(1000, (flight,)))
    return found


def test_a_bar_is_full_where_a_vehicle_surely_flies():
    assert bar(Interval(60, 90), EventDates(0, 30), EventDates(60, 120)).surely == (30, 60)
    assert bar(Interval(10, 90), EventDates(0, 30), EventDates(10, 120)).surely is None
    assert bar(Interval(10), EventDates(0, 30), EventDates(40, INFINITE)).surely == (30, 40)


def test_what_is_not_bounded_goes_on_to_the_edge_of_the_picture():
    milestone = Milestone("there", EventDates(60, INFINITE, may_never=True))
    schedule = Schedule(
        1000, (), (milestone, Milestone("nowhere", EventDates(INFINITE, -INFINITE, may_never=True)))
    )
    ((_, (there, nowhere)),) = groups_of(schedule)
    assert (there.words, there.ends) == ("1:00 or later, if at all", (60, INFINITE))
    assert nowhere.words == "never"
    assert draw_timeline(schedule, title="m").width > 600


@pytest.mark.parametrize("span", [1.0, 59.0, 3600.0, 86_400.0, 6e7])
def test_an_axis_has_a_few_marks(span):
    assert 1 <= len(marks(span)) <= 11
