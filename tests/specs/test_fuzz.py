"""Mutated missions through the parser and the formatter: nothing but diagnostics comes out."""

import os
import random
import re
from pathlib import Path

import pytest

from specs.diagnostics import MissionError
from specs.formatter import format_mission
from specs.language_reference import EXAMPLES
from specs.parser import parse_bytes

ROOT = Path(__file__).parents[2]
LARGEST = 4_000
FEW = 70
MANY = int(os.environ.get("BIGACTORS_FUZZ", "0"))
WORD = re.compile(rb"\w+|\s+|[^\w\s]+")
SEEDS = [
    data
    for path in sorted([*ROOT.glob("tests/corpus/*/*.mission"), *ROOT.glob("specs/missions/*.mission")])
    if len(data := path.read_bytes()) <= LARGEST
] + [text.encode() for text in EXAMPLES.values()]


def flip_a_byte(data, rng):
    at = rng.randrange(len(data))
    return data[:at] + bytes([data[at] ^ (1 << rng.randrange(8))]) + data[at + 1 :]


def truncate(data, rng):
    return data[: rng.randrange(len(data))]


def delete_a_word(data, rng):
    words = WORD.findall(data)
    del words[rng.randrange(len(words))]
    return b"".join(words)


def repeat_a_word(data, rng):
    words = WORD.findall(data)
    at = rng.randrange(len(words))
    return b"".join([*words[:at], words[at] * rng.choice([2, 2, 3, 250]), *words[at:]])


def swap_two_words(data, rng):
    words = WORD.findall(data)
    one, other = rng.randrange(len(words)), rng.randrange(len(words))
    words[one], words[other] = words[other], words[one]
    return b"".join(words)


def take_a_word_from_elsewhere(data, rng):
    words = WORD.findall(data)
    words.insert(rng.randrange(len(words) + 1), rng.choice(WORD.findall(rng.choice(SEEDS) or b" ")))
    return b"".join(words)


MUTATIONS = (
    flip_a_byte,
    truncate,
    delete_a_word,
    repeat_a_word,
    swap_two_words,
    take_a_word_from_elsewhere,
)


def mutated(rng):
    data = rng.choice(SEEDS)
    for _ in range(rng.choice([1, 1, 2, 5])):
        if data:
            data = rng.choice(MUTATIONS)(data, rng)
    return data


def survive(seed):
    """Parse and format one mutated mission; raises whatever is no MissionError."""
    data = mutated(random.Random(seed))
    try:
        source, mission = parse_bytes("fuzz.mission", data)
        once = format_mission(source.text)
        assert parse_bytes("fuzz.mission", once.encode())[1] == mission, data
        assert format_mission(once) == once, data
    except MissionError as error:
        check_words(str(error))


def check_words(text):
    assert text.startswith("fuzz.mission:"), text
    assert not re.search(r"__ANON|[A-Z]+BRACE|LPAR|RPAR|LSQB|LESSTHAN|SEMICOLON|DROPPING", text), text


@pytest.mark.fuzz
def test_a_mutated_mission_gives_diagnostics_and_nothing_else():
    for seed in range(FEW + MANY):
        survive(seed)
