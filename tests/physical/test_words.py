"""Text from outside: what passes can be written again."""

import json

import pytest

from physical import PhysicalError, is_text, is_word, legible, read_json


@pytest.mark.parametrize(
    ("said", "code"),
    [
        (rb'{"name": "\ud800"}', "encoding"),
        (rb'{"\uDFFF": [1]}', "encoding"),
        ("\ud800".encode("utf-8", "surrogatepass").join((b'"', b'"')), "encoding"),
        ('"\ud800"', "encoding"),
        (b'"\xff"', "encoding"),
        (b"NaN", "json"),
        (b"[1e999]", "json"),
        (b"-Infinity", "json"),
        (b"[" * 100_000, "json"),
        (b"{", "json"),
        (b" " * 1_001, "too-large"),
    ],
)
def test_json_that_could_not_be_written_again_is_refused(said, code):
    with pytest.raises(PhysicalError) as found:
        read_json(said, 200_000 if said[:2] == b"[[" else 1_000)
    assert found.value.code == code


def test_what_passes_is_what_json_says():
    said = {"name": "öl \N{OIL DRUM}", "at": [1.5, -2, 1e-3], "deep": [[[None, True]]]}
    assert read_json(json.dumps(said).encode(), 1_000) == said  # a pair of escapes is one character
    assert read_json(json.dumps(said, ensure_ascii=False), 1_000) == said


def test_words_and_texts_are_valid_and_bounded():
    assert is_word("oilSpill0")
    assert not any(map(is_word, ("", " ", "a\nb", "\ud800", "a" * 201, None)))
    assert is_text("two\nlines")
    assert not any(map(is_text, ("\udcff", "a" * 2_001, b"a")))
    assert legible("a\ud800\x1b[1m\n") == "a\N{REPLACEMENT CHARACTER}\N{REPLACEMENT CHARACTER}[1m\n"
    assert len(legible("a" * 5_000)) == 2_000
