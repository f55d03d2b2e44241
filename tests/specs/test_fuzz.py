"""Mutated missions, read, laid out, elaborated and begun: nothing but diagnostics and faults comes out."""

import os
import random
import re
from pathlib import Path

import pytest

from semantics.behaviours.expressions import Fault
from semantics.successors import successors
from specs.diagnostics import MissionError
from specs.elaboration import elaborate
from specs.formatter import format_mission
from specs.language_reference import EXAMPLES
from specs.parser import parse_bytes

ROOT = Path(__file__).parents[2]
LARGEST = 4_000
FEW = 120
MANY = int(os.environ.get("BIGACTORS_FUZZ", "0"))
WORD = re.compile(rb'"[^"\n]*"|\w+|\s+|[^\w\s]')
SORTS = (re.compile(rb"[^\W\d]\w*"), re.compile(rb"\d[\d.]*"))
SEEDS = [
    data
    for path in sorted([*ROOT.glob("tests/corpus/*/*.mission"), *ROOT.glob("specs/missions/*.mission")])
    if len(data := path.read_bytes()) <= LARGEST
] + [text.encode() for text in EXAMPLES.values()]
SOUND = [
    (ROOT / "tests/corpus/ok" / f"{name}.mission").read_bytes()
    for name in ("everything", "rules", "figure2_whole")
]


def flip_a_byte(words, rng):
    data = b"".join(words)
    at = rng.randrange(len(data))
    return [data[:at], bytes([data[at] ^ (1 << rng.randrange(8))]), data[at + 1 :]]


def truncate(words, rng):
    data = b"".join(words)
    return [data[: rng.randrange(len(data))]]


def delete_a_word(words, rng):
    at = rng.randrange(len(words))
    return words[:at] + words[at + 1 :]


def repeat_a_word(words, rng):
    at = rng.randrange(len(words))
    return [*words[:at], words[at] * rng.choice([2, 2, 3, 250]), *words[at:]]


def swap_two_words(words, rng):
    one, other = rng.randrange(len(words)), rng.randrange(len(words))
    words[one], words[other] = words[other], words[one]
    return words


def take_a_word_from_elsewhere(words, rng):
    words.insert(rng.randrange(len(words) + 1), rng.choice(WORD.findall(rng.choice(SEEDS)) or [b" "]))
    return words


def take_a_line(words, rng):
    """Take a line from here or elsewhere."""
    lines = b"".join(words).split(b"\n")
    lines.insert(
        rng.randrange(len(lines) + 1), rng.choice(rng.choice([b"\n".join(lines), *SEEDS[:40]]).split(b"\n"))
    )
    return [b"\n".join(lines)]


def replace_a_word(words, rng):
    """Replace a word by one of its sort, which leaves the syntax as it is, mostly."""
    at = rng.randrange(len(words))
    sort = next((each for each in SORTS if each.fullmatch(words[at])), None)
    words[at] = rng.choice([word for word in words if sort and sort.fullmatch(word)] or [words[at]])
    return words


MUTATIONS = (
    *(flip_a_byte, truncate, delete_a_word, repeat_a_word, swap_two_words, take_a_word_from_elsewhere),
    *(take_a_line, take_a_line, replace_a_word, replace_a_word, replace_a_word),
)


def mutated(rng):
    data = rng.choice(rng.choice([SEEDS, SOUND]))
    for _ in range(rng.choice([1, 1, 1, 2, 5])):
        if words := WORD.findall(data):
            data = b"".join(rng.choice(MUTATIONS)(words, rng))
    return data


def survive(seed):
    """Read a mutated mission and take a few steps; tell whether it is sound."""
    data = mutated(random.Random(seed))
    try:
        source, mission = parse_bytes("fuzz.mission", data)
        once = format_mission(source.text)
        assert parse_bytes("fuzz.mission", once.encode())[1] == mission, data
        assert format_mission(once) == once, data
        front = [elaborate(mission, source, ROOT / "tests/corpus/static_error").initial]
    except MissionError as error:
        check_words(str(error))
        return False
    try:
        for _ in range(2):
            front = [step.target for c in front[:2] for step in successors(c)]
    except Fault:  # the mission's mistake, found on the way
        return True
    return True


def check_words(text):
    assert text.startswith("fuzz.mission:"), text
    assert not re.search(r"__ANON|[A-Z]+BRACE|LPAR|RPAR|LSQB|LESSTHAN|SEMICOLON|DROPPING", text), text


@pytest.mark.fuzz
def test_a_mutated_mission_gives_diagnostics_and_nothing_else():
    sound = sum(map(survive, range(FEW + MANY)))
    assert 0.1 < sound / (FEW + MANY) < 0.6
