"""Critical paths: what the date of a violated deadline is made of."""

from dataclasses import replace
from itertools import pairwise

from checked_missions import load
from hypothesis import HealthCheck, given
from scale import examples
from timed_missions import FLIGHT, timed_missions, with_timing, within

from checker import Limits, check
from checker.reports.report import report_text
from semantics.properties.kinds import PropertyKind
from semantics.properties.property import Property
from semantics.properties.propositions import Ended, HasPending, Not
from semantics.timing.intervals import Interval
from semantics.timing.timing import ONE_HOST, Endurance, Motion, Timing

LINES = (("UAV flies at 18 m/s to 25 m/s", 7), ("agents react within 1 min", 8))
MINUTES = Timing(
    60_000,
    motions=(("uav0", Motion((18.0, 25.0))),),
    endurances=(("uav0", Endurance(5, ("north0",), 20)),),
    react=Interval(0, 1),
    lines=LINES,
)


def flight(timing=MINUTES):
    return with_timing(load(FLIGHT).initial, timing)


def report_on(c, *asked, most=2_000):
    return check(c, asked, Limits(configurations=most))


def test_a_violated_deadline_is_made_of_bounds_each_with_its_words_and_line():
    report = report_on(flight(), within(6))
    (late,) = report.verdicts[0].violations
    assert [(leg.begin, leg.end, leg.label.rule, str(leg.bound), leg.going_on) for leg in late.path] == [
        (0, 1, "command", "agents react within 1 min (line 8)", False),
        (1, 7, "commit", "UAV flies at 18 m/s to 25 m/s (line 7)", True),
    ]
    told = [line[8:] for line in report_text("m", report, traces=False) if line.startswith(" " * 8)]
    assert told[0] == "critical path:"
    assert told[1:] == [f"  {leg}" for leg in late.path]
    assert str(late.path[-1]) == (
        "6 min so far from 1:00 on: ⟨commit : FLY(a, MOVE_HOST_TO south0)⟩, "
        "1 min to 6 min (UAV flies at 18 m/s to 25 m/s, line 7)"
    )


def test_a_late_response_is_made_of_what_happens_since_it_is_awaited():
    flying = HasPending("a", "FLY")
    (late,) = report_on(flight(), within(4, flying, Not(flying))).verdicts[0].violations
    (leg,) = late.path
    assert (leg.end - leg.begin, leg.label.rule, leg.going_on) == (5, "commit", True)


def test_an_exhausted_vehicle_has_the_path_of_the_time_that_it_was_aloft():
    report = report_on(flight(), Property(PropertyKind.ENDURANCE, "endurance"))
    (exhausted,) = report.verdicts[0].violations
    assert not exhausted.path  # it never comes back: nothing is waited for


def test_what_nothing_bounds_is_said_to_be_unbounded():
    timing = replace(MINUTES, react=Interval(), lines=LINES[:1])
    (late,) = report_on(flight(timing), within(6)).verdicts[0].violations
    assert [str(leg).rpartition(", ")[2] for leg in late.path] == ["without an upper time bound"]


def test_time_that_stops_has_the_path_to_that_moment():
    text = """BigActor a hosted_at gcs0 with_behavior {
      react { after 5 s => skip }
      loop { send("on", a) react { case "on" => } }
    }"""
    timing = Timing(react=Interval(0, 0), messages=((ONE_HOST, Interval(0, 0)),))
    c = with_timing(load(text).initial, timing)
    report = report_on(c, Property(PropertyKind.COMPUTATION, "computation"))
    (stop,) = report.verdicts[0].violations
    assert [(leg.begin, leg.end, leg.label.rule) for leg in stop.path] == [(0, 5, "timeout")]


@examples(60, suppress_health_check=list(HealthCheck), deadline=None)
@given(timed_missions())
def test_no_leg_of_a_path_takes_longer_than_its_bound(c):
    asked = [within(2, Ended(a)) for a in sorted(c.alpha.names())[:1]]
    for violation in report_on(c, *asked, most=400).verdicts[0].violations if asked else ():
        assert all(one.end == other.begin for one, other in pairwise(violation.path))
        for leg in violation.path:
            assert leg.begin < leg.end <= 3
            assert leg.interval.hi is None or leg.end - leg.begin <= leg.interval.hi
