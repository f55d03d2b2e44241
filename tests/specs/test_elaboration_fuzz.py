"""Mutated missions through the elaborator and the first steps of a run: only diagnostics and faults come out."""

import os
import random
import re
from pathlib import Path

import pytest

from semantics.behaviours.expressions import Fault
from semantics.successors import successors
from specs.diagnostics import MissionError
from specs.elaboration import elaborate
from specs.parser import parse_bytes

ROOT = Path(__file__).parents[2]
CORPUS = ROOT / "tests" / "corpus"
LARGEST = 4_000
FEW = 70
MANY = int(os.environ.get("BIGACTORS_FUZZ", "0"))
WORD = re.compile(r'"[^"\n]*"|\w+|\s+|[^\w\s]')
NAME = re.compile(r"[^\W\d]\w*")
NUMBER = re.compile(r"\d[\d.]*")
SEEDS = [
    text
    for path in sorted(CORPUS.glob("static_error/LS[2-6]*.mission"))
    if len(text := path.read_text(encoding="utf-8")) <= LARGEST
]
SOUND = [
    (CORPUS / "ok" / f"{name}.mission").read_text(encoding="utf-8")
    for name in ("everything", "rules", "figure2_whole")
]


def same_sort(word, words):
    """Yield the words that may stand where one stands without spoiling the syntax, mostly."""
    for pattern in (NAME, NUMBER):
        if pattern.fullmatch(word):
            return [other for other in words if pattern.fullmatch(other)]
    return [word]


def replace_a_word(words, rng):
    at = rng.randrange(len(words))
    words[at] = rng.choice(same_sort(words[at], words))


def delete_a_word(words, rng):
    del words[rng.randrange(len(words))]


def repeat_a_line(words, rng):
    lines = "".join(words).split("\n")
    at = rng.randrange(len(lines))
    lines.insert(rng.randrange(len(lines) + 1), lines[at])
    words[:] = WORD.findall("\n".join(lines))


def take_a_line_from_elsewhere(words, rng):
    lines = "".join(words).split("\n")
    lines.insert(rng.randrange(len(lines) + 1), rng.choice(rng.choice(SEEDS).split("\n")))
    words[:] = WORD.findall("\n".join(lines))


MUTATIONS = (
    replace_a_word,
    replace_a_word,
    replace_a_word,
    delete_a_word,
    repeat_a_line,
    take_a_line_from_elsewhere,
)


def mutated(rng):
    words = WORD.findall(rng.choice(rng.choice([SEEDS, SOUND, SOUND])))
    for _ in range(rng.choice([1, 1, 1, 2, 4])):
        if words:
            rng.choice(MUTATIONS)(words, rng)
    return "".join(words)


def survive(seed):
    """Elaborate one mutated mission and take a few steps; raises whatever is no diagnostic and no fault."""
    text = mutated(random.Random(seed))
    try:
        source, mission = parse_bytes("mutated.mission", text.encode())
        found = elaborate(mission, source, CORPUS / "static_error")
    except MissionError as error:
        return not str(error)
    front = [found.initial]
    try:
        for _ in range(2):
            front = [step.target for c in front[:2] for step in successors(c)]
    except Fault:  # the mission's mistake, found on the way
        return True
    return True


@pytest.mark.fuzz
def test_mutated_missions_give_diagnostics_only():
    sound = sum(map(survive, range(FEW + MANY)))
    assert 0.1 < sound / (FEW + MANY) < 0.4
