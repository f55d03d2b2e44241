"""What is noted of a rule's reads, and what is not."""

from checker.engines.fast.recording import Ask, Edited, Recorder
from semantics.behaviours.observations import All, Observation
from semantics.state.cells import QUEUE, Row
from semantics.state.eta import appended, first_of, without
from semantics.state.requests import OBS, SND

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
    return Recorder(Source(queue), Row.of({}), lambda _: True, frozenset({"uav0"}))


def values(found):
    """Return what was read whole."""
    return [ask for ask in found.scopes[0].asked if ask.question is None]


def test_the_answer_to_a_question_is_all_that_is_noted():
    found = recorder(B, A)
    assert found.ask(QUEUE, first_of, "a") == ((1, A),)
    assert found.scopes[0].asked == {Ask(QUEUE, None, first_of, ("a",)): ((1, A),)}


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
    assert values(found) == [Ask(QUEUE)]


def test_where_observations_stand_an_edit_reads():
    found = recorder(B)
    assert found.edited(QUEUE, appended, SAID) == (B, SAID)
    assert values(found) == [Ask(QUEUE)]
