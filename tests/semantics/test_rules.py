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
from semantics import strategies
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


def test_fun_requires_the_next_step_to_be_internal():
    assert list(fun(alone(move_to("area")), "a")) == []
    assert list(fun(alone(code=()), "a")) == []


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
    c = run(alone(Observe(around()), move_to("area")), "req_obs")
    assert [str(request) for request in requests(c)] == ["OBS(a, CHILDREN(PARENT(u0)))"]
    assert c.alpha.code("a") == (1,)


def test_req_obs_requires_the_agent_to_be_at_observe():
    assert list(req_obs(alone(move_to("area"), Observe(around())), "a")) == []


# --- sense ------------------------------------------------------------------------------------------------------


def test_sense_updates_belief_and_the_observation_becomes_ready():
    c = run(alone(Observe(around()), beliefs=Beliefs({"u0": "area"})), "req_obs")
    after = run(c, "sense")
    assert after.structure.logical.parent("u0") == "base"
    (ready,) = requests(after)
    assert isinstance(ready, READY)
    assert ready.observation.shown == ("base", "u0")


def test_sense_requires_a_pending_observation():
    assert list(sense(alone(Observe(around())), "a")) == []


def test_sense_requires_the_observation_to_be_in_line():
    c = run(alone(move_to("area"), Observe(around())), "req_ctr", "req_obs")
    assert list(sense(c, "a")) == []
    assert len(list(sense(run(c, "actuate"), "a"))) == 1


@given(st.data())
def test_after_sense_the_structure_is_locally_consistent_with_what_was_seen(data):
    c = data.draw(asking(lambda names: strategies.queries(names).map(lambda query: OBS("a", query))))
    (t,) = sense(c, "a")
    (ready,) = requests(t.target)
    seen = ready.observation
    assert t.target.structure.locally_consistent(seen.relations, seen.nodes())


@st.composite
def asking(draw, request):
    """Yield configurations in any world, of lagging belief too, with one pending request of a, hosted at uav0."""
    world = draw(strategies.worlds())
    beliefs = draw(strategies.beliefs(world)) if draw(st.integers(0, 2)) == 2 else None
    c = world.initial(agents={"a": ("uav0", ())}, beliefs=beliefs)
    return c.with_(c.eta.adding(draw(request(sorted(world.kinds)))))


# --- rcv_obs ----------------------------------------------------------------------------------------------------


def ready(*statements, **more) -> Configuration:
    return run(alone(Observe(around()), *statements, **more), "req_obs", "sense")


def test_rcv_obs_binds_what_was_observed_and_the_request_is_gone():
    c = run(ready(received("o", 2), Display(Variable("o")), code=(0, 1)), "rcv_obs")
    assert requests(c) == []
    assert dict(c.alpha.store("a"))["o"].shown == ("base", "u0")
    assert c.alpha.code("a") == (2,)


def test_rcv_obs_requires_the_agent_to_be_at_a_react():
    assert list(rcv_obs(ready(move_to("area")), "a")) == []


def test_rcv_obs_requires_a_ready_observation():
    c = run(alone(Observe(around()), received("o")), "req_obs")
    assert list(rcv_obs(c, "a")) == []


def test_rcv_obs_requires_a_case_for_it():
    assert list(rcv_obs(ready(received("o", guard=is_in("area", "o"))), "a")) == []
    assert list(rcv_obs(ready(React((Case(Anything("m", "message"), None, ()),))), "a")) == []


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


def test_the_body_of_a_guarded_case_begins_with_one_fun():
    assert "fun" in enabled(run(figure_2(guarded=True), "req_ctr", "actuate", "req_obs", "sense", "rcv_obs"))


# --- req_ctr ----------------------------------------------------------------------------------------------------


def test_req_ctr_adds_the_request_and_the_agent_continues():
    c = run(alone(move_to("area")), "req_ctr")
    assert [str(request) for request in requests(c)] == ["CTR(a, MOVE_HOST_TO area)"]
    assert c.alpha.code("a") == ()


def test_req_ctr_requires_the_agent_to_be_at_control():
    assert list(req_ctr(alone(Observe(around()), move_to("area")), "a")) == []


