"""The build: a digest of all code that decides verdicts. Two builds of one version may decide differently."""

import hashlib
from functools import cache
from importlib import import_module
from pathlib import Path
from typing import Final

ROOMS: Final = ("bigraphs", "physical", "semantics", "specs", "checker")
CODE: Final = frozenset({".py", ".lark"})
"""File suffixes of code. The parser tables generated from the grammars don't count."""


@cache
def build_digest() -> str:
    """Return a digest of the names and contents of the code files, independent of the place of installation."""
    found = hashlib.sha256()
    for room in ROOMS:
        folder = Path(str(import_module(room).__file__)).parent
        for path in sorted(each for each in folder.rglob("*") if each.suffix in CODE):
            name = f"{room}/{path.relative_to(folder).as_posix()}"
            found.update(f"{name}\0{hashlib.sha256(path.read_bytes()).hexdigest()}\n".encode())
    return f"sha256:{found.hexdigest()}"
