"""Realisations and obstacles of controls, `drive`, and control that takes time."""

import inspect
from dataclasses import replace

import pytest
from hypothesis import given
from hypothesis import strategies as st
from scale import examples
from small_missions import SHAPES, aboard, enabled, mission, move_to, run

from physical import Band, centroid, circle, point
from semantics import hypothesis_strategies
from semantics.behaviours.commands import COMMANDS
from semantics.behaviours.expressions import Literal
from semantics.behaviours.reaction_rules import (
    NodeVariable,
    Pattern,
    PlaceVariable,
    Reaction,
    matches,
    moved,
    relinked,
)
from semantics.behaviours.statements import ControlBy
from semantics.control import PREMISES, Obstacle, applicable, is_consistent, obstacle, realisations
from semantics.drive import drive
from semantics.environment import Drifts, Vanishes
from semantics.rules import actuate, command, commit
from semantics.state.initial import Beliefs
from semantics.state.physical_model import Carried, InTransit, Placed
from semantics.state.relations import Linked
from semantics.state.requests import CTR, FLY
from semantics.state.setting import Control, Scheduler, Setting
from semantics.state.signature import REGION, Kind, Signature
from semantics.successors import successors

TIMED = {"control": Control.TIMED}


def commanding(*statements, entities=("base", "area", "u0"), host="u0", **more):
    c = mission(entities, statements, {"a": (host, tuple(range(len(statements))))}, **(TIMED | more))
    return run(c, "req_ctr")


def by(name, *arguments):
    return ControlBy(name, tuple(map(Literal, arguments)))


# --- drive ------------------------------------------------------------------------------------------------------


@examples(100)
@given(st.data())
def test_drive_makes_the_reactum_true_and_disturbs_nothing_else(data):
    world = data.draw(hypothesis_strategies.worlds())
    beliefs = data.draw(hypothesis_strategies.beliefs(world)) if data.draw(st.integers(0, 3)) == 3 else None
    c = world.initial(agents={"a": ("uav0", ())}, beliefs=beliefs)
    reaction = data.draw(hypothesis_strategies.reactions(sorted(world.kinds), "uav0"))
    for match in applicable(c, "a", reaction):
        driven = drive(c, c.setting, reaction, match) if is_consistent(c, CTR("a", reaction), match) else None
        if driven is None:
            continue
        after = c.with_(driven.changes).structure
        assert after.consistent(match.relations(reaction.reactum), match.nodes(reaction.reactum))
        movers = dict(moved(reaction, match))
        linkers = {node for node, _, _ in relinked(reaction, match, c.structure.logical)}
        assert {cell[1] for cell in driven.changes if cell[0] == "placement"} <= set(movers)
        assert {cell[1] for cell in driven.changes if cell[0] == "channels"} <= linkers
        if len(movers) == 1:
            assert all(after.physical.abstract_parent(node) == place for node, place in movers.items())
        for node in movers:
            assert c.structure.physical.cargo(node) <= after.physical.cargo(node)


def test_a_mover_is_placed_at_the_centroid_unless_a_smaller_place_would_swallow_it():
    c = commanding(move_to("area"), entities=("sea", "area", "base", "spill", "u0"), control=Control.ATOMIC)
    after = run(c, "actuate").structure
    assert after.physical.abstract_parent("u0") == "area"  # and not the spill at its centre
    assert not after.physical.contains("spill", "u0")


@pytest.mark.parametrize(("band", "swallows"), [(None, True), (Band(0, 60), True), (Band(100, 200), False)])
def test_a_smaller_place_swallows_only_what_is_at_its_altitude(band, swallows):
    low = Placed(SHAPES["u0"].geometry, Band(20, 30))
    c = commanding(
        move_to("area"),
        entities=("sea", "area", "base", "spill", "u0"),
        placed={"spill": Placed(SHAPES["spill"].geometry, band), "u0": low},
        control=Control.ATOMIC,
    )
    after = run(c, "actuate").structure.physical
    assert after.abstract_parent("u0") == "area"
    assert (after.placement("u0").geometry != centroid(SHAPES["area"].geometry)) is swallows


@pytest.mark.parametrize(("place", "swallowed"), [("area", False), ("base", True)])
def test_of_two_equal_places_the_first_by_name_swallows_what_goes_to_the_other(place, swallowed):
    """What is one day where the other is: drifting places may come to be equal."""
    c = commanding(
        move_to(place),
        entities=("sea", "area", "base", "u0"),
        placed={"base": SHAPES["area"], "u0": SHAPES["gcs0"]},
        control=Control.ATOMIC,
    )
    assert enabled(c) == ([] if swallowed else ["actuate"])
    if not swallowed:
        assert run(c, "actuate").structure.physical.abstract_parent("u0") == place


