"""Conditions against the algebra: a pattern is looked for in the context, or the parameter, of a match."""

from dataclasses import replace

from bigraph_strategies import PLAIN, SIGNATURE, grounds
from engine_strategies import solid, solid_redexes
from hypothesis import given

from bigraphs.algebra import lean
from bigraphs.bigraph import Node, assemble
from bigraphs.decomposition import take_apart
from bigraphs.engine.contexts import ConditionCheck, without_idle
from bigraphs.engine.intern_tables import InternTables
from bigraphs.engine.occurrence_search import Matcher
from bigraphs.engine.patterns import compile_pattern
from bigraphs.engine.state_arrays import make_state
from bigraphs.matching import find_matches
from bigraphs.notation import read_big
from bigraphs.signature import Control, Signature
from bigraphs.system import Condition, Where

HOLES = Signature((*SIGNATURE.controls, Control("Hole", 0), Control("Cap", 1)))


def with_holes(context):
    """Return a ground bigraph: a node stands in each site, and one on each inner name."""
    holes = [Node("Hole", None, (), parents) for parents in context.sites]
    caps = [Node("Cap", None, (link,), (~0,)) for _, link in context.inner_links]
    return assemble(
        HOLES,
        [*context.nodes, *holes, *caps],
        regions=max(context.regions, 1),
        edges=context.edges,
        outer_names=context.outer_names,
    )


def checks(redex, target, pattern, where):
    """Yield for each match what the engine says of a condition, and the match."""
    world = InternTables(SIGNATURE, target.outer_names, target.regions, sharing=False)
    state = make_state(world, target)
    check = ConditionCheck(world, Condition(True, pattern, where))
    found = {each.nodes: each for each in Matcher(world, compile_pattern(world, redex)).find(state)}
    for match in find_matches(redex, target):
        if match.nodes in found:
            yield check.holds(state, found[match.nodes]), match


def occurs(pattern, target):
    pattern = replace(without_idle(pattern), signature=target.signature)
    return not pattern.nodes or any(True for _ in find_matches(pattern, target))


SMALL = solid_redexes(max_nodes=2)


@given(SMALL, grounds(max_nodes=7, controls=PLAIN).map(lean), SMALL)
def test_a_condition_on_the_context_asks_what_is_around_the_match(redex, target, pattern):
    for said, match in checks(redex, target, pattern, Where.CONTEXT):
        assert said == occurs(pattern, with_holes(take_apart(match).context))


@given(SMALL, grounds(max_nodes=7, controls=PLAIN).map(lean), SMALL.filter(lambda each: not each.edges))
def test_a_condition_on_the_parameter_asks_what_the_sites_hold(redex, target, pattern):
    for said, match in checks(redex, target, pattern, Where.PARAM):
        assert said == occurs(pattern, take_apart(match).parameter)


def test_an_edge_within_the_parameter_is_an_edge_of_it():
    target = read_big("A.(/e (B{e}.1 | B{e}.1)) | /e (A.B{e}.1 | B{e}.1)", SIGNATURE)
    pair = read_big("/e (B{e}.1 | B{e}.1)", SIGNATURE)
    assert sorted(said for said, _ in checks(read_big("A", SIGNATURE), target, pair, Where.PARAM)) == [
        False,
        True,
    ]


def test_what_asks_for_nothing_is_left_out_of_a_pattern():
    pattern = solid(read_big("A.1", SIGNATURE))
    idle = read_big("/e (A.1 | {e} | {x} | id) || id", SIGNATURE)
    assert without_idle(idle) == pattern
