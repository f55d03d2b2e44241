"""A file cache of the parser's tables: their computation takes longer than parsing a mission.

The file is plain data (JSON). The build of a wheel writes it. In a checkout the first start after a change writes it,
like Python's `.pyc` files. Tables of another grammar or another lark version are recomputed.
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
    """Return the parser of `make`, built from the tables in a file if these are current.

    Args:
        file: The file of the tables. If it is not writable, each start recomputes them.
        made_from: All inputs of the tables except lark's version.
        make: Constructs the parser.
        callbacks: The parser's options with functions, which the file cannot store.
    """
    identity = source_hash(f"{lark.__version__}\n{made_from}".encode()).hex()
    kept = _read(file)
    if kept.get("identity") == identity:
        load: Callable[..., Lark] = Lark._load_from_dict  # noqa: SLF001 - lark's standalone parsers do the same
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
    """Return a dictionary with its keys as numbers again: JSON keys are strings."""
    return {int(key): value for key, value in members.items()}


def write_tables(file: Path, tables: dict[str, Any]) -> None:
    """Write tables to a file atomically, if possible."""
    new = file.with_name(f".{file.name}.{os.getpid()}")
    try:
        new.write_text(json.dumps(tables, separators=(",", ":")), encoding="utf-8")
        new.replace(file)
    except OSError:
        with suppress(OSError):
            new.unlink()
