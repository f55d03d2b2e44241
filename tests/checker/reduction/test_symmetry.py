"""Symmetry: what is interchangeable is found, one configuration stands for its likes, and its runs replay."""

from contextlib import suppress
from dataclasses import replace
from functools import cache
from itertools import combinations

import pytest
from checked_missions import kinds, load
from everything_found import everything
from hypothesis import given
from scale import examples
from shipped import UNTIMED
from swarms import LOOKS, ORBITS, mission, swarm, swarms

from checker import Engine, Keeping, Limits, Outcome, Reduction, RefusedError, check, explore
from checker.check import reductions_of
from checker.reduction import Reduced, mission_automorphisms
from checker.reduction.configuration_renaming import Renaming
from checker.reduction.footprint_check import Drift
from checker.reduction.symmetry import MissionSymmetry
from checker.traces import replay, to_json
from semantics import Scheduler, control
from semantics.behaviours.expressions import Fault
from semantics.properties.propositions import HasPending, Inside
from semantics.races.monitor import monitored
from semantics.state.configuration import Configuration
from semantics.successors import expand
from specs.elaboration import load_mission

SYMMETRY = (Reduction.SYMMETRY,)
BOTH = (Reduction.POR, Reduction.SYMMETRY)

# --- what is interchangeable ----------------------------------------------------------------------------------


def classes(loaded):
    return [each.names for each in MissionSymmetry(loaded.initial).classes]


def test_robots_that_start_in_one_place_and_run_one_behaviour_are_interchangeable():
    assert classes(mission(LOOKS, robots=3)) == [(("r0", "robot0"), ("r1", "robot1"), ("r2", "robot2"))]


def test_texts_written_out_for_each_are_alike_but_for_names_and_variables():
    texts = "\n".join(
        f"BigActor a{i} hosted_at robot{i} with_behavior {{ observe(PARENT(robot{i}))"
        f" react {{ case seen{i} if robot{i} in seen{i} => control(MOVE_HOST_TO room0) }} }}"
        for i in range(2)
    )
    text = swarm("skip", rest=texts).replace("BigActor r", "// BigActor r")
    assert classes(load(text, "")) == [(("a0", "robot0"), ("a1", "robot1"))]


def test_entities_that_nobody_is_hosted_at_are_interchangeable_too():
    crates = ["point (37.00, -8.70) linked mesh", "point (37.00, -8.70) linked mesh"]
    text = swarm(LOOKS, places=crates, rest="BigActor base hosted_at gcs0 with_behavior { skip }")
    text = text.replace(
        "}\ndef", "  c0: Crate = point (37.04, -8.70)\n  c1: Crate = point (37.04, -8.70)\n}\ndef"
    )
    assert classes(load(text, "")) == [(("r0", "robot0"), ("r1", "robot1")), (("c0",), ("c1",))]


REFUSED = {
    "in another place": (
        {"body": LOOKS, "places": ["point (37.00, -8.70) linked mesh", "point (37.001, -8.70) linked mesh"]},
        "'r0' is not like 'r1', since they are not in the same place",
    ),
    "on another channel": (
        {"body": LOOKS, "places": ["point (37.00, -8.70) linked mesh", "point (37.00, -8.70)"]},
        "since they are on different channels",
    ),
    "iterated": (
        {"body": "observe(ALL) react { case o => for x in o { skip } }"},
        "a 'for' goes through names",
    ),
    "iterated, a set or a route": (
        {"body": "let r = [room0] if HOST in r { r = {room0, dock0} } for x in r { skip }"},
        "a 'for' goes through names",
    ),
    "chosen from": (
        {"body": "observe(ALL) react { case o => choose x in o { observe(PARENT(x)) } }"},
        "those after it in the order of names are lost",
    ),
    "printed": ({"body": "observe(ALL) react { case o => display(o) }"}, "'display' prints names"),
    "ordered": (
        {"body": "observe(ALL) react { case o => control(MOVE first(o of Robot) TO room0) }"},
        "'first' takes names in their order",
    ),
    "named by another": (
        {"body": LOOKS, "rest": "BigActor base hosted_at gcs0 with_behavior { observe(PARENT(robot1)) }"},
        "since the text distinguishes them",
    ),
    "moved by the environment": (
        {"body": LOOKS, "rest": "environment { robot1 drifts among room0 }"},
        "since the environment treats them differently",
    ),
    "told more often": (
        {"body": LOOKS, "rest": 'environment { says "go" to r0 says "go" to r1 at most 2 times }'},
        "since the environment treats them differently",
    ),
    "sure to arrive": (
        {"body": LOOKS, "rest": "environment { robot1 arrives }\ncontrol timed"},
        "since of one flights arrive, of the other not",
    ),
    "missed": (
        {"body": LOOKS, "rest": "environment { observe may miss robot1 }"},
        "since an observation may miss one, and never the other",
    ),
    "named by a rule": (
        {
            "body": "control(enter(HOST))",
            "rest": "rule enter(u: Robot) { u || room0.$0 || robot1 -> room0.($0 | u) || robot1 }",
        },
        "since the rule 'enter' distinguishes them",
    ),
    "of another kind": (
        {"body": "skip", "robots": 1, "rest": "BigActor s hosted_at gcs0 with_behavior { visit() }"},
        "'robot0' and 'gcs0' are not of one kind",
    ),
    "the name of a channel": (
        {"body": LOOKS, "places": ["point (37.00, -8.70) linked net:robot0"] * 2},
        "since a channel or a rule is named with 'robot0'",
    ),
}


