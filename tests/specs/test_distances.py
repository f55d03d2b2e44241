"""Claims about regions: what is said of places, distances and strays, and what is refused."""

import pytest

from semantics.properties.region_atoms import ApartFrom, PossiblyIn, SurelyIn, WithinRangeOf
from semantics.state.setting import Control
from specs.codes import Code
from specs.diagnostics import MissionError
from specs.elaboration import Variation, read_mission
from specs.formatter import format_mission

WORLD = """
signature standard
world {
  area0: Location = box (37.2, -8.5) (37.0, -8.7)
  prison0: Location = circle (37.1, -8.6) radius 900 m
  uav0: UAV = point (37.05, -8.6) linked wifi
  uav1: UAV = point (37.15, -8.6) linked wifi
  F: Station = point (37.12, -8.6)
  within: Station = point (37.13, -8.6)
}
BigActor a hosted_at uav0 with_behavior { control(MOVE_HOST_TO prison0) }
"""


def mission(claim, more="control timed", kind="invariant"):
    return read_mission(f'{WORLD}\n{more}\ncheck {{ {kind} "p": {claim} }}')


def refusal(claim, more="control timed"):
    with pytest.raises(MissionError) as caught:
        mission(claim, more)
    return {each.code for each in caught.value.diagnostics}


@pytest.mark.parametrize(
    ("claim", "atom"),
    [
        ("possibly uav0 in prison0", PossiblyIn("uav0", "prison0")),
        ("surely uav0 in area0", SurelyIn("uav0", "area0")),
        ("uav0 at least 50 m from uav1", ApartFrom("uav0", "uav1", 50.0)),
        ("uav0 at least 1.5 km or 30 m up from uav1", ApartFrom("uav0", "uav1", 1500.0, 30.0)),
        ("uav0 within 3 km of F", WithinRangeOf("uav0", "F", 3000.0)),
        ("F within 3 km of uav0", WithinRangeOf("F", "uav0", 3000.0)),
        ("F at least 3 km from within", ApartFrom("F", "within", 3000.0)),
    ],
)
def test_a_claim_about_a_region_is_an_atom(claim, atom):
    assert mission(claim).properties[0].formula == atom
    assert mission(str(atom)).properties[0].formula == atom


@pytest.mark.parametrize("letter", "XFGAE")
def test_a_letter_before_at_or_within_is_a_name(letter):
    text = WORLD.replace("F:", f"{letter}:")
    for claim in (f"{letter} at least 5 m from uav0", f"{letter} within 5 km of uav0"):
        for kind in ("invariant", "ltl"):
            found = read_mission(f'{text}\ncontrol timed\ncheck {{ {kind} "p": {claim} }}')
            assert str(found.properties[0].written) == claim


def test_a_quantified_claim_is_about_each_pair():
    formula = mission("forall x, y: UAV . x != y -> x at least 50 m from y").properties[0].formula
    assert str(
        formula
    ) == "forall x: UAV . forall y: UAV . not (not x == y) or x at least 50 m from y".replace(
        "not (not x == y)", "not not x == y"
    )


def test_a_formatted_claim_is_the_same_claim():
    text = 'environment { UAV strays at most 30 m } check { invariant "p": a at least 50 m or 3 m up from b }'
    once = format_mission(text)
    assert "UAV strays at most 30 m" in once
    assert "a at least 50 m or 3 m up from b" in once
    assert format_mission(once) == once


def test_a_bound_of_one_vehicle_replaces_that_of_its_kind():
    more = "control timed environment { uav0 strays at most 5 m UAV strays at most 0.5 km }"
    assert dict(mission("true", more).setting.strays) == {"uav0": 5.0, "uav1": 500.0}


