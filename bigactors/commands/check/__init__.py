"""`bigactors check`: the verdicts on missions."""

import argparse
from argparse import Namespace
from typing import Final

from bigactors.arguments.options import (
    MISSION,
    add_checkpoints,
    add_memory,
    add_spill,
    add_variation,
)
from bigactors.arguments.parser import Parser
from bigactors.arguments.values import FORMATS, at_least_one, named, output, reductions, seconds
from bigactors.exits import Exit

DESCRIPTION: Final = """\
Explore every interleaving of a mission and decide its properties, with a shortest trace for each that fails and a
witness for each that holds. Ctrl-C, SIGTERM and SIGHUP end it within seconds with the results so far; a second one
ends it at once. `bigactors --help` lists the exit codes."""

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
        help="check now, and at every save of a mission or a file of its world; print the changes first; "
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
        help="print at most N different violations of each property, and count the others (default: 5)",
    )
    group.add_argument(
        "--times",
        action="store_true",
        help="print the earliest and the latest moment at which each flight of a mission with timing begins and ends, "
        "and each time property is first true",
    )
    group.add_argument(
        "--ways",
        action="store_true",
        help="print the way of each flight leg by leg: its length, its distance from each place that a property about "
        "ways names, and the least distance of two vehicles that may be under way together",
    )
    group.add_argument("--no-traces", action="store_true", help="print a short report, without traces")
    group.add_argument(
        "--all",
        action="store_true",
        help="print whole traces and all warnings (default: about a screen of each mission)",
    )


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
        help="write the trace of each violation and witness into DIR: as text, JSON, pictures and a page that "
        "steps through it",
    )
    group.add_argument(
        "--verdict",
        metavar="FILE",
        type=named,
        help="write the verdict that `bigactors run` needs (docs/explanation/live.md); for one mission, with "
        "--control timed",
    )
    group.add_argument(
        "--sign",
        metavar="KEY",
        type=named,
        help="sign the verdict with the private key in KEY, for `bigactors run --trust KEY.pub` (`bigactors "
        "keygen KEY` makes both)",
    )


def _limits(parser: Parser) -> None:
    group = parser.add_argument_group("limits")
    group.add_argument(
        "--max-configurations",
        metavar="N",
        type=at_least_one,
        help="visit at most N configurations (default: 100,000,000, of about 30 bytes each, for each worker of "
        "--engine ray; 2,000,000 with --engine reference)",
    )
    group.add_argument(
        "--max-pending",
        metavar="N",
        type=at_least_one,
        help="go no further from a configuration in which a bigActor has more than N pending requests or messages "
        "(default: 64)",
    )
    group.add_argument(
        "--max-time",
        metavar="SECONDS",
        type=seconds,
        help="explore and decide for at most SECONDS; the fast engine explores in at most half (default: no limit)",
    )
    add_memory(group)


def _exploring(parser: Parser) -> None:
    group = parser.add_argument_group("exploring")
    group.add_argument(
        "--engine",
        choices=("reference", "fast", "ray"),
        help="the engine that explores; all reach the same verdicts (default: reference or fast, by the "
        "mission's size)",
    )
    group.add_argument(
        "--threads",
        metavar="N",
        type=at_least_one,
        help="let the fast engine use at most N threads, with the same results for every N (default: one a core; "
        "with --reduce por one)",
    )
    group.add_argument(
        "--clock",
        choices=("local", "global"),
        default="local",
        help="explore a mission with timing by zones of local time, one clock for each process, where that is sound "
        "(not under fcfs, with spawn or with --reduce symmetry), or by one clock for all (default: local)",
    )
    group.add_argument(
        "--reduce",
        metavar="NAMES",
        type=reductions,
        default=(),
        help="visit fewer configurations, where that is sound: por (partial-order reduction), symmetry, or "
        "por,symmetry (default: none; docs/explanation/reduction.md)",
    )


def _long_runs(parser: Parser) -> None:
    group = parser.add_argument_group("long runs, by --engine fast or ray")
    add_checkpoints(group)
    add_spill(group, "configurations")
    group.add_argument(
        "--paranoid",
        metavar="N",
        type=at_least_one,
        help="let the interpreter re-check the successors of N configurations, with --reduce also the reduction's "
        "assumptions, and stop at a difference (not with --engine ray; default: none)",
    )


def _several_processes(parser: Parser) -> None:
    group = parser.add_argument_group(
        "several processes or machines, by --engine ray (docs/how-to/cluster.md)"
    )
    group.add_argument(
        "--workers",
        metavar="N",
        type=at_least_one,
        help="the number of processes that share the search (default: 2)",
    )
    group.add_argument(
        "--address",
        metavar="ADDRESS",
        type=named,
        help="the Ray cluster to join, such as 10.0.0.1:6379, or auto for the one on this machine (default: a "
        "new one on this machine)",
    )


def run(options: Namespace) -> Exit:
    """Check missions, with `--watch` at each save; print the reports and write the requested files."""
    from bigactors.commands.check.check_report import check_and_report

    return check_and_report(options)
