import time

from scripts import script

from checker.engines.fast.model.learner import Learner

ours = script("ours")


def test_what_is_learned_on_the_way_is_not_counted_twice(monkeypatch):
    def learn(learner, tree, source):
        time.sleep(0.02)
        if tree:
            learner.learn(tree - 1, source)

    monkeypatch.setattr(Learner, "learn", learn)
    seconds = ours._timed_learning()
    began = time.perf_counter()
    Learner.learn(Learner.__new__(Learner), 3, None)
    assert len(seconds) == 1
    assert sum(seconds) <= time.perf_counter() - began
