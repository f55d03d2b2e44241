"""`bigactors big`: systems of bigraphs, without missions."""

import argparse
from collections.abc import Callable
from typing import Final

from bigactors.arguments.parser import Parser
from bigactors.arguments.values import at_least_one, at_least_zero, named, seconds
from bigactors.exits import Exit

DESCRIPTION: Final = """\
Work with bigraphical reactive systems as such, without missions: all states that rules can reach, runs, predicates,
Markov models for PRISM and Storm, pictures. A search that was cut off is incomplete, exit code 3."""

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
    "a system of bigraphs: .big (BigraphER's language), .bgm (BigMC's), or the name of one that ships, such as "
    "mobile_ambients"
)

TASKS: Final = {
    "full": "every state that can be reached, written for people and for other programs",
    "sim": "one seeded run, or what many runs say",
    "check": "whether predicates hold always, never or ever, and formulas of LTL and CTL, with a run that shows it",
    "validate": "whether the file makes sense, and what is in it",
    "show": "a state, printed and drawn",
    "convert": "the same model in BigraphER's language",
}
_VERBS: Final = {"convert": "Write"}


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
            name, help=TASKS[name], description=f"{_VERBS.get(name, 'Find')} {TASKS[name]}."
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
        help="visit no more than N states (default 1,000,000)",
    )
    task.add_argument(
        "--max-time",
        metavar="SECONDS",
        type=seconds,
        help="explore no longer than SECONDS (default: no limit)",
    )
    task.add_argument(
        "--threads",
        metavar="N",
        type=at_least_one,
        help="let up to N processes share the work after half a second; what is found is the same for every N "
        "(default: as many as there are cores)",
    )


def _full(task: Parser) -> None:
    _limits(task)
    written = task.add_argument_group("what is written")
    for option, metavar, text in (
        ("--html", "FILE", "the state space as one page, the bigraph of a state a click away"),
        ("--svg", "FILE", "the state space as a picture"),
        ("--dot", "FILE", "the state space for Graphviz"),
        ("--json", "FILE", "states and transitions as data; - for standard output, alone"),
        ("--prism", "PREFIX", "PREFIX.tra, .lab, .csl, .srew, .trew for PRISM"),
        ("--storm", "PREFIX", "PREFIX.tra, .lab, .srew, .trew for Storm"),
    ):
        written.add_argument(option, metavar=metavar, type=named, help=text)


def _sim(task: Parser) -> None:
    task.add_argument(
        "--seed",
        metavar="N",
        type=at_least_zero,
        default=0,
        help="which run: the same seed, the same run (default 0)",
    )
    _add_many_runs(task)
    task.add_argument(
        "--steps",
        metavar="N",
        type=at_least_zero,
        default=100,
        help="take no more than N steps (default 100)",
    )
    task.add_argument(
        "--until",
        metavar="TIME",
        type=seconds,
        help="in an sbrs, simulate up to TIME (default: no limit)",
    )
    task.add_argument(
        "--json",
        metavar="FILE",
        type=named,
        help="the run, or what many say, as data; - for standard output, alone",
    )


def _add_many_runs(task: Parser) -> None:
    task.add_argument(
        "--runs",
        metavar="N",
        type=at_least_one,
        help="take N runs of the seed, 0 to N-1, and say in how many each predicate was true, and when first",
    )
    task.add_argument(
        "--run",
        metavar="N",
        type=at_least_zero,
        help="take run N of those that --runs takes, step by step",
    )
    task.add_argument(
        "--plot",
        metavar="FILE",
        type=named,
        help="with --runs: draw the share of runs in which each predicate was true by then, .svg or .png",
    )


def _check(task: Parser) -> None:
    _limits(task)
    wanted = task.add_argument_group("what is checked (default: the properties that the file has)")
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
        ("--ltl", "a formula of predicates that is true of every run, such as 'p leads to q'"),
        ("--ctl", "a formula of predicates that is true of the tree of runs, such as 'AG EF p'"),
    ):
        wanted.add_argument(
            option, metavar="FORMULA", action="append", default=[], help=f"{text}; may be repeated"
        )
    wanted.add_argument(
        "--storm",
        metavar="FORMULA",
        action="append",
        default=[],
        help="a probability, reward or time that Storm computes, such as 'Pmax=? [F goal]', with the likeliest run; or "
        "a claim about one, such as 'P>=0.9 [F goal]'; needs the extra [storm]; may be repeated",
    )
    wanted.add_argument("--no-deadlock", action="store_true", help="something can happen in every state")
    task.add_argument(
        "--json", metavar="FILE", type=named, help="verdicts as data; - for standard output, alone"
    )


def _show(task: Parser) -> None:
    task.add_argument(
        "--state",
        metavar="N",
        type=at_least_zero,
        default=0,
        help="which state, as full numbers them (default 0)",
    )
    task.add_argument("--output", metavar="FILE", type=named, help="draw it: a picture, .svg or .png")


def _convert(task: Parser) -> None:
    task.add_argument(
        "output", metavar="OUT", type=named, help="a .big file that is written; - for standard output"
    )
    task.add_argument(
        "--from",
        dest="source",
        choices=("big", "bgm"),
        help="BigraphER's language or BigMC's (default: by the file's ending)",
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
