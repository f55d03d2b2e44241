"""Arguments and paragraphs of help that several commands share, as parts of their sheets."""

from typing import Final

EXITS: Final = """\
exit codes:
  0  every property holds
  1  a property is violated; a trace does not replay; a file would be formatted
  2  a mistake in the input
  3  incomplete: a bound was reached or the machine failed; nothing is decided beyond it
  4  a bug of bigactors

For several missions the gravest code counts: 4, then 2, 1, 3, 0."""

MISSION: Final = "a mission file, or the name of a shipped mission, such as oil_spill"


SOURCE: Final = """\
  --source NAME=FILE  read FILE where the mission has from "NAME"; may be repeated"""

VARIATION: Final = f"""\
replace parts of the mission
  --scheduler {{program_order,unordered,fcfs}}  the order of requests (default: the mission's)
  --control {{atomic,timed}}  whether controls take time (default: the mission's)
{SOURCE}"""

FOREIGN_NAMES: Final = """\
  --name IDENTITY=NAME  the mission's name of a source in another program's recording, such as mavlink:1=uav0 or
      mmsi:244660274=drifter0; may be repeated"""

MEMORY: Final = """\
  --max-memory SIZE  stop when the process or a worker takes more than SIZE bytes, such as 800M or 12G (default: no
      limit)"""

CHECKPOINTS: Final = """\
  --checkpoint DIR  save the search in DIR, regularly and at the end, so that --resume can continue it
  --every SECONDS = 60  the time between two checkpoints
  --resume  continue from the checkpoint in DIR, if there is one"""

SPILL: Final = """\
  --spill DIR  when --max-memory is reached, move {} to unnamed temporary files in DIR, which should be on a disk"""

SPEAKER: Final = """\
  --by NAME  your name in the recording (default: your login)"""

SOCKET: Final = """\
  --socket FILE  the socket of the running mission (default: that of the only one)"""

SERVING: Final = """\
  --tiles FILE  a background map, as PMTiles: vector tiles of the Protomaps schema, or pictures (default: none)
  --tls CERT KEY  serve the console by HTTPS, with this certificate and its key (PEM)
  --insecure  let other machines reach the console without --tls: the whole network can then read its token"""
