"""`bigactors world`: the bigraph of a world from files."""

from argparse import Namespace
from pathlib import Path
from typing import Final

from bigactors.exits import Exit
from bigactors.terminal import say, tell

DESCRIPTION: Final = """\
Read GeoJSON, waypoint files, plans of QGroundControl and AIS recordings into one world, print its bigraph A(P),
and count the data that was left out, by kind."""

EXAMPLES: Final = (
    "bigactors world harbour.geojson --output harbour.svg",
    "bigactors world harbour.geojson vessels.nmea --at 2020-04-07T21:42:00Z --kinds Vessel,Harbour",
    "bigactors world vessels.nmea --within 52.83,5.66,52.87,5.72",
)

ARGUMENTS: Final = """\
  files FILE...  places (.geojson, .json, .waypoints, .plan), or AIS (NMEA)
  --at TIME  the moment of a recording that is shown, such as 2020-04-07T21:42:00Z (default: its end)
  --within SOUTH,WEST,NORTH,EAST  take only entities in this box, in degrees (default: all)
  --kinds KIND,...  take only entities of these kinds (default: all)
  --output FILE  also draw a picture (.svg or .png), or write GeoJSON for other programs (.geojson, RFC 7946)"""


GEOJSON = (".geojson", ".json")


def run(options: Namespace) -> Exit:
    """Print the world, draw it on request, and count the data that could not be read."""
    from bigactors.files import write_text
    from bigactors.picture_files import draw
    from bigactors.worlds import census, configuration_of, read_world
    from bigraphs import draw_text
    from physical import write_geojson
    from physical.place_files import PLACES
    from physical.wordings import counted

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
            f"warning: {conflict}; entities in both are put into the smaller one, and a mission would refuse them"
        )
    if options.output and Path(options.output).suffix.lower() in GEOJSON:
        write_text(options.output, write_geojson(world.properties))
        tell(f"{counted(len(world.properties), 'feature')} written to {options.output}")
    elif options.output:
        draw(configuration, options.output, title=", ".join(Path(path).name for path in options.files))
        tell(f"picture written to {options.output}")
    return Exit.HOLDS
