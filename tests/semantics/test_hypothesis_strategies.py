"""The public strategies: what they promise of what they yield."""

import random
from contextlib import suppress

from hypothesis import find, given
from hypothesis import strategies as st
from scale import examples

from physical import contains
from semantics import hypothesis_strategies
from semantics.behaviours.expressions import Fault
from semantics.random_programs import random_program
from semantics.state.configuration import Configuration
from semantics.state.physical_model import Placed
from semantics.state.setting import Control, Scheduler
from semantics.successors import successors


@given(hypothesis_strategies.worlds())
def test_places_nest_or_lie_apart(world):
    places = [at.geometry for name, at in sorted(world.placements.items()) if name.startswith("place")]
    for one in places:
        for other in places:
            nested = contains(one, other) or contains(other, one)
            apart = all(not inside(one, corner) for corner in corners(other))
            assert one is other or nested or apart


def corners(geometry):
    return [hypothesis_strategies.point(*vertex) for vertex in geometry.vertices]


def inside(geometry, corner):
    return contains(geometry, corner)


@given(hypothesis_strategies.worlds())
def test_entities_that_are_there_have_placements_of_their_own(world):
    spots = [at for at in (*world.placements.values(), *world.free) if isinstance(at, Placed)]
    assert len({spot.geometry for spot in spots}) == len(spots)
    assert "uav0" in world.placements
    assert set(world.placements) <= set(world.kinds)


@given(hypothesis_strategies.structures(lagging=False))
def test_a_structure_that_does_not_lag_is_consistent(structure):
    assert structure.consistent(structure.relations())


@given(st.data())
def test_beliefs_are_forests_of_known_nodes(data):
    world = data.draw(hypothesis_strategies.worlds())
    logical = world.initial(beliefs=data.draw(hypothesis_strategies.beliefs(world))).structure.logical
    for node in logical.nodes():
        assert all(place in logical for place in logical.ancestors(node))
    assert len(logical.bigraph().nodes) == len(logical.nodes())


@given(
    hypothesis_strategies.initial_configurations(
        [Scheduler.FCFS], [Control.TIMED], monitored=True, lagging=False
    )
)
def test_a_configuration_has_the_scheduler_and_control_that_were_asked_for(c):
    assert (c.setting.scheduler, c.setting.control, c.setting.monitored) == (
        Scheduler.FCFS,
        Control.TIMED,
        True,
    )
    assert c.structure.consistent(c.structure.relations())


def test_the_rules_of_the_paper_are_all_reached_by_random_runs():
    seen: set[str] = set()

    @examples(200)
    @given(hypothesis_strategies.initial_configurations(), st.randoms(use_true_random=False))
    def run(c: Configuration, dice: random.Random) -> None:
        with suppress(Fault):
            for _ in range(12):
                allowed = [t for t in successors(c) if t.label.rule != "env" or dice.random() < 0.2]
                seen.update(t.label.rule for t in allowed)
                c = dice.choice(allowed).target if allowed else c

    run()
    assert seen >= {"fun", "req_obs", "sense", "rcv_obs", "req_ctr", "actuate", "env"}


def test_what_is_found_shrinks_to_little():
    small = find(hypothesis_strategies.worlds(), lambda world: "uav1" in world.kinds)
    assert sorted(small.kinds) == ["place0", "uav0", "uav1"]


def test_programs_are_written_from_any_source_of_choices():
    dice = random.Random(7)
    for _ in range(50):
        program, (code,) = random_program(dice.randrange, ["base", "u0"])
        assert all(number < len(program.statements) for number in code)


@examples(45)
@given(hypothesis_strategies.configurations())
def test_no_computation_fails_in_a_generated_configuration(configuration):
    successors(configuration)
