"""The arguments of `bigactors fmt`."""

from bigactors.arguments.parser import Command, Parser


def fill(parser: Parser) -> None:
    """Add the arguments of `bigactors fmt`."""
    parser.add_argument("files", nargs="+", metavar="FILE", help="a mission file")
    way = parser.add_mutually_exclusive_group()
    way.add_argument("--check", action="store_true", help="write nothing; exit 1 if a file would change")
    way.add_argument("--stdout", action="store_true", help="print the result instead of writing it")


COMMAND = Command(
    "fmt",
    "lay out mission files in the canonical way",
    "Rewrite mission files in the canonical layout, their comments kept. What does not parse is left alone.",
    ("bigactors fmt oil_spill.mission", "bigactors fmt --check specs/missions/*.mission"),
    fill,
)
