"""Systems from files; the suffix determines the language."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path

from bigraphs.errors import BigraphError, NotationError
from bigraphs.notation.big.systems import read_system
from bigraphs.notation.bounded_parsing import MAX_BYTES
from bigraphs.system import System, Value


def load_system(path: Path | str, *, constants: Mapping[str, Value] | None = None) -> System:
    """Return the system of a `.big` or `.bgm` file.

    Raises:
        NotationError: For mistakes in the text.
        BigraphError: For an unreadable file, and for any other suffix.
    """
    return system_in(text_of(path), path, constants=constants)


def text_of(path: Path | str) -> str:
    """Return the text of a `.big` or `.bgm` file.

    Raises:
        NotationError: For a text that is too long.
        BigraphError: For an unreadable file, and for any other suffix.
    """
    file = Path(path)
    if file.suffix not in (".big", ".bgm") and file.exists():
        raise BigraphError("file", f"'{file.name}' is neither a .big nor a .bgm file", "name it so")
    return read_text(file)


def system_in(text: str, path: Path | str, *, constants: Mapping[str, Value] | None = None) -> System:
    """Return the system of the text of a file; raises NotationError for mistakes in it."""
    if Path(path).suffix == ".big":
        return read_system(text, constants=constants)
    if constants:
        raise BigraphError("file", "a .bgm file has no constants", "leave them out")
    from bigraphs.notation.bgm.systems import read_bgm  # noqa: PLC0415 - most files are .big

    return read_bgm(text)


def read_text(file: Path) -> str:
    """Return the text of a file; raises an error instead of reading beyond the maximum length of a text."""
    if file.exists() and not file.is_file():
        raise BigraphError("file", f"'{file}' is a folder, a pipe or a device", "give a file")
    try:
        with file.open("rb") as opened:
            content = opened.read(MAX_BYTES + 1)
        text = content.decode("utf-8")
    except OSError as error:
        raise BigraphError("file", f"'{file}' cannot be read: {error.strerror}") from None
    except UnicodeDecodeError as error:
        raise BigraphError(
            "file", f"'{file}' is not UTF-8 at byte {error.start}", "save it as UTF-8"
        ) from None
    if len(content) > MAX_BYTES:
        raise NotationError("too-long", "the text is longer than 1 MB", text, 0)
    return text
