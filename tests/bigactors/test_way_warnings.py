"""Warnings about ways: those that the text suggests, and those that an exploration leaves standing."""

import pytest
from elaborating import elaborated

from checker.check import check
from checker.engines.contract import Engine
from checker.limits import Limits
from checker.reduction.refusals import Reduction

WORLD = """
signature {
  kind Location contains UAV, Vessel, Drum
  kind UAV driven
  kind Vessel driven carries Drum
  kind Drum
}
control timed
world {
  west0: Location = circle (37.1, -8.7) radius 500 m
  prison0: Location = box (37.15, -8.61) (37.05, -8.64)
  middle0: Location = circle (37.1, -8.66) radius 500 m
  east0: Location = circle (37.1, -8.55) radius 500 m
  south0: Location = circle (37.0, -8.625) radius 500 m
  uav0: UAV = point (37.1, -8.7) linked vhf
  uav1: UAV = point (37.101, -8.7) linked vhf
  boat0: Vessel = point (37.102, -8.7)
  drum0: Drum carried by boat0
}
"""
ACROSS = "control(MOVE_HOST_TO east0)"
AROUND = "control(MOVE_HOST_TO east0 VIA south0)"
LOADED = "control(PUT drum0 IN middle0)"


def mission(property_, more="", /, **bodies):
    hosts = {"a": "uav0", "b": "uav1", "c": "boat0"}
    agents = "".join(
        f"BigActor {name} hosted_at {hosts[name]} with_behavior {{ {body} }}\n"
        for name, body in bodies.items()
    )
    return elaborated(f'{WORLD}{agents}{more}\ncheck {{ invariant "p": {property_} }}')


def warned(found, **options):
    """Return the warnings before an exploration, and after it."""
    report = check(found, suspected=found.suspicions, **options)
    said = (found.warnings, found.warnings_after(report.suspected))
    return tuple([each.message for each in some if each.code.number in ("LS709", "LS711")] for some in said)


FORBIDDEN = "forall x: UAV . not actually x in prison0"
SUGGESTED = ["uav0 may cross prison0 on its way from its start to east0"]
CROSSES = ["uav0 may cross prison0 on its way from west0 to east0"]


@pytest.mark.parametrize("engine", [Engine.REFERENCE, Engine.FAST])
@pytest.mark.parametrize(
    ("body", "after"),
    [
        (ACROSS, CROSSES),
        (f"let x = 1 if x == 2 {{ {ACROSS} }}", []),
        (f"{AROUND} let x = 1 if x == 2 {{ {ACROSS} }}", []),
        (f"for p in [east0, south0] {{ control(MOVE_HOST_TO p) }} {ACROSS}", CROSSES),
    ],
)
def test_a_flight_across_is_warned_of_if_it_is_reached(engine, body, after):
    assert warned(mission(FORBIDDEN, a=body), engine=engine) == (SUGGESTED, after)


def test_the_warning_names_the_vehicle_that_really_crosses():
    never = f"let x = 1 if x == 2 {{ {ACROSS} }}"
    before, after = warned(mission(FORBIDDEN, a=never, b=ACROSS))
    assert before == SUGGESTED
    assert after == ["uav1 may cross prison0 on its way from west0 to east0"]


def test_a_place_of_which_the_text_knows_only_the_variable_counts():
    body = "for p in [south0, east0] { control(MOVE_HOST_TO p) } for p in [west0] { control(MOVE_HOST_TO p) }"
    before, after = warned(mission(FORBIDDEN, a=body))
    assert before
    assert after == ["uav0 may cross prison0 on its way from east0 to west0"]


@pytest.mark.parametrize(
    ("body", "after"),
    [
        (ACROSS, ["drum0, aboard boat0, may cross prison0 on its way from west0 to east0"]),
        (f"control(MOVE_HOST_TO middle0) {LOADED} {ACROSS}", []),
        (
            f"control(MOVE_HOST_TO middle0) {ACROSS} {LOADED}",
            ["drum0, aboard boat0, may cross prison0 on its way from middle0 to east0"],
        ),
    ],
)
def test_a_passenger_crosses_with_its_carrier_only(body, after):
    before, found = warned(mission("not actually drum0 in prison0", c=body))
    assert before
    assert found == after


