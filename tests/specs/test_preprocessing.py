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


@pytest.mark.parametrize(
    ("text", "code", "start"),
    [
        ("é" * 500_001, Code.FILE_TOO_LARGE, 0),
        ("(" * 201, Code.NESTED_TOO_DEEPLY, 200),
        ("a" * 10_001, Code.WORD_TOO_LONG, 0),
        *((f"world {{ {sign} }}", Code.CONTROL_CHARACTER, 8) for sign in ("\0", "\x1b", "\x7f", "\ud800")),
    ],
    ids=["a megabyte", "nesting", "a word", "zero", "escape", "delete", "a lone surrogate"],
)
def test_what_is_beyond_a_bound_is_refused(text, code, start):
    found = refused(text)
    assert (found.code, found.span.start) == (code, start)


def test_what_is_at_a_bound_is_read():
    assert prepare(Source("m", "(" * 200)).open_at_end
    assert prepare(Source("m", "a" * 10_000)).text


def test_a_file_over_a_megabyte_is_refused_undecoded():
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
