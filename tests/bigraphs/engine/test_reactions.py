"""The engine's rewriting against the algebra's."""

import pytest
from bigraph_strategies import PLAIN, SIGNATURE, grounds
from engine_strategies import solid_rules
from hypothesis import given
from hypothesis import strategies as st

from bigraphs.algebra import atom, ion, nest
from bigraphs.canonical_form import canonical
from bigraphs.engine.contexts import PlaceContexts
from bigraphs.engine.decoding import from_key, to_bigraph
from bigraphs.engine.intern_tables import InternTables
from bigraphs.engine.occurrences import Spot
from bigraphs.engine.reactions import CompiledReaction
from bigraphs.engine.rule_index import ReactionIndex
from bigraphs.engine.state_arrays import bits, make_state
from bigraphs.errors import BigraphError
from bigraphs.matching import find_matches
from bigraphs.rewriting import rewrite
from bigraphs.system import Rule


def results(rule, target):
    """Return what the engine makes of a target, canonical."""
    world = InternTables(SIGNATURE, target.outer_names, target.regions, sharing=False)
    reaction, state = CompiledReaction(world, rule, 0), make_state(world, target)
    around = PlaceContexts(state, passive=True)
    return {
        canonical(to_bigraph(reaction.apply(state, found)[0].finish()))
        for found in reaction.matcher.find(state)
        if around.admits(reaction.pattern, found)
    }


@given(solid_rules(), grounds(max_nodes=7, controls=PLAIN))
def test_rules_make_what_the_algebra_makes_of_every_match(rule, target):
    reaction = rule.reaction()
    expected = {canonical(rewrite(reaction, match)) for match in find_matches(rule.redex, target)}
    assert results(rule, target) == expected


def or_orphan(code, made):
    """Return what is made, canonical; a word where that puts a node into a region without a place."""
    try:
        return canonical(made())
    except BigraphError as error:
        if error.code != code:
            raise
        return "an orphan"


@given(
    solid_rules(sharing=True, max_nodes=2, copies=False), grounds(max_nodes=5, controls=PLAIN, sharing=True)
)
def test_rules_on_shared_places_make_something_that_the_algebra_makes_too(rule, target):
    world = InternTables(SIGNATURE, target.outer_names, target.regions, sharing=True)
    reaction, state = CompiledReaction(world, rule, 0), make_state(world, target)
    rule, algebra = reaction.rule, {}  # in canonical form, as the numbers of its nodes in occurrences
    for match in find_matches(rule.redex, target):
        links = dict(match.links)
        found = (match.nodes, tuple(links[name] for name in rule.redex.outer_names))
        made = or_orphan("parent", lambda match=match: rewrite(rule.reaction(), match))
        algebra.setdefault(found, set()).add(made)
    names = [*target.outer_names, *range(target.edges)]
    for found in Spot(state, ReactionIndex([reaction])).live(reaction):
        made = or_orphan("orphan", lambda found=found: to_bigraph(reaction.apply(state, found)[0].finish()))
        links = tuple(names[link] for link in found.links[: len(rule.redex.outer_names)])
        assert made in algebra[found.nodes, links]


@given(st.lists(solid_rules(), min_size=1, max_size=3), grounds(max_nodes=6, controls=PLAIN), st.data())
def test_occurrences_carried_along_a_run_are_those_found_afresh(rules, target, data):
    world = InternTables(SIGNATURE, target.outer_names, target.regions, sharing=False)
    reactions = [CompiledReaction(world, rule, number) for number, rule in enumerate(rules)]
    index = ReactionIndex(reactions)
    spot = Spot(make_state(world, target), index)
    for _ in range(4):
        fresh = Spot(spot.state, index)
        asked = data.draw(st.sets(st.sampled_from(reactions))) if len(reactions) > 1 else reactions
        for reaction in reactions if spot.known == 0 else asked:
            assert set(spot.occurrences(reaction)) == set(fresh.occurrences(reaction))
            assert len(spot.occurrences(reaction)) == len(fresh.occurrences(reaction))
        live = spot.enabled(data.draw(st.integers(0, index.all)) if spot.known else index.all)
        enabled = [(reaction, found) for reaction, occurrences in live for found in occurrences]
        if not enabled or len(spot.state.labels) > 20:
            return
        reaction, found = data.draw(st.sampled_from(enabled))
        spot = spot.after(reaction.apply(spot.state, found)[0])


@given(solid_rules(), grounds(max_nodes=7, controls=PLAIN))
def test_a_rewritten_state_is_the_one_that_its_key_tells(rule, target):
    world = InternTables(SIGNATURE, target.outer_names, target.regions, sharing=False)
    reaction, state = CompiledReaction(world, rule, 0), make_state(world, target)
    for found in reaction.matcher.find(state):
        made = reaction.apply(state, found)[0].finish()
        again = from_key(world, made.key())
        assert again.key() == made.key()
        assert canonical(to_bigraph(again)) == canonical(to_bigraph(made))
        assert_consistent(made)


def assert_consistent(state):
    """Check what a state says twice."""
    for slot in bits(state.occupied()):
        assert all(state.kids[place] >> slot & 1 for place in state.parents[slot])
        assert all(state.points[link] >> slot & 1 for link in state.ports[slot])
        assert state.by_control[state.world.control_of[state.labels[slot]]] >> slot & 1
    for place, inside in enumerate(state.kids[: len(state.labels)]):
        assert all(place in state.parents[slot] for slot in bits(inside))
    for link, on in enumerate(state.points):
        assert all(link in state.ports[slot] for slot in bits(on))


def test_a_named_node_is_not_copied():
    room = ion(SIGNATURE, "A")
    rule = Rule("twice", room, room | room, (0, 0))
    with pytest.raises(BigraphError, match="the rule would copy one:A"):
        results(rule, nest(room, atom(SIGNATURE, "A", name="one")))
