"""Frames from files: folders of pictures with their poses, videos with a flight log, satellite pictures."""

from __future__ import annotations

import math
from collections import Counter
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Final

import numpy as np

from adapters.camera.libraries import MOST_PIXELS, geotiffs, opencv
from adapters.camera.poses import pose_at, read_poses
from adapters.camera.sea_projection import Array, Frame, Lens, Pose, Projection
from physical import PhysicalError, open_file

PICTURES: Final = (".jpg", ".jpeg", ".png", ".bmp", ".webp")
GEOTIFFS: Final = (".tif", ".tiff")
VIDEOS: Final = (".mp4", ".avi", ".mov", ".mkv", ".ts")
LOG: Final = "poses.csv"
MOST_BYTES: Final = 64_000_000
MOST_FRAMES: Final = 20_000
SATELLITE_SIDE: Final = 2_048


@dataclass(frozen=True, slots=True)
class Referenced:
    """The view of a picture with its own georeference: the transform of its pixels, and their coordinate system.

    A pixel's coordinates are a·x + b·y + c and d·x + e·y + f of the six numbers.
    """

    affine: tuple[float, ...]
    crs: Any

    def ground(self, x: Array, y: Array) -> tuple[Array, Array]:
        """Return the latitudes and longitudes of pixels."""
        shape = np.shape(x)
        a, b, c, d, e, f = self.affine
        right, down = np.ravel(x) + 0.5, np.ravel(y) + 0.5
        east, north = a * right + b * down + c, d * right + e * down + f
        longitude, latitude = geotiffs().warp.transform(self.crs, "EPSG:4326", east, north)
        return np.reshape(latitude, shape), np.reshape(longitude, shape)


def frames_of(path: Path, lens: Lens, left_out: Counter[str], every: float = 1.0) -> Iterator[Frame]:
    """Yield the frames of a folder, a video or a GeoTIFF; unusable frames are counted by their reason.

    Raises:
        PhysicalError: There is no such file, or no log of poses.
        OSError: A log cannot be read.
    """
    if path.is_dir():
        yield from _of_folder(path, lens, left_out)
    elif not path.is_file():
        raise PhysicalError(
            "frames", "there is no such file or folder", "see docs/how-to/camera.md", str(path)
        )
    elif path.suffix.lower() in GEOTIFFS:
        yield read_geotiff(path)
    elif path.suffix.lower() in VIDEOS:
        yield from _of_video(path, lens, left_out, every)
    else:
        hint = f"give a folder, a GeoTIFF ({', '.join(GEOTIFFS)}) or a video ({', '.join(VIDEOS)})"
        raise PhysicalError("frames", "this is no source of frames", hint, str(path))


def log_of(path: Path) -> Path:
    """Return the path of a source's poses: poses.csv in a folder, VIDEO.csv beside a video."""
    log = path / LOG if path.is_dir() else path.with_suffix(".csv")
    if not log.is_file():
        hint = "write one: file,time,latitude,longitude,altitude,roll,pitch,yaw (docs/how-to/camera.md)"
        raise PhysicalError("poses", f"there are no poses: {log.name} is missing", hint, str(path))
    return log


def frame_of(image: Array, pose: Pose, lens: Lens, name: str = "") -> Frame:
    """Return the frame of a picture that was taken from a pose; raises PhysicalError."""
    height, width = image.shape[:2]
    return Frame(image, pose.time, Projection(pose, lens, width, height), name)


def read_picture(path: Path) -> Array:
    """Return a picture's pixels; raises PhysicalError, OSError."""
    with open_file(path) as file:
        data = file.read(MOST_BYTES + 1)
    if len(data) > MOST_BYTES:
        raise PhysicalError("too-large", f"over {MOST_BYTES:,} bytes", "reduce it", str(path))
    cv2 = opencv()
    try:
        image = cv2.imdecode(np.frombuffer(data, np.uint8), cv2.IMREAD_COLOR) if data else None
    except cv2.error:
        image = None
    if image is None:
        raise PhysicalError(
            "picture",
            "this is no picture that can be decoded",
            f"of at most {MOST_PIXELS:,} pixels",
            str(path),
        )
    return image


