"""The site of these pages: `make docs` builds it into site/, for a browser without a server too.

The pages are plain Markdown that a forge shows as well. So their order is in no directive: it is the order in which
the README.md of each folder lists them.
"""

import re
import sys
from pathlib import Path
from posixpath import dirname, join, normpath

from sphinx.application import Sphinx

import bigactors

sys.path.insert(0, str(Path(__file__).parent))

from lexers import LEXERS

project = "bigactors"
version = release = bigactors.__version__
extensions = ["myst_parser", "sphinx.ext.autodoc", "sphinx.ext.viewcode", "python_reference"]

# The sources are the repository, since pages link to files outside docs/.
include_patterns = [
    "ARCHITECTURE.md",
    "CHANGELOG.md",
    "CONTRIBUTING.md",
    "benchmarks/README.md",
    "docs/**.md",
    "docs/reference/python/*.txt",
]
source_suffix = {".md": "markdown", ".txt": "restructuredtext"}
root_doc = "docs/README"
html_additional_pages = {"index": "index.html"}
templates_path = ["templates"]

myst_heading_anchors = 6
nitpicky = True

# A word in backticks is a link where it is a public name.
default_role = "py:obj"
nitpick_ignore_regex = [("py:.*", ".*")]
autodoc_typehints_format = "short"
toc_object_entries_show_parents = "hide"
python_maximum_signature_line_length = 100

html_theme = "furo"
html_title = f"bigactors {version}"
html_copy_source = False
html_show_copyright = False
html_search_scorer = str(Path(__file__).with_name("scorer.js"))
html_theme_options = {"navigation_with_keys": True}
pygments_style = "friendly"
highlight_language = "python"

ENTRY = re.compile(r"^- \[[^\]]+\]\(([^)#:]+)\.(?:md|txt)\)", re.MULTILINE)
"""Where a README.md lists a page."""


def listed(docname: str, text: str) -> list[str]:
    """Return the pages that a README.md lists, by their names in the site."""
    return [normpath(join("/", dirname(docname), page)) for page in ENTRY.findall(text)]


def order(_app: Sphinx, docname: str, source: list[str]) -> None:
    """Give the pages that a README.md of docs/ lists their places in the navigation."""
    if docname.startswith("docs/") and docname.endswith("README"):
        source[0] += "\n```{toctree}\n:hidden:\n\n" + "\n".join(listed(docname, source[0])) + "\n```\n"


def setup(app: Sphinx) -> None:
    """Connect what orders the pages, and what colours their blocks."""
    app.connect("source-read", order)
    for language, lexer in LEXERS.items():
        app.add_lexer(language, lexer)
