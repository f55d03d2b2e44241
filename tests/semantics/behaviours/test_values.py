"""Values: their canonical order, their size, and how they print."""

from hypothesis import given
from hypothesis import strategies as st

from semantics.behaviours.observations import Observation
from semantics.behaviours.values import LARGEST_NUMBER, Text, Truth, in_order, order_key, parts, show
from semantics.state.relations import Parent

atoms = st.one_of(
    st.integers(1 - LARGEST_NUMBER, LARGEST_NUMBER - 1),
    st.text(max_size=3),
    st.sampled_from(Truth),
    st.just(Observation.of(("u0",))),
)
values = st.recursive(
    atoms,
    lambda inner: st.lists(inner, max_size=3).map(tuple) | st.frozensets(inner, max_size=3),
    max_leaves=6,
)


@given(st.lists(st.integers(1 - LARGEST_NUMBER, LARGEST_NUMBER - 1)))
def test_numbers_are_ordered_as_numbers(numbers):
    assert sorted(numbers, key=order_key) == sorted(numbers)


@given(values, values)
def test_values_have_one_key_if_and_only_if_they_are_equal(one, other):
    assert (order_key(one) == order_key(other)) == (type(one) is type(other) and one == other)


def test_observations_that_show_alike_have_different_keys():
    assert order_key(Observation.of(("u0",))) != order_key(
        Observation.of(("u0",), relations=(Parent("u0", "base"),))
    )


def test_truth_is_no_number():
    assert Truth.TRUE != 1
    assert frozenset({Truth.TRUE, 1}) == frozenset({1, Truth.TRUE})
    assert len(in_order(frozenset({Truth.TRUE, 1}))) == 2


@given(values)
def test_parts_are_counted_as_often_as_they_occur(value):
    assert parts((value, value)) == 1 + 2 * parts(value)


def test_a_text_that_is_no_name_is_quoted():
    assert show((Text("go"), "u0", Truth.FALSE)) == '("go", u0, false)'
