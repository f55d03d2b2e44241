"""Several processes explore together: what they find is what one finds, whatever becomes of them."""

import multiprocessing
import os
import signal
from dataclasses import replace

import pytest
from bigraph_strategies import grounds
from engine_strategies import solid_rules, system
from explored_systems import GROWING, SYSTEMS, WALK, told
from hypothesis import given
from hypothesis import strategies as st
from scale import crossed, examples

from bigraphs import workers
from bigraphs.algebra import lean
from bigraphs.errors import BigraphError
from bigraphs.exploration import explore
from bigraphs.notation import read_system
from bigraphs.workers import Workers


@pytest.fixture(autouse=True)
def _soon(monkeypatch):
    """Start workers at once, for any work."""
    monkeypatch.setattr(workers, "BEGIN", 0.0)
    monkeypatch.setattr(workers, "LEAST", 0.0)


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
        seen.extend(multiprocessing.active_children())
        if seen and progress.states > 30:
            raise KeyboardInterrupt

    found = explore(read_system(GROWING), threads=3, watch=interrupt, max_states=10_000)
    assert found.reason == "it was interrupted"
    assert seen
    assert not multiprocessing.active_children()