def test_what_is_carried_leaves_no_hole_where_its_carrier_is():
    kinds = [
        Kind("Place", frozenset({"Uav", "Vessel"})),
        Kind("Vessel", frozenset({"Uav"}), frozenset({"Vessel"}), driven=True),
        Kind("Uav", driven=True),
    ]
    c = commanding(
        move_to("ship"),
        entities=("sea", "base", "ship", "boat", "u0"),
        placed={"boat": aboard("ship", "boat")},
        signature=Signature.of(kinds),
        control=Control.ATOMIC,
    )
    assert run(c, "actuate").structure.physical.abstract_parent("u0") == "ship"


def test_what_a_carrier_holds_may_be_put_where_the_carrier_is_at_once():
    c = commanding(
        by("PUT", "crate", "sea"),
        entities=("sea", "area", "ship", "crate"),
        host="ship",
        placed={"crate": aboard("ship", "crate")},
    )
    assert enabled(c) == ["actuate"]
    assert run(c, "actuate").structure.physical.abstract_parent("crate") == "sea"


def test_what_is_carried_may_be_put_into_what_carries_its_carrier():
    c = commanding(
        by("PUT", "crate", "ship"),
        entities=("sea", "ship", "boat", "crate"),
        host="boat",
        placed={"boat": aboard("ship", "boat"), "crate": aboard("boat", "crate")},
    )
    assert run(c, "actuate").structure.physical.carrier("crate") == "ship"


@pytest.mark.parametrize("by_ship", [True, False])
def test_what_is_carried_may_be_put_into_a_carrier_that_is_aboard_too(by_ship):
    c = commanding(
        by("PUT", "crate", "boat"),
        entities=("sea", "ship", "boat", "crate"),
        host="ship",
        placed={"crate": aboard("ship", "crate")} | ({"boat": aboard("ship", "boat")} if by_ship else {}),
    )
    assert enabled(c) == (["actuate"] if by_ship else [])
    if by_ship:
        assert run(c, "actuate").structure.physical.carrier("crate") == "boat"
    else:
        assert obstacle(c, c.eta.all()[0].request) is Obstacle.UNREALISABLE


def test_what_is_put_down_is_where_a_of_p_has_it_and_not_where_belief_is_coarser():
    c = commanding(
        by("PUT", "crate", "sea"),
        entities=("sea", "area", "ship", "crate"),
        host="ship",
        placed={"ship": Placed(circle((36.65, -8.65), 200)), "crate": aboard("ship", "crate")},
        beliefs=Beliefs({"ship": "sea"}),
    )
    assert enabled(c) == []
    assert obstacle(c, c.eta.all()[0].request) is Obstacle.UNREALISABLE


def test_what_flies_to_a_carrier_is_carried():
    c = commanding(move_to("ship"), entities=("sea", "base", "ship", "u0"))
    assert run(c, "command", "commit").structure.physical.carrier("u0") == "ship"


def test_nothing_can_be_moved_out_of_every_place():
    x, y = PlaceVariable("x"), PlaceVariable("y")
    follow = Reaction(
        "follow",
        Pattern(("u0", "gcs0"), (("u0", x), ("gcs0", y))),
        Pattern(("u0", "gcs0"), (("u0", y), ("gcs0", y))),
    )
    c = mission(["base", "u0", "gcs0"], agents={"a": ("u0", ())})
    assert c.structure.physical.abstract_parent("gcs0") == REGION
    assert obstacle(c, CTR("a", follow)) is Obstacle.UNREALISABLE


def test_what_a_later_move_undoes_is_unrealisable():
    """The boat leaves from under what has just been placed within it."""
    x, y = PlaceVariable("x"), PlaceVariable("y")
    nodes = ("u0", "boat", "area")
    meet = Reaction(
        "meet",
        Pattern(nodes, (("u0", x), ("boat", y))),
        Pattern(nodes, (("u0", "boat"), ("boat", "area"))),
    )
    kinds = [
        Kind("Place", frozenset({"Uav", "Vessel"})),
        Kind("Vessel", frozenset({"Uav"}), driven=True),
        Kind("Uav", driven=True),
    ]
    c = mission(
        ["sea", "base", "area", "boat", "u0"], agents={"a": ("u0", ())}, signature=Signature.of(kinds)
    )
    assert obstacle(c, CTR("a", COMMANDS["MOVE_HOST_TO"]("u0", "boat"))) is None
    assert obstacle(c, CTR("a", meet)) is Obstacle.UNREALISABLE


