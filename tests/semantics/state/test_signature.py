"""Kinds and what may contain whom."""

from hypothesis import given
from hypothesis import strategies as st

from semantics.state.signature import EntityKinds, Kind, Signature

SIGNATURE = Signature.of(
    [Kind("Sea", frozenset({"Boat", "Sea", "Whale"})), Kind("Bay", frozenset({"Boat"})), Kind("Boat")]
)
kinds = st.dictionaries(st.sampled_from("abcdefgh"), st.sampled_from(["Sea", "Bay", "Boat", "Whale"]))


@given(kinds, kinds)
def test_who_contains_whom_is_the_same_whether_an_entity_was_named_at_first_or_later(first, later):
    later = {name: kind for name, kind in later.items() if name not in first}
    sorting = EntityKinds(SIGNATURE, first)
    sorting.containers("Boat")  # from now on it is known
    named, whole = sorting.naming(later), EntityKinds(SIGNATURE, {**first, **later})
    assert named.kinds == whole.kinds
    assert all(named.containers(kind) == whole.containers(kind) for kind in SIGNATURE.kinds)


@given(kinds)
def test_containers_are_those_whose_kind_contains_another_by_name(named):
    sorting = EntityKinds(SIGNATURE, named)
    for kind in (*SIGNATURE.kinds, "Whale", "Unknown"):
        holding = [name for name, of in sorted(named.items()) if kind in SIGNATURE[of].contains]
        assert sorting.containers(kind) == tuple(holding)


def test_entities_that_contain_nothing_change_nothing_about_containers():
    sorting = EntityKinds(SIGNATURE, {"sea": "Sea"})
    assert sorting.naming({"boat": "Boat"}).containers("Boat") is sorting.containers("Boat")
