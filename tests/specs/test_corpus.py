"""The corpus: missions whose folder is the verdict, and the messages expected of those with mistakes."""

import re
from pathlib import Path

import pytest

from specs.codes import Code
from specs.diagnostics import MissionError
from specs.parser import parse_bytes

CORPUS = Path(__file__).parents[1] / "corpus"
GOOD = sorted((CORPUS / "ok").glob("*.mission"))
BAD = sorted((CORPUS / "static_error").glob("*.mission"))
# No text of the corpus shows these: a file that is too large, and a file that cannot be read.
NOT_IN_THE_CORPUS = {"LS001", "LS007"}


def expected(path):
    return path.with_suffix(".expected").read_text(encoding="utf-8")


def codes(text):
    return re.findall(r": (LS\d{3}): ", text)


def is_syntax(code):
    return code[:3] in {"LS0", "LS1"} or code == "LS501"


@pytest.mark.parametrize("path", GOOD, ids=lambda path: path.stem)
def test_a_good_mission_parses(path):
    parse_bytes(path.name, path.read_bytes())


@pytest.mark.parametrize("path", BAD, ids=lambda path: path.stem)
def test_a_mistake_gives_the_expected_block(path, expect):
    if not any(map(is_syntax, codes(expected(path)))):
        parse_bytes(path.name, path.read_bytes())  # what is wrong with it is not the parser's business
        return
    with pytest.raises(MissionError) as caught:
        parse_bytes(path.name, path.read_bytes())
    expect(f"{caught.value}\n", path.with_suffix(".expected"))


def test_every_code_of_the_parser_has_a_file_in_the_corpus():
    shown = {code for path in BAD for code in codes(expected(path))}
    missing = {code.number for code in Code if is_syntax(code.number)} - shown
    assert missing == NOT_IN_THE_CORPUS
