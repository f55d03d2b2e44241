"""What may be written on the command line: commands, arguments, options, and their help.

It imports nothing that takes time to load, so that help is there at once.
"""

import argparse
import math
import re
from collections.abc import Callable, Sequence
from datetime import UTC, datetime
from typing import Final, NoReturn

from bigactors import __version__
from bigactors.mistakes import Mistake, suggestion

EXITS: Final = """\
exit codes:
  0  every property holds
  1  a property is violated; a trace does not replay; a file would be formatted
  2  a mistake in the input
  3  incomplete: a bound was reached, nothing is decided beyond it
  4  a bug of bigactors

Of several missions the gravest counts: 4, then 2, 1, 3, 0."""

FORMATS: Final = ("json", "junit", "sarif", "github")
"""What `check --output` writes; `github` are the annotations of GitHub Actions."""

REDUCTIONS: Final = ("por", "symmetry")
"""What `check --reduce` takes."""

MISSION: Final = "a mission file, or the name of a mission that ships with bigactors, such as oil_spill"


class Parser(argparse.ArgumentParser):
    """Reports what is wrong as a Mistake; knows no abbreviations, and no colours but its user's."""

    def __init__(self, **settings: object) -> None:
        super().__init__(
            allow_abbrev=False,
            formatter_class=argparse.RawDescriptionHelpFormatter,
            **settings,  # type: ignore[arg-type]  # they are argparse's own
        )
        self.color = False  # since Python 3.14 help is coloured, and the pages of docs/ would be

    def error(self, message: str) -> NoReturn:
        """Raise what is wrong as a mistake of the user."""
        raise Mistake(message, f"{self.prog} --help shows what can be written")


def make_parser() -> tuple[Parser, dict[str, Parser]]:
    """Return the parser of the whole line, and those of the commands in the order of their help."""
    whole = Parser(
        prog="bigactors",
        description=(
            "Logical-space programming: check a mission in every interleaving, look at it, run it, replay it."
        ),
        epilog="bigactors COMMAND --help says more of each command, with examples.\n\n" + EXITS,
    )
    whole.add_argument("--version", action="version", version=f"bigactors {__version__}")
    commands = whole.add_subparsers(dest="command", metavar="COMMAND", title="commands", parser_class=Parser)
    made: dict[str, Parser] = {}
    for name, (summary, description, examples, fill) in COMMANDS.items():
        shown = "examples:\n" + "\n".join(f"  {example}" for example in examples)
        made[name] = commands.add_parser(name, help=summary, description=description, epilog=shown)
        fill(made[name])
    return whole, made


def parse_arguments(line: Sequence[str]) -> argparse.Namespace:
    """Return the options of a command line; raises Mistake, and SystemExit after --help and --version."""
    whole, commands = make_parser()
    if not line:
        whole.print_help()
        raise SystemExit(2)
    if not line[0].startswith("-") and line[0] not in commands:
        hint = suggestion(line[0], commands) or f"the commands are {', '.join(commands)}"
        raise Mistake(f"unknown command '{line[0]:.60}'", hint)
    options, unknown = whole.parse_known_args(_joined(line))
    if unknown:
        raise _unknown(unknown[0], commands.get(options.command, whole))
    return options


def _unknown(word: str, parser: Parser) -> Mistake:
    if not word.startswith("-"):
        return Mistake(f"'{word:.60}' is one argument too many", f"see {parser.prog} --help")
    known = parser.format_usage().replace("[", " ").replace("]", " ").split()
    hint = suggestion(word.partition("=")[0], (option for option in known if option.startswith("--")))
    return Mistake(f"unknown option '{word:.60}'", hint or f"see {parser.prog} --help")


def _joined(line: Sequence[str]) -> list[str]:
    """Join `--within` and a southern latitude, which would be taken for an option."""
    joined: list[str] = []
    for word in line:
        if joined and joined[-1] in ("--within", "--at") and re.match(r"-[\d.]", word):
            joined[-1] += f"={word}"
        else:
            joined.append(word)
    return joined


def _varying(parser: Parser) -> None:
    group = parser.add_argument_group("the mission, but for what it says of")
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
        help='read FILE where the mission says from "NAME"; may be repeated',
    )


# --- the commands ---------------------------------------------------------------------------------------------


def _check(parser: Parser) -> None:
    parser.add_argument("files", nargs="+", metavar="FILE", help=MISSION)
    parser.add_argument(
        "--json",
        metavar="FILE",
        type=named,
        help="write the report as JSON (docs/json.md); - for standard output, alone",
    )
    parser.add_argument(
        "--output",
        metavar="FORMAT:FILE",
        action="append",
        default=[],
        type=output,
        help=f"write the report for other programs (docs/output.md): {', '.join(FORMATS)}; - as FILE for standard "
        "output, alone; may be repeated",
    )
    parser.add_argument(
        "--max-configurations",
        metavar="N",
        type=at_least_one,
        default=2_000_000,
        help="visit no more than N configurations (default 2,000,000)",
    )
    parser.add_argument(
        "--max-time",
        metavar="SECONDS",
        type=seconds,
        help="explore no longer than SECONDS (default: no limit)",
    )
    parser.add_argument(
        "--trace",
        metavar="DIR",
        type=named,
        help="write the trace of each violation and witness into DIR: as text, as JSON and as pictures",
    )
    parser.add_argument("--no-traces", action="store_true", help="print no traces: a short report")
    parser.add_argument(
        "--engine",
        choices=("learned", "reference"),
        default="learned",
        help="how it explores; verdicts are the same",
    )
    parser.add_argument(
        "--reduce",
        metavar="NAMES",
        type=reductions,
        default=(),
        help="visit less, where that is sound: por (partial-order reduction), symmetry, or por,symmetry "
        "(docs/reduction.md)",
    )
    _varying(parser)


