"""The libraries of the extra `camera`, loaded when they are needed, with bounds on decoded sizes."""

from __future__ import annotations

import os
from functools import cache
from typing import Any, Final

from physical import PhysicalError
from physical.wordings import install_extra

MOST_PIXELS: Final = 100_000_000


@cache
def opencv() -> Any:
    """Return OpenCV; raises PhysicalError if it is not installed."""
    os.environ.setdefault("OPENCV_IO_MAX_IMAGE_PIXELS", str(MOST_PIXELS))  # read when it is loaded
    os.environ.setdefault("OPENCV_LOG_LEVEL", "SILENT")  # undecodable pictures are counted
    try:
        import cv2  # noqa: PLC0415 - an extra, and slow to load
    except ImportError as missing:
        raise PhysicalError("camera-extra", "cameras need OpenCV", install_extra("camera")) from missing
    cv2.setNumThreads(1)  # a run needs the other cores
    return cv2


@cache
def geotiffs() -> Any:
    """Return rasterio; raises PhysicalError if it is not installed."""
    try:
        import rasterio  # noqa: PLC0415 - an extra, and slow to load
        import rasterio.warp  # noqa: PLC0415
    except ImportError as missing:
        raise PhysicalError(
            "camera-extra", "satellite pictures need rasterio", install_extra("camera")
        ) from missing
    return rasterio
