"""What a `timing` section comes to: bounds in whole ticks, of vehicles, agents, messages and clauses."""

from pathlib import Path

import pytest
from elaborating import elaborated
from hypothesis import given
from hypothesis import strategies as st

from semantics.environment import Drifts, Drops, Leaves, Says
from semantics.properties.kinds import PropertyKind
from semantics.properties.propositions import HasPending, Inside, Not
from semantics.state.setting import Control
from semantics.timing.intervals import Interval
from semantics.timing.timing import ClauseTimes, Endurance, Every, Motion, Sayable, Window
from specs import syntax as s
from specs.diagnostics import MissionError, Source
from specs.elaboration import load_mission
from specs.elaboration.mission_mistakes import Findings
from specs.elaboration.timing import TickConversion
from specs.elaboration.variation import Variation
from specs.formatter import format_mission

TIMED = Path(__file__).parents[1] / "corpus" / "ok" / "timed.mission"


@pytest.fixture(scope="module")
def mission():
    return load_mission(TIMED)


def test_a_mission_without_a_section_has_no_times():
    assert load_mission("oil_spill").setting.timing is None


def test_vehicles_have_what_is_said_of_their_kind_or_of_themselves(mission):
    knot = 1852 / 3600
    timing = mission.setting.timing
    assert timing.tick == 500
    assert timing.motion("uav0") == Motion((18.0, 25.0), (2.0, 5.0), 160.0)  # a circle by its diameter
    assert timing.motion("vessel0") == Motion((10 * knot, pytest.approx(10.0)))
    assert timing.endurances == (("uav0", Endurance(5_400, ("base0",), 2_400)),)


def test_what_is_said_of_one_vehicle_replaces_what_is_said_of_its_kind():
    text = TIMED.read_text(encoding="utf-8").replace(
        "  tick 500 ms\n", "  tick 500 ms\n  vessel0 lasts 2 h\n  Vessel lasts 1 h\n"
    )
    timing = elaborated(text, TIMED.parent).setting.timing
    assert dict(timing.endurances)["vessel0"] == Endurance(14_400)


def test_steps_have_their_intervals(mission):
    timing = mission.setting.timing
    assert (timing.react, timing.sense) == (Interval(1, 2), Interval(2, 10))
    assert timing.messages == (("", Interval(0, 2)), ("wifi", Interval(2, 6)))
    assert timing.commands == (
        ("HAND", Interval(0, 20)),
        ("land", Interval(60, 60)),
        ("migrate", Interval(2, None)),
        ("spawn", Interval(0, 4)),
    )


def test_clauses_have_their_times_by_their_numbers(mission):
    times = dict(zip(mission.setting.environment, mission.setting.timing.clauses, strict=True))
    by_kind = {type(clause): each for clause, each in times.items()}
    assert by_kind[Drifts] == ClauseTimes(Every(2_400))
    assert by_kind[Drops] == ClauseTimes(Every(3_600), returns=600)
    assert by_kind[Leaves] == ClauseTimes(None, returns=600)
    assert by_kind[Says] == ClauseTimes(Sayable(1_200, 2_400))
    assert [each.step for each in times.values() if isinstance(each.step, Window)] == [
        Window(1_200, 3_600),
        Window(0, 7_200),
    ]


def test_every_bound_is_told_with_its_line(mission):
    lines = mission.setting.timing.lines
    assert len(lines) == 17  # all but the tick
    text = mission.source.text.split("\n")
    assert all(text[line - 1].strip() == words for words, line in lines)


def test_properties_of_time(mission):
    there, answered, endurance, found = mission.properties[:4]
    assert (there.kind, there.name, there.bound, there.then) == (PropertyKind.WITHIN, "there", 4_800, None)
    assert there.formula == Inside("uav0", "search0", actually=True)
    assert there.written == "actually uav0 in search0"
    assert (answered.bound, answered.formula) == (600, HasPending("a", "OBS"))
    assert answered.then == Not(HasPending("a", "OBS"))
    assert (endurance.kind, found.kind) == (PropertyKind.ENDURANCE, PropertyKind.TIME)


def test_a_section_is_written_in_the_canonical_layout():
    text = TIMED.read_text(encoding="utf-8")
    section = text[text.index("timing {") : text.index("check {")]
    assert section.strip() in format_mission(text)


@given(st.integers(1, 5_000), st.integers(0, 600_000))
def test_durations_are_counted_exactly_in_milliseconds(tick, milliseconds):
    findings = Findings(Source("", ""))
    ticks = TickConversion(tick, findings).count(s.Duration(milliseconds / 1000, "s"))
    if milliseconds % tick:
        assert len(findings) == 1
    else:
        assert (ticks * tick, len(findings)) == (milliseconds, 0)


def test_the_control_that_is_given_instead_has_to_take_time_too():
    with pytest.raises(MissionError, match="LS803"):
        load_mission(TIMED, Variation(control=Control.ATOMIC))
