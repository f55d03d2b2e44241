"""Race-freedom by ownership: what it promises, the search never contradicts; and why it is not promised."""

import pytest
from checked_missions import WORLD, load, start, verdict
from hypothesis import assume, event, given, reject
from mission_texts import missions
from scale import IS_WHOLE, examples
from stale_missions import written

from checker import Limits, explore, owned
from checker.properties.races import ControlRaces, StaleObservationRaces
from checker.verdicts import Outcome
from semantics.behaviours.expressions import Fault
from semantics.hypothesis_strategies import initial_configurations
from semantics.races.monitor import monitored
from specs import MissionError


def races(c, most=1_500):
    """Return the kinds of races that a search finds, None where it is cut off."""
    control, stale = ControlRaces(), StaleObservationRaces()
    found = explore(c, (control,), Limits(configurations=most))
    remembered = explore(monitored(c), (stale,), Limits(configurations=2 * most))
    kinds = {kind for kind, _ in (*control.collected.first, *stale.collected.first)}
    return kinds if kinds or (found.complete and remembered.complete) else None


A_ENTERS, B_ENTERS = "a@uav0: ENTER\n", "b@uav1: ENTER\n"

# --- owned implies that the search finds nothing --------------------------------------------------------------


@examples(100)
@given(missions())
def test_what_is_owned_has_no_race(text):
    try:
        c = start(text)
    except MissionError:  # what can be known to be unrealisable is no mission
        reject()
    promised = owned(c)
    event("owned" if promised else "not owned")
    if promised:
        assert races(c) in (set(), None)


@examples(30 if IS_WHOLE else 15)
@given(initial_configurations())
def test_what_is_owned_among_generated_configurations_has_no_race(c):
    assume(len(c.alpha.names()) > 1)
    assume(any(type(s).__name__ == "ControlBy" for s in c.setting.program.statements))
    promised = owned(c)
    event("owned" if promised else "not owned")
    if promised:
        try:
            found = races(c, 150)
        except Fault:
            return
        assert found in (set(), None)


OWNED = {
    "one agent alone": "a@gcs0: control(MOVE uav0 TO gate0) control(HAND uav0 TO gcs1)",
    "each moves its own": f"{A_ENTERS}{B_ENTERS}",
    "each moves its own while the other looks at what nobody moves": A_ENTERS
    + "b@uav1: LOOKS react { case o if gcs0 in o => control(MOVE_HOST_TO south0) case o => skip }",
    "one moves, one only looks": A_ENTERS
    + "b@uav1: observe(ALL) react { case o if uav0 in o => display(o) }",
    "one moves what the other links": f"{A_ENTERS}b@gcs1: control(HAND uav1 TO gcs2)",
    "each hands over its own": "a@gcs0: control(HAND uav0 TO gcs2)\nb@gcs1: control(HAND uav1 TO gcs2)",
    "messages that rest on nothing": A_ENTERS + 'b@uav1: ENTER send("there", a)',
}


@pytest.mark.parametrize("text", OWNED.values(), ids=OWNED)
def test_owned(text):
    assert owned(start(written(text)))
    assert races(start(written(text))) == set()
    found = verdict(written(text), "race_freedom")
    assert found.outcome is Outcome.HOLDS
    assert (
        found.note
        == "by ownership, without a search: no agent may change anything that another's control depends on"
    )


# --- why it is not owned --------------------------------------------------------------------------------------


def looking(query, test, host="uav0", does="ENTER"):
    return f"a@{host}: observe({query}) react {{ case o if {test} => {does} case o => skip }}\n"