@pytest.mark.parametrize(
    ("claim", "code"),
    [
        ("uav0 at least 50 from uav1", Code.MISSING_UNIT),
        ("uav0 within 5 min of uav1", Code.MISSING_UNIT),
        ("uav0 within 0 km of uav1", Code.BAD_RANGE),
        ("uav0 at least 0 m from uav1", Code.BAD_RANGE),
        ("uav0 at least 50 m from a", Code.WRONG_SORT),
        ("a within 50 m of uav0", Code.WRONG_SORT),
        ("possibly uav0 in uav1", Code.NOT_A_PLACE),
        ("surely uav0 in region", Code.NOT_A_PLACE),
        ("possibly uav0 directly in prison0", Code.UNEXPECTED),
        ("surely uav0 in prison", Code.UNKNOWN_NAME),
    ],
)
def test_a_claim_without_a_meaning_is_refused_by_its_code(claim, code):
    assert refusal(claim) == {code}


@pytest.mark.parametrize("claim", ["possibly uav0 in prison0", "uav0 within 3 km of uav1"])
def test_under_control_atomic_nothing_is_under_way(claim):
    assert refusal(claim, "control atomic") == refusal(claim, "") == {Code.NOT_UNDER_WAY}
    read_mission(f'{WORLD}\ncheck {{ invariant "p": {claim} }}', variation=Variation(control=Control.TIMED))


@pytest.mark.parametrize(
    ("clause", "code"),
    [
        ("uav0 strays at most 101 km", Code.BAD_RANGE),
        ("area0 strays at most 5 m", Code.NOT_DRIVEN),
        ("boat strays at most 5 m", Code.UNKNOWN_NAME),
        ("uav0 strays at most 5 m uav0 strays at most 6 m", Code.REPEATED_SETTING),
        ("uav0 strays at most 5", Code.MISSING_UNIT),
    ],
)
def test_strays_without_a_meaning_is_refused_by_its_code(clause, code):
    assert refusal("true", f"control timed environment {{ {clause} }}") == {code}


def test_a_vehicle_that_circles_strays_at_least_by_a_circle():
    more = (
        "control timed timing { UAV flies at 20 m/s, circles 40 m } environment { UAV strays at most %s m }"
    )
    assert refusal("true", more % 79) == {Code.BAD_RANGE}
    assert mission("true", more % 80).setting.strays["uav1"] == 80.0


def test_an_invariant_about_the_way_silences_the_warning_about_the_place():
    denied = "not actually uav0 in prison0"
    text = WORLD.replace("MOVE_HOST_TO prison0", "MOVE_HOST_TO north0").replace(
        "prison0: ", "north0: Location = circle (37.15, -8.6) radius 500 m\n  prison0: "
    )
    warned = read_mission(f'{text}\ncontrol timed check {{ invariant "p": {denied} }}').warnings
    assert [each.code for each in warned] == [Code.MAY_CROSS]
    both = f'check {{ invariant "p": {denied} invariant "q": not possibly uav0 in prison0 }}'
    assert read_mission(f"{text}\ncontrol timed {both}").warnings == ()


@pytest.mark.parametrize("claim", ["not possibly uav0 in prison0", "not actually uav0 in prison0"])
def test_a_mistake_in_a_rule_is_reported_alone(claim):
    rule = "rule bad(u: UAV) { u | -> u }\nBigActor b hosted_at uav1 with_behavior { control(bad(uav0)) }\n"
    assert refusal(claim, f"{rule}control timed") == {Code.RULE_SYNTAX}


@pytest.mark.parametrize(
    ("claim", "hint"),
    [
        ("uav0 not within 5 km of uav1", "write not uav0 within ..."),
        ("uav0 not at least 50 m from uav1", "write not uav0 at ..."),
        ("definitely uav0 in area0", "write surely uav0 in ..."),
        ("not maybe uav0 in prison0", "write possibly uav0 in ..."),
        ("uav0 within 25 of uav1", "write 25 m or 25 km"),
    ],
)
def test_a_claim_in_other_words_is_refused_with_the_one_to_write(claim, hint):
    with pytest.raises(MissionError) as refused:
        mission(claim)
    assert refused.value.diagnostics[0].hint == hint
