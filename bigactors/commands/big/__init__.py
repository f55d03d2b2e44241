"""`bigactors big`: systems of bigraphs, without missions."""

import argparse
from collections.abc import Callable
from typing import Final

from bigactors.arguments.options import add_checkpoints, add_memory, add_spill
from bigactors.arguments.parser import Parser
from bigactors.arguments.values import at_least_one, at_least_zero, named, seconds
from bigactors.exits import Exit

DESCRIPTION: Final = """\
Explore, simulate, check and draw bigraphical reactive systems, without missions, and write Markov models for PRISM and
Storm. A search that a limit stops is incomplete: exit code 3."""

EXAMPLES: Final = (
    "bigactors big full sensor_network --html network.html",
    "bigactors big full --storm network --max-states 100000 network.big",
    "bigactors big sim --seed 7 --until 20 network.big",
    "bigactors big sim --runs 10000 --plot network.svg network.big",
    "bigactors big check --never collision network.big",
    "bigactors big check --ltl 'request leads to answer' --ctl 'AG EF idle' network.big",
    "bigactors big check --storm 'Pmax=? [F delivered]' network.big",
)

FILE: Final = (
    "a system of bigraphs: .big (BigraphER's language), .bgm (BigMC's), or the name of a system that ships, such as "
    "mobile_ambients"
)

TASKS: Final = {
    "full": "explore every reachable state, and write the state space for people and other programs",
    "sim": "simulate one run, or many with statistics",
    "check": "decide predicates, and formulas of LTL and CTL, each with a run as evidence",
    "validate": "read the file, and print its contents",
    "show": "print a state, and draw it",
    "convert": "write the model in BigraphER's language",
}


def add_arguments(parser: Parser) -> None:
    """Add the arguments of `bigactors big`."""
    tasks = parser.add_subparsers(
        dest="task",
        metavar="TASK",
        title="tasks",
        prog=parser.prog,  # without it, argparse builds a help formatter
        parser_class=type(parser),
        required=True,
    )
    fillers: dict[str, Callable[[Parser], None]] = {
        "full": _full,
        "sim": _sim,
        "check": _check,
        "validate": lambda _: None,
        "show": _show,
        "convert": _convert,
    }
    for name, add in fillers.items():
        task = tasks.add_parser(
            name, help=TASKS[name], description=f"{TASKS[name][0].upper()}{TASKS[name][1:]}."
        )
        task.add_argument("file", metavar="FILE", help=FILE)
        task.add_argument(
            "--const",
            metavar="NAME=VALUE",
            action="append",
            default=[],
            type=constant,
            help="give a constant of the file another value; may be repeated",
        )
        add(task)


def _limits(task: Parser) -> None:
    task.add_argument(
        "--max-states",
        metavar="N",
        type=at_least_one,
        default=1_000_000,
        help="visit at most N states (default: 1,000,000)",
    )
    task.add_argument(
        "--max-time",
        metavar="SECONDS",
        type=seconds,
        help="explore for at most SECONDS (default: no limit)",
    )
    task.add_argument(
        "--threads",
        metavar="N",
        type=at_least_one,
        help="let at most N processes share the search after half a second; the results are the same for every N "
        "(default: one a core)",
    )
    add_memory(task)
    long = task.add_argument_group("long runs")
    add_checkpoints(long)
    add_spill(long, "states")


def _full(task: Parser) -> None:
    _limits(task)
    written = task.add_argument_group("files")
    for option, metavar, text in (
        ("--html", "FILE", "write the state space as a page; a click on a state shows its bigraph"),
        ("--svg", "FILE", "write the state space as a picture"),
        ("--dot", "FILE", "write the state space for Graphviz"),
        ("--json", "FILE", "write states and transitions as JSON; - for standard output, alone"),
        ("--prism", "PREFIX", "write PREFIX.tra, .lab, .csl, .srew and .trew for PRISM"),
        ("--storm", "PREFIX", "write PREFIX.tra, .lab, .srew and .trew for Storm"),
    ):
        written.add_argument(option, metavar=metavar, type=named, help=text)