def test_what_is_aboard_already_may_be_put_there_where_l_is_coarser():
    c = commanding(
        by("MOVE", "crate", "ship"),
        entities=("sea", "ship", "crate", "gcs0"),
        host="gcs0",
        placed={"crate": aboard("ship", "crate")},
        channels={"gcs0": ("control:gcs0",), "crate": ("control:gcs0",)},
        beliefs=Beliefs(parents={"crate": "sea"}),
    )
    after = run(c, "actuate").structure
    assert (after.logical.parent("crate"), after.physical.carrier("crate")) == ("ship", "ship")


def test_what_a_carrier_holds_cannot_be_put_where_the_carrier_is_not():
    c = commanding(
        by("PUT", "crate", "area"),
        entities=("sea", "area", "ship", "crate"),
        host="ship",
        placed={"crate": aboard("ship", "crate")},
    )
    assert enabled(c) == []
    assert obstacle(c, c.eta.all()[0].request) is Obstacle.UNREALISABLE


def test_nothing_boards_what_rides_on_it():
    c = commanding(
        move_to("boat"),
        entities=("sea", "ship", "boat"),
        host="ship",
        placed={"boat": aboard("ship", "boat")},
        beliefs=Beliefs({"boat": "sea"}),
        control=Control.ATOMIC,
    )
    assert enabled(c) == []
    assert obstacle(c, c.eta.all()[0].request) is Obstacle.UNREALISABLE


def test_a_hand_over_that_is_believed_done_is_still_made_true():
    c = commanding(
        by("HAND", "u0", "gcs1"),
        entities=("base", "u0", "gcs0", "gcs1"),
        host="gcs0",
        channels={"gcs0": ["control:0"], "gcs1": ["control:1"], "u0": ["control:0"]},
        beliefs=Beliefs({}, {"u0": ["control:0", "control:1"]}),
        control=Control.ATOMIC,
    )
    after = run(c, "actuate").structure
    assert after.locally_consistent((Linked("control:1", "u0"),))
    assert after.logical.links("u0") == ("control:0", "control:1")


def test_creating_and_deleting_nothing_a_closed_node_must_be_empty_in_fact_too():
    closing = Reaction(
        "swap",
        Pattern(("base", "u0"), (("u0", "base"),), closed=("base",)),
        Pattern(("base", "u0"), (("u0", "base"),)),
    )
    c = mission(["base", "u0", "u1"], agents={"a": ("u0", ())}, beliefs=Beliefs({"u1": REGION}))
    (match,) = applicable(c, "a", closing)
    assert not is_consistent(c, CTR("a", closing), match)
    assert obstacle(c, CTR("a", closing)) is Obstacle.INCONSISTENT


# --- obstacles --------------------------------------------------------------------------------------------------


def test_the_three_obstacles_are_told_apart():
    def meets(**more):
        c = commanding(move_to("area"), **more)
        return obstacle(c, c.eta.all()[0].request)

    assert meets() is None
    assert meets(beliefs=Beliefs({"area": None})) is Obstacle.UNMATCHED
    assert meets(beliefs=Beliefs({"area": REGION}), placed={"area": None}) is Obstacle.INCONSISTENT
    assert meets(beliefs=Beliefs({"u0": "area"}), entities=("base", "area", "u0")) is Obstacle.INCONSISTENT
    still = Signature.of([Kind("Place", frozenset({"Uav"})), Kind("Uav")])
    assert meets(signature=still) is Obstacle.UNREALISABLE


def test_of_several_matches_the_obstacle_is_that_of_the_one_that_comes_furthest():
    x, anywhere = PlaceVariable("x"), NodeVariable("p", "Place")
    go = Reaction(
        "go", Pattern(("u0", anywhere), (("u0", x),)), Pattern(("u0", anywhere), (("u0", anywhere),))
    )
    c = mission(
        ["sea", "area", "u0"],
        agents={"a": ("u0", ())},
        placed={"area": None},
        beliefs=Beliefs({"area": REGION}),
        signature=Signature.of([Kind("Place", frozenset({"Place", "Uav"})), Kind("Uav")]),
    )
    lost, still = (obstacle(c, CTR("a", COMMANDS["MOVE_HOST_TO"]("u0", place))) for place in ("area", "sea"))
    assert (lost, still) == (Obstacle.INCONSISTENT, Obstacle.UNREALISABLE)
    assert obstacle(c, CTR("a", go)) is Obstacle.UNREALISABLE


