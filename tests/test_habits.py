"""What is built, what it is tested with, and the files that other programs read: they fit what is here."""

import json
import re
import subprocess
import sys
import tomllib
import zipfile
from collections import Counter
from importlib import import_module

import pytest
import yaml
from packaging.requirements import Requirement
from packaging.utils import canonicalize_name
from repository import PAGES, ROOT, name_of, read

from bigactors import __version__
from bigactors.commands import NAMES
from bigraphs.notation.bgm import parser as bgm_parser
from bigraphs.notation.big import parser as big_parser
from hatch_build import PACKAGE, ROOMS, installed, refuse_imports_of_rooms
from specs import grammar


@pytest.fixture(scope="module")
def wheel(tmp_path_factory):
    folder = tmp_path_factory.mktemp("dist")
    command = [sys.executable, "-m", "hatchling", "build", "-t", "wheel", "-d", str(folder)]
    subprocess.run(command, cwd=ROOT, check=True, capture_output=True)
    with zipfile.ZipFile(next(folder.glob("*.whl"))) as built:
        yield built


@pytest.mark.long
def test_the_wheel_puts_one_name_into_site_packages_with_every_file_of_every_room(wheel):
    names = {name.split("/")[0] for name in wheel.namelist()}
    assert {name for name in names if not name.endswith(".dist-info")} == {PACKAGE}
    here = {name_of(path) for room in (*ROOMS, PACKAGE) for path in (ROOT / room).rglob("*.*")}
    expected = {name if name.startswith(f"{PACKAGE}/") else f"{PACKAGE}/{name}" for name in here}
    built = {name for name in wheel.namelist() if name.startswith(f"{PACKAGE}/")}
    # npm's, from which the page's parts are copied; parsers' tables lie here once somebody has read a file
    unwanted = ("__pycache__", "node_modules", "page/package", ".tables.json")
    tables = {f"{PACKAGE}/{name_of(module.TABLES)}" for module in (grammar, big_parser, bgm_parser)}
    assert built == tables | {name for name in expected if not any(each in name for each in unwanted)}


@pytest.mark.parametrize(
    ("text", "there"),
    [
        ("from semantics.rules import env\n", "from bigactors.semantics.rules import env\n"),
        ("def f():\n    from specs import parse\n", "def f():\n    from bigactors.specs import parse\n"),
        ("    >>> from physical.shape import box\n", "    >>> from bigactors.physical.shape import box\n"),
        ("python -m adapters.simulated", "python -m bigactors.adapters.simulated"),
        ("from bigactors.cli import main\n", "from bigactors.cli import main\n"),
        ("from physicality import specs\n", "from physicality import specs\n"),
        ("What comes\nfrom physical things\n", "What comes\nfrom physical things\n"),
    ],
)
def test_installed_a_room_is_imported_from_the_package(text, there):
    assert installed(text) == there


@pytest.mark.parametrize(
    "line", ["import semantics", "import specs.preprocessing as words", "if 1: from checker import check"]
)
def test_an_import_that_stays_as_it_was_is_refused(line, tmp_path):
    (tmp_path / "a.py").write_text(f"\n{installed(line)}\n", encoding="utf-8")
    with pytest.raises(ValueError, match=r"a\.py:2 imports \w+"):
        refuse_imports_of_rooms(tmp_path / "a.py", tmp_path)


@pytest.mark.parametrize("page", PAGES, ids=lambda page: page.name)
def test_what_a_page_imports_is_there(page):
    for module, names in re.findall(
        r"^from (bigactors[\w.]*) import (.+)$", page.read_text("utf-8"), re.MULTILINE
    ):
        here = import_module(re.sub(rf"^bigactors\.(?={'|'.join(ROOMS)})", "", module))
        assert all(hasattr(here, name) for name in names.split(", ")), (module, names)


def test_no_page_imports_a_room_by_its_name_in_the_repository():
    assert [page.name for page in PAGES if (text := page.read_text("utf-8")) != installed(text)] == []


def test_constraints_are_exact_and_within_what_the_project_asks_for():
    lines = [line for line in read("constraints.txt").splitlines() if not line.startswith("#")]
    assert [line for line in lines if not re.fullmatch(r"[\w.-]+==[\w.]+", line)] == []
    pinned = {canonicalize_name(name): version for name, version in (line.split("==") for line in lines)}
    asked = {each.name: each for each in requirements("dev")}
    assert [name for name, each in asked.items() if not allowed(each, pinned)] == []


def requirements(extra):
    project = tomllib.loads(read("pyproject.toml"))["project"]
    for each in map(Requirement, (*project["dependencies"], *project["optional-dependencies"][extra])):
        if each.name == project["name"]:
            yield from (found for other in sorted(each.extras) for found in requirements(other))
        else:
            yield each


def allowed(requirement, pinned):
    return requirement.specifier.contains(pinned[canonicalize_name(requirement.name)], prereleases=True)


def test_hooks_for_users_run_commands_that_there_are():
    entries = re.findall(r"^  entry: bigactors (\S+)$", read(".pre-commit-hooks.yaml"), re.MULTILINE)
    assert entries == ["fmt", "check"]
    assert set(entries) <= set(NAMES)


def test_the_workflow_runs_what_there_is():
    workflow = read(".github/workflows/ci.yml")
    targets = set(re.findall(r"^([\w-]+):", read("Makefile"), re.MULTILINE))
    assert "- run: .ci/run\n" in workflow
    assert set(re.search(r"target: \[(.+)\]", workflow)[1].split(", ")) <= targets
    assert set(re.findall(r"^make ([\w-]+)$", read(".ci/run"), re.MULTILINE)) <= targets


def test_no_two_modules_beside_the_tests_have_one_name():
    """Tests import what stands beside them by its name alone, so the first on the path would be taken for all."""
    folders = [path for room in ("tests", "benchmarks") for path in (ROOT / room).rglob("*.py")]
    stems = Counter(path.stem for path in folders if not path.stem.startswith(("test_", "conftest", "__")))
    assert [stem for stem, times in stems.items() if times > 1] == []


def test_the_version_is_the_same_everywhere():
    citation = yaml.safe_load(read("CITATION.cff"))
    released = re.search(r"^## (\d\S+) \((\S+)\)$", read("CHANGELOG.md"), re.MULTILINE)
    assert (citation["version"], str(citation["date-released"])) == released.groups()
    assert citation["version"] == json.loads(read("editors/vscode/package.json"))["version"] == __version__


def test_the_forms_of_issues_ask_for_something():
    for form in (ROOT / ".github" / "ISSUE_TEMPLATE").glob("[!c]*.yml"):
        asked = yaml.safe_load(form.read_text(encoding="utf-8"))
        assert asked["name"]
        assert asked["description"]
        assert {each["type"] for each in asked["body"]} <= {"textarea", "input"}
        assert all(each["attributes"]["label"] for each in asked["body"])
