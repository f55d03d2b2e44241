"""The public API: one import, one home for each name."""

import re
import subprocess
import sys
from importlib import import_module
from pathlib import Path

import pytest

import bigactors

REFERENCE = Path(__file__).parents[2] / "docs" / "reference" / "python"


@pytest.mark.parametrize(("name", "home"), bigactors.HOMES.items())
def test_each_public_name_is_what_its_home_has_and_is_defined_in_that_room(name, home):
    assert getattr(bigactors, name) is getattr(import_module(home), name)
    assert getattr(bigactors, name).__module__.split(".")[0] == home.split(".")[0]


def test_an_unknown_name_is_an_attribute_error():
    with pytest.raises(AttributeError, match="no attribute 'nothing'"):
        bigactors.nothing  # noqa: B018 - the access is the test


def test_the_names_are_listed():
    assert set(bigactors.__all__) <= set(dir(bigactors))


@pytest.mark.parametrize("page", ["bigactors", "bigraphs", "physical", "plugin", "strategies"])
def test_each_public_name_is_used_in_a_session_of_the_reference(page):
    text = (REFERENCE / f"{page}.txt").read_text(encoding="utf-8")
    module = import_module(re.search(r"^\.\. automodule:: (\S+)$", text, re.MULTILINE)[1])
    used = set(re.findall(r"\w+", "".join(re.findall(r"^(?:>>>|\.\.\.)( .+\n)", text, re.MULTILINE))))
    assert [name for name in module.__all__ if name not in used] == []


def test_importing_the_package_loads_no_room_and_no_library():
    script = "import sys, bigactors; print(*{name.split('.')[0] for name in sys.modules})"
    done = subprocess.run([sys.executable, "-c", script], capture_output=True, text=True, check=True)
    rooms = {"bigraphs", "checker", "physical", "semantics", "specs"}
    assert not set(done.stdout.split()) & {"shapely", "pyproj", "lark", "resvg_py", *rooms}