def test_a_vehicle_at_rest_may_fly_on_across_a_smaller_place():
    text = WORLD.replace("box (37.15, -8.61) (37.05, -8.64)", "circle (37.103, -8.552) radius 50 m")
    agent = f"BigActor a hosted_at uav0 with_behavior {{ {ACROSS} }}"
    found = elaborated(f'{text}{agent}\ncheck {{ invariant "p": not actually uav0 in prison0 }}')
    assert len(warned(found)[1]) == 1


def test_under_control_atomic_nothing_is_under_way():
    text = WORLD.replace("control timed", "")
    agent = f"BigActor a hosted_at uav0 with_behavior {{ {ACROSS} }}"
    assert elaborated(f'{text}{agent}\ncheck {{ invariant "p": {FORBIDDEN} }}').warnings == ()


# --- two at one point -----------------------------------------------------------------------------

APART = "not possibly uav0 in south0"
SEND = 'observe(CHILDREN(PARENT(HOST))) react { case obs => send "go" to b }'
WAITS = 'react { case "go" => skip }'


@pytest.mark.parametrize("engine", [Engine.REFERENCE, Engine.FAST])
@pytest.mark.parametrize(
    ("a", "b", "meet"),
    [
        (ACROSS, ACROSS, True),
        (ACROSS, f"{ACROSS} control(MOVE_HOST_TO west0)", True),
        (f"{ACROSS} control(MOVE_HOST_TO west0) {SEND}", f"{WAITS} {ACROSS}", False),
        (f"{ACROSS} control(MOVE_HOST_TO west0)", "control(MOVE_HOST_TO west0)", False),  # it is there
        (f"{ACROSS} {SEND}", f"{WAITS} {ACROSS}", True),
        (f"let x = 1 if x == 2 {{ {ACROSS} }}", ACROSS, False),
    ],
)
def test_two_that_are_sent_to_one_point_are_warned_of_if_both_may_be_there(engine, a, b, meet):
    before, after = warned(mission(APART, a=a, b=b), engine=engine)
    assert len(before) == 1
    assert bool(after) == meet


def test_a_vehicle_that_waits_where_the_mission_put_it_was_not_sent():
    before, after = warned(
        mission(APART, a="control(MOVE_HOST_TO west0)", b="react { case 2 => control(MOVE_HOST_TO west0) }")
    )
    assert (len(before), after) == (1, [])


@pytest.mark.parametrize(("minutes", "meet"), [(1, True), (40, False)])
def test_two_that_never_are_under_way_at_one_time_do_not_meet(minutes, meet):
    """A flight of 14 km takes up to 12 minutes, and the way back as long."""
    times = "timing { tick 10 s  UAV flies at 20 m/s to 30 m/s  agents react within 10 s }\n"
    waits = f"react {{ after {minutes} min => {ACROSS} }}"
    asked = mission(APART, times, a=f"{ACROSS} control(MOVE_HOST_TO west0)", b=waits)
    before, after = warned(asked)
    assert (len(before), bool(after)) == (1, meet)


# --- an exploration that does not know ------------------------------------------------------------


@pytest.mark.parametrize("options", [{"reduce": [Reduction.POR]}, {"limits": Limits(configurations=3)}])
def test_an_exploration_that_leaves_configurations_out_refutes_nothing(options):
    never = f"{AROUND} let x = 1 if x == 2 {{ {ACROSS} }}"
    found = mission(FORBIDDEN, a=never, b=AROUND)
    before, after = warned(found, **options)
    assert after == before == SUGGESTED


def test_suspicions_change_neither_counts_nor_notes():
    found = mission(FORBIDDEN, a=ACROSS, b=AROUND)
    plain, asked = check(found), check(found, suspected=found.suspicions)
    assert (plain.configurations, plain.transitions, plain.notes) == (
        asked.configurations,
        asked.transitions,
        asked.notes,
    )
