"""The sources of a camera's frames in flight: a folder of new pictures, or a stream of video."""

from __future__ import annotations

import os
import re
import threading
import time
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Final, Protocol

from adapters.camera.frames import PICTURES, read_picture
from adapters.camera.libraries import opencv
from adapters.camera.sea_projection import Array

MOST_FILES: Final = 100
"""The most new pictures of a folder at one check: the newest."""

PAUSES: Final = (1.0, 2.0, 5.0, 10.0, 30.0)
"""Seconds before a lost stream is tried again; the last value is repeated."""

OPENS: Final = 10_000
"""Milliseconds for a stream to open, and for its next frame."""

STAMP: Final = re.compile(r"[0-9]{9,11}(\.[0-9]{1,6})?")
"""The name of a picture with its time: seconds since 1970."""


@dataclass(frozen=True, slots=True)
class Shot:
    """A picture: its time, its name, and a function that reads its pixels (raises PhysicalError, OSError)."""

    time: float
    name: str
    pixels: Callable[[], Array]


class Source(Protocol):
    """A source of shots."""

    def begin(self) -> None:
        """Begin to look for shots."""

    def taken(self, now: float) -> list[Shot]:
        """Return the new shots, in the order of time; `now` is the time of the run."""

    def trouble(self) -> str:
        """Return the reason why no shots come; an empty text if they do."""

    def end(self) -> None:
        """Release all resources."""


class Folder:
    """A folder of new pictures, best added by renaming: half written ones cannot be decoded."""

    def __init__(self, path: Path) -> None:
        self._path = path
        self._seen: dict[Path, int] = {}
        self._trouble = ""

    def begin(self) -> None:
        """Ignore the present pictures."""
        self._seen = self._listed()

    def taken(self, now: float) -> list[Shot]:
        """Return the new pictures, at the times in their names, else at the times of their files."""
        listed = self._listed()
        new = [path for path, written in listed.items() if self._seen.get(path) != written]
        self._seen = listed
        shots = [self._shot(path, listed[path], now) for path in new]
        return sorted(shots, key=lambda shot: shot.time)[-MOST_FILES:]

    def trouble(self) -> str:
        """Return the reason why the folder cannot be read, or an empty text."""
        return self._trouble

    def end(self) -> None:
        """Do nothing: no resource is open."""

    def _shot(self, path: Path, written: int, now: float) -> Shot:
        stamp = STAMP.fullmatch(path.stem)
        at = float(stamp[0]) if stamp else now - max(0.0, time.time() - written / 1e9)
        return Shot(at, path.name, lambda: read_picture(path))

    def _listed(self) -> dict[Path, int]:
        found: dict[Path, int] = {}
        try:
            with os.scandir(self._path) as entries:
                for entry in entries:
                    if Path(entry.name).suffix.lower() in PICTURES and not entry.name.startswith("."):
                        found[Path(entry.path)] = entry.stat().st_mtime_ns
        except OSError as error:
            self._trouble = f"{self._path}: {error.strerror}"
        else:
            self._trouble = ""
        return found


class Stream:
    """A stream of video (RTSP, HTTP, UDP, a device), read by a thread that keeps its newest frame only."""

    def __init__(self, address: str) -> None:
        self._address = address
        self._called = re.sub(r"//[^/@]*@", "//", address)  # without a password
        self._newest: tuple[float, Array] | None = None
        self._trouble = "not open yet"
        self._ends = threading.Event()
        self._number = 0

    def begin(self) -> None:
        """Begin to read."""
        opencv()
        threading.Thread(target=self._read, name=f"camera {self._called}", daemon=True).start()

    def taken(self, now: float) -> list[Shot]:
        """Return the newest frame, once."""
        newest, self._newest = self._newest, None
        if newest is None:
            return []
        grabbed, image = newest
        self._number += 1
        return [Shot(now - (time.monotonic() - grabbed), f"frame {self._number}", lambda: image)]

    def trouble(self) -> str:
        """Return the reason why no frames come, or an empty text."""
        return f"{self._called}: {self._trouble}" if self._trouble else ""

    def end(self) -> None:
        """Stop the thread."""
        self._ends.set()

    def _read(self) -> None:
        tries = 0
        while not self._ends.is_set():
            video = self._open()
            while not self._ends.is_set() and video.isOpened():
                good, image = video.read()
                if not good:
                    break
                self._newest, self._trouble, tries = (time.monotonic(), image), "", 0
            self._trouble = "lost, and tried again" if video.isOpened() else "it cannot be opened"
            video.release()
            self._ends.wait(PAUSES[min(tries, len(PAUSES) - 1)])
            tries += 1

    def _open(self) -> Any:
        cv2 = opencv()
        bounds = [cv2.CAP_PROP_OPEN_TIMEOUT_MSEC, OPENS, cv2.CAP_PROP_READ_TIMEOUT_MSEC, OPENS]
        return cv2.VideoCapture(self._address, cv2.CAP_ANY, bounds)


def source_of(address: str) -> Source:
    """Return the source at an address: `folder:PATH`, else one for OpenCV."""
    scheme, _, rest = address.partition(":")
    return Folder(Path(rest)) if scheme == "folder" else Stream(address)
