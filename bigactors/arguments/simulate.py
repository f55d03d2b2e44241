"""The arguments of `bigactors simulate`."""

from bigactors.arguments.common import MISSION, varying
from bigactors.arguments.parser import Command, Parser
from bigactors.arguments.values import at_least_zero, named


def fill(parser: Parser) -> None:
    """Add the arguments of `bigactors simulate`."""
    parser.add_argument("file", metavar="FILE", help=MISSION)
    parser.add_argument(
        "--seed",
        metavar="N",
        type=at_least_zero,
        default=0,
        help="which run: the same seed, the same run (default 0)",
    )
    parser.add_argument(
        "--steps",
        metavar="N",
        type=at_least_zero,
        default=100,
        help="take no more than N steps (default 100)",
    )
    parser.add_argument(
        "--choose",
        action="store_true",
        help="choose each step: what is enabled is listed, and answers are read from standard input (? says which)",
    )
    parser.add_argument(
        "--json",
        metavar="FILE",
        type=named,
        help="write the run as a trace in JSON; - for standard output, alone",
    )
    varying(parser)


COMMAND = Command(
    "simulate",
    "run a mission once",
    "Take one run of a mission, chosen by a seed or step by step, and print it in the paper's notation.",
    (
        "bigactors simulate oil_spill.mission --seed 7",
        "bigactors simulate oil_spill.mission --steps 20 --json run.json",
        "bigactors simulate oil_spill.mission --choose",
    ),
    fill,
)
