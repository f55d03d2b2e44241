"""Several processes explore together: what they find is what one finds, whatever becomes of them."""

import os
import signal
import sys
import threading
import time
from pathlib import Path

import pytest
from bigraph_strategies import grounds
from engine_strategies import solid_rules, system
from hypothesis import given
from hypothesis import strategies as st
from scale import examples

from bigraphs import workers
from bigraphs.algebra import lean
from bigraphs.errors import BigraphError
from bigraphs.examples import example_text
from bigraphs.exploration import explore
from bigraphs.notation import read_bgm, read_system, write_big
from bigraphs.workers import Workers

sys.path.insert(0, str(Path(__file__).parents[2] / "benchmarks"))
import bigraph_shapes as shapes
import uav_family

# Actions, weights, and instantaneous rules that do not agree, so that least forms are looked for.
CHANCE = """
ctrl Box = 0; atomic ctrl Red = 1; atomic ctrl Blue = 1; atomic ctrl Grey = 0; atomic ctrl Spark = 1;
big boxes = /x /y (Box.(Red{x} | Red{x} | Spark{y}) | Box.(Red{y} | Red{y}) | Box.Grey | Box.Grey);
action paint
  react blue = Red{x} -[2]-> Blue{x} | Spark{x};
  react red = Blue{x} -[1]-> Red{x};
end
action carry[3]
  react carry = Box.(Red{x} | id) | Box -[1]-> Box | Box.(Red{x} | id) @ [1, 0];
end
react fade = Spark{x} | Grey -[inf]-> {x} | Grey;
react leap = Box.(Spark{x} | id) | Box -[inf]-> Box | Box.(Spark{x} | id) @ [1, 0];
begin nbrs init boxes; rules = [ (fade), {blue, red, carry} ]; preds = { both }; end
"""
GROWING = "ctrl A = 0; big start = A.1; react grow = A --> A.(A | B); react more = B --> A.1;" + (
    "atomic ctrl B = 0; begin brs init start; rules = [ {grow, more} ]; end"
)
WALK = """
ctrl Room = 0; atomic ctrl Ball = 0;
big six = Room.(Ball | Ball | Ball | Ball | Ball | Ball) | Room | Room | Room;
react move = Room.(Ball | id) | Room.id --> Room.id | Room.(Ball | id);
begin brs init six; rules = [ {move} ]; end
"""


@pytest.fixture(autouse=True)
def _soon(monkeypatch):
    """Start workers at once, for any work."""
    monkeypatch.setattr(workers, "BEGIN", 0.0)
    monkeypatch.setattr(workers, "LEAST", 0.0)


def told(found):
    """Return all that a transition system says."""
    states = [write_big(found.state(number)) for number in range(len(found))]
    return states, list(found.transitions()), list(found.found_from), list(found.holding), found.occurrences


def same_for_each_number(one, **limits):
    alone = explore(one, **limits)
    for threads in (2, 3, 4):
        together = explore(one, threads=threads, **limits)
        assert (together.reason, list(together.keys)) == (alone.reason, list(alone.keys))
        assert told(together) == told(alone)
    return alone


SYSTEMS = {
    "plain, many subtrees": shapes.nest(3, 12).text,
    "plain, many rules": shapes.batteries(3, 8).text,
    "priorities": shapes.agenda(5, 20).text,
    "edges": shapes.calls(5).text,
    "sharing": shapes.motes(5).text,
    "names": uav_family.text(uav_family.Case("row", 2, 4, distinct=True, open=True)),
    "closed links": uav_family.text(uav_family.Case("3x3", 2, 9, distinct=False, open=False)),
    "predicates": example_text("sensor_network"),
}


@pytest.mark.parametrize("name", SYSTEMS)
def test_any_number_of_processes_finds_the_same(name):
    found = same_for_each_number(read_system(SYSTEMS[name]))
    assert found.complete
    assert len(found) > 20


@examples(8)
@given(
    st.lists(solid_rules(sharing=True), min_size=1, max_size=3),
    grounds(max_nodes=5, controls=("A", "B", "Z"), sharing=True),
)
def test_so_it_is_for_generated_systems(rules, initial):
    from dataclasses import replace

    rules = [replace(rule, name=f"r{number}") for number, rule in enumerate(rules)]
    one = system(lean(initial), *rules)
    try:
        alone = explore(one, max_states=60)
    except BigraphError as error:
        with pytest.raises(BigraphError, match="^" + error.message.split("'")[0]):
            explore(one, max_states=60, threads=2)
        return
    together = explore(one, max_states=60, threads=2)
    assert told(together) == told(alone)
