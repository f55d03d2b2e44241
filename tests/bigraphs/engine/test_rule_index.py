"""The index leaves out only rules that cannot occur, and limits hold however many rules are asked."""

import pytest
from bigraph_strategies import PLAIN, SIGNATURE, grounds
from engine_strategies import solid_rules
from hypothesis import given
from hypothesis import strategies as st

from bigraphs.engine.intern_tables import InternTables
from bigraphs.engine.machine import Machine
from bigraphs.engine.occurrence_search import Matcher
from bigraphs.engine.occurrences import Spot
from bigraphs.engine.reactions import CompiledReaction
from bigraphs.engine.rule_index import ReactionIndex
from bigraphs.engine.state_arrays import make_state
from bigraphs.exploration import explore
from bigraphs.notation import read_system

COUNTERS = """
    fun ctrl Count(n) = 0; atomic ctrl Tick = 0; big start = Count(0).1 | Count(0).1 | Tick;
    fun react up(n) = Count(n) | Tick --> Count(n + 1) | Tick;
    fun react meet(n) = Count(n) | Count(n) --> Count(n) | Count(0);
    fun big at(n) = Count(n);
    begin brs int n = [0 : 1 : 199]; init start; rules = [ {up(n), meet(n)} ]; preds = { at(n) }; end
"""


@given(st.lists(solid_rules(), min_size=1, max_size=6), grounds(max_nodes=6, controls=PLAIN))
def test_every_rule_that_occurs_is_possible_and_they_keep_their_order(rules, target):
    world = InternTables(SIGNATURE, target.outer_names, target.regions, sharing=False)
    reactions = [CompiledReaction(world, rule, number) for number, rule in enumerate(rules)]
    state = make_state(world, target)
    index = ReactionIndex(reactions)
    possible = index.possible(state)
    occurring = [each for each in reactions if Spot(state, index).occurrences(each)]
    assert all(possible >> each.number & 1 for each in occurring)
    enabled = [(each.number, live) for each, live in Spot(state, index).enabled(index.all)]
    expected = [(each.number, Spot(state, index).live(each)) for each in reactions]
    assert enabled == [(number, live) for number, live in expected if live]


def test_of_the_instances_of_a_rule_or_a_predicate_only_those_are_asked_whose_nodes_are_there(monkeypatch):
    asked = []
    for name in ("find", "find_at"):
        search = getattr(Matcher, name)
        monkeypatch.setattr(
            Matcher, name, lambda *given, search=search, **how: asked.append(1) or search(*given, **how)
        )
    found = explore(read_system(COUNTERS), max_states=30)
    assert len(found) == 30
    assert found.labels_of(0) == ("at(0)",)
    assert len(asked) == 94  # of 18,000: 30 states, 400 rules, 200 predicates


def test_a_limit_holds_between_the_searches_for_many_rules():
    class Stop(Exception):
        pass

    def pause():
        asked.append(1)
        if len(asked) == 3:
            raise Stop

    asked = []
    text = COUNTERS.replace("Count(0).1 | Count(0).1", " | ".join(f"Count({n}).1" for n in range(9)))
    machine = Machine(read_system(text), pause)
    spot, _ = machine.start()
    with pytest.raises(Stop):
        list(machine.steps(spot))
    assert len(spot.found) == 2
