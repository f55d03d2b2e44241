"""The seven rules: for each its conclusion, and for each premise what happens without it."""

import pytest
from hypothesis import given
from hypothesis import strategies as st
from scale import examples
from small_missions import (
    GUARD,
    SHAPES,
    aboard,
    around,
    enabled,
    figure_2,
    is_in,
    mission,
    move_to,
    of_name,
    received,
    run,
)

from physical import box, point
from semantics import hypothesis_strategies
from semantics.behaviours.expressions import Apply, Fault, Literal, Variable
from semantics.behaviours.patterns import Anything
from semantics.behaviours.statements import (
    Assign,
    Case,
    Choose,
    ChooseFrom,
    ControlBy,
    Display,
    Loop,
    Observe,
    React,
    While,
)
from semantics.behaviours.values import Truth
from semantics.control import realisations
from semantics.environment import Drifts, Drops, Says, Vanishes
from semantics.rules import actuate, command, commit, env, fun, rcv_obs, req_ctr, req_obs, sense
from semantics.state.configuration import Configuration
from semantics.state.initial import Beliefs
from semantics.state.physical_model import Placed
from semantics.state.relations import Parent
from semantics.state.requests import CTR, FLY, OBS, READY
from semantics.state.setting import Control, Scheduler
from semantics.state.signature import REGION
from semantics.successors import successors


def alone(*statements, entities=("base", "area", "u0"), code=None, **more) -> Configuration:
    """Return a mission of one agent on u0 that runs these statements."""
    return mission(entities, statements, {"a": ("u0", code or tuple(range(len(statements))))}, **more)


def requests(c: Configuration) -> list[object]:
    return [each.request for each in c.eta.all()]


# --- premises ---------------------------------------------------------------------------------------------------

LOOK = Observe(around())


def ready(*statements, **more) -> Configuration:
    return run(alone(LOOK, *statements, **more), "req_obs", "sense")


def asked(place: str = "area", **more) -> Configuration:
    return run(alone(move_to(place), **more), "req_ctr")


FULL = {
    "spill": SHAPES["spill"],
    "u0": Placed(box((36.5, -8.8), (36.52, -8.82))),
}  # u0 is larger than the spill
CRATE = mission(["sea", "area", "crate"], [move_to("area")], {"a": ("crate", (0,))})
OF_MESSAGES = React((Case(Anything("m", "message"), None, ()),))
WITHOUT = {
    "fun: the next step is internal": (fun, alone(move_to("area"))),
    "fun: there is a next step": (fun, alone(code=())),
    "req_obs: the agent is at observe": (req_obs, alone(move_to("area"), LOOK)),
    "sense: an observation is pending": (sense, alone(LOOK)),
    "sense: it is in line": (sense, run(alone(move_to("area"), LOOK), "req_ctr", "req_obs")),
    "rcv_obs: the agent is at a react": (rcv_obs, ready(move_to("area"))),
    "rcv_obs: the observation is ready": (rcv_obs, run(alone(LOOK, received("o")), "req_obs")),
    "rcv_obs: a guard admits it": (rcv_obs, ready(received("o", guard=is_in("area", "o")))),
    "rcv_obs: a case is for observations": (rcv_obs, ready(OF_MESSAGES)),
    "req_ctr: the agent is at control": (req_ctr, alone(LOOK, move_to("area"))),
    "actuate: a control is pending": (actuate, alone(move_to("area"))),
    "actuate: it is in line": (actuate, run(alone(LOOK, move_to("area")), "req_obs", "req_ctr")),
    "actuate: there is a match": (actuate, asked(beliefs=Beliefs({"area": None}))),
    "actuate: the redex is consistent": (actuate, asked("base", beliefs=Beliefs({"u0": "area"}))),
    "actuate: its place is there": (actuate, asked(placed={"area": None}, beliefs=Beliefs({"area": REGION}))),
    "actuate: the mover is driven": (actuate, run(CRATE, "req_ctr")),
    "actuate: there is room": (actuate, asked("spill", entities=("spill", "u0"), placed=FULL)),
}


@pytest.mark.parametrize("premise", WITHOUT)
def test_without_a_premise_a_rule_does_nothing(premise):
    rule, c = WITHOUT[premise]
    assert list(rule(c, "a")) == []


# --- fun --------------------------------------------------------------------------------------------------------


