"""Every word of a report that a reader may not know is explained."""

import re
from pathlib import Path
from typing import get_args

import pytest

from checker.properties import deadlines
from checker.reports.glossary import ALL, PROPERTIES, RULES, WORDS, find_word
from checker.verdicts import Outcome
from semantics import bigactor_rules, rules
from semantics.control import Obstacle
from semantics.properties.property import PropertyKind
from semantics.state.requests import Request

CORPUS = Path(__file__).parents[2] / "corpus"
KIND = re.compile(r"^      ([a-z][\w -]*): ", re.MULTILINE)
OF_TIME = Path(deadlines.__file__).read_text(encoding="utf-8")
KINDS = set(re.findall(r'Violation\("([\w ]+)"', OF_TIME)) | {
    kind
    for path in sorted(CORPUS.glob("*/*.expected"))
    for kind in KIND.findall(path.read_text(encoding="utf-8"))
    if not kind.startswith("LS")
}


def test_the_properties_are_those_that_there_are():
    assert list(PROPERTIES) == [kind.value for kind in PropertyKind]


def test_the_rules_are_those_that_there_are():
    every = (*rules.RULES, rules.env, *rules.TIMED_RULES, *bigactor_rules.EXTENSION, bigactor_rules.say)
    assert [rule.__name__ for rule in every] == list(RULES)


@pytest.mark.parametrize(
    "word",
    [
        *(outcome.value for outcome in Outcome),
        *(obstacle.value for obstacle in Obstacle),
        *(f"unserved {request.__name__}" for request in get_args(Request)),
        *(request.__name__ for request in get_args(Request)),
        *sorted(KINDS),
    ],
)
def test_what_a_report_says_is_explained(word):
    found = find_word(word)
    assert found is not None
    assert found[1].endswith((".", "`"))


def test_the_corpus_has_the_kinds_of_findings():
    assert {
        "control race",
        "stale-observation race",
        "deadlock",
        "inconsistent",
        "not arrived",
        "late",
    } <= KINDS


@pytest.mark.parametrize("word", ALL)
def test_a_word_is_found_as_it_is_written_and_explained_in_sentences(word):
    found = find_word(word)
    assert found is not None
    assert found[0] == word
    assert "  " not in found[1].split("\n")[0]


@pytest.mark.parametrize("word", ["", "a", "xyzzy", "rac", "no such thing"])
def test_another_word_is_none(word):
    assert find_word(word) is None


def test_words_that_a_text_refers_to_are_explained():
    texts = " ".join((*PROPERTIES.values(), *WORDS.values()))
    referred = {" ".join(each.split()) for each in re.findall(r"(?<!\*)\*([a-z][\w\s-]*)\*", texts)}
    assert referred
    assert {each for each in referred if find_word(each) is None} == set()