def read_geotiff(path: Path) -> Frame:
    """Return a satellite's picture as a frame; raises PhysicalError."""
    rasterio = geotiffs()
    try:
        with rasterio.open(path, driver="GTiff") as picture:
            if picture.crs is None:
                raise PhysicalError("georeference", "it has no georeference", "give a GeoTIFF", str(path))
            part = max(1.0, max(picture.width, picture.height) / SATELLITE_SIDE)
            size = math.ceil(picture.height / part), math.ceil(picture.width / part)
            bands = (3, 2, 1) if picture.count >= 3 else (1, 1, 1)
            pixels = picture.read(bands, out_shape=(3, *size))
            wide, high = picture.width / size[1], picture.height / size[0]
            a, b, c, d, e, f = picture.transform[:6]
            view = Referenced((a * wide, b * high, c, d * wide, e * high, f), picture.crs)
    except rasterio.errors.RasterioError as problem:
        raise PhysicalError("picture", str(problem), "give a GeoTIFF", str(path)) from None
    return Frame(_bytes(pixels), path.stat().st_mtime, view, path.name)


def _bytes(pixels: Array) -> Array:
    """Return rows of pixels in bytes: other numbers are stretched between their 1st and 99th percentile."""
    rows = np.ascontiguousarray(np.moveaxis(pixels, 0, -1))
    if rows.dtype == np.uint8:
        return rows
    low, high = np.nanpercentile(rows, (1, 99))
    scaled = np.nan_to_num((rows - low) / max(high - low, 1e-9) * 254 + 1)
    return np.clip(scaled, 0, 255).astype(np.uint8)


def _of_folder(path: Path, lens: Lens, left_out: Counter[str]) -> Iterator[Frame]:
    files = sorted(each for each in path.iterdir() if each.suffix.lower() in (*PICTURES, *GEOTIFFS))
    left_out["over the most frames"] += max(0, len(files) - MOST_FRAMES)
    poses: dict[str, Pose] = {}
    if any(each.suffix.lower() in PICTURES for each in files):
        poses = {name: pose for name, pose in read_poses(log_of(path)) if name}
    for file in files[:MOST_FRAMES]:
        try:
            if file.suffix.lower() in GEOTIFFS:
                yield read_geotiff(file)
            elif file.name not in poses:
                left_out["without a pose"] += 1
            else:
                yield frame_of(read_picture(file), poses[file.name], lens, file.name)
        except (PhysicalError, OSError) as problem:
            if isinstance(problem, PhysicalError) and problem.code == "camera-extra":
                raise
            left_out[f"unreadable: {problem}".partition("\n")[0][:200]] += 1
    left_out += Counter()  # drops zeros


def _of_video(path: Path, lens: Lens, left_out: Counter[str], every: float) -> Iterator[Frame]:
    cv2 = opencv()
    poses = [pose for _, pose in read_poses(log_of(path))]
    video = cv2.VideoCapture(str(path))
    rate = video.get(cv2.CAP_PROP_FPS)
    if not video.isOpened() or not 0.1 <= rate <= 1_000:
        raise PhysicalError("video", "this is no video that can be decoded", "try another format", str(path))
    step = max(1, round(every * rate))
    try:
        number = -1
        while number < MOST_FRAMES * step and video.grab():
            number += 1
            if number % step:
                continue
            decoded, image = video.retrieve()
            pose = pose_at(poses, number / rate)
            if not decoded or pose is None:
                left_out["unreadable" if not decoded else "without a pose"] += 1
                continue
            try:
                yield frame_of(image, pose, lens, f"{path.name} at {number / rate:.1f} s")
            except PhysicalError as problem:
                left_out[problem.message] += 1
    finally:
        video.release()
