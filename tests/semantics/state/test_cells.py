"""Rows: immutable, shared where nothing changes, with a hash kept up to date."""

import pickle

from hypothesis import given
from hypothesis import strategies as st

from semantics.state.cells import Row

cells = st.tuples(st.sampled_from(["line", "store", "placement"]), st.sampled_from("abc"))
contents = st.dictionaries(cells, st.integers(0, 3) | st.none(), max_size=6)


@given(contents, contents)
def test_writing_gives_the_row_that_would_have_been_made_at_once(before, changes):
    written, made = Row.of(before).with_(changes), Row.of({**before, **changes})
    assert written == made
    assert hash(written) == hash(made)
    assert dict(written.items()) == {**before, **changes}


@given(contents)
def test_writing_what_is_there_gives_the_same_object(before):
    row = Row.of(before)
    assert row.with_(before) is row
    assert row.with_({}) is row


@given(contents, contents)
def test_rows_are_equal_if_and_only_if_their_cells_are(one, other):
    assert (Row.of(one) == Row.of(other)) == (one == other)


@given(contents)
def test_a_row_survives_pickling(before):
    assert pickle.loads(pickle.dumps(Row.of(before))) == Row.of(before)


def test_a_cell_that_is_not_there_reads_as_none():
    assert Row.of({}).read(("line", "a")) is None
