"""Local consistency, deadlock and arrival, computation, invariants and reachability, clause by clause."""

import pytest
from checked_missions import (
    PILOTS,
    WORLD,
    checked,
    enumerate_naively,
    kinds,
    load,
    moves,
    verdict,
    verdict_of,
    violation,
)

from checker import Engine, check
from checker.properties.inspections import LocalConsistency
from checker.verdicts import Outcome
from semantics.properties.propositions import holds
from semantics.state.requests import FLY
from semantics.successors import expand
from specs.elaboration import load_mission, read_mission

WATCH = "BigActor watch hosted_at gcs2 with_behavior { loop { observe(PARENT(HOST)) react { case obs => skip } } }\n"
"""It goes on, so that nothing stands still."""

SPILL = WORLD.replace("spill0: OilSpill absent", "spill0: OilSpill = circle (37.09, -8.70) radius 200 m")

# --- local consistency ----------------------------------------------------------------------------------------


def consistency(text):
    return verdict(text, "local_consistency")


ASKS = moves("gate0", "a", "uav0")
BELIEVES = "believes { uav0 in south0 }"
LOOKS_FIRST = "observe(PARENT(HOST)) react { case obs => control(MOVE_HOST_TO gate0) }"
QUEUED = "observe(PARENT(HOST)) control(MOVE_HOST_TO gate0) react { case o => skip }"
HANDS = "BigActor a hosted_at gcs0 with_behavior { control(HAND uav0 TO gcs1) }\n"
B_DRIFTS = ASKS + moves("gate0", "b", "uav1") + "environment { uav1 drifts among north0 }\n"


def a_does(body):
    return f"BigActor a hosted_at uav0 with_behavior {{ {body} }}\n"


CONSISTENCY = {
    "where what moves is elsewhere": (
        ASKS + "environment { uav0 drifts among south0 }",
        {"inconsistent": 2},
        "uav0: believed in north0, actually in south0",
    ),
    "where what moves has vanished": (
        ASKS + "environment { uav0 vanishes }",
        {"inconsistent": 2},
        "uav0: believed in north0, actually gone",
    ),
    "where a link is down": (
        HANDS + "environment { uav0 leaves control:gcs0 }",
        {"inconsistent": 2},
        "uav0: believed on control:gcs0, mesh, actually on mesh",
    ),
    "where the target has vanished": (ASKS + "environment { gate0 vanishes }", {"inconsistent": 2}, ""),
    "where nobody looked at what is believed": (ASKS + BELIEVES, {"inconsistent": 1}, ""),
    "not after a look": (a_does(LOOKS_FIRST) + BELIEVES, {}, ""),
    "not of what waits behind a look": (a_does(QUEUED) + BELIEVES, {}, ""),
    "of all in no line": (a_does(QUEUED) + f"{BELIEVES} scheduler unordered", {"inconsistent": 2}, ""),
    "whose turn it may be": (B_DRIFTS + "scheduler program_order", {"inconsistent": 2}, ""),
    "whose turn it is not": (B_DRIFTS + "scheduler fcfs", {"inconsistent": 2}, ""),
    "not of a command for what is in transit": (
        PILOTS + "control timed\nenvironment { uav0 arrives }",
        {},
        "",
    ),
}


UNMATCHED = {
    "an authority": ("gcs0", "MOVE vessel0 TO gate0", "vessel0 is not on control:gcs0"),
    "an authority of one's own": ("vessel0", "HAND uav0 TO gcs1", "vessel0 is not on control:gcs0"),
    "one authority of both": (
        "gcs0",
        "MOVE uav1 TO gate0",
        "gcs0 is on control:gcs0, uav1 is on control:gcs1: on none together",
    ),
    "a place on the carrier": ("uav0", "PUT drifter0 IN gate0", "drifter0 is not in uav0: it is believed in vessel0"),
}  # fmt: skip


