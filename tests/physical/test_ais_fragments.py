from dataclasses import replace

import pytest
from hypothesis import given
from hypothesis import strategies as st

from physical.ais_fragments import EMPTY, FRAGMENT_LINES, FRAGMENT_SECONDS, FRAGMENT_TABLE, join
from physical.nmea import Fragment


def fragment(number, total=2, sequence=b"1", payload=b"0"):
    return Fragment(b"", "AI", sequence, b"A", total, number, payload, 6 * len(payload))


def joined(parts, time=None):
    """Join parts one by one; the table, the completed messages and the number lost."""
    table, complete, lost = EMPTY, [], 0
    for part in parts:
        step = join(table, part, time)
        table, lost = step.fragments, lost + len(step.lost)
        complete += [step.complete] if step.complete else []
    return table, complete, lost


@pytest.mark.parametrize(
    "change",
    [{"talker": "BS"}, {"sequence": b"2"}, {"channel": b"B"}, {"total": 3}],
    ids=str,
)
def test_parts_that_differ_in_any_of_the_key_stay_apart(change):
    table, complete, lost = joined([fragment(1), replace(fragment(2), **change)])
    assert (len(table.waiting), complete, lost) == (2, [], 0)


def test_parts_of_two_groups_stay_apart():
    first = join(EMPTY, fragment(1), None, "7")
    assert join(first.fragments, fragment(2), None, "8").complete is None
    assert join(first.fragments, fragment(2), None, "7").complete is not None


def test_a_part_heard_twice_counts_once():
    _, complete, lost = joined([fragment(1), fragment(1), fragment(2)])
    assert (len(complete), lost) == (1, 0)


def test_another_text_under_the_same_number_begins_a_new_message_and_loses_the_old():
    _, complete, lost = joined([fragment(1, payload=b"5"), fragment(1, payload=b"6"), fragment(2)])
    assert [part.payload for part in complete[0].parts] == [b"6", b"0"]
    assert lost == 1


def test_a_part_that_comes_too_late_begins_a_new_message():
    first = join(EMPTY, fragment(1), 100.0)
    assert join(first.fragments, fragment(2), 100.0 + FRAGMENT_SECONDS).complete is not None
    late = join(first.fragments, fragment(2), 100.1 + FRAGMENT_SECONDS)
    assert (late.complete, len(late.lost), len(late.fragments.waiting)) == (None, 1, 1)


def test_a_message_is_given_up_after_many_other_parts():
    table = join(EMPTY, fragment(1), None).fragments
    for turn in range(FRAGMENT_LINES):
        table = join(table, fragment(turn % 2 + 1, sequence=b"2"), None).fragments
    assert join(table, fragment(2), None).complete is None


def test_the_time_of_a_message_is_that_of_its_first_part():
    first = join(EMPTY, fragment(2), 100.0)
    complete = join(first.fragments, fragment(1), 101.0).complete
    assert complete is not None
    assert complete.time == 100.0


parts = st.builds(
    lambda total, number, sequence, payload: fragment(min(number, total), total, sequence, payload),
    st.integers(2, 4),
    st.integers(1, 4),
    st.binary(min_size=1, max_size=2),
    st.sampled_from([b"0", b"1"]),
)


@given(st.lists(st.tuples(parts, st.none() | st.floats(0, 30)), max_size=200))
def test_the_table_is_bounded_and_every_message_ends_once(heard):
    table, begun, ended = EMPTY, 0, 0
    for part, time in heard:
        step = join(table, part, time)
        assert len(step.fragments.waiting) <= FRAGMENT_TABLE
        begun += step.fragments.heard - 1 in {entry.heard for entry in step.fragments.waiting}
        ended += len(step.lost) + (step.complete is not None)
        table = step.fragments
    assert ended + len(table.waiting) == begun


def test_the_oldest_message_gives_way_in_a_full_table():
    sequences = [b"%d" % number for number in range(FRAGMENT_TABLE + 1)]
    table, _, lost = joined(fragment(1, sequence=sequence) for sequence in sequences)
    assert lost == 1
    assert [entry.key[1] for entry in table.waiting] == sequences[1:]


@given(st.permutations([(name, number) for name in (b"1", b"2", b"3") for number in (1, 2, 3)]))
def test_independent_messages_may_be_interleaved_in_any_order(order):
    table, complete, lost = joined(fragment(number, 3, name, payload=name) for name, number in order)
    assert sorted(entry.key[1] for entry in complete) == [b"1", b"2", b"3"]
    assert all({part.payload for part in entry.parts} == {entry.key[1]} for entry in complete)
    assert (table.waiting, lost) == ((), 0)
