"""Orders of columns: what is asked together stands together."""

from collections import Counter

from checker.symbolic.order import ordered


def span(order, group):
    places = [order.index(column) for column in group]
    return max(places) - min(places)


def test_groups_that_are_told_apart_by_nothing_else_are_drawn_together():
    even, odd = frozenset(range(0, 12, 2)), frozenset(range(1, 12, 2))
    groups = Counter({frozenset({a, b}): 3 for part in (even, odd) for a in part for b in part if a < b})
    order = ordered(range(12), groups)
    assert sorted(order) == list(range(12))
    assert span(order, even) == span(order, odd) == 5


def test_the_order_is_never_worse_than_the_one_that_was_given():
    chain = Counter({frozenset({n, n + 1}): 1 for n in range(9)})
    assert ordered(range(10), chain) == list(range(10))


def test_columns_without_a_group_keep_their_place():
    assert ordered([3, 1, 2], Counter()) == [3, 1, 2]