def test_what_is_passed_on_the_way_has_to_be_believed_and_there():
    def meets(**more):
        c = commanding(by("MOVE_HOST_TO", "area", "sea"), entities=("sea", "base", "area", "u0"), **more)
        return obstacle(c, c.eta.all()[0].request)

    assert meets() is None
    assert meets(beliefs=Beliefs({"sea": None, "area": REGION})) is Obstacle.UNMATCHED
    assert (
        meets(beliefs=Beliefs({"sea": REGION, "area": REGION}), placed={"sea": None}) is Obstacle.INCONSISTENT
    )


@pytest.mark.parametrize("control", Control)
def test_a_way_changes_nothing_but_where_the_mover_is(control):
    entities = ("sea", "base", "area", "u0")
    rules = ("actuate",) if control is Control.ATOMIC else ("command", "commit")
    straight, round_about = (
        run(commanding(each, entities=entities, control=control), *rules)
        for each in (move_to("area"), by("MOVE_HOST_TO", "area", "base", "sea"))
    )
    assert dict(straight.state.items()) == dict(round_about.state.items())
    assert round_about.structure.logical.parent("u0") == "area"


def test_what_is_passed_and_vanishes_is_a_lost_target():
    c = run(
        commanding(
            by("MOVE_HOST_TO", "area", "spill"),
            entities=("sea", "base", "area", "spill", "u0"),
            environment=(Vanishes("spill"),),
        ),
        "command",
        "env",
    )
    assert obstacle(c, c.eta.all()[0].request) is Obstacle.INCONSISTENT


@given(hypothesis_strategies.configurations())
def test_a_control_in_line_is_served_or_has_an_obstacle_or_waits(c):
    for agent in c.alpha.names():
        for pending in c.eta.in_line(agent):
            request = pending.request
            if not isinstance(request, CTR | FLY):
                continue
            rules = (actuate, command) if isinstance(request, CTR) else (commit,)
            served = any(t.served == pending for rule in rules for t in rule(c, agent))
            assert not (served and obstacle(c, request))
            if not served and obstacle(c, request) is None:
                physical = c.structure.physical
                assert any(physical.transit(name) is not None for name in physical.entities())


# --- control that takes time ------------------------------------------------------------------------------------


def test_command_changes_neither_belief_nor_where_the_entity_was():
    c = commanding(move_to("area"))
    after = run(c, "command")
    assert after.structure.logical.parent("u0") == "base"
    assert after.structure.physical.placement("u0") == InTransit(SHAPES["u0"], "area")
    assert isinstance(after.eta.all()[0].request, FLY)


ASKED_AND_SENT = (("req_ctr", "a"), ("req_ctr", "b"), ("command", "a"))


def taken(c, *steps):
    """Take the first transition of each of these rules by the agent beside it."""
    for step in steps:
        c = next(t.target for t in successors(c) if (t.label.rule, t.label.agent) == step)
    return c


def two_commands(*places, **more):
    """Return a mission in which both agents of u0 command it, the first already on its way."""
    agents = {"a": ("u0", (0,)), "b": ("u0", (1,))}
    c = mission(["base", "sea", "area", "u0"], tuple(map(move_to, places)), agents, **TIMED, **more)
    return taken(c, *ASKED_AND_SENT)


def test_a_command_for_an_entity_in_transit_waits_and_is_not_inconsistent():
    c = two_commands("area", "sea")
    assert enabled(c) == ["commit"]
    assert obstacle(c, c.eta.of("b")[0].request) is None
    assert enabled(run(c, "commit")) == ["command"]


IN_SEA = Placed(point(36.55, -8.5))


def test_a_command_waits_though_what_is_in_transit_has_not_left_its_place():
    c = two_commands("area", "base", placed={"u0": IN_SEA})
    assert c.structure.physical.abstract_parent("u0") == "sea"
    assert enabled(c) == ["commit"]
    assert obstacle(c, c.eta.of("b")[0].request) is None


def pair(place="area"):
    """Return u0 and u1 in the sea, u0's agent about to move it to a place, and a request to move both at once."""
    both = Reaction(
        "both",
        Pattern(("u0", "u1", "base", "sea"), (("u0", "sea"), ("u1", "sea"))),
        Pattern(("u0", "u1", "base", "sea"), (("u0", "base"), ("u1", "base"))),
    )
    placed = {"u0": IN_SEA, "u1": Placed(point(36.56, -8.5))}
    agents = {"a": ("u0", (0,)), "b": ("u1", ())}
    c = mission(["base", "sea", "area", "u0", "u1"], (move_to(place),), agents, placed=placed, **TIMED)
    return c.with_({("line", "b"): (CTR("b", both),)})


