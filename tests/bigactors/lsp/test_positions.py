"""Offsets and an editor's positions: one the inverse of the other, in each encoding."""

import pytest
from hypothesis import given
from hypothesis import strategies as st

from bigactors.lsp.positions import UNITS, LineStarts

TEXTS = st.text(st.sampled_from("ab\n\r\té🚁 \u2028\x85"), max_size=40)


@given(TEXTS, st.sampled_from(sorted(UNITS)))
def test_an_offset_and_its_position_say_the_same(text, encoding):
    lines = LineStarts(text, encoding)
    for offset in range(len(text) + 1):
        if text[offset - 1 : offset + 1] != "\r\n" and text[offset : offset + 1] not in ("\n", "\r"):
            assert lines.offset(*lines.position(offset)) == offset


@pytest.mark.parametrize(("encoding", "units"), [("utf-8", 4), ("utf-16", 2), ("utf-32", 1)])
def test_an_encoding_counts_a_character_in_its_units(encoding, units):
    lines = LineStarts("x\n🚁y", encoding)
    assert lines.position(3) == (1, units)
    assert lines.offset(1, units) == 3
    assert lines.offset(1, units - 1) == 2


def test_lines_end_where_the_protocol_says():
    assert LineStarts("a\r\nb\rc\nd\u2028e", "utf-16").starts == [0, 3, 5, 7]


def test_a_position_behind_a_line_or_the_text_is_at_its_end():
    lines = LineStarts("ab\ncd", "utf-16")
    assert (lines.offset(0, 99), lines.offset(99, 0)) == (2, 5)