def test_fun_takes_all_internal_steps_up_to_the_next_command():
    c = alone(
        Assign("x", Literal(1)),
        Assign("y", Apply("+", (Variable("x"), Literal(1)))),
        Display(Variable("y")),
        move_to("area"),
    )
    (t,) = fun(c, "a")
    assert t.target.alpha.code("a") == (3,)
    assert t.shown == ("2",)
    assert t.target.alpha.store("a") == ()  # nobody reads x and y any more


def test_fun_stops_before_a_choose_and_gives_one_successor_per_alternative():
    c = alone(Display(Literal(1)), Choose(((2,), (3,))), move_to("area"), move_to("base"), code=(0, 1))
    (before,) = fun(c, "a")
    assert before.target.alpha.code("a") == (1,)
    assert [t.target.alpha.code("a") for t in fun(before.target, "a")] == [(2,), (3,)]


def test_choosing_from_nothing_is_a_fault():
    c = alone(ChooseFrom("x", Literal(frozenset()), ()))
    with pytest.raises(Fault, match="nothing to choose"):
        list(fun(c, "a"))


def test_a_computation_that_reaches_no_command_diverges():
    c = alone(While(Literal(Truth.TRUE), (1,)), Display(Literal(1)), code=(0,))
    with pytest.raises(Fault) as raised:
        successors(c)
    assert (raised.value.diverges, raised.value.agent) == (True, "a")


def test_loop_jumps_belong_to_the_step_that_they_stand_before():
    c = alone(Loop((1,)), move_to("area"), code=(0,))
    assert c.alpha.code("a") == (1, 0)
    assert run(c, "req_ctr").alpha.code("a") == (1, 0)


# --- req_obs ----------------------------------------------------------------------------------------------------


def test_req_obs_adds_the_request_and_the_agent_continues():
    c = run(alone(LOOK, move_to("area")), "req_obs")
    assert [str(request) for request in requests(c)] == ["OBS(a, CHILDREN(PARENT(u0)))"]
    assert c.alpha.code("a") == (1,)


# --- sense ------------------------------------------------------------------------------------------------------


def test_sense_updates_belief_and_the_observation_becomes_ready():
    c = run(alone(LOOK, beliefs=Beliefs({"u0": "area"})), "req_obs")
    after = run(c, "sense")
    assert after.structure.logical.parent("u0") == "base"
    (ready,) = requests(after)
    assert isinstance(ready, READY)
    assert ready.observation.shown == ("base", "u0")


# --- rcv_obs ----------------------------------------------------------------------------------------------------


def test_rcv_obs_binds_what_was_observed_and_the_request_is_gone():
    c = run(ready(received("o", 2), Display(Variable("o")), code=(0, 1)), "rcv_obs")
    assert requests(c) == []
    assert dict(c.alpha.store("a"))["o"].shown == ("base", "u0")
    assert c.alpha.code("a") == (2,)


def test_rcv_obs_takes_the_first_case_that_fits():
    cases = React(
        (
            Case(Anything("m", "message"), None, ()),
            Case(Anything("o"), is_in("area", "o"), (2,)),
            Case(Anything("p"), is_in("base", "p"), (3, 4)),
            Case(Anything("q"), None, (2,)),
        )
    )
    c = ready(cases, move_to("area"), GUARD, move_to("base"), code=(0, 1))
    (t,) = rcv_obs(c, "a")
    assert t.target.alpha.code("a") == (3, 4)


@pytest.mark.parametrize("place", ["area", "base"])
def test_in_no_order_an_observation_that_no_case_takes_hides_no_other(place):
    looks = [Observe(of_name("CHILDREN", each)) for each in ("area", "base")]
    c = alone(*looks, received("o", guard=is_in(place, "o")), scheduler=Scheduler.UNORDERED)
    c = run(c, "req_obs", "req_obs", "sense", "sense")
    (t,) = rcv_obs(c, "a")
    (left,) = requests(t.target)
    assert place not in left.observation.shown


def test_the_body_of_a_guarded_case_begins_with_one_fun():
    assert "fun" in enabled(run(figure_2(guarded=True), "req_ctr", "actuate", "req_obs", "sense", "rcv_obs"))


# --- req_ctr ----------------------------------------------------------------------------------------------------


def test_req_ctr_adds_the_request_and_the_agent_continues():
    c = run(alone(move_to("area")), "req_ctr")
    assert [str(request) for request in requests(c)] == ["CTR(a, MOVE_HOST_TO area)"]
    assert c.alpha.code("a") == ()