def test_a_command_waits_for_each_that_it_moves():
    asked = taken(pair(), ("req_ctr", "a"))
    assert enabled(asked) == ["command", "command"]
    assert enabled(taken(asked, ("command", "a"))) == ["commit"]


def test_it_waits_though_only_one_of_those_that_it_moves_is_away():
    c = taken(pair("base"), ("req_ctr", "a"), ("command", "a"))
    assert c.structure.physical.abstract_parent("u0") == REGION
    assert enabled(c) == ["commit"]
    assert obstacle(c, c.eta.of("b")[0].request) is None


def test_what_is_linked_in_vain_does_not_wait_for_what_is_in_transit():
    channels = {"u0": ["control:0"], "gcs0": ["control:0"], "gcs1": ["control:1"]}
    agents = {"a": ("u0", (0,)), "b": ("gcs0", (1,))}
    statements = (move_to("area"), by("HAND", "u0", "gcs1"))
    entities = ["base", "area", "u0", "gcs0", "gcs1"]
    c = taken(mission(entities, statements, agents, channels=channels, **TIMED), *ASKED_AND_SENT)
    assert enabled(c) == ["actuate", "commit"]
    dropped = c.with_({("channels", "u0"): ()})
    assert obstacle(dropped, c.eta.of("b")[0].request) is Obstacle.INCONSISTENT


def test_what_is_not_matched_does_not_wait():
    others = Reaction(
        "others", Pattern(("u1", "base"), (("u1", "sea"),)), Pattern(("u1", "base"), (("u1", "base"),))
    )
    c = mission(["base", "sea", "area", "u0", "u1"], agents={"a": ("u0", ())}, **TIMED)
    c = c.with_({("placement", "u1"): InTransit(IN_SEA, "area"), ("parent", "u1"): "sea"})
    assert obstacle(c, CTR("a", others)) is Obstacle.UNMATCHED


def test_commit_requires_each_that_travels_to_be_on_its_way():
    c = run(pair(), "command")
    (pending,) = c.eta.all()
    assert "commit" in enabled(c)
    for name in ("u0", "u1"):
        back = c.with_({("placement", name): IN_SEA})
        assert list(commit(back, "b")) == []
        assert obstacle(back, pending.request) is Obstacle.INCONSISTENT


def test_commit_requires_the_links_of_what_travels():
    authority = {"gcs0": ["control:0"], "u0": ["control:0"]}
    flying = run(
        commanding(
            by("MOVE", "u0", "area"),
            entities=("base", "area", "u0", "gcs0"),
            host="gcs0",
            channels=authority,
        ),
        "command",
    )
    fly = flying.eta.all()[0].request
    assert obstacle(flying, fly) is None
    assert obstacle(flying.with_({("links", "u0"): ()}), fly) is Obstacle.UNMATCHED
    assert obstacle(flying.with_({("channels", "u0"): ()}), fly) is Obstacle.INCONSISTENT


def test_what_is_put_down_on_arrival_is_carried_on_the_way():
    x = PlaceVariable("x")
    land = Reaction(
        "land",
        Pattern(("ship", "crate", "area"), (("ship", x), ("crate", "ship"))),
        Pattern(("ship", "crate", "area"), (("ship", "area"), ("crate", "area"))),
    )
    placed = {"crate": aboard("ship", "crate")}
    c = mission(["sea", "area", "ship", "crate"], agents={"a": ("ship", ())}, placed=placed, **TIMED)
    flying = run(c.with_({("line", "a"): (CTR("a", land),)}), "command")
    assert flying.structure.physical.carrier("crate") == "ship"
    arrived = run(flying, "commit").structure.physical
    assert [arrived.abstract_parent(name) for name in ("ship", "crate")] == ["area", "area"]


def test_a_command_waits_for_the_carrier_too_even_to_put_something_down():
    put, go = by("PUT", "crate", "sea"), move_to("area")
    c = mission(
        ["sea", "area", "ship", "crate"],
        (go, put),
        {"a": ("ship", (0,)), "b": ("ship", (1,))},
        placed={"crate": aboard("ship", "crate")},
        **TIMED,
    )
    c = taken(c, *ASKED_AND_SENT)
    assert enabled(c) == ["commit"]
    assert obstacle(c, c.eta.of("b")[0].request) is None


