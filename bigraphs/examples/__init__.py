"""Systems that ship: known calculi and small worlds as `.big` files, each with a header that explains it."""

from __future__ import annotations

from pathlib import Path
from typing import Final

from bigraphs.errors import BigraphError

_HERE: Final = Path(__file__).parent


def example_names() -> tuple[str, ...]:
    """Return the names of the examples, sorted."""
    return tuple(sorted(path.stem for path in _HERE.glob("*.big")))


def example_text(name: str) -> str:
    """Return the text of an example; raises BigraphError for an unknown name."""
    if name not in example_names():
        raise BigraphError("name", f"there is no example '{name}'", f"there are {', '.join(example_names())}")
    return (_HERE / f"{name}.big").read_text(encoding="utf-8")
