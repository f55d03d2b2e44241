from dataclasses import replace
from itertools import islice

import pytest
from bigraph_strategies import PLAIN, SIGNATURE, grounds, redexes, shuffled
from hypothesis import given
from hypothesis import strategies as st
from naive_matching import naive_matches

from bigraphs.algebra import atom, close, ion, merge, nest, placing, substitution
from bigraphs.bigraph import find
from bigraphs.decomposition import recompose, take_apart
from bigraphs.errors import BigraphError
from bigraphs.matching import find_matches
from bigraphs.relational_bigraphs import from_relations

SLOT, ONE = merge(1), merge(0)


def node(control, *links, inside=SLOT, name=None):
    return nest(ion(SIGNATURE, control, links, name), inside)


def count(redex, target, **options):
    return len(list(find_matches(redex, target, **options)))


@st.composite
def redex_and_target(draw, *, sharing=False, size=5, redex_size=3):
    """Draw a redex and a target that holds it, often."""
    redex = draw(redexes(max_nodes=redex_size, sharing=sharing))
    if draw(st.booleans()):
        return redex, draw(grounds(max_nodes=size, sharing=sharing, named=True, controls=(*PLAIN, "P")))
    parts = [draw(grounds(max_nodes=2, names=("x",), controls=PLAIN)) for _ in redex.sites]
    filling = ONE if not parts else parts[0]
    for part in parts[1:]:
        filling = filling // part
    flat = [draw(grounds(max_nodes=1, names=("x",), controls=("A", "P")))]
    width = filling.regions if parts else 0
    tops = [{draw(st.integers(0, max(0, len(redex.sites) - 1)))} for _ in range(width)]
    inner = (placing(tops, len(redex.sites)) // substitution("x", ["x"])) if parts else None
    whole = (
        redex
        if inner is None
        else (redex // substitution("x", ["x"])) @ inner @ (filling // substitution("x", []))
    )
    found = whole | flat[0]
    closing = [name for name in found.outer_names if draw(st.booleans())]
    return redex, named(close(found, *closing)) if len(found.nodes) <= size else (named(flat[0]))


def named(bigraph):
    return replace(
        bigraph, nodes=tuple(replace(node, name=f"n{number}") for number, node in enumerate(bigraph.nodes))
    )


@given(redex_and_target())
def test_matches_are_those_of_the_naive_enumerator(pair):
    redex, target = pair
    found = list(find_matches(redex, target))
    assert len(found) == len(set(found))
    assert set(found) == naive_matches(redex, target)


@given(redex_and_target(sharing=True, size=4, redex_size=2))
def test_matches_in_shared_places_are_those_of_the_naive_enumerator(pair):
    redex, target = pair
    found = list(find_matches(redex, target))
    assert len(found) == len(set(found))
    assert set(found) == naive_matches(redex, target, sharing=True)


@given(redex_and_target(size=6, sharing=True))
def test_context_redex_and_parameter_make_the_target_again(pair):
    redex, target = pair
    for match in islice(find_matches(redex, target), 100):
        assert recompose(take_apart(match)) == target


@given(redex_and_target(size=6).flatmap(lambda pair: st.tuples(st.just(pair), shuffled(pair[0]))))
def test_the_number_of_matches_does_not_depend_on_the_order_of_nodes(given_):
    (redex, target), other = given_
    assert count(redex, target) == count(other, target)


def test_a_link_constant_matches_its_namesake_only():
    target = atom(SIGNATURE, "B", ["x"]) | atom(SIGNATURE, "B", ["y"])
    assert count(atom(SIGNATURE, "B", ["x"]), target) == 2
    assert count(atom(SIGNATURE, "B", ["x"]), target, link_constants=frozenset("x")) == 1


def test_a_named_node_matches_its_namesake_and_a_variable_any():
    target = from_relations({"a": "K", "b": "K"}, {}, {})
    redex = from_relations({"a": "K"}, {}, {})
    assert [match.nodes for match in find_matches(redex, target)] == [(find(target, "a"),)]
    assert count(redex, target, node_variables=frozenset("a")) == 2


def test_a_region_may_lie_nowhere_if_its_nodes_are_in_nodes_of_the_redex_too():
    holder = ion(SIGNATURE, "A") // merge(1)
    redex = holder @ placing([{0, 1}], 2) @ node("A", inside=ONE)
    target = named(node("A", inside=node("A", inside=ONE)))
    (match,) = find_matches(redex, target)
    assert match.regions == ((~0,), ())
    assert recompose(take_apart(match)) == target


@pytest.mark.parametrize(
    ("redex", "target", "message"),
    [
        (merge(1), ONE, "region 0 of the redex has no node, so it would match anywhere"),
        (atom(SIGNATURE, "A"), merge(1), "rules apply to ground bigraphs, this one has <1, {}>"),
        (atom(SIGNATURE, "A") // substitution("x", ["x"]), ONE, "a redex with inner names cannot be matched"),
    ],
)
def test_what_cannot_be_matched_is_refused(redex, target, message):
    with pytest.raises(BigraphError) as found:
        count(redex, target)
    assert found.value.message == message
