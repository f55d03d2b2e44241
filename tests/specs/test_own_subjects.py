"""LS712: tests of an observation that always has a member, with an exploration as the judge."""

import pytest

from checker import check
from specs.codes import Code
from specs.elaboration import read_mission

WORLD = """signature {
  kind Location contains UAV, Boat
  kind UAV driven
  kind Boat carries Buoy
  kind Buoy
  kind Station
}
world {
  bay0: Location = box (37.1, -8.6) (37.0, -8.7)
  gate0: Location = circle (37.2, -8.65) radius 300 m
  uav0: UAV = point (37.05, -8.65) linked radio0
  uav1: UAV = point (37.06, -8.65) linked radio0
  gcs0: Station = point (37.04, -8.65) linked radio0
  boat0: Boat = point (37.05, -8.66)
}
control timed
BigActor mover hosted_at uav1 with_behavior { control(MOVE_HOST_TO gate0) }
"""


def asking(query, test, *, more="", host="uav0"):
    """A bigActor that asks once, and tests the answer."""
    return read_mission(f"""{WORLD}
BigActor a hosted_at {host} with_behavior {{
  observe({query})
  react {{ case o: Observation =>
    if {test} {{ skip }} else {{ skip }} }}
}}
{more}""")


def warned(mission):
    return [each for each in mission.warnings if each.code is Code.SHOWS_ITSELF]


def never(mission):
    """Whether a whole exploration finds an outcome of the test that no run has."""
    report = check(mission.initial, mission.properties)
    assert report.coverage.complete
    return any(gap.message.startswith("this condition is never") for gap in report.coverage.gaps)


ALWAYS = [
    ("LINKED_TO_HOST", "empty(o)"),
    ("LINKED_TO(uav1)", "not empty(o of UAV)"),
    ("LINKED_TO(CHILDREN(bay0))", "size(o) < 1"),
    ("LINKED_TO(LINKED_TO(gcs0))", "0 != size(o)"),
    ("HOST", "empty(o)"),
    ("CHILDREN(PARENT(uav1))", "empty(o)"),
    ("HOSTED_AT_HOST", "empty(o)"),
]


@pytest.mark.parametrize(("query", "test"), ALWAYS)
def test_an_answer_that_always_has_its_subject_is_never_empty_and_the_text_says_so(query, test):
    mission = asking(query, test)
    assert never(mission)
    (warning,) = warned(mission)
    assert query.split("(")[0] in warning.message


EITHER = [
    ("CHILDREN(bay0)", "empty(o of UAV)", "environment { boat0 vanishes }"),
    ("LINKED_TO(boat0)", "empty(o)", "environment { boat0 vanishes }"),
    ("LINKED_TO(boat0)", "empty(o)", "environment { observe may miss boat0 }"),
    ("CHILDREN_HOST", "empty(o)", ""),
    ("HOSTED_AT(uav1)", "empty(o)", ""),
    ("LINKED_TO_HOST", "size(o) == 3", ""),
    ("LINKED_TO_HOST", "empty(o of Station)", ""),
    ("LINKED_TO_HOST", "empty(o - {HOST})", ""),
]


@pytest.mark.parametrize(("query", "test", "more"), EITHER)
def test_an_answer_that_may_be_empty_gives_no_warning(query, test, more):
    assert not warned(asking(query, test, more=more))


@pytest.mark.parametrize(("query", "more"), [(query, more) for query, test, more in EITHER[1:3]])
def test_what_may_be_absent_or_missed_is_not_always_shown(query, more):
    assert not never(asking(query, "empty(o)", more=more))


def test_what_may_vanish_with_its_carrier_is_not_always_shown():
    text = f"""{WORLD.replace("boat0: Boat", "buoy0: Buoy carried by boat0 boat0: Boat")}
BigActor a hosted_at gcs0 with_behavior {{
  observe(LINKED_TO(buoy0))
  react {{ case o: Observation => if empty(o) {{ skip }} else {{ skip }} }}
}}
environment {{ boat0 vanishes }}"""
    mission = read_mission(text)
    assert not warned(mission)
    assert not never(mission)


def test_an_answer_that_another_query_may_have_given_is_not_judged():
    mission = asking("LINKED_TO_HOST", "empty(o)", more="")
    text = mission.source.text.replace(
        "observe(LINKED_TO_HOST)", "observe(LINKED_TO_HOST) observe(CHILDREN_HOST)"
    )
    two = read_mission(f"{text}\nscheduler unordered")
    assert warned(mission)
    assert not warned(two)
    assert not never(two)


def test_the_members_of_a_family_share_a_warning():
    text = f"""{WORLD}
BigActor watch[i] for u in UAV hosted_at u with_behavior {{
  observe(LINKED_TO(u))
  react {{ case o: Observation => if empty(o) {{ skip }} }}
}}"""
    (warning,) = warned(read_mission(text))
    assert warning.hint == "ask for the others: empty(o - {u})"
    spared = read_mission(f"{text}\nenvironment {{ observe may miss uav1 }}")
    assert not warned(spared)
