"""The parser's tables, kept in a file: making them takes longer than parsing a mission.

The file is plain data (JSON). The build of a wheel writes it; in a checkout the first start after a change does, as
Python does with `.pyc` files. Tables of another grammar, or of another lark, are made anew.
"""

from __future__ import annotations

import json
import os
from collections.abc import Callable, Mapping
from contextlib import suppress
from importlib.util import source_hash
from pathlib import Path
from typing import Any

import lark
from lark import Lark
from lark.grammar import Rule
from lark.lexer import TerminalDef


def parser_with_tables(
    file: Path, made_from: str, make: Callable[[], Lark], callbacks: Mapping[str, Any]
) -> Lark:
    """Return the parser that `make` makes, by the tables in a file where they were made from the same.

    Args:
        file: Where the tables are kept. Where it cannot be written they are made at each start.
        made_from: All that the tables depend on, lark's version excepted.
        make: Makes the parser.
        callbacks: Those of the parser's options that are not kept: they do something.
    """
    identity = source_hash(f"{lark.__version__}\n{made_from}".encode()).hex()
    kept = _read(file)
    if kept.get("identity") == identity:
        load: Callable[..., Lark] = Lark._load_from_dict  # noqa: SLF001 - as its standalone parsers do
        tables = kept["data"]["parser"]["parser"]
        tables["tokens"] = _numbered(tables["tokens"])
        tables["states"] = _numbered({state: _numbered(row) for state, row in tables["states"].items()})
        return load(kept["data"], _numbered(kept["memo"]), **callbacks)
    made = make()
    data, memo = made.memo_serialize([TerminalDef, Rule])
    options = data["options"].items()
    data["options"] = {
        name: value for name, value in options if name not in callbacks and not callable(value)
    }
    write_tables(file, {"identity": identity, "data": data, "memo": memo})
    return made


def _read(file: Path) -> dict[str, Any]:
    try:
        kept = json.loads(file.read_bytes())
    except (OSError, ValueError):
        return {}
    return kept if isinstance(kept, dict) else {}


def _numbered(members: dict[str, Any]) -> dict[int, Any]:
    """Return a dictionary with the numbers that it had as keys: JSON has names only."""
    return {int(key): value for key, value in members.items()}


def write_tables(file: Path, tables: dict[str, Any]) -> None:
    """Put tables into a file at once, if that is possible."""
    new = file.with_name(f".{file.name}.{os.getpid()}")
    try:
        new.write_text(json.dumps(tables, separators=(",", ":")), encoding="utf-8")
        new.replace(file)
    except OSError:
        with suppress(OSError):
            new.unlink()