def _show(parser: Parser) -> None:
    parser.add_argument("file", nargs="?", metavar="FILE", help=f"{MISSION}; with --trace it may be left out")
    parser.add_argument(
        "--output",
        metavar="FILE",
        type=named,
        help="the picture, .svg or .png (default: the mission's name .svg, here)",
    )
    parser.add_argument(
        "--trace", metavar="TRACE", type=named, help="a trace in JSON, as check --trace and simulate write it"
    )
    parser.add_argument(
        "--step",
        metavar="K",
        type=at_least_zero,
        help="show c_K of the trace (default: its last configuration)",
    )
    _varying(parser)


def _simulate(parser: Parser) -> None:
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
        "--json",
        metavar="FILE",
        type=named,
        help="write the run as a trace in JSON; - for standard output, alone",
    )
    _varying(parser)


def _replay(parser: Parser) -> None:
    parser.add_argument(
        "trace", metavar="TRACE", help="a trace in JSON, as check --trace and simulate write it"
    )
    parser.add_argument(
        "--mission",
        metavar="FILE",
        type=named,
        help="replay it on this mission (default: the one that it names)",
    )
    _varying(parser)


def _world(parser: Parser) -> None:
    parser.add_argument(
        "files", nargs="+", metavar="FILE", help="GeoJSON (.geojson, .json), or an AIS recording (NMEA)"
    )
    parser.add_argument(
        "--at",
        metavar="TIME",
        type=time_of,
        help="as of a time of the recording, such as 2020-04-07T21:42:00Z",
    )
    parser.add_argument(
        "--within",
        metavar="SOUTH,WEST,NORTH,EAST",
        type=corners,
        help="only what is inside this box, in degrees",
    )
    parser.add_argument("--kinds", metavar="KIND,...", help="only entities of these kinds")
    parser.add_argument("--output", metavar="FILE", type=named, help="draw it too: a picture, .svg or .png")


def _explain(parser: Parser) -> None:
    parser.add_argument(
        "code", nargs="?", metavar="CODE", help="such as LS201; without it all codes are listed"
    )


def _fmt(parser: Parser) -> None:
    parser.add_argument("files", nargs="+", metavar="FILE", help="a mission file")
    way = parser.add_mutually_exclusive_group()
    way.add_argument("--check", action="store_true", help="write nothing; exit 1 if a file would change")
    way.add_argument("--stdout", action="store_true", help="print the result instead of writing it")


def _demo(parser: Parser) -> None:
    parser.add_argument(
        "--out", metavar="DIR", type=named, default="demo", help="where pictures and traces go (default demo)"
    )


CHECK: Final = f"""\
Explore every interleaving of a mission and decide its properties, with a shortest trace for each that
fails and a witness for each that holds. Ctrl-C ends the exploration with what was found so far.

{EXITS}"""

REPLAY: Final = """\
Run a trace again through the rules, step by step. A step that they do not allow ends it with exit code 1,
and what was enabled instead is shown."""

WORLD: Final = """\
Read what is where from GeoJSON files and AIS recordings together, print the bigraph A(P) that it makes,
and what of the recordings could not be used."""

DEMO: Final = """\
Check the oil spill of the paper and the watch over a harbour, print their verdicts, and write their
pictures and traces."""

Command = tuple[str, str, tuple[str, ...], Callable[[Parser], None]]

