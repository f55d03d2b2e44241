"""Several processes explore together: what they find is what one finds, whatever becomes of them."""

import multiprocessing
import os
import signal
import sys
from dataclasses import replace
from pathlib import Path

import pytest
from bigraph_strategies import grounds
from engine_strategies import solid_rules, system
from hypothesis import given
from hypothesis import strategies as st
from scale import crossed, examples

from bigraphs import workers
from bigraphs.algebra import lean
from bigraphs.errors import BigraphError
from bigraphs.examples import example_text
from bigraphs.exploration import explore
from bigraphs.notation import read_system, write_big
from bigraphs.workers import Workers

sys.path.insert(0, str(Path(__file__).parents[2] / "benchmarks"))
import bigraph_shapes as shapes
import uav_family

# Actions, weights, edges, and instantaneous rules that do not agree, so that least forms are looked for.
CHANCE = """
ctrl Box = 0; atomic ctrl Red = 1; atomic ctrl Blue = 1; atomic ctrl Grey = 0; atomic ctrl Spark = 1;
big boxes = /x /y (Box.(Red{x} | Red{x} | Spark{y} | Grey) | Box.(Red{y} | Grey) | Box.1);
big three = Spark{x} | Spark{x} | id;
react blue = Red{x} -[2]-> Blue{x} | Spark{x};
react red = Blue{x} -[1]-> Red{x};
react carry = Box.(Red{x} | id) | Box.id -[1]-> Box.id | Box.(Red{x} | id) @ [1, 0];
react fade = Spark{x} | Spark{x} | Grey -[1]-> {x} | Grey | Spark{x};
react leap = Box.(Spark{x} | Grey | id) | Box.id -[1]-> Box.(Grey | id) | Box.(Spark{x} | id);
begin pbrs init boxes; rules = [ (fade), {blue, red, carry}, {leap} ]; end
"""
GROWING = """
ctrl A = 0; atomic ctrl B = 0;
big one = A.B;
react grow = A.id --> A.(B | id);
react nest = A.(B | id) --> A.(A.B | id);
begin brs init one; rules = [ {grow, nest} ]; end
"""
WALK = """
ctrl Room = 1; atomic ctrl Ball = 0;
big six = Room{a}.(Ball | Ball | Ball | Ball | Ball | Ball) | Room{b}.1 | Room{c}.1 | Room{d}.1;
react move = Room{x}.(Ball | id) | Room{y}.id --> Room{x}.id | Room{y}.(Ball | id);
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


MODELS = {
    "many subtrees": shapes.nest(3, 6),
    "many rules": shapes.batteries(3, 5),
    "priorities": shapes.agenda(4, 6),
    "edges": shapes.calls(5),
    "sharing": shapes.motes(5),
}
CASES = {
    "names": uav_family.Case("row", 2, 4, distinct=True, open=True),
    "closed links": uav_family.Case("2x2", 3, 4, distinct=False, open=False),
}
SYSTEMS = {
    **{name: (model.text, model.states) for name, model in MODELS.items()},
    **{name: (uav_family.text(case), uav_family.counts(case)[0]) for name, case in CASES.items()},
    "predicates": (example_text("sensor_network"), 24),
    "weights": (CHANCE, 12),
}


@crossed(list(SYSTEMS), {"2 processes": 2, "3 processes": 3, "4 processes": 4})
def test_any_number_of_processes_finds_the_same(name, variation):
    text, states = SYSTEMS[name]
    one = read_system(text)
    alone = explore(one)
    assert (len(alone), alone.complete) == (states, True)
    together = explore(one, threads=variation)
    assert list(together.keys) == list(alone.keys)
    assert told(together) == told(alone)


@examples(8)
@given(
    st.lists(solid_rules(sharing=True), min_size=1, max_size=3),
    grounds(max_nodes=5, controls=("A", "B", "Z"), sharing=True),
)
def test_so_it_is_for_generated_systems(rules, initial):
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


# --- limits, and workers that fail ----------------------------------------------------------------------------


@pytest.mark.parametrize("most", [2, 20, 21])
def test_a_limit_of_states_cuts_where_one_process_would(most):
    one = read_system(WALK)  # of 84 states
    alone = explore(one, max_states=most)
    assert (len(alone), alone.complete) == (most, False)
    together = explore(one, max_states=most, threads=3)
    assert together.reason == alone.reason
    assert told(together) == told(alone)


def started_and(then):
    """Return a way to start a worker after which something else is done with it."""
    start = Workers._started

    def started(self, pieces):
        worker = start(self, pieces)
        then(worker)
        return worker

    return started


def kill(worker):
    os.kill(worker.process.pid, signal.SIGKILL)


def kill_after_an_answer(worker):
    worker.answers.poll(None)
    kill(worker)


@pytest.mark.parametrize("killing", [kill, kill_after_an_answer])
def test_what_a_killed_worker_has_not_done_is_done_without_it(monkeypatch, killing):
    monkeypatch.setattr(Workers, "_started", started_and(killing))
    one = read_system(WALK)
    assert told(explore(one, threads=3)) == told(explore(one))


def test_without_room_for_another_process_one_does_it_all(monkeypatch):
    def refuse(_):
        raise OSError("no")

    monkeypatch.setattr(Workers, "_started", started_and(refuse))
    one = read_system(WALK)
    assert told(explore(one, threads=4)) == told(explore(one))


def test_an_error_is_the_one_that_a_process_alone_meets():
    text = """
    ctrl Room = 0; atomic ctrl Ball = 0; atomic ctrl Pair = 0; atomic ctrl Loop = 0;
    big rooms = Room.(Ball | Ball | Ball | Ball) | Room.(Ball | Ball | Ball | Ball);
    react take = Ball | Ball --> Pair;
    react turn = Loop --> Loop;
    react loop = Pair | Pair --> Loop;
    begin brs init rooms; rules = [ {take}, (turn), {loop} ]; end
    """
    for threads in (1, 3):
        with pytest.raises(BigraphError, match="the instantaneous rules turn never come to rest"):
            explore(read_system(text), threads=threads)


def test_an_interruption_ends_the_workers(monkeypatch):
    monkeypatch.setattr("bigraphs.exploration.LOOK_EVERY", 0.0)
    seen = []

    def interrupt(progress):
        if progress.states > 30:
            seen.extend(multiprocessing.active_children())
            raise KeyboardInterrupt

    found = explore(read_system(GROWING), threads=3, watch=interrupt, max_states=10_000)
    assert found.reason == "it was interrupted"
    assert seen
    assert not multiprocessing.active_children()
