"""A map of a folder: its modules with their docstrings' first lines (`python -m bigactors.module_map FOLDER`)."""

import ast
import sys
from collections.abc import Iterator, Sequence
from pathlib import Path

from bigactors.terminal import safe_output, say

ROOT = Path(__file__).parents[1]


def module_map(folder: Path) -> Iterator[tuple[str, str]]:
    """Yield each module of a folder, and of the folders in it, with the first line of its docstring."""
    for path in sorted(folder.rglob("*.py")):
        text = ast.get_docstring(ast.parse(path.read_text(encoding="utf-8"))) or ""
        if text and path.name != "__main__.py":
            name = path.relative_to(folder).with_suffix("").as_posix().removesuffix("__init__")
            yield name or ".", text.splitlines()[0]


def main(line: Sequence[str] | None = None) -> int:
    """Print the map of a folder of the checkout; exit code 2 if there is none."""
    words = list(sys.argv[1:] if line is None else line)
    with safe_output():
        found = list(module_map(ROOT / words[0])) if len(words) == 1 else []
        if not found:
            say("usage: python -m bigactors.module_map FOLDER (such as checker/engines/fast)")
            return 2
        width = max(len(name) for name, _ in found)
        for name, sentence in found:
            say(f"{name:{width}}  {sentence}")
        return 0


if __name__ == "__main__":
    sys.exit(main())
