"""Columns and numbered texts: what goes in comes out, however large they grow."""

from collections.abc import Sequence

import pytest
from hypothesis import given
from hypothesis import strategies as st

from bigraphs.compact_lists import DictionaryColumn, Numbering, Texts


@given(st.lists(st.integers(0, 5)), st.slices(8))
def test_a_column_is_the_list_of_its_values(values, part):
    column = DictionaryColumn(values)
    assert isinstance(column, Sequence)
    assert list(column) == values
    assert column[part] == values[part]
    assert column == DictionaryColumn(tuple(values))
    assert sorted(column.values) == sorted(set(values))


@pytest.mark.parametrize(("distinct", "code"), [(256, "B"), (257, "H"), (65_536, "H"), (65_537, "I")])
def test_a_column_widens_with_the_number_of_its_values(distinct, code):
    column = DictionaryColumn(range(distinct))
    column.append(0)
    assert column.codes.typecode == code
    assert list(column) == [*range(distinct), 0]


@given(st.lists(st.binary(max_size=4)), st.slices(8))
def test_texts_are_the_list_of_them(given_texts, part):
    texts = Texts(given_texts)
    assert list(texts) == given_texts
    assert texts[part] == given_texts[part]
    assert texts == Texts(given_texts)


@given(st.lists(st.binary(max_size=3)))
def test_texts_are_numbered_as_they_first_come(given_texts):
    numbering, known = Numbering(), dict[bytes, int]()
    for text in given_texts:
        assert numbering.find(text) == known.get(text, -1)
        if text not in known:
            known[text] = len(known)
            assert numbering.add(text) == known[text]
    assert list(numbering.texts) == list(known)


def test_texts_that_share_a_place_in_the_table_are_told_apart():
    numbering = Numbering()
    texts = [number.to_bytes(2, "big") for number in range(20_000)]
    for text in texts:
        assert numbering.find(text) == -1
        numbering.add(text)
    assert [numbering.find(text) for text in texts] == list(range(20_000))