@pytest.mark.parametrize("why", REFUSED)
def test_it_is_refused_with_the_reason(why):
    arguments, reason = REFUSED[why]
    with pytest.raises(RefusedError, match="the reduction 'symmetry' is refused") as refused:
        MissionSymmetry(mission(**arguments).initial)
    assert reason in str(refused.value)


def test_a_rule_that_is_a_function_is_tried_with_all_names(monkeypatch):
    found = mission("control(enter(HOST))", rest="rule enter(u: Robot) { u || room0 -> room0.u }").initial
    program = found.setting.program
    enter = program.reactions["enter"]

    def symmetry(make):
        reactions = {**program.reactions, "enter": make}
        setting = found.setting.with_(program=replace(program, reactions=reactions))
        return MissionSymmetry(Configuration(setting, found.state))

    def enter_anew(host, name):
        return enter(host, name)

    def at_home(host, name):
        if host == name:
            raise Fault("it is there already")
        return enter(host, name)

    assert symmetry(enter_anew).classes
    assert symmetry(at_home).classes
    with pytest.raises(RefusedError, match="since the rule 'enter' distinguishes them"):
        symmetry(lambda host, _: enter(host, "robot1"))
    monkeypatch.setattr(mission_automorphisms, "MOST_ARGUMENTS", 5**2)  # two robots, two rooms, a station
    assert symmetry(enter_anew).classes
    monkeypatch.setattr(mission_automorphisms, "MOST_ARGUMENTS", 5**2 - 1)
    with pytest.raises(RefusedError, match="the rule 'enter' has too many arguments to be tried with all"):
        symmetry(enter_anew)


def test_it_is_refused_for_what_is_asked_of_one_or_remembered_of_each():
    initial = mission(LOOKS).initial
    with pytest.raises(RefusedError, match="a property distinguishes them: robot1 in room0"):
        MissionSymmetry(initial, [Inside("robot1", "room0")])
    with pytest.raises(RefusedError, match="recorded by name"):
        Reduced(monitored(initial), SYMMETRY)
    with pytest.raises(RefusedError, match="nothing in the mission is interchangeable"):
        MissionSymmetry(load_mission("rendezvous").initial)


def test_containers_are_not_exchanged_since_the_smallest_is_found_by_name():
    text = swarm(LOOKS, robots=1).replace("kind Station\n", "kind Station\n  kind Raft contains Robot\n")
    rafts = "".join(f"  raft{i}: Raft = circle (37.00, -8.70{i}) radius 9 m\n" for i in (2, 4))
    with pytest.raises(RefusedError, match="'raft2' is not like 'raft4', since 'raft2' may contain others"):
        MissionSymmetry(load(text.replace("}\ndef", f"{rafts}}}\ndef"), "").initial)


def test_a_property_of_all_of_them_tells_nobody_apart():
    asked = 'invariant "a": forall r: Robot . not (r in gcs0) reachable "b": exists r: Robot . r in room0'
    loaded = mission(LOOKS, rest=f"check {{ {asked} }}")
    assert MissionSymmetry(loaded.initial, [each.formula for each in loaded.properties]).classes
    assert tuple(map(str, reductions_of(loaded))) == ("por", "symmetry")
    assert tuple(map(str, reductions_of(mission("choose p in {dock0, room0} { skip }")))) == ("por",)


@pytest.mark.parametrize("name", UNTIMED)
def test_nothing_in_the_missions_that_ship_is_exchanged_without_being_alike(name):
    initial = load_mission(name).initial
    with suppress(RefusedError):
        assert equivariant(initial, MissionSymmetry(initial), most=60)


# --- what stands for what -------------------------------------------------------------------------------------


def swaps(symmetry):
    """Yield all exchanges of two members."""
    for each in symmetry.classes:
        for one, other in combinations(range(len(each.members)), 2):
            order = list(range(len(each.members)))
            order[one], order[other] = other, one
            yield Renaming(*each.moving(order))


def equivariant(initial, symmetry, most=400):
    """Tell whether what follows a renamed configuration is what follows it, renamed."""
    for c in explore(initial, limits=Limits(configurations=most)).configurations:
        for swap in swaps(symmetry):
            after = {swap.configuration(each.target) for each in expand(c).transitions}
            if {each.target for each in expand(swap.configuration(c)).transitions} != after:
                return False
    return True