def test_a_flight_forgets_where_it_was_believed_to_set_out():
    believed = [Beliefs(), Beliefs(parents={"u0": REGION})]
    flights = [
        run(commanding(move_to("area"), beliefs=each), "command").eta.all()[0].request for each in believed
    ]
    assert flights[0] == flights[1]


def test_a_flight_remembers_a_place_of_which_the_reaction_says_more():
    x = PlaceVariable("x")
    beside = Reaction(
        "beside",
        Pattern(("u0", "u1", "area"), (("u0", x), ("u1", x))),
        Pattern(("u0", "u1", "area"), (("u0", "area"), ("u1", x))),
    )
    c = mission(("base", "area", "u0", "u1"), (), {"a": ("u0", ())}, **TIMED)
    c = run(c.with_({("line", "a"): (CTR("a", beside),)}), "command")
    assert c.eta.all()[0].request.match[x] == "base"


def test_commit_requires_a_flight_in_line():
    c = run(commanding(move_to("area")), "command")
    fly = c.eta.all()[0].request
    behind = c.with_({("line", "a"): (CTR("a", fly.reaction), fly)})
    assert list(commit(behind, "a")) == []


def test_commit_requires_the_entity_to_be_on_the_way_of_this_flight_and_not_of_another():
    """It may have vanished, appeared elsewhere, and been sent from there by another agent."""
    flying = run(commanding(move_to("area")), "command")
    going = flying.structure.physical.placement("u0")
    elsewhere = flying.with_({("placement", "u0"): InTransit(going.origin, "base")})
    assert list(commit(elsewhere, "a")) == []
    assert obstacle(elsewhere, elsewhere.eta.all()[0].request) is Obstacle.INCONSISTENT


def meeting():
    """Return u0 on its way to the area, by a rule that has u1 stay in the base."""
    x = PlaceVariable("x")
    meet = Reaction(
        "meet",
        Pattern(("u0", "u1", "area", "base"), (("u0", x), ("u1", "base"))),
        Pattern(("u0", "u1", "area", "base"), (("u0", "area"), ("u1", "base"))),
    )
    c = mission(["base", "sea", "area", "u0", "u1"], agents={"a": ("u0", ())}, **TIMED)
    return run(c.with_({("line", "a"): (CTR("a", meet),)}), "command")


def test_commit_requires_its_unmoved_part_to_hold_in_belief_and_in_fact():
    c = meeting()
    fly = c.eta.all()[0].request
    assert enabled(c) == ["commit"]
    assert obstacle(c.with_({("parent", "u1"): "sea"}), fly) is Obstacle.UNMATCHED
    assert obstacle(c.with_({("placement", "u1"): SHAPES["spill"]}), fly) is Obstacle.INCONSISTENT
    assert (
        obstacle(c.with_({("parent", "u0"): REGION}), fly) is None
    )  # the moved node's own parent may change


def test_commit_requires_what_has_no_site_to_be_empty_still_in_belief_and_in_fact():
    x = PlaceVariable("x")
    alone = Reaction(
        "alone",
        Pattern(("u0", "area"), (("u0", x),), closed=("area",)),
        Pattern(("u0", "area"), (("u0", "area"),), closed=("area",)),
    )
    c = mission(["base", "area", "u0", "u1"], agents={"a": ("u0", ())}, **TIMED)
    c = run(c.with_({("line", "a"): (CTR("a", alone),)}), "command")
    fly = c.eta.all()[0].request
    assert enabled(c) == ["commit"]
    assert obstacle(c.with_({("parent", "u1"): "area"}), fly) is Obstacle.UNMATCHED
    entered = c.with_({("placement", "u1"): Placed(point(36.65, -8.65))})
    assert obstacle(entered, fly) is Obstacle.INCONSISTENT


def test_commit_requires_every_node_to_be_outside_of_what_is_passive():
    c = run(commanding(move_to("area"), entities=("base", "area", "bunker", "u0")), "command")
    inside = c.with_({("parent", "area"): "bunker"})
    assert enabled(inside) == []
    assert obstacle(inside, c.eta.all()[0].request) is Obstacle.UNMATCHED


def test_commit_goes_to_where_the_place_is_now():
    north = Placed(circle((36.78, -8.62), 400))
    c = run(
        commanding(
            move_to("spill"),
            entities=("sea", "base", "area", "spill", "u0"),
            environment=(Drifts("spill", (north,), ("north",), ((),), (0,)),),
        ),
        "command",
        "env",
        "commit",
    )
    assert c.structure.physical.abstract_parent("u0") == "spill"
    assert c.structure.physical.contains("spill", "u0")