@pytest.mark.parametrize(("host", "command", "words"), UNMATCHED.values(), ids=UNMATCHED)
def test_an_unmatched_control_is_told_with_what_is_missing(host, command, words):
    text = f"BigActor a hosted_at {host} with_behavior {{ control({command}) }}\n"
    assert words in violation(consistency(text), "unmatched").details


def test_a_control_into_a_place_of_a_wrong_kind_is_told_with_the_signature_that_it_lacks():
    text = """signature standard { kind Buoy driven }
world {
  sea0: Location = box (37.1, -8.5) (37.0, -8.7)
  buoy0: Buoy = point (37.3, -8.6)
}
BigActor a hosted_at buoy0 with_behavior { react { case ("go", place) => control(MOVE_HOST_TO place) } }
environment { says ("go", sea0) to a }"""
    found = violation(check(read_mission(text)).verdicts["local_consistency"], "unrealisable")
    assert found.details == (
        "no Location may contain a Buoy: the signature lacks 'kind Location contains Buoy'",
    )


def test_an_unrealisable_control_names_the_place_in_which_the_carrier_is_not():
    found = violation(
        check(load_mission("broken_unrealisable")).verdicts["local_consistency"], "unrealisable"
    )
    assert "nothing drives drifter0, and vessel0, which carries it, is not in oilSpill0" in found.details


@pytest.mark.parametrize(("text", "found", "words"), CONSISTENCY.values(), ids=CONSISTENCY)
def test_a_control_is_inconsistent(text, found, words):
    said = consistency(text)
    assert kinds(said) == found
    assert said.outcome is (Outcome.VIOLATED if found else Outcome.HOLDS)
    if words:
        assert violation(said, "inconsistent").details == (words,)


ENTERS = """
def enter(place) = { observe(PARENT(HOST)) react { case o => control(MOVE_HOST_TO place) } }
BigActor a hosted_at uav0 with_behavior { choose p in {gate0, north0, south0} { enter(p) } }
BigActor b hosted_at uav1 with_behavior { choose p in {gate0, south0} { enter(p) } }
environment { uav0 drifts among point (36.98, -8.70), point (37.02, -8.70) }
"""


@pytest.mark.parametrize("engine", [Engine.REFERENCE, Engine.FAST])
def test_findings_about_the_same_control_of_the_text_are_shown_as_one(engine):
    mission = load(ENTERS + "check { local_consistency }")
    found = verdict_of(check(mission, engine=engine), "local_consistency")
    assert [(each.subject, each.alike, each.told[-1]) for each in found.violations] == [
        ("CTR(a, MOVE_HOST_TO gate0)", 2, "and 2 alike")
    ]
    assert (found.different, found.count) == (3, 78)


def test_findings_about_different_controls_of_the_text_are_shown_each():
    twice = "enter(gate0) control(MOVE_HOST_TO south0)"
    found = consistency(ENTERS.replace("choose p in {gate0, north0, south0} { enter(p) }", twice))
    assert [(each.subject, each.alike) for each in found.violations] == [
        ("CTR(a, MOVE_HOST_TO gate0)", 0),
        ("CTR(a, MOVE_HOST_TO south0)", 0),
    ]


def test_a_flight_whose_target_vanished_is_inconsistent():
    text = moves("gate0", "a", "uav0") + WATCH + "control timed\nenvironment { gate0 vanishes }"
    found = consistency(text)
    assert kinds(found) == {"inconsistent": 2}
    lost = [c for c in enumerate_naively(load(text).initial)[0] if is_lost(c)]
    assert lost
    for c in lost:
        looked = LocalConsistency()
        looked(0, c, expand(c))
        assert [each.message.partition(":")[0] for each in looked.collected.first.values()] == [
            "FLY(a, MOVE_HOST_TO gate0) is inconsistent"
        ]


def is_lost(c):
    flies = any(isinstance(each.request, FLY) for each in c.eta.all())
    return flies and "gate0" not in c.structure.physical


