"""What live runs cost: strangers come and go as counted, and each part's time is without the parts inside it."""

import time

from benchmarks.parts import PARTS, Parts
from benchmarks.strangers import EVENTS, flown
from benchmarks.wire import Autopilot


def test_each_stranger_comes_moves_twice_and_goes(tmp_path):
    run = flown(30, tmp_path)
    assert [run.counts[event] for event in EVENTS] == [30, 60, 30]
    assert run.known == len(run.plan.first.setting.kinds) + 30


def test_the_time_of_a_part_is_without_the_parts_inside_it():
    class Run:
        def inner(self):
            until = time.thread_time() + 0.02
            while time.thread_time() < until:
                pass
            yield "found"

        def outer(self):
            return self.inner()

    parts = Parts()
    Run.inner = parts._timed("inner", Run, "inner")
    Run.outer = parts._timed("outer", Run, "outer")
    assert Run().outer() == ["found"]
    assert parts.spent["inner"][0] > 0.019
    assert parts.spent["outer"][0] < 0.01


def test_what_was_replaced_is_put_back():
    before = [getattr(owner, name) for _, owner, name in PARTS]
    with Parts().watching():
        assert Autopilot._receive not in before
    assert [getattr(owner, name) for _, owner, name in PARTS] == before