@pytest.mark.parametrize("value", [1, Truth.TRUE, frozenset(), frozenset({"area", "base"}), ("area",)])
def test_a_control_of_what_is_no_name_is_a_fault(value):
    with pytest.raises(Fault, match="name was expected"):
        successors(alone(ControlBy("MOVE_HOST_TO", (Literal(value),))))


# --- actuate ----------------------------------------------------------------------------------------------------


def test_actuate_makes_the_reactum_true_in_belief_and_in_fact():
    c = run(asked(), "actuate")
    assert c.structure.logical.parent("u0") == "area"
    assert c.structure.physical.abstract_parent("u0") == "area"
    assert requests(c) == []


def test_actuate_allows_belief_to_be_coarser_than_fact():
    c = run(
        alone(
            move_to("base"),
            entities=("sea", "area", "base", "spill", "u0"),
            placed={"u0": Placed(point(36.65, -8.65))},
            beliefs=Beliefs({"u0": "sea"}),
        ),
        "req_ctr",
    )
    assert c.structure.physical.abstract_parent("u0") == "area"
    assert len(list(actuate(c, "a"))) == 1


@examples(100)
@given(st.data(), st.sampled_from(Control))
def test_after_a_control_the_structure_is_locally_consistent_with_the_reactum(data, control):
    world = data.draw(hypothesis_strategies.worlds())
    beliefs = data.draw(hypothesis_strategies.beliefs(world)) if data.draw(st.integers(0, 2)) == 2 else None
    reaction = data.draw(hypothesis_strategies.reactions(sorted(world.kinds), "uav0"))
    c = world.initial(agents={"a": ("uav0", ())}, beliefs=beliefs)
    timed = Configuration(c.setting.with_(control=control), c.with_(c.eta.adding(CTR("a", reaction))).state)
    ways = [found.match for found in realisations(timed, CTR("a", reaction))]
    flown = [after for t in command(timed, "a") for after in commit(t.target, "a")]
    ends = [t.target.structure for t in (*actuate(timed, "a"), *flown)]
    parts = [(m.relations(reaction.reactum), m.nodes(reaction.reactum)) for m in ways]
    assert len(ends) == len(ways)
    assert all(any(end.locally_consistent(*part) for part in parts) for end in ends)


# --- env --------------------------------------------------------------------------------------------------------


def test_env_changes_p_alone():
    other = SHAPES["crate"]
    drift = Drifts("crate", (other, SHAPES["u0"]), ("here", "there"), ((1,), (0,)), (0, 1))
    c = mission(
        ["sea", "base", "crate"], environment=(drift, Says("go", "a", 1, 0)), agents={"a": ("crate", ())}
    )
    (t,) = env(c, drift)
    assert t.target.structure.physical.abstract_parent("crate") == "base"
    assert t.target.structure.logical.parent("crate") == "sea"
    assert str(t.label) == "⟨env : crate drifts to there⟩"


def test_env_requires_a_clause_about_p_that_allows_the_change():
    says, drop = Says("go", "a", 1, 0), Drops("w", returns=False)
    c = mission(["u0"], channels={"u0": ["w"]}, environment=(says, drop))
    (t,) = env(c, drop)
    assert [*env(c, says), *env(t.target, drop)] == []


def test_what_vanishes_takes_its_cargo_along_and_belief_keeps_both():
    c = mission(
        ["sea", "ship", "crate"], placed={"crate": aboard("ship", "crate")}, environment=(Vanishes("ship"),)
    )
    (t,) = env(c, c.setting.environment[0])
    assert "crate" not in t.target.structure.physical
    assert t.target.structure.logical.parent("crate") == "ship"
    assert not t.target.structure.locally_consistent((Parent("crate", "ship"),))


# --- requests are served in place -------------------------------------------------------------------------------


def test_what_a_request_becomes_stands_where_it_stood():
    seen = run(alone(LOOK, Observe(of_name("CHILDREN", "base"))), "req_obs", "req_obs", "sense")
    assert [type(request) for request in requests(seen)] == [READY, OBS]
    flying = run(alone(move_to("area"), LOOK, control=Control.TIMED), "req_ctr", "req_obs", "command")
    assert [type(request) for request in requests(flying)] == [FLY, OBS]
