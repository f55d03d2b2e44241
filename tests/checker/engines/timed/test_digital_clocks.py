"""Missions with times, in whole ticks: against what their times mean by hand, and against a naive interpreter."""

import re
import sys
from dataclasses import replace
from math import inf

import pytest
from checked_missions import load, rules_of
from hypothesis import HealthCheck, assume, given, settings
from hypothesis import strategies as st
from naive_time import Naive, TooLarge
from scale import IS_WHOLE, examples
from shipped import TIMED
from timed_missions import ANSWERS, FLIGHT, SOUTH, timed_missions, timed_programs, with_timing, within
from timed_reports import assert_alike

from checker import CombinationError, Limits, Reduction, check, replay
from checker.check import BY_LOOKING
from checker.engines.choose import explore
from checker.engines.contract import Engine, EngineError
from checker.properties.deadlines import Deadlines
from checker.reports.lanes import lanes_of_trace, lanes_text
from checker.traces import ReplayError, print_trace, to_json
from checker.verdicts import Outcome
from semantics.properties.kinds import PropertyKind
from semantics.properties.property import Property, watching
from semantics.properties.propositions import Ended, HasPending, Inside, LinkedWith, Not
from semantics.timing.intervals import Interval
from semantics.timing.timing import ClauseTimes, Endurance, Every, Motion, Sayable, Timing, Window
from specs.elaboration import load_mission
from specs.missions import shipped_missions

MINUTES = Timing(
    60_000,
    motions=(("uav0", Motion((18.0, 25.0))),),
    endurances=(("uav0", Endurance(6, ("north0",), 20)),),
    react=Interval(0, 1),
)


def timed(text, timing):
    return with_timing(load(text).initial, timing)


def decided(c, *properties):
    """Return what whole ticks say, and look whether zones say the same."""
    asked = (*properties, Property(PropertyKind.COMPUTATION, "computation"))
    report, zones = (check(c, asked, engine=each) for each in (Engine.REFERENCE, Engine.FAST))
    assert_alike(report, zones)
    return report


def when(formula=SOUTH):
    return Property(PropertyKind.TIME, "time", formula)


@pytest.fixture(scope="module")
def flight():
    return timed(FLIGHT, MINUTES)


@pytest.fixture
def late(flight):
    """Return the trace of a deadline that is not kept, as data."""
    return to_json(decided(flight, within(7)).verdicts["within"].violations[0].trace, "flight", "")


# At least 2.2 km at 25 m/s, 88 s; at most 5.9 km at 18 m/s, 326 s: 1 to 6 whole minutes, after two reactions.


@pytest.mark.long
def test_a_flight_has_an_earliest_and_a_latest_arrival(flight):
    report = decided(flight, when())
    assert (report.configurations, report.transitions, report.complete) == (4, 3, True)
    assert report.verdicts["time"].note == "at 1:00 at the earliest, at 8:00 at the latest"
    (note,) = report.notes  # 2 while it is asked for, 2 while it is pending, 7 in flight, 1 at the end
    assert (
        note
        == "searched over 12 timed configurations, in ticks of 1 min; times are those under 'scheduler fcfs'"
    )


def test_a_deadline_holds_exactly_from_the_latest_arrival_on(flight):
    assert decided(flight, within(8)).verdicts["within"].outcome is Outcome.HOLDS
    late = decided(flight, within(7)).verdicts["within"]
    assert late.outcome is Outcome.VIOLATED
    assert late.violations[0].message.startswith("still not true at 8:00: ")


def test_a_trace_has_dates_and_replays_with_them(flight):
    trace = decided(flight, within(7)).verdicts["within"].violations[0].trace
    assert rules_of(trace) == ["req_ctr", "command"]
    assert next(print_trace(trace)) == "c0 --at 1:00 ⟨req_ctr : a, control(MOVE_HOST_TO south0)⟩--> c1"
    data = to_json(trace, "flight", "")
    assert [step["at"] for step in data["steps"]] == [60.0, 120.0]
    assert replay(flight, data) == trace
    assert [line.split()[-1] for line in lanes_text(lanes_of_trace(trace)) if "●" in line] == ["1:00", "2:00"]


