"""`bigactors world`: the bigraph of a world from files."""

from argparse import Namespace
from pathlib import Path

from bigactors.drawings import draw
from bigactors.exits import Exit
from bigactors.files import write_text
from bigactors.terminal import say, tell
from bigactors.worlds import census, configuration_of, read_world
from bigraphs import draw_text
from physical import write_geojson
from physical.place_files import PLACES
from physical.wordings import counted

GEOJSON = (".geojson", ".json")


def run(options: Namespace) -> Exit:
    """Print the world, draw it on request, and count the data that could not be read."""
    kinds = [kind.strip() for kind in (options.kinds or "").split(",") if kind.strip()]
    world = read_world(options.files, options.at, options.within, kinds)
    configuration = configuration_of(world)
    say(draw_text(configuration.structure.logical.bigraph()))
    say(census(world))
    for path, tally in world.accounts:
        for row in tally.rows() if tally.missing() or Path(path).suffix.lower() not in PLACES else ():
            say(f"{path}: {row}")
    for doubt in world.doubts:
        tell(f"warning: {doubt}")
    for conflict in world.conflicts:
        tell(
            f"warning: {conflict}; what is in both is put into the smaller one, and a mission would refuse them"
        )
    if options.output and Path(options.output).suffix.lower() in GEOJSON:
        write_text(options.output, write_geojson(world.properties))
        tell(f"{counted(len(world.properties), 'feature')} written to {options.output}")
    elif options.output:
        draw(configuration, options.output, title=", ".join(Path(path).name for path in options.files))
        tell(f"picture written to {options.output}")
    return Exit.HOLDS
