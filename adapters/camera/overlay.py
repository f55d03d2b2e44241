"""Found patches, drawn over their frame for people."""

from __future__ import annotations

import re
from collections.abc import Iterable
from pathlib import Path

import numpy as np

from adapters.camera.libraries import opencv
from adapters.camera.sea_projection import Frame
from adapters.camera.slick import Patch


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
