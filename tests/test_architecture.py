"""Every path and module that the documentation names exists."""

import re
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[1]
PAGES = [
    *(ROOT / name for name in ("ARCHITECTURE.md", "CONTRIBUTING.md", "README.md")),
    *sorted((ROOT / "docs").rglob("*.md")),
]
LINKED = [*PAGES, ROOT / "CHANGELOG.md", ROOT / "benchmarks" / "README.md"]
ROOMS = "adapters|bigactors|bigraphs|checker|physical|semantics|specs"

PATH = re.compile(rf"`((?:{ROOMS}|tests|benchmarks|docs)/[\w./]*)`")
FILE = re.compile(r"`(\w+\.py)`")
MODULE = re.compile(rf"`((?:{ROOMS})(?:\.\w+)+)`")
LINK = re.compile(r"\]\((?!https?:)([^)#\s]*)(?:#([^)\s]+))?\)")
WRITTEN_BY_BENCHMARKS = "benchmarks/results/"


def exists(name):
    """Tell whether a dotted name (installed or not) is a module or package, or something that a module defines."""
    path = ROOT.joinpath(*re.sub(rf"^bigactors\.(?={ROOMS})", "", name).split("."))
    if path.is_dir() or path.with_suffix(".py").exists():
        return True
    module = path.parent / "__init__.py" if path.parent.is_dir() else path.parent.with_suffix(".py")
    return module.exists() and bool(
        re.search(rf"^(?:class|def) {path.name}\b", module.read_text("utf-8"), re.MULTILINE)
    )


def anchors(page):
    """Return the anchors of a page's headings, as GitHub makes them."""
    headings = re.findall(r"^#+ (.+)$", page.read_text(encoding="utf-8"), re.MULTILINE)
    return {re.sub(r"[^\w\- ]", "", heading.lower()).replace(" ", "-") for heading in headings}


@pytest.mark.parametrize("page", PAGES, ids=lambda page: page.name)
def test_every_path_on_a_page_exists(page):
    paths = PATH.findall(page.read_text(encoding="utf-8"))
    assert [path for path in paths if not (ROOT / path).exists() and WRITTEN_BY_BENCHMARKS not in path] == []


@pytest.mark.parametrize("page", PAGES, ids=lambda page: page.name)
def test_every_file_that_a_page_names_without_its_folder_exists(page):
    text = page.read_text(encoding="utf-8")
    names = set(FILE.findall(text)) - set(re.findall("<!-- file: (.+) -->", text))
    known = {
        path.name
        for folder in (*ROOMS.split("|"), "tests", "benchmarks")
        for path in (ROOT / folder).rglob("*.py")
    } | {path.name for path in ROOT.glob("*.py")}
    assert names - known == set()


@pytest.mark.parametrize("page", PAGES, ids=lambda page: page.name)
def test_every_module_on_a_page_exists(page):
    assert [name for name in MODULE.findall(page.read_text(encoding="utf-8")) if not exists(name)] == []


@pytest.mark.parametrize("page", LINKED, ids=lambda page: page.name)
def test_every_link_of_a_page_leads_somewhere(page):
    dead = []
    for path, anchor in LINK.findall(page.read_text(encoding="utf-8")):
        target = page.parent / path if path else page
        if not target.exists() or (anchor and target.suffix == ".md" and anchor not in anchors(target)):
            dead.append(f"{path}#{anchor}")
    assert dead == []


def test_a_decision_is_a_short_record_with_a_claim_for_its_title():
    page = (ROOT / "docs" / "explanation" / "decisions.md").read_text(encoding="utf-8")
    records = [record.split("\n\n")[0].partition("\n") for record in page.split("\n### ")[1:]]
    assert len(records) > 60
    for title, _, text in records:
        labels = re.findall(r"\*(\w+):\*", text)
        assert labels == [
            each for each in ("Context", "Decision", "Consequence", "Rejected") if each in labels
        ], title
        assert "Decision" in labels, title
        assert len(text.split()) <= 100, title
