"""`bigactors detect`: slicks in a camera's frames, as polygons."""

from __future__ import annotations

from argparse import Namespace
from collections import Counter
from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Final

from bigactors.exits import Exit
from bigactors.mistakes import Mistake, unreadable
from bigactors.terminal import say, tell

if TYPE_CHECKING:
    from adapters.camera.sea_projection import Frame
    from adapters.camera.slick import Patch
    from adapters.camera.votes import Region
    from physical import PhysicalProperty

DESCRIPTION: Final = """\
Find slicks on the sea in the frames of a camera, and print their polygons' areas and positions. SOURCE is a folder of
pictures with their poses (poses.csv), a video with its flight log (VIDEO.csv beside it), or a satellite's GeoTIFF."""

EXAMPLES: Final = (
    "bigactors detect flight1 --fov 62 --output spill.geojson --pictures looked",
    "bigactors detect flight1.mp4 --fov 78 --mount=-60 --every 0.5",
    "bigactors detect sentinel.tif --output spill.geojson",
)

ARGUMENTS: Final = """\
  source SOURCE as named  a folder, a video or a GeoTIFF
  --fov DEGREES = 60  the horizontal field of view
  --mount PITCH[,YAW[,ROLL]] = -90  the camera's angles to the vehicle, in degrees: -90 (default) looks down,
      --mount=-60 looks 30° forward of that
  --level  ignore the vehicle's roll and pitch: a gimbal holds the camera level
  --every SECONDS = 1  the time between two frames of a video
  --detector NAME as named  a function as MODULE:NAME, or the name of an installed detector (default: the detector
      of slicks)
  --kind KIND = OilSpill  the kind of the regions
  --name NAME = oilSpill  the name of the regions, before a number
  --output FILE  write the polygons as GeoJSON (RFC 7946)
  --pictures FOLDER  draw the regions over each frame, as PNG, into this folder"""


def run(options: Namespace) -> Exit:
    """Print the regions found in the frames, and the number of unusable frames by reason."""
    from adapters.camera.frames import frames_of
    from adapters.camera.region_detection import draw_patches, properties, sightings
    from adapters.camera.sea_projection import Lens
    from adapters.camera.slick import find_slicks
    from adapters.naming import NamingService
    from bigactors.installed_plugins import find_detector
    from physical import PhysicalError
    from physical.wordings import counted

    left_out: Counter[str] = Counter()
    try:
        pitch, yaw, roll = options.mount
        lens = Lens(options.fov, pitch, yaw, roll, options.level)
        detector = find_detector(options.detector) if options.detector else find_slicks
        taken = frames_of(Path(options.source), lens, left_out, options.every)

        def looked(frame: Frame) -> tuple[Patch, ...]:
            patches = detector(frame)
            if options.pictures:
                draw_patches(frame, patches, Path(options.pictures))
            return patches

        count, found = sightings(taken, left_out, looked)
        named = properties(found, options.kind, options.name, NamingService())
    except PhysicalError as error:
        raise Mistake(error.message, error.hint, error.where) from error
    except OSError as error:
        raise unreadable(str(error.filename or options.source), error) from error
    for what, region in zip(named, found, strict=True):
        say(" ".join(_words(what.entity, region)))
    say(f"{counted(count, 'frame')}, {counted(len(found), 'region')}")
    for reason, number in sorted(left_out.items()):
        say(f"{counted(number, 'frame')} left out: {reason}")
    if options.output:
        _write(named, options.output)
    return Exit.HOLDS


def _write(named: Sequence[PhysicalProperty], path: str) -> None:
    """Write regions as GeoJSON."""
    from bigactors.files import write_text
    from physical import write_geojson
    from physical.wordings import counted

    write_text(path, write_geojson(named))
    tell(f"{counted(len(named), 'feature')} written to {path}")


def _words(name: str, region: Region) -> Iterator[str]:
    from physical.shape import planar

    centre = planar(region.geometry).centroid
    yield f"{name}: {region.area:,.0f} m² around {centre.y / 1e7:.5f}, {centre.x / 1e7:.5f},"
    yield f"confidence {region.confidence:.2f}"
    if not region.whole:
        yield "(its border was not all in view)"