def test_a_flight_to_a_target_that_moved_is_renewed():
    text = """
    BigActor a hosted_at uav0 with_behavior { control(MOVE_HOST_TO spill0) }
    control timed
    environment {
      spill0 drifts among circle (36.98, -8.70) radius 200 m, circle (37.02, -8.69) radius 200 m
      uav0 arrives
    }
    check {
      local_consistency deadlock_freedom arrival
      reachable "there": actually uav0 in spill0 and ended a and not pending a
    }
    """
    report = checked(text, SPILL)
    assert verdict_of(report, "deadlock_freedom").outcome is Outcome.HOLDS
    assert verdict_of(report, "there").outcome is Outcome.HOLDS
    assert "inconsistent" not in kinds(verdict_of(report, "local_consistency"))


def test_a_mission_without_controls_is_vacuously_consistent():
    found = consistency(WATCH)
    assert (found.outcome, found.examined, found.witness) == (Outcome.HOLDS, 0, None)


# --- deadlock -------------------------------------------------------------------------------------------------


def deadlock(text):
    return verdict(text, "deadlock_freedom")


def agents(**bodies):
    """Return bigActors a, b, ... at the hosts and with the bodies that are given."""
    return "\n".join(
        f"BigActor {a} hosted_at {host} with_behavior {{ {body} }}" for a, (host, body) in bodies.items()
    )


SENDS = 'send("go", b)'


@pytest.mark.parametrize(
    ("text", "causes"),
    [
        (
            agents(a=("uav0", SENDS), b=("gcs1", 'react { case "go" => skip }')),
            ('SND(a, b, "go"): their hosts, uav0 and gcs1, share no link', 'b waits for "go" from a'),
        ),
        (
            agents(a=("uav0", SENDS), b=("uav1", "")) + "environment { mesh drops }",
            ('SND(a, b, "go"): their hosts, uav0 and uav1, share no link: mesh is down',),
        ),
        (
            agents(a=("uav0", SENDS), b=("uav1", "")) + "environment { uav1 vanishes }",
            ('SND(a, b, "go"): their hosts, uav0 and uav1, share no link: uav1 is not there',),
        ),
        (
            agents(a=("uav0", SENDS), b=("uav1", "")) + "believes { uav1 unlinked }",
            (
                'SND(a, b, "go"): their hosts, uav0 and uav1, share no link in belief: both are actually on mesh',
            ),
        ),
        (
            agents(a=("gcs0", "migrate(uav1)")),
            ("MGR(a, uav1): the two, gcs0 and uav1, share no link",),
        ),
        (
            agents(a=("gcs0", "control(HAND uav1 TO gcs2) observe(ALL)")),
            (
                "CTR(a, HAND uav1 TO gcs2): it is unmatched",
                "OBS(a, ALL): it waits behind CTR(a, HAND uav1 TO gcs2)",
            ),
        ),
        (
            agents(a=("gcs0", 'react { case ("seen", x) => skip }'), b=("gcs1", "send(2, a)")),
            ('a waits for ("seen", x), which no bigActor can send any more; no case takes 2',),
        ),
        (
            agents(a=("gcs0", "react { case o: Observation => skip }")),
            ("a waits for an observation, which it has not asked for",),
        ),
        (
            agents(
                a=("gcs0", 'react { case "b" => send("a", b) }'),
                b=("gcs1", 'react { case "a" => send("b", a) }'),
            ),
            ('a waits for "b" from b', 'b waits for "a" from a'),
        ),
    ],
)
def test_a_deadlock_is_told_with_its_causes(text, causes):
    (found,) = deadlock(text).violations
    assert found.message.startswith("only the environment can move, and ")
    assert found.details == causes


