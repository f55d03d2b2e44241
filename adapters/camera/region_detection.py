"""Frames in, regions out: the detector, the vote over all frames of a source, and pictures of what was found."""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Iterable
from dataclasses import dataclass, replace
from importlib import import_module
from pathlib import Path

import numpy as np

from adapters.camera.libraries import opencv
from adapters.camera.sea_projection import Frame
from adapters.camera.slick import Detector, Patch, find_slicks, sea_colour
from adapters.camera.votes import Region, TooWide, Votes, regions, vote
from adapters.naming import NamingService
from physical import PhysicalError, PhysicalProperty


@dataclass(frozen=True, slots=True)
class Looked:
    """The accumulated result of frames.

    Attributes:
        votes: Their votes on the grid's cells.
        sea: The colour of the sea in them.
        count: Their number.
    """

    votes: Votes | None = None
    sea: tuple[float, ...] | None = None
    count: int = 0

    @property
    def regions(self) -> tuple[Region, ...]:
        """The merged regions, the largest first."""
        return regions(self.votes)


def look(before: Looked, frame: Frame, detector: Detector) -> Looked:
    """Return the result with one more frame; raises TooWide."""
    frame = replace(frame, sea=before.sea)
    patches = detector(frame)
    return Looked(vote(before.votes, frame, patches), sea_colour(frame, patches), before.count + 1)


def sightings(
    frames: Iterable[Frame], left_out: Counter[str], detector: Detector = find_slicks
) -> tuple[int, tuple[Region, ...]]:
    """Return the number of used frames and their merged regions, the largest first; unusable frames are counted."""
    found = Looked()
    for frame in frames:
        try:
            found = look(found, frame, detector)
        except TooWide as problem:
            left_out[problem.message] += 1
    return found.count, found.regions


def properties(
    found: Iterable[Region], kind: str, name: str, naming: NamingService
) -> tuple[PhysicalProperty, ...]:
    """Return regions as physical properties of a kind, called name0, name1, ...; raises NameClash."""
    return tuple(
        PhysicalProperty(naming.name(f"name:{name}{number}", kind), kind, region.geometry, source="camera")
        for number, region in enumerate(found)
    )


def load_detector(word: str) -> Detector:
    """Return a detector of the user's own, MODULE:NAME; raises PhysicalError."""
    module, _, name = word.partition(":")
    try:
        detector: Detector = getattr(import_module(module), name)
    except (ImportError, AttributeError, ValueError) as error:
        hint = "write MODULE:NAME of a function that Python finds (PYTHONPATH)"
        raise PhysicalError("detector", f"there is no detector {word:.80}: {error}", hint) from None
    if not callable(detector):
        raise PhysicalError("detector", f"{word:.80} is no function", "it takes a Frame, and returns Patches")
    return detector


def draw_patches(frame: Frame, patches: Iterable[Patch], folder: Path) -> None:
    """Write a frame with its patches as a PNG of its name; raises OSError."""
    cv2 = opencv()
    folder.mkdir(parents=True, exist_ok=True)
    image = frame.image.copy()
    for patch in patches:
        corners = np.array(patch.corners).round().astype(np.int32)
        cv2.polylines(image, [corners], isClosed=True, color=(0, 255, 255), thickness=2)
        at = tuple(int(each) for each in corners.min(axis=0))
        cv2.putText(image, f"{patch.confidence:.2f}", at, cv2.FONT_HERSHEY_SIMPLEX, 0.6, (0, 255, 255), 2)
    name = re.sub(r"[^\w.-]+", "_", frame.name).removesuffix(".png")
    (folder / f"{name}.png").write_bytes(cv2.imencode(".png", image)[1])