def test_a_paranoid_check_notices_that_likes_are_not_alike(monkeypatch):
    def of_one(c, request):
        yield from control.realisations(c, request) if request.agent == "r0" else ()

    asked = mission(LOOKS)
    monkeypatch.setattr("semantics.rules.realisations", of_one)
    with pytest.raises(Drift, match="r0, robot0 and r1, robot1 are not alike"):
        check(asked, reduce=SYMMETRY, keeping=Keeping(doubted=50))


def orbits(initial, symmetry, most=20_000):
    """Return how many classes of likes are reachable, counted naively."""
    found = explore(initial, limits=Limits(configurations=most))
    assert found.complete
    left, count = set(found.configurations), 0
    while left:
        count += 1
        waiting = [left.pop()]
        while waiting:
            c = waiting.pop()
            for like in (swap.configuration(c) for swap in swaps(symmetry)):
                if like in left:
                    left.discard(like)
                    waiting.append(like)
    return count


@pytest.mark.parametrize("name", ORBITS)
def test_likes_have_one_representative(name):
    body, rest, robots = ORBITS[name]
    initial = mission(body, robots, rest).initial
    reduced = Reduced(initial, SYMMETRY)
    found = explore(initial, reduce=reduced)
    assert len(found.configurations) == orbits(initial, reduced.symmetry)


@given(swarms())
@examples(12)
def test_generated_swarms_are_equivariant_and_found_alike(text):
    initial = load(text, "").initial
    symmetry = MissionSymmetry(initial)
    assert equivariant(initial, symmetry, most=80)
    formulas = [HasPending("base"), Inside("gcs0", "room0")]
    full, whole = everything(initial, formulas, most=700)
    if full is None:
        return
    by = [SYMMETRY] if initial.setting.scheduler is Scheduler.FCFS else [SYMMETRY, BOTH]
    for reductions in by:
        found, part = everything(initial, formulas, Reduced(initial, reductions, formulas), most=700)
        assert len(part.configurations) <= len(whole.configurations)
        assert found[1] == {symmetry.representative(c) for c in full[1]}
        assert found[2:] == full[2:]
        assert {kind for kind, _ in found[0]} == {kind for kind, _ in full[0]}


# --- runs -----------------------------------------------------------------------------------------------------

LATE = """
environment { robot0 vanishes robot1 vanishes robot2 vanishes }
check { local_consistency deadlock_freedom reachable "all": forall r: Robot . r in room0 }
"""


@cache
def checked(reductions, rest=LATE, robots=3) -> tuple[Configuration, object]:
    loaded = mission(LOOKS, robots, rest)
    return loaded.initial, check(loaded, reduce=reductions)


@pytest.mark.parametrize("reductions", [SYMMETRY, BOTH], ids=["symmetry", "both"])
def test_runs_of_a_reduced_search_are_runs_of_the_mission_itself(reductions):
    initial, report = checked(reductions)
    _, full = checked(())
    assert report.configurations < full.configurations
    for found, whole in zip(report.verdicts, full.verdicts, strict=True):
        assert found.outcome is whole.outcome
        assert {each.kind for each in found.violations} == {each.kind for each in whole.violations}
        if reductions == SYMMETRY:
            assert kinds(found) == kinds(whole)
            assert all(each.trace.shortest for each in found.violations)
        runs = [(each.trace, each.message) for each in found.violations]
        runs += [(found.witness, "")] if found.witness else []
        for trace, message in runs:
            assert replay(initial, to_json(trace, "m", "d")) == trace
            if "inconsistent" in message:
                host = message.split("(")[1].split(",")[0]
                last = trace.configurations[-1]
                assert any(each.request.agent == host for each in last.eta.all())


# --- what is put off ------------------------------------------------------------------------------------------

CIRCLES = 'send ("here", SELF) to base loop {{ observe(PARENT(HOST)) react {{ case o => skip }} {} }}'
ROUNDS = {"program_order": "migrate(HOST)", "unordered": ""}
"""What else is done in each round, such that the two take one another's places on a cycle."""

FOLLOWS = 'send ("me", SELF) to base react { case "go" => control(MOVE_HOST_TO room0) }'
SENDS_ON = """
BigActor base hosted_at gcs0 with_behavior {
  react { case ("me", who) => react { case ("here", other) => send "go" to who } }
}
check { invariant "out": not (actually robot0 in room0) and not (actually robot1 in room0) }
"""


@pytest.mark.parametrize("engine", [Engine.REFERENCE, Engine.FAST])
@pytest.mark.parametrize("scheduler", ROUNDS)
@pytest.mark.parametrize("is_first", [True, False], ids=["circles first", "last"])
def test_who_waits_beside_its_like_that_circles_is_not_taken_for_it_under_both_reductions(
    is_first, scheduler, engine
):
    ways = (CIRCLES.format(ROUNDS[scheduler]), FOLLOWS)
    body = "choose {{ {} }} or {{ {} }}".format(*(ways if is_first else ways[::-1]))
    asked = mission(body, 2, f"{SENDS_ON}scheduler {scheduler}")
    found = check(asked, reduce=BOTH, engine=engine).verdicts
    assert [each.outcome for each in found if each.property.name == "out"] == [Outcome.VIOLATED]