AT_REST = {
    "at the react of a loop": "loop { react { case x => skip } }",
    "after something else": 'observe(ALL) react { case o => skip } loop { react { case "x" => skip } }',
    "with more in the loop": 'loop { react { case "x" => skip } react { case "y" => skip } }',
    "in a behaviour that is called last": "serve()",
    "in a behaviour that the loop calls": "loop { once() }",
    "in one that this calls": "loop { twice() }",
}
NOT_AT_REST = {
    "at a react": 'react { case "x" => skip }',
    "in a loop in a loop": 'loop { let again = true while again { react { case "x" => again = false } } }',
    "in a choice in a loop": 'loop { if HOST == gcs0 { react { case "x" => skip } } }',
    "in a case in a loop": 'loop { observe(ALL) react { case o => react { case "x" => skip } } }',
}
BEHAVIOURS = """
def serve() = { loop { react { case x => skip } } }
def once() = { react { case "x" => skip } }
def twice() = { once() once() }
"""


@pytest.mark.parametrize("body", [*AT_REST.values(), *NOT_AT_REST.values()], ids=[*AT_REST, *NOT_AT_REST])
def test_an_agent_is_at_rest_where_it_waits_in_a_loop_for_what_begins_its_next_turn(body):
    found = deadlock(BEHAVIOURS + f"BigActor a hosted_at gcs0 with_behavior {{ {body} }}")
    assert list(kinds(found)) == (["deadlock"] if body in NOT_AT_REST.values() else [])
    assert found.examined > 0 or found.violations


WAITS = 'BigActor a hosted_at gcs0 with_behavior { react { case "x" => skip } }\n'
WAITS_TWICE = WAITS.replace("skip } }", 'skip } react { case "x" => skip } }')
SERVES = 'BigActor b hosted_at gcs0 with_behavior { loop { react { case "x" => skip } } }\n'
HELP = {
    "a link that comes and goes": (WAITS + "environment { uav0 leaves mesh and returns }", {"deadlock": 0}),
    "another that can always move": (WAITS + WATCH, {}),
    "what may be said as often": (WAITS_TWICE + 'environment { says "x" to a at most 2 times }', {}),
    "what may be said once": (WAITS_TWICE + 'environment { says "x" to a }', {"deadlock": 2}),
    "what no case takes": (WAITS_TWICE + 'environment { says "y" to a }', {"deadlock": 0}),
    "what is said to another": (WAITS + SERVES + 'environment { says "x" to b }', {"deadlock": 0}),
}


@pytest.mark.parametrize(("text", "found"), HELP.values(), ids=HELP)
def test_who_waits_is_helped_or_not_by(text, found):
    assert kinds(deadlock(text)) == found


def test_an_observation_that_an_ended_agent_did_not_receive_is_nothing():
    found = deadlock("BigActor a hosted_at gcs0 with_behavior { observe(ALL) }")
    assert (found.outcome, found.examined) == (Outcome.HOLDS, 1)


def test_an_observation_that_no_case_takes_leaves_its_agent_waiting():
    text = "BigActor a hosted_at gcs0 with_behavior { observe(PARENT(HOST)) react { case o if uav0 in o => skip } }"
    found = deadlock(text)
    assert found.violations[0].message.endswith("and a waits at a react")


# --- arrival --------------------------------------------------------------------------------------------------

FLIGHT = moves("gate0", "a", "uav0") + "control timed\n"
FAIR = "flights declared to arrive are fair"


def test_a_flight_that_is_not_declared_to_arrive_is_reported_apart():
    report = checked(FLIGHT + "check { deadlock_freedom arrival }")
    late = verdict_of(report, "arrival")
    assert late.violations[0].message == (
        "a run may wait here for ever for ⟨commit : FLY(a, MOVE_HOST_TO gate0)⟩"
    )
    assert verdict_of(report, "deadlock_freedom").outcome is Outcome.HOLDS
    assert "declare that it arrives" in verdict_of(report, "deadlock_freedom").note