@pytest.mark.parametrize(
    ("at", "cause"),
    [
        ([0, 120], "another step is due by 1:00"),
        ([60, 0], "it is 1:00 already"),
        ([120, 120], "another step is due by 1:00"),
    ],
)
def test_a_step_at_a_moment_that_the_clocks_do_not_allow_does_not_replay(flight, late, at, cause):
    for step, seconds in zip(late["steps"], at, strict=True):
        step["at"] = seconds
    with pytest.raises(ReplayError, match=cause):
        replay(flight, late)


@pytest.mark.parametrize("at", [-60, 61, "noon", True, None, 1e300])
def test_a_date_is_a_whole_number_of_ticks(flight, late, at):
    late["steps"][0]["at"] = at
    with pytest.raises(ValueError, match="step 1 should be taken 'at' a whole number of ticks of 60000 ms"):
        replay(flight, late)


def test_a_vehicle_that_never_left_is_full_and_then_lasts_so_long(flight):
    endurance = Property(PropertyKind.ENDURANCE, "endurance")
    found = decided(flight, endurance).verdicts["endurance"]
    assert found.violations[0].message == "uav0 lasts 6 min, and is still not restored at 7:00"
    exactly = MINUTES.endurances[0][1]
    places = (*exactly.places, "south0")
    home = with_timing(load(FLIGHT).initial, replaced(endurances=(("uav0", Endurance(7, places, 20)),)))
    assert decided(home, endurance).verdicts["endurance"].outcome is Outcome.HOLDS


ABOARD = """\
signature standard { kind Vessel driven carries UAV }
world {
  south0: Location = circle (37.0, -8.7) radius 300 m
  north0: Location = circle (37.02, -8.7) radius 300 m
  ship0: Vessel = point (37.0, -8.7)
  uav0: UAV carried by ship0
}
BigActor a hosted_at ship0 with_behavior {
  control(MOVE_HOST_TO north0)
}
control timed
timing {
  tick 1 min
  ship0 flies at 3 m/s
  uav0 lasts 2 min, restored in PLACE
  agents react within 1 min
}
check {
  endurance
}
"""


@pytest.mark.parametrize(("place", "outcome"), [("ship0", Outcome.HOLDS), ("south0", Outcome.VIOLATED)])
def test_a_vehicle_aboard_what_restores_it_is_restored_on_its_way(place, outcome, tmp_path):
    file = tmp_path / "aboard.mission"
    file.write_text(ABOARD.replace("PLACE", place), encoding="utf-8")
    mission = load_mission(file)
    assert decided(mission.initial, *mission.properties).verdicts["endurance"].outcome is outcome


def replaced(**changes):
    return Timing(**{name: getattr(MINUTES, name) for name in Timing.__dataclass_fields__} | changes)


def test_a_flight_that_ends_in_time_arrives(flight):
    arrival = Property(PropertyKind.ARRIVAL, "arrival")
    assert decided(flight, arrival).verdicts["arrival"].outcome is Outcome.HOLDS
    unknown = with_timing(load(FLIGHT).initial, replaced(motions=()))
    assert decided(unknown, arrival).verdicts["arrival"].outcome is Outcome.VIOLATED


def test_what_is_not_said_is_not_assumed_and_a_late_deadline_says_so():
    late = decided(with_timing(load(FLIGHT).initial, replaced(motions=())), within(7)).verdicts["within"]
    assert late.violations[0].details == (
        "it may stay so for ever",
        "⟨commit : FLY(a, MOVE_HOST_TO south0)⟩ has no upper time bound",
    )


@pytest.mark.parametrize("said", [(), (("HAND", Interval(0, 2)),)], ids=["unsaid", "said"])
def test_a_command_of_which_no_line_speaks_takes_any_time(said):
    hand = "BigActor a hosted_at gcs0 with_behavior { control(HAND uav0 TO gcs1) }"
    linked = LinkedWith("uav0", "gcs1", actually=True)
    report = decided(
        timed(hand, Timing(react=Interval(0, 1), commands=said)), when(linked), within(3, linked)
    )
    latest = "at 0:03 at the latest" if said else "at any time if at all: it may never"
    assert report.verdicts["time"].note == f"at 0:00 at the earliest, {latest}"
    assert (report.verdicts["within"].outcome is Outcome.HOLDS) is bool(said)


COMES_AGAIN = """
signature { kind Tanker contains UAV kind UAV driven }
world {
  tanker0: Tanker = circle (37.02, -8.70) radius 300 m
  uav0: UAV = point (37.00, -8.70)
}
BigActor a hosted_at uav0 with_behavior { control(MOVE_HOST_TO tanker0) }
control timed
environment {
  tanker0 vanishes
  tanker0 appears at circle (37.12, -8.70) radius 300 m
}
timing { UAV flies at 400 m/s to 500 m/s agents take 0 s }
"""