def test_a_lost_target_is_inconsistent():
    c = run(
        commanding(
            move_to("spill"), entities=("sea", "base", "spill", "u0"), environment=(Vanishes("spill"),)
        ),
        "command",
        "env",
    )
    assert obstacle(c, c.eta.all()[0].request) is Obstacle.INCONSISTENT


@pytest.mark.parametrize(
    ("request_of", "host", "links"),
    [
        (by("CONNECT_HOST_TO", "u1"), "u0", ("control:0", "w")),
        (by("DISCONNECT_HOST_FROM", "u1"), "ship", ()),
        (by("HAND", "u0", "gcs1"), "gcs0", ("control:1",)),
    ],
    ids=["connected", "disconnected", "handed over"],
)
def test_link_changes_commit_at_once_in_belief_and_in_fact(request_of, host, links):
    channels = {"u0": ["control:0"], "u1": ["w"], "ship": ["w"], "gcs0": ["control:0"], "gcs1": ["control:1"]}
    entities = ("base", "u0", "u1", "ship", "gcs0", "gcs1")
    c = commanding(request_of, entities=entities, host=host, channels=channels)
    assert enabled(c) == ["actuate"]
    after = run(c, "actuate").structure
    changed = "u0" if host == "gcs0" else host
    assert (after.logical.links(changed), after.physical.links(changed)) == (links, links)


def test_one_way_to_make_a_control_true_hides_no_other():
    """To the area and the spill it flies; in the sea it is put down, and aboard it is already."""
    anywhere = NodeVariable("p")
    leave = Reaction(
        "leave", Pattern(("u0", anywhere), (("u0", "ship"),)), Pattern(("u0", anywhere), (("u0", anywhere),))
    )
    c = mission(
        ["sea", "area", "ship", "spill", "u0"],
        agents={"a": ("u0", ())},
        placed={"u0": aboard("ship", "u0")},
        **TIMED,
    )
    c = c.with_({("line", "a"): (CTR("a", leave),)})
    assert enabled(c) == ["actuate", "actuate", "command", "command"]


def test_in_no_order_a_flight_ends_though_another_control_waits():
    c = commanding(
        move_to("area"),
        move_to("base"),
        entities=("sea", "area", "base", "u0"),
        scheduler=Scheduler.UNORDERED,
    )
    assert enabled(run(c, "req_ctr", "command")) == ["commit"]


def test_a_command_from_a_carrier_keeps_the_shape_of_what_is_carried():
    more = {"entities": ("sea", "area", "ship", "u0"), "placed": {"u0": aboard("ship", "u0")}}
    flying = run(commanding(move_to("area"), **more), "command")
    assert flying.structure.physical.placement("u0").origin.geometry.is_point
    assert flying.structure.physical.carrier("u0") is None
    arrived = run(flying, "commit").structure.physical.placement("u0")
    at_once = run(commanding(move_to("area"), control=Control.ATOMIC, **more), "actuate")
    assert arrived == at_once.structure.physical.placement("u0")


@examples(100)
@given(st.data())
def test_atomic_control_is_command_then_commit_with_nothing_between(data):
    world = data.draw(hypothesis_strategies.worlds())
    reaction = data.draw(hypothesis_strategies.reactions(sorted(world.kinds), "uav0"))
    c = world.initial(agents={"a": ("uav0", ())}).with_({("line", "a"): (CTR("a", reaction),)})
    timed = under(c, c.setting.with_(**TIMED))
    at_once = {t.target for t in actuate(c, "a")}
    direct = {t.target for t in actuate(timed, "a")}
    flown = {after.target for t in command(timed, "a") for after in commit(t.target, "a")}
    assert at_once == direct | flown
    assert len(list(realisations(c, CTR("a", reaction)))) == len(list(actuate(timed, "a"))) + len(
        list(command(timed, "a"))
    )


def under(c, setting: Setting):
    return type(c)(setting, c.state)


@given(
    hypothesis_strategies.configurations(
        hypothesis_strategies.initial_configurations(controls=[Control.TIMED])
    )
)
def test_whatever_is_in_transit_was_commanded_and_will_be_committed(c):
    flights = [each.request for each in c.eta.all() if isinstance(each.request, FLY)]
    travelling = {node for fly in flights for node, _ in moved(fly.reaction, fly.match)}
    for name in c.structure.physical.entities():
        if isinstance(c.structure.physical.placement(name), InTransit):
            assert name in travelling


