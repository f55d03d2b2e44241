"""Difference bound matrices against the ages that they stand for, one by one."""

from itertools import product

import numpy as np
from hypothesis import given
from hypothesis import strategies as st
from scale import examples

from checker.engines.zones.difference_bounds import FREE, close, end, extrapolate, restrict
from checker.engines.zones.earliest_dates import before_edge, holds, least_delay, without
from checker.engines.zones.timed_automaton import Constraint, Edge

MOST = 3
SOME = examples(120, deadline=None)
SHOWN = np.array([(0, *ages) for ages in product(range(4 * MOST), repeat=2)])
APART = SHOWN[:, :, None] - SHOWN[:, None, :]
"""The differences of all ages of two clocks, as far as they are looked at here."""


@st.composite
def zones(draw):
    """Yield matrices of two clocks, with some ages in them: each bound is as wide as these need it, or wider."""
    shown = np.array([0, draw(st.integers(0, MOST)), draw(st.integers(0, MOST))], np.int32)
    zone = shown[:, None] - shown[None, :]
    for i, j in product(range(3), repeat=2):
        if i != j:
            more = draw(st.integers(0, MOST))
            zone[i, j] = min(zone[i, j] + more, 0 if i == 0 else FREE)
            if i and draw(st.booleans()):
                zone[i, j] = FREE
    assert close(zone, 3)
    return zone


def members(zone):
    inside = ((zone >= APART) | (zone >= FREE)).all(axis=(1, 2))
    return {tuple(ages) for ages in SHOWN[inside, 1:].tolist()}


def fails(zone, i, j, bound):
    """Tell for ages whether the difference of two clocks is larger than a bound."""
    return {ages for ages in members(zone) if (0, *ages)[i] - (0, *ages)[j] > bound}


CLOCKS = st.sampled_from([(i, j) for i, j in product(range(3), repeat=2) if i != j])


@SOME
@given(zones(), CLOCKS, st.integers(-MOST, MOST))
def test_a_zone_is_restricted_to_the_ages_within_a_bound(zone, clocks, bound):
    before, rest = members(zone), zone.copy()
    left = before - fails(zone, *clocks, bound)
    if restrict(rest, 3, *clocks, bound):
        assert members(rest) == left
        closed = rest.copy()
        assert close(closed, 3)
        assert np.array_equal(closed, rest)
    else:
        assert not left


@SOME
@given(zones(), st.integers(0, MOST))
def test_time_passes_until_a_clock_comes_to_its_bound(zone, bound):
    most = max(bound, -int(zone[0, 1]))
    assert restrict(zone, 3, 1, 0, most)
    before = members(zone)
    zone[1:, 0] = FREE
    end(zone, 3, *np.array([[1], [most]], np.int32))
    later = {(x + d, y + d) for x, y in before for d in range(2 * MOST) if x + d <= most}
    assert {ages for ages in members(zone) if max(ages) <= MOST} == {
        each for each in later if max(each) <= MOST
    }


@SOME
@given(zones(), st.tuples(*[st.integers(-1, MOST)] * 2), st.tuples(*[st.integers(-1, MOST)] * 2))
def test_what_extrapolation_adds_passes_no_test_that_the_rest_does_not_pass(zone, lower, upper):
    wider = zone.copy()
    extrapolate(wider, 3, np.array((-1, *lower), np.int32), np.array((-1, *upper), np.int32))
    assert (wider >= zone).all()
    shown = members(zone)
    for ages in filter(lambda each: max(each) <= 2 * MOST, members(wider)):
        assert any(
            all(
                x == y or low < x < y or high < y < x
                for x, y, low, high in zip(other, ages, lower, upper, strict=True)
            )
            for other in shown
        )


@SOME
@given(zones(), zones())
def test_what_is_left_without_a_zone_is_the_rest(zone, away):
    left = [members(each) for each in without([zone], away)]
    assert set().union(*left) == members(zone) - members(away)


@SOME
@given(zones(), st.tuples(st.integers(0, MOST), st.integers(0, MOST)))
def test_the_least_delay_is_the_first_at_which_ages_are_in_a_zone(zone, ages):
    delays = [d for d in range(3 * MOST) if holds(zone, (ages[0] + d, ages[1] + d))]
    assert least_delay(zone, ages) == min(delays, default=None)


@SOME
@given(zones(), st.tuples(st.integers(0, 2), st.integers(0, 2)), st.integers(0, MOST))
def test_ages_before_an_edge_are_those_that_it_leads_from(zone, sources, least):
    edge = Edge(0, (Constraint(1, least),), 0, sources)
    before = before_edge(edge, 2, zone)
    leading = {
        ages
        for ages in product(range(4 * MOST), repeat=2)
        if ages[0] >= least and holds(zone, tuple((0, *ages)[source] for source in sources))
    }
    assert (set() if before is None else members(before)) == leading