def test_a_destination_that_vanishes_on_the_way_and_comes_again_brings_nobody_there_sooner():
    arrived = Inside("uav0", "tanker0", actually=True)
    stays = COMES_AGAIN[: COMES_AGAIN.index("environment")] + COMES_AGAIN[COMES_AGAIN.index("timing") :]
    for text in (stays, COMES_AGAIN):
        report = decided(load(text, "").initial, when(arrived))
        assert report.verdicts["time"].note.startswith("at 0:03 at the earliest")


def test_a_response_is_bounded_by_all_that_it_takes():
    pending, over = HasPending("a"), Ended("b")
    timing = Timing(react=Interval(0, 1), sense=Interval(0, 5), messages=(("internet", Interval(1, 3)),))
    c = timed(ANSWERS, timing)
    report = decided(c, within(11, pending, over), when(over))
    assert report.verdicts["within"].outcome is Outcome.HOLDS
    assert report.verdicts["time"].note == "at 0:01 at the earliest, at 0:12 at the latest"
    assert decided(c, within(10, pending, over)).verdicts["within"].outcome is Outcome.VIOLATED
    never = decided(c, within(3, Inside("uav0", "gate0"), over)).verdicts["within"]
    assert never.remarks[0].startswith("vacuous: never true: ")


def environment(clause, times, text='BigActor a hosted_at gcs0 with_behavior { react { case "go" => } }'):
    return timed(f"{text}\nenvironment {{ {clause} }}", Timing(react=Interval(0, 0), clauses=(times,)))


def test_a_message_may_be_said_in_its_window_and_need_not_be():
    c = environment('someone says "go" to a', ClauseTimes(Sayable(2, 4)))
    report = decided(c, when(Ended("a")), Property(PropertyKind.DEADLOCK_FREEDOM, "deadlock_freedom"))
    assert (
        report.verdicts["time"].note
        == "at 0:02 at the earliest, at 0:04 at the latest if at all: it may never"
    )
    assert report.verdicts["deadlock_freedom"].outcome is Outcome.VIOLATED
    ever = environment('someone says "go" to a', ClauseTimes(Sayable(2)))
    assert decided(ever, Property(PropertyKind.DEADLOCK_FREEDOM, "d")).verdicts["d"].outcome is Outcome.HOLDS


def test_what_vanishes_in_a_window_does():
    c = environment("drifter0 vanishes", ClauseTimes(Window(2, 4)))
    gone = Not(Inside("drifter0", "vessel0", actually=True))
    assert decided(c, when(gone)).verdicts["time"].note == "at 0:02 at the earliest, at 0:04 at the latest"


def test_a_channel_drops_at_most_every_so_often_and_returns_in_time():
    c = environment("mesh drops and returns", ClauseTimes(Every(5), returns=2))
    timeline = explore(c).times.timeline
    drops, ups = (timeline.situations[number].steps for number in timeline.order)
    assert [str(each.transition.label) for each in (*drops, *ups)] == [
        "⟨env : mesh drops⟩",
        "⟨env : mesh returns⟩",
    ]
    assert len(timeline.states) == 9  # up: 0 to 5 since the last drop; down: 0 to 2


def test_agents_that_loop_in_zero_time_stop_it():
    c = timed(
        'BigActor a hosted_at gcs0 with_behavior { loop { send("on", a) react { case "on" => } } }', ZERO
    )
    report = decided(c, within(3), when(Ended("a")))
    (stop,) = report.verdicts["computation"].violations
    assert stop.kind == "time stops"
    assert stop.trace.loop is not None
    assert {report.verdicts[name].outcome for name in ("within", "time")} == {Outcome.INCOMPLETE}
    assert report.verdicts["time"].note.startswith(
        "not decided: time stops; no time can pass any more after 0:00: "
    )


ZERO = Timing(react=Interval(0, 0), messages=(("", Interval(0, 0)),))


