"""The repository, as tests of the house read it: its rooms, their modules, and its pages."""

import ast
from functools import cache
from pathlib import Path

ROOT = Path(__file__).parents[1]
ROOMS = ("adapters", "bigactors", "bigraphs", "checker", "physical", "semantics", "specs")
PAGES = [
    *(ROOT / name for name in ("ARCHITECTURE.md", "CONTRIBUTING.md", "README.md")),
    *sorted((ROOT / "docs").rglob("*.md")),
]


def sources(rooms=ROOMS):
    """Return the modules of rooms."""
    paths = (path for room in rooms for path in sorted((ROOT / room).rglob("*.py")))
    return [path for path in paths if "node_modules" not in path.parts]


@cache
def parsed(path):
    return ast.parse(path.read_text(encoding="utf-8"))


def read(name):
    return (ROOT / name).read_text(encoding="utf-8")


def name_of(path):
    return path.relative_to(ROOT).as_posix()
