from pathlib import Path

import pytest
from scripts import script

from checker import Engine, Limits, Reduction, explore
from checker.reduction import Reduced
from specs import parse_bytes
from specs.elaboration import elaborate

wide = script("wide")


def start(*size, text=wide.mission_text):
    source, tree = parse_bytes("fleet.mission", text(*size).encode())
    return elaborate(tree, source, Path()).initial


def test_both_engines_visit_the_same_of_a_fleet():
    initial = start(2, 2, 2)
    found = [explore(initial, engine=engine) for engine in (Engine.FAST, Engine.REFERENCE)]
    assert [each.complete for each in found] == [True, True]
    assert [(each.size, each.transitions) for each in found] == [(2_377, 5_930)] * 2


def test_each_vehicle_more_costs_as_many_runs_of_rules_as_the_one_before():
    limits = Limits(configurations=2_000)
    few, many = (explore(start(n, 5, 8), limits=limits, engine=Engine.FAST).rule_runs for n in (5, 20))
    assert many < 5 * few


@pytest.mark.long
def test_more_than_sixty_four_actors_are_reduced_as_the_reference_reduces_them():
    initial, limits = start(35, 5, 7), Limits(configurations=80)
    reduced = Reduced(initial, [Reduction.POR])
    found = [
        explore(initial, limits=limits, engine=each, reduce=reduced)
        for each in (Engine.FAST, Engine.REFERENCE)
    ]
    assert list(found[0].configurations) == list(found[1].configurations)
    assert found[0].transitions == found[1].transitions < found[0].allowed == found[1].allowed
    assert max(len(reduced.ample.actors.of(c)) for c in found[0].configurations) > 64


@pytest.mark.parametrize("uavs", [3, 6])
@pytest.mark.parametrize("engine", [Engine.FAST, Engine.REFERENCE])
def test_uavs_that_have_nothing_to_do_with_one_another_go_round_one_after_another(uavs, engine):
    initial = start(uavs, text=wide.text_of_rounds)
    found = explore(initial, engine=engine, reduce=Reduced(initial, [Reduction.POR]))
    assert (found.size, found.transitions, found.complete) == (19 * uavs + 1, 20 * uavs, True)


@pytest.mark.long
def test_fifty_of_them_are_decided():
    initial = start(50, text=wide.text_of_rounds)
    found = explore(initial, engine=Engine.FAST, reduce=Reduced(initial, [Reduction.POR]))
    assert (found.size, found.transitions, found.complete) == (951, 1_000, True)