COMMANDS: Final[dict[str, Command]] = {
    "check": (
        "decide the properties of missions",
        "Explore every interleaving of a mission and decide its properties, with a shortest trace for each that\n"
        "fails and a witness for each that holds. Ctrl-C ends the exploration with what was found so far.\n\n"
        + EXITS,
        (
            "bigactors check oil_spill.mission",
            "bigactors check --no-traces specs/missions/*.mission",
            "bigactors check --json - oil_spill.mission | jq '.properties[] | [.name, .verdict]'",
            "bigactors check --trace traces --max-time 60 handover.mission",
            "bigactors check --output junit:report.xml --output sarif:report.sarif specs/missions/*.mission",
        ),
        _check,
    ),
    "show": (
        "print and draw a configuration",
        "Print the initial configuration of a mission, or any one of a trace; draw its bigraph beside the map.",
        (
            "bigactors show oil_spill.mission --output oil_spill.png",
            "bigactors show oil_spill.mission --trace run.json --step 3",
        ),
        _show,
    ),
    "simulate": (
        "run a mission once",
        "Take one run of a mission, chosen by a seed, and print it in the paper's notation.",
        (
            "bigactors simulate oil_spill.mission --seed 7",
            "bigactors simulate oil_spill.mission --steps 20 --json run.json",
        ),
        _simulate,
    ),
    "replay": (
        "run a trace again",
        REPLAY,
        (
            "bigactors replay traces/oil_spill/over_the_spill-witness/trace.json",
            "bigactors replay run.json --mission changed.mission",
        ),
        _replay,
    ),
    "world": (
        "print and draw the bigraph of a GeoJSON or AIS world",
        WORLD,
        (
            "bigactors world harbour.geojson --output harbour.svg",
            "bigactors world harbour.geojson vessels.nmea --at 2020-04-07T21:42:00Z --kinds Vessel,Harbour",
            "bigactors world vessels.nmea --within 52.83,5.66,52.87,5.72",
        ),
        _world,
    ),
    "explain": (
        "explain a diagnostic code",
        "Say what a diagnostic code means and what to do about it.",
        ("bigactors explain LS201", "bigactors explain"),
        _explain,
    ),
    "fmt": (
        "lay out mission files in the canonical way",
        "Rewrite mission files in the canonical layout, their comments kept. What does not parse is left alone.",
        ("bigactors fmt oil_spill.mission", "bigactors fmt --check specs/missions/*.mission"),
        _fmt,
    ),
    "demo": (
        "check two missions that ship, and draw them",
        DEMO,
        ("bigactors demo --out demo",),
        _demo,
    ),
}
"""For each command its summary, description, examples, and what adds its arguments."""


# --- values ---------------------------------------------------------------------------------------------------


def named(text: str) -> str:
    """Return the name of a file or folder, which is not empty."""
    if not text:
        raise argparse.ArgumentTypeError("the name of a file is missing")
    return text


def output(word: str) -> tuple[str, str]:
    """Read FORMAT:FILE.

    >>> output("sarif:report.sarif")
    ('sarif', 'report.sarif')
    """
    name, _, file = word.partition(":")
    if name not in FORMATS:
        near = suggestion(name, FORMATS)
        message = f"unknown format '{name:.40}': {near or 'the formats are ' + ', '.join(FORMATS)}"
        raise argparse.ArgumentTypeError(message)
    if not file:
        raise argparse.ArgumentTypeError(f"'{word:.60}' is not FORMAT:FILE, such as {name}:report")
    return name, file


def at_least_zero(text: str) -> int:
    """Return a whole number from 0."""
    if not re.fullmatch(r"[0-9]{1,12}", text):
        raise argparse.ArgumentTypeError(f"'{text:.40}' is not a whole number from 0")
    return int(text)


def substitute(word: str) -> tuple[str, str]:
    """Read NAME=FILE."""
    name, equals, file = word.partition("=")
    if not (name and equals and file):
        raise argparse.ArgumentTypeError(
            f"'{word:.60}' is not NAME=FILE, such as harbour_watch.nmea=marina.nmea"
        )
    return name, file


def reductions(text: str) -> tuple[str, ...]:
    """Read names of reductions, separated by commas."""
    names = tuple(dict.fromkeys(text.split(",")))
    for name in names:
        if name not in REDUCTIONS:
            raise argparse.ArgumentTypeError(f"'{name:.60}' is none of {', '.join(REDUCTIONS)}")
    return names


def at_least_one(text: str) -> int:
    """Return a whole number from 1; commas may divide its thousands."""
    plain = text.replace(",", "").replace("_", "")
    if not re.fullmatch(r"[0-9]{1,12}", plain) or not int(plain):
        raise argparse.ArgumentTypeError(f"'{text:.40}' is not a whole number from 1")
    return int(plain)


def seconds(text: str) -> float:
    """Return a number of seconds above 0."""
    value = _number(text)
    if value is None or value <= 0:
        raise argparse.ArgumentTypeError(f"'{text:.40}' is not a number of seconds above 0")
    return value


def time_of(text: str) -> float:
    """Return a time in seconds since 1970; without a zone it is UTC.

    >>> time_of("2020-04-07T21:42:00Z")
    1586295720.0
    """
    value = _number(text)
    if value is not None:
        return value
    try:
        time = datetime.fromisoformat(text)
        return (time if time.tzinfo else time.replace(tzinfo=UTC)).timestamp()
    except (ValueError, OverflowError):
        message = f"'{text:.40}' is no time: write it as 2020-04-07T21:42:00Z, or in seconds since 1970"
        raise argparse.ArgumentTypeError(message) from None


def corners(text: str) -> tuple[float, float, float, float]:
    """Return the south, west, north and east of a box."""
    found = [value for part in text.split(",") if (value := _number(part)) is not None]
    if len(found) != 4 or text.count(",") != 3:
        message = (
            f"'{text:.60}' is no box: write SOUTH,WEST,NORTH,EAST in degrees, such as 52.83,5.66,52.87,5.72"
        )
        raise argparse.ArgumentTypeError(message)
    south, west, north, east = found
    return south, west, north, east


def _number(text: str) -> float | None:
    try:
        value = float(text)
    except ValueError:
        return None
    return value if math.isfinite(value) else None
