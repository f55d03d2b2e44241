"""Logical-space programming: the public names of all packages, in one import.

>>> import bigactors
>>> report = bigactors.check(bigactors.load_mission("oil_spill"))
>>> report.verdicts["race_freedom"].outcome
<Outcome.HOLDS: 'holds'>

`__init__.pyi` lists the names and their modules, also for type checkers. Importing this package loads none of these
modules: the first use of a name loads its module.
"""

import ast
import sys
from importlib import import_module
from pathlib import Path
from typing import Any, Final

from bigactors.checkout import share_rooms

share_rooms()

__version__ = "0.3.0"

HOMES: Final = {
    alias.name: str(line.module)
    for line in ast.parse(Path(__file__).with_suffix(".pyi").read_text(encoding="utf-8")).body
    if isinstance(line, ast.ImportFrom)
    for alias in line.names
}
"""The module of each public name."""

__all__ = sorted(HOMES)  # noqa: PLE0605 - a sorted list of the names above


def __getattr__(name: str) -> Any:
    """Return a public name from its module."""
    if name not in HOMES:
        raise AttributeError(f"module 'bigactors' has no attribute '{name}'")
    return getattr(import_module(HOMES[name]), name)


def __dir__() -> list[str]:
    return sorted({*globals(), *__all__})


def _register_in_notebook() -> None:
    """In a running IPython, show configurations, traces and reports as pictures and tables."""
    shell = getattr(sys.modules.get("IPython"), "get_ipython", lambda: None)()
    if shell is not None:
        import_module("bigactors.notebook").register(shell.display_formatter)


_register_in_notebook()
