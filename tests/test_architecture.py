"""Every path and module that the documentation names exists."""

import re

import pytest
from repository import PAGES, ROOMS, ROOT, read, sources

LINKED = [*PAGES, ROOT / "CHANGELOG.md", ROOT / "benchmarks" / "README.md"]
LABELS = ("Context", "Decision", "Consequence", "Rejected")
ANY = "|".join(ROOMS)

PATH = re.compile(rf"`((?:{ANY}|tests|benchmarks|docs)/[\w./]*)`")
FILE = re.compile(r"`(\w+\.py)`")
MODULE = re.compile(rf"`((?:{ANY})(?:\.\w+)+)`")
LINK = re.compile(r"\]\((?!https?:)([^)#\s]*)(?:#([^)\s]+))?\)")
WRITTEN_BY_BENCHMARKS = "benchmarks/results/"
KNOWN = {path.name for path in [*sources((*ROOMS, "tests", "benchmarks")), *ROOT.glob("*.py")]}


def exists(name):
    """Tell whether a dotted name (installed or not) is a module or package, or something that a module defines."""
    path = ROOT.joinpath(*re.sub(rf"^bigactors\.(?={ANY})", "", name).split("."))
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
def test_every_path_file_and_module_on_a_page_exists(page):
    text = page.read_text(encoding="utf-8")
    paths = (path for path in PATH.findall(text) if WRITTEN_BY_BENCHMARKS not in path)
    assert [path for path in paths if not (ROOT / path).exists()] == []
    names = set(FILE.findall(text)) - set(re.findall("<!-- file: (.+) -->", text))
    assert names - KNOWN == set()
    assert [name for name in MODULE.findall(text) if not exists(name)] == []


@pytest.mark.parametrize("page", LINKED, ids=lambda page: page.name)
def test_every_link_of_a_page_leads_somewhere(page):
    dead = []
    for path, anchor in LINK.findall(page.read_text(encoding="utf-8")):
        target = page.parent / path if path else page
        if not target.exists() or (anchor and target.suffix == ".md" and anchor not in anchors(target)):
            dead.append(f"{path}#{anchor}")
    assert dead == []


def test_a_decision_is_a_short_record_with_a_claim_for_its_title():
    page = read("docs/explanation/decisions.md")
    records = [record.split("\n\n")[0].partition("\n") for record in page.split("\n### ")[1:]]
    assert len(records) > 60
    for title, _, text in records:
        labels = re.findall(r"\*(\w+):\*", text)
        assert labels == [each for each in LABELS if each in labels], title
        assert "Decision" in labels, title
        assert len(text.split()) <= 100, title
