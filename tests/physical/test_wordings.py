import re
import tomllib
from pathlib import Path

from physical.wordings import install_extra

ROOT = Path(__file__).parents[2]
ROOMS = ("adapters", "bigactors", "bigraphs", "checker", "physical", "semantics", "specs")


def sources():
    return {
        path: path.read_text(encoding="utf-8")
        for room in ROOMS
        for path in sorted((ROOT / room).rglob("*.py"))
    }


def test_a_hint_of_an_extra_says_how_for_a_clone_and_for_a_wheel():
    hint = install_extra("live")
    assert "pip install '.[live]'" in hint
    assert "pip install 'FILE.whl[live]'" in hint
    assert "bigactors[" not in hint  # a registry would have something else of this name
    assert "as you did" in hint


def test_every_hint_of_an_extra_is_of_one_wording_and_names_an_extra_that_there_is():
    extras = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))["project"][
        "optional-dependencies"
    ]
    texts = sources()
    named = {extra for text in texts.values() for extra in re.findall(r"install_extra\(.(\w+).\)", text)}
    assert named <= set(extras)
    assert named >= {"ais", "cluster", "live", "stations"}
    assert [path.name for path, text in texts.items() if "pip install" in text] == ["wordings.py"]
