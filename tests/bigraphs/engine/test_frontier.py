"""The queue of states that wait: packed ones come back as they were."""

from bigraphs.engine.frontier import BLOCK, Frontier
from bigraphs.engine.machine import Machine
from bigraphs.engine.occurrences import Spot
from bigraphs.examples import example_text
from bigraphs.exploration import explore
from bigraphs.notation import read_system

WALK = """
ctrl Room = 0; atomic ctrl Ball = 0;
big two = Room.(Ball | Ball) | Room.Ball;
react move = Room.(Ball | id) | Room.id --> Room.id | Room.(Ball | id);
begin brs init two; rules = [ {move} ]; end
"""


def spots(text):
    """Return a machine and some spots, those after the first with occurrences to carry over."""
    machine = Machine(read_system(text))
    first, _ = machine.start()
    return machine, [first, *(step.target for step in machine.steps(first))]


def found(machine, spot):
    return spot.state.key(), [(reaction.number, live) for reaction, live in spot.enabled(machine.index.all)]


def test_a_spot_is_remade_from_its_parts():
    for text in (WALK, example_text("mobile_ambients"), example_text("sensor_network")):
        machine, some = spots(text)
        for spot in some:
            assert found(machine, some[0].remade(spot.parts())) == found(machine, spot)


def test_what_waits_comes_out_in_order_packed_or_not():
    machine, (first, *_) = spots(WALK)
    waiting, lengths = Frontier(first), []
    for number in range(3 * BLOCK + 7):
        spot = Spot(first.state, machine.index)
        spot.lost = number
        waiting.append(spot)
    assert len(waiting) == 3 * BLOCK + 7
    taken = []
    while waiting:
        taken.append(waiting.popleft().lost)
        lengths.append(len(waiting))
    assert taken == list(range(3 * BLOCK + 7))
    assert lengths == list(range(3 * BLOCK + 6, -1, -1))


def test_packing_changes_no_transition_system(monkeypatch):
    for name in ("uav_patrol", "sensor_network", "actors"):
        system = read_system(example_text(name))
        plain = explore(system)
        monkeypatch.setattr("bigraphs.engine.frontier.BLOCK", 1)
        packed = explore(system)
        monkeypatch.undo()
        assert (plain.keys, plain.targets, plain.kinds) == (packed.keys, packed.targets, packed.kinds)
