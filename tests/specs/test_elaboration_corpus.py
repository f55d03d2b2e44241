"""The corpus through the elaborator: the messages expected of missions that parse and mean nothing."""

import re
from pathlib import Path

import pytest

from specs.codes import Code
from specs.diagnostics import MissionError, render_all
from specs.elaboration import elaborate, load_mission, require_bigactor
from specs.parser import parse_bytes

CORPUS = Path(__file__).parents[1] / "corpus"
MISSIONS = Path(__file__).parents[2] / "specs" / "missions"
NOT_IN_THE_CORPUS = {"LS308"}  # depends on what is installed


def expected(path):
    return path.with_suffix(".expected").read_text(encoding="utf-8")


def codes(text):
    return re.findall(r": (LS\d{3}): ", text)


def is_ours(code):
    return code[:3] in {"LS2", "LS3", "LS4", "LS5", "LS6", "LS8"} and code != "LS501"


BAD = [
    path
    for path in sorted((CORPUS / "static_error").glob("*.mission"))
    if path.with_suffix(".expected").exists() and all(map(is_ours, codes(expected(path))))
]


def message_of(path):
    source, mission = parse_bytes(path.name, path.read_bytes())
    with pytest.raises(MissionError) as caught:
        require_bigactor(elaborate(mission, source, path.parent))
    return str(caught.value) + "\n"


@pytest.mark.parametrize("path", BAD, ids=lambda path: path.stem)
def test_a_mistake_gives_the_expected_blocks(path, expect):
    expect(message_of(path), path.with_suffix(".expected"))


def test_every_code_of_the_elaborator_has_a_file_in_the_corpus():
    shown = {code for path in BAD for code in codes(expected(path))}
    assert {code.number for code in Code if is_ours(code.number)} - shown == NOT_IN_THE_CORPUS


WARNED = sorted((CORPUS / "warned").glob("*.mission"))


@pytest.mark.parametrize("path", WARNED, ids=lambda path: path.stem)
def test_what_is_hardly_meant_gives_the_expected_warnings(path, expect):
    source, mission = parse_bytes(path.name, path.read_bytes())
    found = render_all(elaborate(mission, source, path.parent).warnings, source)
    expect(f"{found}\n", path.with_suffix(".expected"))


def test_every_warning_has_a_file_in_the_corpus():
    shown = {code for path in WARNED for code in codes(expected(path))}
    assert shown == {code.number for code in Code if code.number.startswith("LS7")}


@pytest.mark.parametrize("path", sorted(MISSIONS.glob("*.mission")), ids=lambda path: path.stem)
def test_nothing_that_ships_is_warned_of(path):
    assert load_mission(path).warnings == ()


@pytest.mark.parametrize("name", ["everything", "rules", "figure2_whole", "empty", "timed"])
def test_a_sound_mission_elaborates(name):
    path = CORPUS / "ok" / f"{name}.mission"
    assert load_mission(path).name in (name, "oil_spill")