def test_every_command_of_the_language_is_realisable_somewhere():
    c = mission(
        ["sea", "base", "area", "ship", "crate", "u0", "gcs0", "gcs1"],
        placed={"crate": aboard("ship", "crate"), "u0": Placed(point(36.6001, -8.5))},
        channels={"gcs0": ["control:0", "w"], "u0": ["control:0"], "ship": ["w"], "gcs1": ["control:1", "v"]},
        agents={"a": ("gcs0", ()), "s": ("ship", ())},
    )
    somewhere = {
        "MOVE_HOST_TO": ("s", "area"),
        "MOVE": ("a", "u0", "area"),
        "PUT": ("s", "crate", "sea"),
        "HAND": ("a", "u0", "gcs1"),
        "CONNECT_HOST_TO": ("a", "gcs1"),
        "DISCONNECT_HOST_FROM": ("a", "ship"),
    }
    assert somewhere.keys() == COMMANDS.keys()
    for name, (agent, *arguments) in somewhere.items():
        reaction = COMMANDS[name](c.alpha.host(agent), *arguments)
        assert obstacle(c, CTR(agent, reaction)) is None, name
    assert isinstance(c.structure.physical.placement("crate"), Carried)


# --- premises -----------------------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("rule", "premise"),
    [(actuate, each) for each in PREMISES[CTR]] + [(commit, each) for each in PREMISES[FLY]],
    ids=lambda each: getattr(each, "text", each.__name__ if callable(each) else ""),
)
def test_each_premise_stands_above_the_bar_of_its_rule(rule, premise):
    above, _, _ = inspect.getdoc(rule).partition("──")
    assert premise.text in above


@pytest.mark.parametrize("request_type", [CTR, FLY])
def test_a_control_is_served_just_where_no_premise_fails(request_type, monkeypatch):
    c = commanding(move_to("area"))
    c = run(c, "command") if request_type is FLY else c
    (pending,) = c.eta.all()
    assert isinstance(pending.request, request_type)
    assert obstacle(c, pending.request) is None
    for number, premise in enumerate(PREMISES[request_type]):
        never = replace(premise, holds=lambda *_: False)
        those = (*PREMISES[request_type][:number], never, *PREMISES[request_type][number + 1 :])
        with monkeypatch.context() as patch:
            patch.setitem(PREMISES, request_type, those)
            assert obstacle(c, pending.request) is premise.otherwise
            assert not [*actuate(c, "a"), *command(c, "a"), *commit(c, "a")]


def first_failing():
    """Return for each premise, by its request and function, a configuration in which it is the first to fail."""
    bystander = Reaction("r", Pattern(("u1",)), Pattern(("u1",)))
    apart = mission(["base", "u0", "u1"], agents={"a": ("u0", ())}).with_(
        {("line", "a"): (CTR("a", bystander),)}
    )
    cargo = {"entities": ("sea", "ship", "crate"), "placed": {"crate": aboard("ship", "crate")}}
    flying = run(commanding(move_to("area")), "command")
    return {
        (CTR, "involves_host"): apart,
        (CTR, "leaves_forest"): commanding(move_to("crate"), host="ship", **cargo),
        (CTR, "is_consistent"): commanding(
            move_to("area"), beliefs=Beliefs({"area": REGION}), placed={"area": None}
        ),
        (FLY, "is_under_way"): flying.with_({("placement", "u0"): SHAPES["u1"]}),
        (FLY, "still_matches"): flying.with_({("parent", "area"): None}),
        (FLY, "leaves_forest"): flying.with_({("parent", "area"): "u0"}),
        (FLY, "is_unmoved_consistent"): meeting().with_({("placement", "u1"): SHAPES["spill"]}),
    }


def test_each_premise_is_the_first_to_fail_somewhere():
    found = first_failing()
    assert found.keys() == {(of, each.holds.__name__) for of, each_of in PREMISES.items() for each in each_of}
    for (of, name), c in found.items():
        (pending,) = c.eta.all()
        request = pending.request
        ways = [request.match] if of is FLY else matches(request.reaction.redex, c.structure.logical)
        failing = [next(p for p in PREMISES[of] if not p.holds(c, request, match)) for match in ways]
        assert {each.holds.__name__ for each in failing} == {name}
        assert obstacle(c, request) is failing[0].otherwise


@pytest.mark.parametrize("premise", ["involves_host", "leaves_forest", "is_consistent"])
def test_a_match_is_applicable_that_fulfils_each_premise_about_l(premise):
    c = first_failing()[CTR, premise]
    (pending,) = c.eta.all()
    found = list(applicable(c, pending.request.agent, pending.request.reaction))
    assert bool(found) is (premise == "is_consistent")
