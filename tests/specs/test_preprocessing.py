"""Bounds, comments, brackets and printed line numbers."""

import pytest

from specs.codes import Code
from specs.diagnostics import MissionError, Source
from specs.preprocessing import decode, prepare


def refused(text):
    with pytest.raises(MissionError) as caught:
        prepare(Source("m", text))
    (found,) = caught.value.diagnostics
    return found


def test_the_text_keeps_its_length_and_its_lines():
    text = 'a // b\n0 BigActor {\n1 "// no" # c\n2 }\n'
    prepared = prepare(Source("m", text))
    assert prepared.text == 'a     \n  BigActor {\n  "// no"    \n  }\n'
    assert [comment.text for comment in prepared.comments] == ["// b", "# c"]


def test_only_the_line_numbers_of_a_bigactor_that_count_on_are_blanked():
    def blanked(text):
        return prepare(Source("m", text)).text

    assert blanked("1 BigActor {\n3 skip\n4 }") == "  BigActor {\n3 skip\n4 }"
    assert blanked("9 BigActor {\n\n 10  skip\n11 }\n12 x") == "  BigActor {\n\n     skip\n   }\n12 x"
    assert blanked("0 world {\n1 }") == "0 world {\n1 }"


def test_a_file_over_a_megabyte_is_refused_unread():
    assert refused("é" * 500_001).code is Code.FILE_TOO_LARGE
    with pytest.raises(MissionError, match="LS001: the file has 5,000,000 bytes, more than 1,000,000"):
        decode("m", b"\xff" * 5_000_000)


def test_bytes_that_are_not_utf8_are_told_by_offset():
    with pytest.raises(MissionError) as caught:
        decode("m", b"\xef\xbb\xbfab\r\nc\xe9d")
    (found,) = caught.value.diagnostics
    assert found.code is Code.NOT_UTF8
    assert found.message == "byte 8 of the file is not UTF-8 (0xe9)"
    assert str(caught.value).startswith("m:2:2: LS002")


def test_line_ends_become_line_feeds_and_the_byte_order_mark_goes():
    assert decode("m", b"\xef\xbb\xbfa\r\nb\rc").text == "a\nb\nc"


@pytest.mark.parametrize("character", ["\0", "\x1b", "\x7f", "\ud800"])
def test_control_characters_and_lone_surrogates_are_refused(character):
    found = refused(f"world {{ {character} }}")
    assert found.code is Code.CONTROL_CHARACTER
    assert found.span.start == 8


def test_the_bound_on_nesting_is_exact():
    assert prepare(Source("m", "(" * 200)).open_at_end
    assert refused("(" * 201).span.start == 200


def test_the_bound_on_words_is_exact():
    assert prepare(Source("m", "a" * 10_000)).text
    assert refused("a" * 10_001).code is Code.WORD_TOO_LONG


def test_brackets_within_strings_and_comments_do_not_count():
    prepared = prepare(Source("m", '{ "(" // [\n}'))
    assert prepared.unmatched is None
    assert prepared.open_at_end == ()


def test_an_open_string_is_told_where_it_begins():
    prepared = prepare(Source("m", 'says "a\nb"'))
    assert [(found.code, found.span.start, found.span.end) for found in prepared.mistakes] == [
        (Code.UNCLOSED_STRING, 5, 7),
        (Code.UNCLOSED_STRING, 9, 10),
    ]
    assert prepared.text == "says   \nb "