@pytest.mark.parametrize("value", [1, Truth.TRUE, frozenset(), frozenset({"area", "base"}), ("area",)])
def test_a_control_of_what_is_no_name_is_a_fault(value):
    with pytest.raises(Fault, match="name was expected"):
        successors(alone(ControlBy("MOVE_HOST_TO", (Literal(value),))))


# --- actuate ----------------------------------------------------------------------------------------------------


def asked(place: str = "area", **more) -> Configuration:
    return run(alone(move_to(place), **more), "req_ctr")


def test_actuate_makes_the_reactum_true_in_belief_and_in_fact():
    c = run(asked(), "actuate")
    assert c.structure.logical.parent("u0") == "area"
    assert c.structure.physical.abstract_parent("u0") == "area"
    assert requests(c) == []


def test_actuate_requires_a_pending_control():
    assert list(actuate(alone(move_to("area")), "a")) == []


def test_actuate_requires_the_control_to_be_in_line():
    c = run(alone(Observe(around()), move_to("area")), "req_obs", "req_ctr")
    assert list(actuate(c, "a")) == []
    assert (
        len(list(actuate(Configuration(c.setting.with_(scheduler=Scheduler.UNORDERED), c.state), "a"))) == 1
    )


def test_actuate_requires_a_match():
    assert list(actuate(asked(beliefs=Beliefs({"area": None})), "a")) == []


def test_actuate_requires_a_locally_consistent_redex():
    assert list(actuate(asked(beliefs=Beliefs({"u0": "area"}), place="base"), "a")) == []
    assert list(actuate(asked(placed={"area": None}, beliefs=Beliefs({"area": REGION})), "a")) == []


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


def test_actuate_requires_something_that_can_be_driven():
    c = mission(["sea", "area", "crate"], [move_to("area")], {"a": ("crate", (0,))})
    assert list(actuate(run(c, "req_ctr"), "a")) == []


def test_actuate_requires_room_in_the_new_place():
    full = {
        "spill": SHAPES["spill"],
        "u0": Placed(box((36.5, -8.8), (36.52, -8.82))),
    }  # larger than the spill
    c = run(alone(move_to("spill"), entities=("spill", "u0"), placed=full), "req_ctr")
    assert list(actuate(c, "a")) == []


@examples(100)
@given(st.data(), st.sampled_from(Control))
def test_after_a_control_the_structure_is_locally_consistent_with_the_reactum(data, control):
    c = data.draw(
        asking(lambda names: strategies.reactions(names, "uav0").map(lambda reaction: CTR("a", reaction)))
    )
    reaction = requests(c)[0].reaction
    ways = [found.match for found in realisations(c, requests(c)[0])]
    timed = Configuration(c.setting.with_(control=control), c.state)
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


def test_env_requires_a_clause_about_p():
    c = mission(["base"], environment=(Says("go", "a", 1, 0),))
    assert list(env(c, c.setting.environment[0])) == []


def test_env_requires_the_environment_to_allow_the_change():
    drop = Drops("w", returns=False)
    c = mission(["u0"], channels={"u0": ["w"]}, environment=(drop,))
    (t,) = env(c, drop)
    assert t.target.structure.physical.links("u0") == ()
    assert list(env(t.target, drop)) == []


def test_what_vanishes_takes_its_cargo_along_and_belief_keeps_both():
    c = mission(
        ["sea", "ship", "crate"], placed={"crate": aboard("ship", "crate")}, environment=(Vanishes("ship"),)
    )
    (t,) = env(c, c.setting.environment[0])
    assert "crate" not in t.target.structure.physical
    assert t.target.structure.logical.parent("crate") == "ship"
    assert not t.target.structure.locally_consistent((Parent("crate", "ship"),))


# --- requests are served in place -------------------------------------------------------------------------------


def test_a_ready_observation_stands_where_the_request_stood():
    c = run(alone(Observe(around()), Observe(of_name("CHILDREN", "base"))), "req_obs", "req_obs", "sense")
    assert [type(request) for request in requests(c)] == [READY, OBS]


def test_a_command_stands_where_the_control_stood():
    c = alone(move_to("area"), Observe(around()), control=Control.TIMED)
    assert [type(each) for each in requests(run(c, "req_ctr", "req_obs", "command"))] == [FLY, OBS]
