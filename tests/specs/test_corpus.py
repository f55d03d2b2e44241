"""The corpus: missions whose folder is the verdict, and the messages expected of those with mistakes."""

import re
from pathlib import Path

import pytest

from specs.codes import Code
from specs.diagnostics import MissionError, render_all
from specs.elaboration import elaborate, require_bigactor
from specs.parser import parse_bytes

CORPUS = Path(__file__).parents[1] / "corpus"
BAD = sorted((CORPUS / "static_error").glob("*.mission"))
WARNED = sorted((CORPUS / "warned").glob("*.mission"))
# No text of the corpus shows these: a file that is too large, one that cannot be read, and what depends on what is
# installed.
NOT_IN_THE_CORPUS = {"LS001", "LS007", "LS308"}


def read(path):
    source, mission = parse_bytes(path.name, path.read_bytes())
    return elaborate(mission, source, path.parent)


def codes(paths):
    texts = (path.with_suffix(".expected").read_text(encoding="utf-8") for path in paths)
    return {code for text in texts for code in re.findall(r": (LS\d{3}): ", text)}


@pytest.mark.parametrize("path", BAD, ids=lambda path: path.stem)
def test_a_mistake_gives_the_expected_blocks(path, expect):
    with pytest.raises(MissionError) as caught:
        require_bigactor(read(path))
    expect(f"{caught.value}\n", path.with_suffix(".expected"))


@pytest.mark.parametrize("path", WARNED, ids=lambda path: path.stem)
def test_what_is_hardly_meant_gives_the_expected_warnings(path, expect):
    found = read(path)
    expect(f"{render_all(found.warnings, found.source)}\n", path.with_suffix(".expected"))


def test_every_code_has_a_file_in_the_corpus():
    warnings = {code.number for code in Code if code.number.startswith("LS7")}
    assert codes(WARNED) == warnings
    assert {code.number for code in Code} - warnings - codes(BAD) == NOT_IN_THE_CORPUS


@pytest.mark.parametrize("name", ["everything", "rules", "figure2_whole", "empty", "timed"])
def test_a_sound_mission_elaborates(name):
    assert read(CORPUS / "ok" / f"{name}.mission").name in (name, "oil_spill")
