"""Control races (semantics.md, check 2), each of their clauses."""

import pytest
from checked_missions import PILOTS, WORLD, kinds, load, moves, rules_of, verdict, violation

from checker import explore
from checker.properties.findings import Collected
from checker.properties.races import ControlRaces
from checker.verdicts import Outcome

HANDS_AND_MOVES = """
BigActor a hosted_at gcs0 with_behavior { control(HAND uav0 TO gcs1) }
BigActor b hosted_at gcs0 with_behavior { control(MOVE uav0 TO gate0) }
"""
MOVES_AND_HANDS = HANDS_AND_MOVES.replace("or a", "or x").replace("or b", "or a").replace("or x", "or b")
APART = moves("gate0", "a", "uav0") + moves("gate0", "b", "uav1")
LOOKS_TOO = APART.replace(" }", " observe(PARENT(HOST)) }")
ONCE = moves("gate0", "a", "uav0")
TWICE = ONCE.replace("}", "control(MOVE_HOST_TO gate0) }")
THERE_AND_BACK = ONCE.replace("}", "control(MOVE_HOST_TO south0) }")
MOVES_AND_PARTS = ONCE.replace("}", "control(DISCONNECT_HOST_FROM uav1) }")
UNORDERED, FCFS, TIMED = "scheduler unordered\n", "scheduler fcfs\n", "control timed\n"

NO_RACES = {
    "controls that commute": APART,
    "what is pending, in the order of programs": LOOKS_TOO,
    "what is pending, in one queue": LOOKS_TOO + FCFS,
    "what is pending, in no order": LOOKS_TOO + UNORDERED,
    "one agent's controls in a line": THERE_AND_BACK,
    "one agent's controls in the one queue": THERE_AND_BACK + FCFS,
    "one agent's equal controls, of which the second changes nothing": TWICE + UNORDERED,
    "one control that takes time": ONCE + UNORDERED + TIMED,
    "one agent's controls that commute in no line": MOVES_AND_PARTS + UNORDERED,
    "flights of two vehicles into one place": APART + TIMED,
    "the environment beside a control": ONCE + "environment { uav0 drifts among south0 gate0 vanishes }",
}
RACES = {
    "one queue hides none": (PILOTS + FCFS, "end differently"),
    "nor one that disables": (HANDS_AND_MOVES + FCFS, "serving CTR(a, HAND uav0 TO gcs1) disables CTR(b, MOVE "),
    "the first disables": (HANDS_AND_MOVES, "serving CTR(a, HAND uav0 TO gcs1) disables CTR(b, MOVE uav0 TO gate0)"),
    "the second disables": (MOVES_AND_HANDS, "serving CTR(b, HAND uav0 TO gcs1) disables CTR(a, MOVE uav0 TO gate0)"),
    "one agent in no line": (THERE_AND_BACK + UNORDERED, "end differently"),
    "one agent's equal controls, of which one has to wait": (
        TWICE + UNORDERED + TIMED,
        "serving CTR(a, MOVE_HOST_TO gate0) disables CTR(a, MOVE_HOST_TO gate0)",
    ),
    "two commands for one vehicle, of which one has to wait": (
        PILOTS + TIMED,
        "serving CTR(a, MOVE uav0 TO south0) disables CTR(b, MOVE uav0 TO gate0)",
    ),
}  # fmt: skip


def first_race(text):
    """Return the first message of a control race, None where there is none; ownership is not asked."""
    looked = ControlRaces()
    explore(load(text).initial, (looked,))
    first = next(iter(looked.collected.first.values()), None)
    return first and first.message


@pytest.mark.parametrize("text", NO_RACES.values(), ids=NO_RACES)
def test_no_control_race_is(text):
    assert first_race(text) is None


@pytest.mark.parametrize(("text", "words"), RACES.values(), ids=RACES)
def test_a_control_race_is(text, words):
    assert words in first_race(text)


def test_two_orders_that_end_differently_are_a_race():
    found = verdict(PILOTS, "race_freedom")
    assert kinds(found) == {"control race": 2}
    race = violation(found, "control race")
    assert (
        race.message
        == "CTR(a, MOVE uav0 TO south0) and CTR(b, MOVE uav0 TO gate0) end differently in the two orders"
    )
    assert rules_of(race.trace) == ["req_ctr", "req_ctr"]
    assert race.details == (
        "enabled here: ⟨actuate : CTR(a, MOVE uav0 TO south0)⟩ and ⟨actuate : CTR(b, MOVE uav0 TO gate0)⟩",
    )


def test_a_flight_races_with_what_takes_its_authority_away():
    looked = []

    class Flights(ControlRaces):
        def __call__(self, number, c, expansion):
            self.collected = Collected()
            super().__call__(number, c, expansion)
            looked.extend(each.message for each in self.collected.first.values() if "FLY" in each.message)

    explore(load(HANDS_AND_MOVES + TIMED).initial, (Flights(),))
    assert "disables FLY(b, MOVE uav0 TO gate0)" in looked[0]


TWO_APART = """
control timed
rule enter(u: UAV, b: Location) { u || b -> b.u }
BigActor a hosted_at uav0 with_behavior { control(enter(uav0, gate0)) }
BigActor b hosted_at uav1 with_behavior { control(enter(uav1, basin0)) }
timing { UAV flies at 300 m/s to 400 m/s }
"""


def test_what_is_remembered_of_flights_for_their_times_makes_no_race():
    apart = WORLD.replace("  gate0: ", "  basin0: Location = circle (37.00, -8.60) radius 300 m\n  gate0: ")
    for timing in (TWO_APART, TWO_APART[: TWO_APART.index("timing")]):
        assert verdict(timing, "race_freedom", apart).outcome is Outcome.HOLDS
