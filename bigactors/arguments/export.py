"""The arguments of `bigactors export`."""

from typing import Final

from bigactors.arguments.common import MISSION, varying
from bigactors.arguments.parser import Command, Parser
from bigactors.arguments.values import named

DESCRIPTION: Final = """\
Write what can be reached of a mission with times as a timed automaton, for a second opinion: --format tchecker
for TChecker (github.com/ticktac-project/tchecker), --format uppaal for UPPAAL (uppaal.org), as XML. With
--property, the name of a deadline or `endurance`, an observer is part of it: the location `wrong` is reachable
exactly if the property is violated.

  tck-reach -a covreach -l wrong patrol.tck     REACHABLE true: it is violated
  verifyta patrol.xml                           Formula is satisfied: it holds"""


def fill(parser: Parser) -> None:
    """Add the arguments of `bigactors export`."""
    parser.add_argument("file", metavar="FILE", help=MISSION)
    parser.add_argument(
        "--format", choices=("tchecker", "uppaal"), required=True, help="the language that it is written in"
    )
    parser.add_argument(
        "--property", metavar="NAME", type=named, help="label where this deadline, or endurance, is violated"
    )
    parser.add_argument(
        "--out", metavar="FILE", type=named, default="-", help="where it goes (default -, standard output)"
    )
    varying(parser)


COMMAND = Command(
    "export",
    "write a mission with times as a timed automaton",
    DESCRIPTION,
    (
        "bigactors export endurance --format tchecker --out endurance.tck",
        "bigactors export broken_endurance --format uppaal --property endurance --out broken_endurance.xml",
    ),
    fill,
)
