"""What live runs cost: the time of each part is without the parts inside it."""

import time

from benchmarks.parts import PARTS, Parts
from benchmarks.wire import Autopilot


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
