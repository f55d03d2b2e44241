"""`bigactors detect`: slicks in a camera's frames, as polygons."""

from argparse import Namespace
from collections import Counter
from collections.abc import Iterator
from pathlib import Path

from adapters.camera.frames import frames_of
from adapters.camera.overlay import draw_patches
from adapters.camera.sightings import properties, sightings
from adapters.camera.slick import Patch, find_slicks
from adapters.camera.view import Frame, Lens
from adapters.camera.votes import Region
from adapters.naming import NamingService
from bigactors.exits import Exit
from bigactors.files import write_text
from bigactors.installed_plugins import find_detector
from bigactors.mistakes import Mistake, unreadable
from bigactors.terminal import say, tell
from physical import PhysicalError, write_geojson
from physical.shape import planar
from physical.wordings import counted


def run(options: Namespace) -> Exit:
    """Print the regions found in the frames, and the number of unusable frames by reason."""
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
        write_text(options.output, write_geojson(named))
        tell(f"{counted(len(named), 'feature')} written to {options.output}")
    return Exit.HOLDS


def _words(name: str, region: Region) -> Iterator[str]:
    centre = planar(region.geometry).centroid
    yield f"{name}: {region.area:,.0f} m² around {centre.y / 1e7:.5f}, {centre.x / 1e7:.5f},"
    yield f"confidence {region.confidence:.2f}"
    if not region.whole:
        yield "(its border was not all in view)"