def _sim(task: Parser) -> None:
    task.add_argument(
        "--seed",
        metavar="N",
        type=at_least_zero,
        default=0,
        help="the number that chooses the run; the same seed gives the same run (default: 0)",
    )
    _add_many_runs(task)
    task.add_argument(
        "--steps",
        metavar="N",
        type=at_least_zero,
        default=100,
        help="take at most N steps (default: 100)",
    )
    task.add_argument(
        "--until",
        metavar="TIME",
        type=seconds,
        help="in an sbrs, simulate up to TIME, in its own unit (default: no limit)",
    )
    task.add_argument(
        "--json",
        metavar="FILE",
        type=named,
        help="write the run or the statistics as JSON; - for standard output, alone",
    )


def _add_many_runs(task: Parser) -> None:
    task.add_argument(
        "--runs",
        metavar="N",
        type=at_least_one,
        help="simulate runs 0 to N-1 of the seed, and print in how many each predicate was true, and when first",
    )
    task.add_argument(
        "--run",
        metavar="N",
        type=at_least_zero,
        help="print run N of those of --runs, step by step",
    )
    task.add_argument(
        "--plot",
        metavar="FILE",
        type=named,
        help="with --runs: draw the share of runs in which each predicate has been true, over time (.svg or .png)",
    )


def _check(task: Parser) -> None:
    _limits(task)
    wanted = task.add_argument_group("claims (default: the properties in the file)")
    for option, text in (
        ("--always", "the predicate holds in every state"),
        ("--never", "the predicate holds in no state"),
        ("--reachable", "the predicate holds in some state"),
    ):
        wanted.add_argument(
            option,
            metavar="PREDICATE",
            action="append",
            default=[],
            type=named,
            help=f"{text}; may be repeated",
        )
    for option, text in (
        ("--ltl", "a formula of predicates that holds on every run, such as 'p leads to q'"),
        ("--ctl", "a formula of predicates that holds on the tree of runs, such as 'AG EF p'"),
    ):
        wanted.add_argument(
            option, metavar="FORMULA", action="append", default=[], help=f"{text}; may be repeated"
        )
    wanted.add_argument(
        "--storm",
        metavar="FORMULA",
        action="append",
        default=[],
        help="a probability, reward or time for Storm to compute, such as 'Pmax=? [F goal]', with the likeliest "
        "run; or a bound on one, such as 'P>=0.9 [F goal]'; needs the extra [storm]; may be repeated",
    )
    wanted.add_argument("--no-deadlock", action="store_true", help="every state has a next state")
    task.add_argument(
        "--json", metavar="FILE", type=named, help="write the verdicts as JSON; - for standard output, alone"
    )


def _show(task: Parser) -> None:
    task.add_argument(
        "--state",
        metavar="N",
        type=at_least_zero,
        default=0,
        help="the number of the state, as the task full counts (default: 0)",
    )
    task.add_argument("--output", metavar="FILE", type=named, help="draw the state (.svg or .png)")


def _convert(task: Parser) -> None:
    task.add_argument(
        "output", metavar="OUT", type=named, help="the .big file that is written; - for standard output"
    )
    task.add_argument(
        "--from",
        dest="source",
        choices=("big", "bgm"),
        help="the language of FILE, BigraphER's or BigMC's (default: by its suffix)",
    )


def constant(word: str) -> tuple[str, int | float | str]:
    """Parse NAME=VALUE; a numeric value becomes a number.

    >>> constant("t=0.5"), constant("n=3"), constant("who=ann")
    (('t', 0.5), ('n', 3), ('who', 'ann'))
    """
    name, equals, value = word.partition("=")
    if not (name and equals and value):
        raise argparse.ArgumentTypeError(f"'{word:.60}' is not NAME=VALUE, such as n=3")
    for kind in (int, float):
        try:
            return name, kind(value)
        except ValueError:
            continue
    return name, value


def run(options: argparse.Namespace) -> Exit:
    """Run one of the tasks."""
    from bigactors.commands.big.tasks import run_task

    return run_task(options)
