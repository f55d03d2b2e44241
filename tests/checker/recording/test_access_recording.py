"""What is noted of a rule's reads, and what is not."""

from checker.engines.fast.model.columns import packing
from checker.engines.fast.model.decision_leaves import PAIR, STEP, WRITES, WRITES_END
from checker.engines.fast.model.decision_trees import UNKNOWN
from checker.engines.fast.model.learner import CodedSource, Learner, TransitionGroup
from checker.recording.access_recording import CellRecorder, ColumnQuestion, Edited
from semantics.behaviours.observations import All, Observation
from semantics.behaviours.program import Program
from semantics.state.cell_values import AGENTS, QUEUE, Row
from semantics.state.configuration import Label, Transition
from semantics.state.eta import appended, first_of, without
from semantics.state.requests import OBS, SND
from semantics.state.setting import Setting
from semantics.state.signature import Signature

A, B = OBS("a", All()), OBS("b", All())
SAID = SND("b", "a", (Observation.of(),))


class Source:
    def __init__(self, queue):
        self.queue = queue

    def skeleton(self, cell):
        assert cell == QUEUE
        return self.queue

    def fact(self, cell, number, name):
        raise AssertionError((cell, number, name))


def recorder(*queue):
    return CellRecorder(Source(queue), Row.of({}), lambda _: True, frozenset({"uav0"}))


def values(found):
    """Return what was read whole."""
    return [ask for ask in found.scopes[0].asked if ask.question is None]


def test_the_answer_to_a_question_is_all_that_is_noted():
    found = recorder(B, A)
    assert found.ask(QUEUE, first_of, "a") == ((1, A),)
    assert found.scopes[0].asked == {ColumnQuestion(QUEUE, None, first_of, ("a",)): ((1, A),)}


def test_what_is_edited_is_not_read():
    found = recorder(B, A)
    after = found.with_({QUEUE: found.edited(QUEUE, without, 1)})
    assert after.changes == {QUEUE: Edited(QUEUE, without, (1,))}
    assert after == found.with_({QUEUE: found.edited(QUEUE, without, 1)})
    assert values(found) == []


def test_who_looks_at_an_edit_reads_what_was_there():
    found = recorder(B, A)
    after = found.with_({QUEUE: found.edited(QUEUE, without, 1)})
    assert after.read(QUEUE) == (B,)
    assert after.ask(QUEUE, first_of, "b") == ((0, B),)
    assert after.edited(QUEUE, appended, A) == (B, A)
    assert after != found.with_({QUEUE: found.edited(QUEUE, without, 0)})
    assert values(found) == [ColumnQuestion(QUEUE)]


def test_where_observations_stand_an_edit_reads():
    found = recorder(B)
    assert found.edited(QUEUE, appended, SAID) == (B, SAID)
    assert values(found) == [ColumnQuestion(QUEUE)]


def test_what_is_written_unread_over_what_was_always_there_is_learned_again_when_that_varies():
    """Two agents write a cell that nobody reads: one what it holds at first, then the other something else."""
    still = Row.of({("shown",): "first", AGENTS: ("a", "b")})
    learner = Learner(Setting(Signature(), {}, Program()), still, 10)

    def writes(value):
        return lambda c, a: [Transition(Label("fun", a, value), c.with_({("shown",): value}))]

    def source():
        codes = learner.columns.codes(still)
        where = packing(learner.columns.sizes)
        words = [0] * where.words
        for word, shift, code in zip(where.word.tolist(), where.shift.tolist(), codes, strict=True):
            words[word] |= code << shift
        return CodedSource(learner.columns, where, words)

    keeps, changes = (
        learner.tree(TransitionGroup(writes(value), agent))
        for value, agent in (("first", "a"), ("other", "b"))
    )
    learner.learn(keeps, source())
    assert int(learner.trees.root.room[keeps]) < 0
    learner.learn(changes, source())
    assert int(learner.trees.root.room[keeps]) == UNKNOWN  # else it would go on to write nothing
    learner.learn(keeps, source())
    (step,) = learner.leaves.steps_of(-int(learner.trees.root.room[keeps]) - 1)
    record = learner.leaves.steps.room[STEP * step :]
    written = learner.leaves.writes.room[PAIR * record[WRITES] : PAIR * record[WRITES_END]]
    assert written.tolist() == [learner.columns.numbers[("shown",),], 0]
