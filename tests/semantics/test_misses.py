"""Observations that miss: each answer is that of a world from which something has vanished, and none is left out."""

from itertools import chain, combinations

from hypothesis import given
from scale import examples
from small_missions import aboard, around, explore, mission, of_name

from physical import point
from semantics import hypothesis_strategies
from semantics.behaviours.observations import Of, QueryOperator
from semantics.behaviours.queries import evaluate, overlay
from semantics.behaviours.statements import Observe
from semantics.environment import Vanishes
from semantics.rules import sense
from semantics.state.physical_model import Placed
from semantics.state.requests import OBS
from semantics.successors import successors

IN_SPILL = Placed(point(36.7, -8.7))
IN_AREA = Placed(point(36.65, -8.75))


def looks(query, names, missable, **placed):
    """Return what u0's agent may miss, with the relations that it then sees."""
    first = mission(names, [Observe(query)], {"a": ("u0", (0,))}, placed=placed, missable=missable)
    (asked,) = successors(first)
    found = {}
    for step in sense(asked.target, "a"):
        (ready,) = (each.request for each in step.target.eta.all())
        found[step.label.missed] = set(map(str, ready.observation.relations))
    return found


def test_an_answer_leaves_out_any_of_those_that_it_would_show():
    found = looks(
        around(), ["area", "crate", "u0", "u1"], ("crate", "u1"), u0=IN_AREA, u1=IN_AREA, crate=IN_AREA
    )
    assert found == {
        missed: {f"parent({name}) = area" for name in ("crate", "u0", "u1") if name not in missed}
        for missed in [(), ("crate",), ("u1",), ("crate", "u1")]
    }


def test_what_is_in_a_missed_place_is_seen_one_place_further_out():
    found = looks(of_name("PARENT", "u0"), ["area", "sea", "spill", "u0"], ("area", "spill"), u0=IN_SPILL)
    assert found == {
        (): {"parent(u0) = spill"},
        ("spill",): {"parent(u0) = area"},
        ("area", "spill"): {"parent(u0) = sea"},
    }


def test_the_cargo_of_a_missed_carrier_is_missed_with_it():
    found = looks(
        of_name("CHILDREN", "ship"), ["crate", "sea", "ship", "u0"], ("ship",), crate=aboard("ship", "crate")
    )
    assert found == {(): {"parent(crate) = ship"}, ("ship",): set()}


def test_no_agent_misses_its_host_or_what_carries_that():
    found = looks(around(), ["sea", "ship", "u0"], ("ship", "u0"), u0=aboard("ship", "u0"))
    assert found == {(): {"parent(u0) = ship"}}


def test_counted_by_hand():
    """One observation of two that may be missed: asked, four answers, each received, and the end."""
    names, placed = ["area", "crate", "u0", "u1"], dict.fromkeys(("crate", "u0", "u1"), IN_AREA)
    first = mission(names, [Observe(around())], {"a": ("u0", (0,))}, placed=placed, missable=("crate", "u1"))
    counted = explore(first)
    assert (len(counted.configurations), len(counted.transitions)) == (1 + 1 + 4, 1 + 4)


@given(hypothesis_strategies.configurations(hypothesis_strategies.initial_configurations(misses=True)))
@examples(300, 6)
def test_the_answers_are_those_of_worlds_from_which_something_has_vanished(c):
    for agent in c.alpha.names():
        steps = list(sense(c, agent))
        for pending in [each for each in c.eta.in_line(agent) if isinstance(each.request, OBS)]:
            query = pending.request.query
            found = [step.target for step in steps if step.served == pending]
            right = {after_seeing(c, query, world) for world in worlds(c, agent)}
            seen = [frozenset(each.structure.logical.contents().items()) for each in found]
            assert set(seen) <= right
            assert set(seen) == right or asks_of_agents(query)


def worlds(c, agent):
    """Yield P without each set of the entities that may be missed, as the environment's clause makes it."""
    host = c.alpha.host(agent)
    own = {host, *c.structure.physical.carriers(host)}
    names = [name for name in c.setting.missable if name not in own]
    for some in chain.from_iterable(combinations(names, size) for size in range(len(names) + 1)):
        world = c
        for name in some:
            for _, changes in Vanishes(name).effects(world.structure.physical):
                world = world.with_(changes)
        yield world.structure.physical


def after_seeing(c, query, physical):
    parts = overlay(c.structure.logical, evaluate(query, physical, c.alpha))
    return frozenset(c.with_each(parts).structure.logical.contents().items())


def asks_of_agents(query):
    """Tell whether an answer may be about agents alone, which no sensor misses."""
    return isinstance(query, Of) and (query.operator == QueryOperator.HOSTED_AT or asks_of_agents(query.of))
