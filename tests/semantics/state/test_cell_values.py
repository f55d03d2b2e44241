"""Rows: immutable, shared where nothing changes, with a hash kept up to date."""

import pickle
import weakref

from hypothesis import given
from hypothesis import strategies as st

from semantics.state.cell_values import _LAYOUTS, Row

cells = st.tuples(st.sampled_from(["line", "store", "placement"]), st.sampled_from("abc"))
contents = st.dictionaries(cells, st.integers(0, 3) | st.none(), max_size=6)


@given(contents)
def test_writing_what_is_there_gives_the_same_object(before):
    row = Row.of(before)
    assert row.with_(before) is row
    assert row.with_({}) is row


def test_a_cell_that_is_not_there_reads_as_none():
    assert Row.of({}).read(("line", "a")) is None


# --- rows that grow ---------------------------------------------------------------------------------------------


@given(contents, st.lists(contents, max_size=4), st.data())
def test_a_row_that_has_grown_is_the_row_that_would_have_been_made_at_once(before, news, data):
    told = before.copy()
    grown = Row.of(before)
    for changes in news:
        order = data.draw(st.permutations(sorted(changes)))
        grown = grown.growing({cell: changes[cell] for cell in order})
        told |= changes
    made = Row.of(told)
    assert dict(grown.items()) == told
    assert (grown, hash(grown)) == (made, hash(made))
    assert made == grown
    assert all(grown.read(cell) == value for cell, value in told.items())
    assert not grown.changed(made)


@given(contents, contents, contents)
def test_rows_that_have_grown_are_equal_if_and_only_if_their_cells_are(before, one, other):
    grown, too = Row.of(before).growing(one), Row.of(other)
    assert (grown == too) == (too == grown) == ({**before, **one} == other)


def test_rows_that_have_grown_and_have_one_hash_need_not_be_equal():
    grown = Row.of({("store", "a"): -1}).growing({("store", "b"): 0})
    other = Row.of({("store", "a"): -2, ("store", "b"): 0})
    assert hash(grown) == hash(other)  # since -1 and -2 have one hash
    assert grown != other


@given(contents, contents, contents)
def test_a_row_that_has_grown_is_written_like_any_other(before, news, changes):
    written = Row.of(before).growing(news).with_(changes)
    made = Row.of({**before, **news, **changes})
    assert (written, hash(written)) == (made, hash(made))
    assert written.with_(changes) is written


@given(contents, contents)
def test_a_row_that_has_grown_survives_pickling(before, news):
    grown = Row.of(before).growing(news)
    assert (
        pickle.loads(pickle.dumps(grown)) == grown == pickle.loads(pickle.dumps(Row.of({**before, **news})))
    )


def test_a_row_that_grows_keeps_what_it_had_in_place():
    row = Row.of({("store", "b"): 1, ("store", "d"): 2})
    grown = row.growing({("store", "c"): 3, ("store", "a"): 4})
    assert grown.layout.cells == (*row.layout.cells, ("store", "c"), ("store", "a"))
    assert row.growing({("store", "b"): 1}) is row


def test_a_layout_lives_as_long_as_a_row_has_it():
    known = len(_LAYOUTS)
    row = Row.of({("never", "written"): 0})
    layouts = [weakref.ref(row.layout)]
    for number in range(100):
        row = row.growing({("comes", str(number)): number})
        layouts.append(weakref.ref(row.layout))
        copy = pickle.loads(pickle.dumps(row))
        assert copy == row
    del copy
    assert [layout() is not None for layout in layouts] == [False] * 100 + [True]
    assert len(_LAYOUTS) == known
