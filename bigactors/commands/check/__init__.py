"""`bigactors check`: the verdicts on missions."""

import argparse
from argparse import Namespace
from typing import Final

from bigactors.arguments.options import EXITS, MISSION, add_variation
from bigactors.arguments.parser import Parser
from bigactors.arguments.values import FORMATS, at_least_one, named, output, reductions, seconds, size
from bigactors.exits import Exit

DESCRIPTION: Final = f"""\
Explore every interleaving of a mission and decide its properties, with a shortest trace for each that fails and a
witness for each that holds. Ctrl-C, SIGTERM and SIGHUP end it within seconds with what was found so far; a second one
ends it at once.

{EXITS}"""

EXAMPLES: Final = (
    "bigactors check oil_spill.mission",
    "bigactors check --watch oil_spill.mission",
    "bigactors check --no-traces specs/missions/*.mission",
    "bigactors check --json - oil_spill.mission | jq '.properties[] | [.name, .verdict]'",
    "bigactors check --trace traces --max-time 60 handover.mission",
    "bigactors check --output junit:report.xml --output sarif:report.sarif specs/missions/*.mission",
)


def add_arguments(parser: Parser) -> None:
    """Add the arguments of `bigactors check`."""
    parser.add_argument("files", nargs="+", metavar="FILE", help=MISSION)
    parser.add_argument(
        "--watch",
        action="store_true",
        help="check now, and again whenever a mission or a file of its world is saved; what has changed is said first; "
        "Ctrl-C ends it with the exit code of the last check",
    )
    _report(parser)
    _limits(parser)
    _exploring(parser)
    _long_runs(parser)
    _several_processes(parser)
    add_variation(parser)


def _report(parser: Parser) -> None:
    group = parser.add_argument_group("report")
    _add_files(group)
    group.add_argument(
        "--violations",
        metavar="N",
        type=at_least_one,
        default=5,
        help="show at most N different violations of each property, each with a shortest trace; count the others "
        "(default 5)",
    )
    group.add_argument(
        "--times",
        action="store_true",
        help="say how long each flight of a mission with timing takes, when it begins and ends, and when each time "
        "property is first true: from the earliest moment to the latest; every tick is counted for it",
    )
    group.add_argument("--no-traces", action="store_true", help="print no traces: a short report")


def _add_files(group: argparse._ActionsContainer) -> None:
    group.add_argument(
        "--json",
        metavar="FILE",
        type=named,
        help="write the report as JSON (docs/reference/json.md); - for standard output, alone",
    )
    group.add_argument(
        "--output",
        metavar="FORMAT:FILE",
        action="append",
        default=[],
        type=output,
        help=f"write the report for other programs (docs/reference/output.md): {', '.join(FORMATS)}; - as FILE for "
        "standard output, alone; may be repeated",
    )
    group.add_argument(
        "--trace",
        metavar="DIR",
        type=named,
        help="write the trace of each violation and witness into DIR: as text, as JSON, as pictures and as a page that "
        "steps through it",
    )
    group.add_argument(
        "--verdict",
        metavar="FILE",
        type=named,
        help="write the verdict that `run` needs (docs/explanation/live.md); of one mission, with --control timed",
    )
    group.add_argument(
        "--sign",
        metavar="KEY",
        type=named,
        help="sign the verdict with the key in KEY, for `run --trust KEY.pub` (bigactors keygen KEY makes a pair)",
    )


def _limits(parser: Parser) -> None:
    group = parser.add_argument_group("limits")
    group.add_argument(
        "--max-configurations",
        metavar="N",
        type=at_least_one,
        help="visit no more than N configurations (default 100,000,000, of which each takes some 30 bytes, for each "
        "worker of --engine ray; 2,000,000 with --engine reference)",
    )
    group.add_argument(
        "--max-pending",
        metavar="N",
        type=at_least_one,
        help="follow no configuration in which one bigActor has more than N requests or messages pending "
        "(default: 64)",
    )
    group.add_argument(
        "--max-time",
        metavar="SECONDS",
        type=seconds,
        help="explore and decide for at most SECONDS; the fast explorer takes at most half (default: no limit)",
    )
    group.add_argument(
        "--max-memory",
        metavar="SIZE",
        type=size,
        help="stop when the process, or one of its workers, takes more memory, such as 800M or 12G (default: no limit)",
    )


def _exploring(parser: Parser) -> None:
    group = parser.add_argument_group("exploring")
    group.add_argument(
        "--engine",
        choices=("reference", "fast", "ray"),
        help="the engine that explores; verdicts are the same (default: reference or fast, whichever is quicker for "
        "the mission's size)",
    )
    group.add_argument(
        "--threads",
        metavar="N",
        type=at_least_one,
        help="let the fast explorer use at most N threads; what it finds is the same for every N (default: as many as "
        "there are cores; with --reduce one)",
    )
    group.add_argument(
        "--reduce",
        metavar="NAMES",
        type=reductions,
        default=(),
        help="visit less, where that is sound: por (partial-order reduction), symmetry, or por,symmetry "
        "(docs/explanation/reduction.md)",
    )


def _long_runs(parser: Parser) -> None:
    group = parser.add_argument_group("long runs, by --engine fast or ray")
    group.add_argument(
        "--checkpoint",
        metavar="DIR",
        type=named,
        help="save in DIR, every minute and at the end, what is needed to go on after the process was killed",
    )
    group.add_argument(
        "--every", metavar="SECONDS", type=seconds, default=60.0, help="between two checkpoints (default 60)"
    )
    group.add_argument(
        "--resume", action="store_true", help="go on from the checkpoint in DIR, if there is one"
    )
    group.add_argument(
        "--spill",
        metavar="DIR",
        type=named,
        help="when --max-memory is reached, move configurations to files in DIR, which should be on a disk; the files "
        "are unnamed and deleted at the end",
    )
    group.add_argument(
        "--paranoid",
        metavar="N",
        type=at_least_one,
        help="let the interpreter re-check the successors of N configurations, and stop at a difference; with "
        "--reduce, also check what the reduction assumes of rules and properties there (not with --engine ray)",
    )


def _several_processes(parser: Parser) -> None:
    group = parser.add_argument_group(
        "several processes or machines, by --engine ray (docs/how-to/cluster.md)"
    )
    group.add_argument(
        "--workers", metavar="N", type=at_least_one, help="how many processes share the rows (default 2)"
    )
    group.add_argument(
        "--address",
        metavar="ADDRESS",
        type=named,
        help="the Ray cluster to join, such as 10.0.0.1:6379, or auto for the one on this machine (default: a new one "
        "on this machine)",
    )


def run(options: Namespace) -> Exit:
    """Check missions, with `--watch` at each save; print the reports and write the requested files."""
    from bigactors.commands.check.report import check_and_report

    return check_and_report(options)
