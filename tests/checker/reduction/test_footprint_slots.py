"""Footprints over slots, beside sets of accesses: a slot is read, written, or added to."""

from itertools import product

import pytest

from checker.reduction.footprint_slots import SlotFootprint, Slots, joined

ACCESSES = [frozenset(each) for each in ("", "r", "w", "m", "rw", "rm", "wm", "rwm")]
COMMUTING = {("r", "r"), ("m", "m")}
"""Both read, or both add."""

for_each_pair = pytest.mark.parametrize(("one", "other"), list(product(ACCESSES, repeat=2)))


def of(*accesses):
    """Return the footprint with some accesses to each slot, by the slots' numbers."""
    bits = ((sum(1 << n for n, each in enumerate(accesses) if kind in each)) for kind in "rwm")
    return SlotFootprint(*bits)


@for_each_pair
def test_one_disturbs_another_where_accesses_to_one_slot_do_not_commute(one, other):
    expected = not COMMUTING.issuperset(product(one, other))
    for none in (of(), of("", "", "rwm")):
        assert (of(one) | none).disturbs(of(other)) is expected
        assert of("", one).disturbs(of("", other) | none) is expected
    assert not of(one).disturbs(of("", other))


@for_each_pair
def test_who_may_write_may_add_and_read_too(one, other):
    may = other | ({"m"} if "w" in other else set()) | ({"r"} if other & {"w", "m"} else set())
    assert of(one).beyond(of(other)) == (0 if one <= may else 1)
    assert of("", one).beyond(of(other)) == (2 if one else 0)


@for_each_pair
def test_together_two_access_what_each_accesses(one, other):
    assert of(one) | of(other) == joined([of(one), of(other)]) == of(one | other)
    assert of(one, other).changes == of(*("w" if each & {"w", "m"} else "" for each in (one, other))).writes


def test_slots_have_numbers_from_their_first_use_on():
    slots = Slots()
    one, other = slots.footprint([("b",)], [("c", "d")]), slots.of("c", ["d", "e"])
    assert (one, other) == (of("r", "w"), 6)
    assert slots.named(other) == (("c", "d"), ("c", "e"))
    assert [slots.has(other, each) for each in (("b",), ("c", "d"), ("c", "f"))] == [False, True, False]
    assert slots.has(-1, ("new",))
