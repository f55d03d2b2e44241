"""The corpus through the elaborator: the messages expected of missions that parse and mean nothing."""

import re
from pathlib import Path

import pytest

from specs.codes import Code
from specs.diagnostics import MissionError
from specs.elaboration import elaborate, load_mission
from specs.parser import parse_bytes

CORPUS = Path(__file__).parents[1] / "corpus"
NOT_IN_THE_CORPUS = {"LS308"}  # depends on what is installed


def expected(path):
    return path.with_suffix(".expected").read_text(encoding="utf-8")


def codes(text):
    return re.findall(r": (LS\d{3}): ", text)


def is_ours(code):
    return code[:3] in {"LS2", "LS3", "LS4", "LS5", "LS6"} and code != "LS501"


BAD = [
    path
    for path in sorted((CORPUS / "static_error").glob("*.mission"))
    if path.with_suffix(".expected").exists() and all(map(is_ours, codes(expected(path))))
]


def message_of(path):
    source, mission = parse_bytes(path.name, path.read_bytes())
    with pytest.raises(MissionError) as caught:
        elaborate(mission, source, path.parent)
    return str(caught.value) + "\n"


@pytest.mark.parametrize("path", BAD, ids=lambda path: path.stem)
def test_a_mistake_gives_the_expected_blocks(path):
    assert message_of(path) == expected(path)


def test_every_code_of_the_elaborator_has_a_file_in_the_corpus():
    shown = {code for path in BAD for code in codes(expected(path))}
    assert {code.number for code in Code if is_ours(code.number)} - shown == NOT_IN_THE_CORPUS


@pytest.mark.parametrize("name", ["everything", "rules", "figure2_whole", "empty"])
def test_a_sound_mission_elaborates(name):
    path = CORPUS / "ok" / f"{name}.mission"
    assert load_mission(path).name in (name, "oil_spill")