def test_controls_race_only_where_both_may_be_served_at_one_moment():
    race = Property(PropertyKind.RACE_FREEDOM, "race_freedom")
    two = """
BigActor a hosted_at gcs0 with_behavior { control(HAND uav0 TO gcs1) }
BigActor b hosted_at gcs0 with_behavior { react { case "go" => control(HAND uav0 TO gcs2) } }
environment { someone says "go" to b }
"""
    found = {}
    for after in (1, 2):
        times = (ClauseTimes(Sayable(after)),)
        c = timed(two, Timing(react=Interval(0, 0), commands=(("HAND", Interval(1, 2)),), clauses=times))
        found[after] = [each.kind for each in decided(c, race).verdicts["race_freedom"].violations]
    assert found == {1: ["control race"], 2: []}  # a is served at 2 at the latest, b at 1 later than asked


def test_other_engines_and_reductions_are_refused_by_name(flight):
    with pytest.raises(
        CombinationError, match="the engine 'ray' does not explore missions with a section 'timing': each"
    ):
        check(flight, (when(),), engine=Engine.RAY)
    with pytest.raises(
        CombinationError, match="the reduction 'por' is refused: it is not sound for missions with a section"
    ):
        check(flight, (when(),), reduce=(Reduction.POR,))


def test_what_ticks_do_not_get_through_is_given_to_zones(flight, monkeypatch):
    monkeypatch.setattr(sys.modules["checker.check"], "PATIENCE", 0.0)
    report = check(flight, (when(),))
    assert report.complete
    assert report.notes[0].startswith("searched over 4 zones, ")


@pytest.mark.parametrize(("engine", "most"), [(Engine.FAST, 1), (Engine.REFERENCE, 5)])
def test_a_limit_is_said_and_nothing_holds(flight, engine, most):
    report = check(flight, (within(8), when()), Limits(configurations=most), engine=engine)
    assert not report.complete
    assert {each.outcome for each in report.verdicts} == {Outcome.INCOMPLETE}


def test_more_ticks_than_zones_count_are_refused():
    endless = replaced(endurances=(("uav0", Endurance(1 << 28)),))
    with pytest.raises(EngineError, match="268,435,457 ticks are more than the engine 'fast' counts"):
        check(
            with_timing(load(FLIGHT).initial, endless),
            (Property(PropertyKind.ENDURANCE, "endurance"),),
            engine=Engine.FAST,
        )


DAY = """
BigActor a hosted_at gcs0 with_behavior { react { after 24 h => skip } }
BigActor b hosted_at gcs1 with_behavior { observe(HOST) }
control timed
timing { tick 1 ms agents react within 1 ms sense within 24 h }
"""


def test_a_date_of_more_ticks_than_zones_count_is_refused():
    """No clock of the mission shows so many ticks, but that of the question does."""
    with pytest.raises(EngineError, match="ticks are more than the engine 'fast' counts"):
        check(load(DAY).initial, (when(Ended("a")),), engine=Engine.FAST)


def test_how_long_vehicles_are_aloft_is_timed_only_where_endurance_is_asked(flight):
    endurance = Property(PropertyKind.ENDURANCE, "endurance")
    assert watching(flight, (when(), endurance)) is flight
    said = replaced(lines=(("uav0 lasts 6 min", 3), ("agents react within 1 min", 4)))
    kept = watching(with_timing(flight, said), (when(),)).setting.timing
    assert kept == replaced(endurances=(), lines=said.lines[1:])
    alone, both = (decided(flight, *asked) for asked in ((when(),), (when(), endurance)))
    assert alone.verdicts["time"].note == both.verdicts["time"].note
    assert (alone.configurations, alone.transitions) == (both.configurations, both.transitions)
    assert "20 timed configurations" in both.notes[0]


def test_properties_of_runs_are_not_decided_with_times(flight):
    progress = Property(PropertyKind.PROGRESS, "progress")
    found = decided(flight, progress).verdicts["progress"]
    assert (found.outcome, found.note.partition(":")[0]) == (Outcome.INCOMPLETE, "not decided")


def test_without_timing_nothing_is_decided_of_times():
    found = decided(load(FLIGHT).initial, within(8)).verdicts["within"]
    assert found.note.endswith("give it a section `timing`")


# --- the naive interpreter


@st.composite
def questions(draw, c):
    agents, names = c.alpha.names(), sorted(c.setting.kinds)
    some = [*map(Ended, agents), *map(HasPending, agents), Inside(names[0], names[-1], actually=True)]
    formulas = st.sampled_from([*some, *map(Not, some)])
    return draw(formulas), draw(formulas), draw(st.integers(0, 5))


