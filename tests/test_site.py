"""The site of the pages: it builds without a warning, has every page, and needs no server."""

import json
import re
import subprocess
import sys
from importlib import import_module

import pytest
from repository import ROOT

pytestmark = pytest.mark.long  # it builds the site

LOADED = re.compile(
    r'<(?:script|img|iframe)[^>]* src="([^"]+)"|<link[^>]* rel="stylesheet"[^>]* href="([^"]+)"'
)


@pytest.fixture(scope="module")
def site(tmp_path_factory):
    """Build the site, as `make docs` does."""
    folder = tmp_path_factory.mktemp("site")
    command = [*["-m", "sphinx", "-W", "--keep-going", "--quiet", "-c", "docs", "."], str(folder)]
    done = subprocess.run([sys.executable, *command], cwd=ROOT, capture_output=True, text=True, check=False)
    assert (done.returncode, done.stderr) == (0, "")
    return folder


@pytest.fixture(scope="module")
def index(site):
    """Return what the search reads."""
    text = (site / "searchindex.js").read_text(encoding="utf-8")
    return json.loads(text.removeprefix("Search.setIndex(").removesuffix(")"))


def test_every_page_of_docs_is_in_the_site_and_leads_to_no_other_machine(site):
    for page in (ROOT / "docs").rglob("*.md"):
        built = (site / page.relative_to(ROOT)).with_suffix(".html").read_text(encoding="utf-8")
        loaded = ["".join(found) for found in LOADED.findall(built)]
        assert loaded
        assert [each for each in loaded if "//" in each or each.startswith("/")] == []


@pytest.mark.parametrize(
    ("page", "name"),
    [
        ("bigactors", "bigactors"),
        ("bigraphs", "bigactors.bigraphs"),
        ("physical", "bigactors.physical"),
        ("plugin", "bigactors.adapters.plugin"),
        ("strategies", "bigactors.strategies"),
    ],
)
def test_each_public_name_has_its_docstring_and_source_by_its_installed_name(site, page, name):
    built = (site / "docs" / "reference" / "python" / f"{page}.html").read_text(encoding="utf-8")
    module = import_module(name)
    for each in module.__all__:
        signature, _, text = built.partition(f'id="{name}.{each}"')[2].partition("</dt>")
        while text.lstrip().startswith("<dt"):  # an overload
            further, _, text = text.partition("</dt>")
            signature += further
        assert text.lstrip().startswith("<dd><p>"), each
        if getattr(getattr(module, each), "__name__", "") == each:  # no constant, nor a type's other name
            assert 'href="../../../_modules/bigactors/' in signature, each
    assert {path.name for path in (site / "_modules").iterdir()} == {"bigactors", "index.html"}


def test_the_first_page_leads_to_the_landing_page(site):
    assert 'content="0; url=docs/README.html"' in (site / "index.html").read_text(encoding="utf-8")
    assert (site / "docs" / "README.html").is_file()


@pytest.mark.parametrize(
    ("words", "page"),
    [
        (["geojson"], "docs/how-to/geojson"),
        (["race"], "docs/tutorial/race"),
        (["race"], "docs/explanation/races"),
        (["connect", "vehicl"], "docs/how-to/connect-a-vehicle"),
        (["test", "rule"], "docs/how-to/own-rule"),
        (["bigraph", "alon"], "docs/how-to/bigraphs"),
        (["ci"], "docs/how-to/check-in-ci"),
        (["simul"], "docs/tutorial/flight"),
    ],
)
def test_what_a_reader_looks_for_is_in_the_title_of_its_page(index, words, page):
    number = index["docnames"].index(page)
    for word in words:
        found = index["titleterms"][word]
        assert number in (found if isinstance(found, list) else [found])
