"""The arguments of `bigactors export`."""

from typing import Final

from bigactors.arguments.common import MISSION, varying
from bigactors.arguments.parser import Command, Parser
from bigactors.arguments.values import named

DESCRIPTION: Final = """\
Write what can be reached of a mission with times as a timed automaton, for a second opinion: --format tchecker
for TChecker (github.com/ticktac-project/tchecker). With --property, the name of a deadline or `endurance`, the
label `wrong` is reachable there exactly if the property is violated:

  tck-reach -a covreach -l wrong patrol.tck"""


def fill(parser: Parser) -> None:
    """Add the arguments of `bigactors export`."""
    parser.add_argument("file", metavar="FILE", help=MISSION)
    parser.add_argument(
        "--format", choices=("tchecker",), required=True, help="the language that it is written in"
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
        "bigactors export broken_endurance --format tchecker --property endurance",
    ),
    fill,
)