def agree(c, data, most):
    found = explore(c, limits=Limits(configurations=most))
    assume(found.complete)
    try:
        naive = Naive(c, 4 * most)
    except TooLarge:
        assume(False)
    timed = Deadlines(found, found.times, c.setting.timing)
    assert set(found.configurations) == naive.configurations()
    assert (timed.stop is not None) == naive.time_stops()
    aloft = timed.endurance(Property(PropertyKind.ENDURANCE, ""))
    assert {each.subject for each in aloft.violations} == naive.exhausted()
    f, g, ticks = data.draw(questions(c))
    moments = found.times.moments(f)
    earliest = inf if moments.first is None else moments.first.end
    assert (earliest, moments.latest, moments.may_wait) == naive.first_time(f)
    for formula, then in ((None, g), (f, g)):
        asked = within(ticks, g if formula is None else f, None if formula is None else g)
        assert (timed.within(asked).outcome is Outcome.VIOLATED) == naive.late(formula, then, ticks)


UNBOTHERED = list(HealthCheck)


def tried(often):
    return settings(max_examples=often, deadline=None, suppress_health_check=UNBOTHERED)


@tried(12)
@given(timed_missions(), st.data())
def test_whole_ticks_agree_with_parts_of_ticks(c, data):
    agree(c, data, 100)


@pytest.mark.long
@tried(150)
@given(timed_missions(), st.data())
def test_whole_ticks_agree_with_parts_of_ticks_on_many_missions(c, data):
    agree(c, data, 1500)


# --- zones


ALL = (
    *(Property(kind, kind.value) for kind in BY_LOOKING),
    Property(PropertyKind.RACE_FREEDOM, "race_freedom"),
    Property(PropertyKind.ENDURANCE, "endurance"),
)


def agree_with_zones(c, data, most):
    assume(explore(c, limits=Limits(configurations=most)).complete)
    f, g, ticks = data.draw(questions(c))
    timed_ones = (within(ticks, g), replace(within(ticks, f, g), name="leads"), when(f))
    formulas = (
        Property(PropertyKind.INVARIANT, "invariant", f),
        Property(PropertyKind.REACHABLE, "reachable", g),
    )
    asked = (*ALL, *timed_ones, *formulas)
    assert_alike(*(check(c, asked, engine=each, times=True) for each in (Engine.REFERENCE, Engine.FAST)))


@tried(540 if IS_WHOLE else 18)
@given(st.one_of(timed_programs(), timed_missions()), st.data())
def test_zones_report_what_whole_ticks_report(c, data):
    agree_with_zones(c, data, 100)


@pytest.mark.long
@examples(1000, deadline=None, suppress_health_check=UNBOTHERED)
@given(timed_missions(), st.data())
def test_zones_report_what_whole_ticks_report_on_many_missions(c, data):
    agree_with_zones(c, data, 2000)


FINE = "oil_spill_timed"
"""Its seconds are too many for whole ticks."""


@pytest.mark.parametrize("name", [name for name in TIMED if name != FINE])
def test_zones_report_of_a_shipped_mission_what_whole_ticks_report(name):
    mission = load_mission(name)
    assert_alike(*(check(mission, engine=each, times=True) for each in (Engine.REFERENCE, Engine.FAST)))


@pytest.mark.long
def test_zones_report_what_whole_ticks_report_of_a_mission_whose_ticks_are_made_coarse(tmp_path):
    text = shipped_missions()[FINE].read_text(encoding="utf-8")
    coarse = re.sub(r"within (1|2|10) s", "within 2 min", text).replace("timing {", "timing {\n  tick 2 min")
    (tmp_path / "coarse.mission").write_text(coarse, encoding="utf-8")
    mission = load_mission(tmp_path / "coarse.mission")
    assert_alike(*(check(mission, engine=each) for each in (Engine.REFERENCE, Engine.FAST)))


def test_after_the_end_of_its_time_a_search_in_ticks_decides_nothing_more(flight):
    met = []
    found = explore(
        flight, [lambda *seen: met.append(seen)], limits=Limits(seconds=1e-9), engine=Engine.REFERENCE
    )
    time = "the time limit of 1e-09 s"
    assert list(map(str, found.bounds)) == [
        time,
        f"{time}, in the examination of the explored configurations",
    ]
    assert met == []
    report = check(flight, [when()], Limits(seconds=1e-9), engine=Engine.REFERENCE)
    assert report.verdicts["time"].note == f"not decided: {time} was met"