@pytest.mark.parametrize(
    ("text", "found", "note"),
    [
        (FLIGHT, {"not arrived": 2}, FAIR),
        (FLIGHT + "environment { uav1 arrives }", {"not arrived": 2}, FAIR),
        (FLIGHT + "environment { uav0 arrives }", {}, FAIR),
        (FLIGHT + WATCH, {}, FAIR),
        (moves("gate0", "a", "uav0"), {}, ""),
    ],
    ids=["undeclared", "declared of another", "declared", "another goes on", "no flight"],
)
def test_a_flight_arrives_if_it_is_declared_to_or_another_goes_on(text, found, note):
    said = verdict(text, "arrival")
    assert (kinds(said), said.note) == (found, note)


# --- computation ----------------------------------------------------------------------------------------------


def test_one_agents_fault_does_not_stop_the_others():
    text = "BigActor b hosted_at gcs0 with_behavior { display(first(minus({uav0}, {uav0}))) }\n" + moves(
        "gate0", "a", "uav0"
    )
    report = checked(text + 'check { reachable "there": actually uav0 in gate0 }')
    assert verdict_of(report, "there").outcome is Outcome.HOLDS
    assert kinds(verdict_of(report, "computation")) == {"fails": 0}


def test_what_a_failed_agent_had_asked_for_is_served_all_the_same():
    text = """
    BigActor a hosted_at uav0 with_behavior { control(MOVE_HOST_TO gate0) send(first(minus({uav0}, {uav0})), a) }
    BigActor b hosted_at uav1 with_behavior { control(MOVE_HOST_TO gate0)
        display(first(minus({uav0}, {uav0}))) observe(ALL) }
    check { reachable "a": actually uav0 in gate0 reachable "b": actually uav1 in gate0 }
    """
    report = checked(text)
    assert verdict_of(report, "computation").outcome is Outcome.VIOLATED
    assert [verdict_of(report, name).outcome for name in ("a", "b")] == [Outcome.HOLDS, Outcome.HOLDS]


# --- invariants and reachability ------------------------------------------------------------------------------

FORMULAS = [
    "actually uav0 in gate0",
    "uav0 in gate0 and not (uav1 in gate0)",
    "pending CTR a and pending CTR b",
    "ended a -> actually uav0 in gate0",
    "uav0 in gate0 <-> actually uav0 in gate0",
    "forall u: UAV . actually u in gate0",
]


@pytest.mark.parametrize("formula", FORMULAS)
def test_invariants_and_reachability_agree_with_a_naive_enumeration_and_are_shortest(formula):
    text = moves("gate0", "a", "uav0") + moves("gate0", "b", "uav1")
    asked = f'invariant "always": {formula} invariant "never": not ({formula}) reachable "once": {formula}'
    text += f"\ncheck {{ {asked} }}"
    mission = load(text)
    proposition = next(each.formula for each in mission.properties if each.kind == "reachable")
    depths = enumerate_naively(mission.initial)[0]
    true = [depth for c, depth in depths.items() if holds(proposition, c)]
    false = [depth for c, depth in depths.items() if not holds(proposition, c)]
    report = checked(text)
    always, never, once = (verdict_of(report, name) for name in ("always", "never", "once"))
    assert kinds(always) == ({"invariant": min(false)} if false else {})
    assert kinds(never) == ({"invariant": min(true)} if true else {})
    assert (always.count, always.examined) == (len(false), len(true))
    assert (None if once.witness is None else len(once.witness)) == (min(true) if true else None)
    assert once.examined == len(true)
    if true:
        assert holds(proposition, once.witness.configurations[-1])


def test_what_is_nowhere_reachable_is_violated_and_says_so():
    found = verdict(moves("gate0", "a", "uav0") + 'check { reachable "up": uav1 in gate0 }', "up")
    assert (found.outcome, found.violations, found.witness) == (Outcome.VIOLATED, (), None)
    assert found.note == "no reachable configuration satisfies: uav1 in gate0"
