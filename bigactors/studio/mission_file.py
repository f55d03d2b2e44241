"""The file of the mission that is edited: other editors may save it too."""

from __future__ import annotations

import hashlib
import re
from base64 import b64decode
from dataclasses import dataclass
from pathlib import Path
from shutil import copyfile
from typing import Final

from bigactors.commands.new import new_mission
from bigactors.files import check_writable, read_bytes, write_text
from bigactors.mistakes import Mistake, unreadable
from bigactors.studio.page_requests import MOST_TEXT
from physical import PhysicalError, read_places
from physical.place_files import PLACES
from specs.missions import shipped_missions

NAME: Final = re.compile(r"[^\W_][\w .-]{0,99}")
"""The name of a dropped file: no path leads elsewhere, and no file is hidden."""


class Overwritten(Exception):
    """The file has another content than the one that the page knows."""


@dataclass(frozen=True, slots=True)
class Saved:
    """A file's content.

    Attributes:
        text: Its text with line feeds alone.
        digest: The digest of its bytes.
        crlf: Whether its lines end as on Windows.
    """

    text: str
    digest: str
    crlf: bool


def read_mission(path: Path) -> Saved:
    """Return the content of a mission's file; raises Mistake."""
    data = read_bytes(str(path), 4 * MOST_TEXT)
    try:
        text = data.decode("utf-8")
    except UnicodeDecodeError as error:
        raise Mistake("this is no text in UTF-8", "save it as UTF-8", str(path)) from error
    if len(text) > MOST_TEXT:
        raise Mistake(f"the text is over {MOST_TEXT:,} characters", "divide the mission", str(path))
    plain = text.replace("\r\n", "\n").replace("\r", "\n")
    return Saved(plain, _digest(data), "\r\n" in text)


def is_empty(path: Path) -> bool:
    """Return whether a mission's file is missing or has no text yet; raises Mistake."""
    return not path.exists() or not read_mission(path).text.strip()


def save_mission(path: Path, text: str, over: str) -> Saved:
    """Replace a mission's text, with the line ends of the file.

    Raises:
        Overwritten: The file has another digest than `over`, which is not empty.
        Mistake: It cannot be written.
    """
    crlf = False
    if path.exists():
        there = read_mission(path)
        crlf = there.crlf
        if over and there.digest != over:
            raise Overwritten
    written = text.replace("\n", "\r\n") if crlf else text
    write_text(str(path), written)
    return Saved(text, _digest(written.encode()), crlf)


def begin_mission(folder: Path, name: str, source: str) -> Path:
    """Write a new mission, from the template or a shipped one with the files beside it; raises Mistake."""
    name = name.removesuffix(".mission")
    path = folder / f"{name}.mission"
    text = new_mission(name)
    check_writable(str(path))
    shipped = shipped_missions().get(source) if source else None
    if source and shipped is None:
        raise Mistake(f"no mission that ships is called {source:.60}", "choose one of the list")
    if shipped is not None:
        text = shipped.read_text(encoding="utf-8")
    try:
        with path.open("w" if path.exists() and is_empty(path) else "x", encoding="utf-8") as file:
            file.write(text)
        if shipped is not None:
            _copy_companions(shipped, folder)
    except FileExistsError:
        hint = "choose another name, or open it: bigactors studio FILE"
        raise Mistake("it exists already, and is left as it is", hint, str(path)) from None
    except OSError as error:
        raise unreadable(str(path), error) from error
    return path


def keep_places(folder: Path, name: str, content: str) -> str:
    """Write a file of places, given in base 64, beside the mission; return its name.

    Raises:
        Mistake: Its name or its content is none of a file of places, or another file has its name.
    """
    suffix = Path(name).suffix.lower()
    if suffix not in PLACES or not NAME.fullmatch(name):
        raise Mistake(f"'{name:.60}' is no file of places", f"drop a file that ends with {', '.join(PLACES)}")
    try:
        data = b64decode(content, validate=True)
    except ValueError as error:
        raise Mistake("the file has not arrived whole", "drop it again", name) from error
    try:
        if not read_places(suffix, data):
            raise Mistake("the file has no places", "a plan needs items with positions", name)
    except PhysicalError as error:
        raise Mistake(error.message, error.hint, f"{name}: {error.where}" if error.where else name) from error
    path = folder / name
    try:
        with path.open("xb") as file:
            file.write(data)
    except FileExistsError:
        if read_bytes(str(path), len(data)) != data:
            hint = "rename the file that you drop"
            raise Mistake("another file beside the mission has this name", hint, name) from None
    except OSError as error:
        raise unreadable(str(path), error) from error
    return name


def _copy_companions(shipped: Path, folder: Path) -> None:
    """Copy the recordings of a shipped mission, where there are none of these names."""
    for each in shipped.parent.glob(f"{shipped.stem}.*"):
        if each != shipped and not (folder / each.name).exists():
            copyfile(each, folder / each.name)


def _digest(data: bytes) -> str:
    return hashlib.sha256(data).hexdigest()
