"""Arguments that several commands share: the mission, its variations, and the exit codes."""

from typing import Final

from bigactors.arguments.parser import Parser
from bigactors.arguments.values import substitute

EXITS: Final = """\
exit codes:
  0  every property holds
  1  a property is violated; a trace does not replay; a file would be formatted
  2  a mistake in the input
  3  incomplete: a bound was reached or the machine failed; nothing is decided beyond it
  4  a bug of bigactors

With several missions the gravest code counts: 4, then 2, 1, 3, 0."""

MISSION: Final = "a mission file, or the name of a mission that ships with bigactors, such as oil_spill"


def varying(parser: Parser) -> None:
    """Add the options that replace parts of a mission."""
    group = parser.add_argument_group("replace what the mission says")
    group.add_argument(
        "--scheduler", choices=("program_order", "unordered", "fcfs"), help="which request is served next"
    )
    group.add_argument("--control", choices=("atomic", "timed"), help="whether control takes time")
    group.add_argument(
        "--source",
        metavar="NAME=FILE",
        action="append",
        default=[],
        type=substitute,
        help='read FILE where the mission has from "NAME"; may be repeated',
    )