NOT_OWNED = {
    "two move one": "a@gcs0: control(MOVE uav0 TO gate0)\nb@gcs0: control(MOVE uav0 TO south0)",
    "one moves another's host": A_ENTERS + "b@gcs0: control(MOVE uav0 TO south0)",
    "one takes the other's authority": "a@gcs0: control(HAND uav0 TO gcs1)\nb@gcs0: control(MOVE uav0 TO south0)",
    "a test of what the other moves": looking("CHILDREN(gate0)", "not (uav1 in o)") + B_ENTERS,
    "a test of everything": looking("CHILDREN(gate0)", "size(o) < 2") + B_ENTERS,
    "a test of where it is": looking("PARENT(uav1)", "north0 in o") + B_ENTERS,
    "a test of a link": looking("LINKED_TO(HOST)", "uav0 in o", "gcs0", "control(MOVE uav0 TO gate0)")
    + "b@uav1: control(DISCONNECT_HOST_FROM vessel0)",
    "a test that a message carries": looking("CHILDREN(gate0)", "not (uav1 in o)", "gcs0", 'send("go", c)')
    + f'c@uav0: react {{ case "go" => control(MOVE_HOST_TO south0) }}\n{B_ENTERS}',
    "an argument that is not known from the text": looking(
        "CHILDREN(gate0)", "gcs0 in o", "gcs0", "control(MOVE first(o) TO gate0)"
    )
    + B_ENTERS,
    "a host that is not known from the text": "a@uav0: migrate(vessel0) ENTER\n" + B_ENTERS,
    "a place closed to others": "rule enter() { gate0 || HOST -> gate0.HOST }\na@uav0: control(enter())\n" + B_ENTERS,
    "one that is yet to be spawned": "def enter() = { ENTER }\na@uav0: spawn d hosted_at uav1 with_behavior enter()",
    "one alone in no line": "scheduler unordered\na@uav0: ENTER",
}  # fmt: skip


@pytest.mark.parametrize("text", NOT_OWNED.values(), ids=NOT_OWNED)
def test_not_owned(text):
    assert not owned(start(written(text)))


def test_cargo_cannot_be_put_down_once_its_carrier_has_been_moved():
    text = written("a@vessel0: control(PUT drifter0 IN south0)\nb@vessel0: NORTH")
    assert not owned(start(text))
    message = verdict(text, "race_freedom").violations[0].message
    assert message == "serving CTR(b, MOVE_HOST_TO north0) disables CTR(a, PUT drifter0 IN south0)"


def test_cargo_of_cargo_goes_along():
    world = (
        WORLD.replace("kind Drifter\n", "kind Drifter carries Buoy\n  kind Buoy\n")
        .replace("gcs0: Station =", "buoy0: Buoy carried by drifter0\n  gcs0: Station =")
        .replace("contains Location,", "contains Buoy, Location,")
    )
    text = """
    BigActor a hosted_at drifter0 with_behavior { control(PUT buoy0 IN south0) }
    BigActor b hosted_at vessel0 with_behavior { control(MOVE_HOST_TO north0) }
    """
    c = load(text, world).initial
    assert races(c) == {"control race"}
    assert not owned(c)


PASSIVE = """
signature {
  kind Location contains Location, Hangar, UAV, Vessel, Station
  kind Hangar contains Vessel, UAV, Station passive
  kind UAV driven
  kind Vessel driven carries Station
  kind Station
}
world {
  sea0: Location = box (37.03, -8.68) (37.01, -8.72)
  hangar0: Hangar = box (37.06, -8.68) (37.04, -8.72)
  uav0: UAV = point (37.02, -8.70) linked control:gcs0
  vessel0: Vessel = point (37.015, -8.70)
  gcs0: Station = point (37.10, -8.70) linked control:gcs0
  gcs1: Station carried by vessel0 linked control:gcs1
}
"""


def test_what_is_taken_into_a_passive_place_reacts_no_more():
    text = """
    BigActor a hosted_at gcs0 with_behavior { control(HAND uav0 TO gcs1) }
    BigActor b hosted_at vessel0 with_behavior { control(MOVE_HOST_TO hangar0) }
    """
    c = load(text, PASSIVE).initial
    assert races(c) == {"control race"}
    assert not owned(c)
