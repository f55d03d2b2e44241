"""Text from outside: what passes can be written again."""

import json
import math

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
        (b'{"a": 1, "b": 2, "a": 1}', "json"),
        (b"9" * 301, "json"),
        (b"-1" + b"0" * 350, "json"),
        (b" " * 1_001, "too-large"),
    ],
)
def test_json_that_could_not_be_written_again_is_refused(said, code):
    with pytest.raises(PhysicalError) as found:
        read_json(said, 200_000 if said[:2] == b"[[" else 1_000)
    assert found.value.code == code


@pytest.mark.parametrize(
    ("said", "reason"),
    [
        (b'[{"holds": false, "holds": true}]', "the key 'holds' is there twice in one object"),
        (b'{"a": 1, "\\u0061": 2}', "the key 'a' is there twice in one object"),
        (b"[" + b"1" * 5_000 + b"]", "a number of 5,000 digits is longer than 300"),
    ],
)
def test_what_others_could_read_otherwise_is_refused_in_our_own_words(said, reason):
    with pytest.raises(PhysicalError) as found:
        read_json(said, 10_000)
    assert found.value.message == f"the text is not JSON: {reason}"


@pytest.mark.parametrize("said", [b"9" * 300, b"-" + b"9" * 300, b"1e308"])
def test_every_number_that_is_read_is_a_float_too(said):
    assert math.isfinite(float(read_json(said, 1_000)))


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
