"""The command line: its parser, and what the arguments of several commands share.

It loads the module of the command that the line names, and nothing slow: help appears at once.
"""

import argparse
import re
from collections.abc import Callable, Mapping, Sequence
from functools import partial
from typing import Final

from bigactors import __version__
from bigactors.arguments.options import EXITS
from bigactors.arguments.parser import Parser, command_of
from bigactors.arguments.sheets import add_arguments
from bigactors.commands import GROUPS, NAMES
from bigactors.mistakes import Mistake, suggestion

__all__ = ["make_parser", "parse_arguments", "parser_of"]

BEGINNING: Final = """\
examples:
  bigactors check oil_spill                  check a mission that ships
  bigactors show oil_spill                   draw its initial configuration
  bigactors new patrol                       write your first mission
  bigactors check --watch patrol.mission     check it at every save

bigactors COMMAND --help describes a command, with examples. FILE is a mission file, or the name of a mission that
ships. Each command has --color, too: auto colours terminals without NO_COLOR, and pipes with FORCE_COLOR."""

GONE: Final = {
    "bigactors check --hash-compact": "it is gone, since a configuration takes some 24 bytes: --max-memory SIZE "
    "bounds memory, and --spill DIR moves configurations to files",
    "bigactors big --to": "it is gone with XMI: BigraphER's language is written",
    "bigactors big --initial": "it is gone with XMI: a whole model is written",
}
"""Options of earlier versions, each with its replacement."""


def make_parser() -> tuple[Parser, dict[str, Parser]]:
    """Return the parser of the whole line, and the parsers of all commands in the order of the help."""
    whole = _front_page()
    commands = whole.add_subparsers(dest="command", metavar="COMMAND", help=argparse.SUPPRESS)
    return whole, {name: parser_of(name, partial(commands.add_parser, name)) for name in NAMES}


def _front_page() -> Parser:
    """Return the parser of `bigactors` without a command, whose help lists all commands."""
    whole = Parser(
        prog="bigactors",
        usage="bigactors [-h] [--version] [--color WHEN] COMMAND ...",
        description=(
            "Logical-space programming: check a mission in every interleaving, draw it, fly it, replay it.\n\n"
            + "\n\n".join(map(_listed, GROUPS))
        ),
        epilog=f"{BEGINNING}\n\n{EXITS}",
    )
    whole.add_argument("--version", action="version", version=f"bigactors {__version__}")
    return whole


def _listed(group: str) -> str:
    """Return the commands of a group, each with its summary."""
    width = max(map(len, NAMES))
    return "\n".join(
        [f"{group}:", *(f"  {name:<{width}}  {summary}" for name, summary in GROUPS[group].items())]
    )


def parser_of(name: str, make: Callable[..., Parser] = Parser) -> Parser:
    """Return the parser of a command's line."""
    command = command_of(name)
    shown = "examples:\n" + "\n".join(f"  {example}" for example in command.EXAMPLES)
    parser = make(prog=f"bigactors {name}", description=command.DESCRIPTION, epilog=shown)
    if isinstance(command.ARGUMENTS, str):
        add_arguments(parser, command.ARGUMENTS)
    else:
        _add_tasks(parser, command.ARGUMENTS)
    return parser


def _add_tasks(parser: Parser, sheets: Mapping[str, tuple[str, str]]) -> None:
    """Add the tasks of a command, each with its purpose and the sheet of its arguments."""
    tasks = parser.add_subparsers(
        dest="task",
        metavar="TASK",
        title="tasks",
        prog=parser.prog,  # without it, argparse builds a help formatter
        parser_class=type(parser),
        required=True,
    )
    for name, (purpose, sheet) in sheets.items():
        task = tasks.add_parser(name, help=purpose, description=f"{purpose[0].upper()}{purpose[1:]}.")
        add_arguments(task, sheet)


def parse_arguments(line: Sequence[str]) -> argparse.Namespace:
    """Return the options of a command line; raises Mistake, and SystemExit after --help and --version."""
    place = _place_of_command(line)
    whole = _front_page()
    options = _parsed(whole, line[:place], argparse.Namespace(color="auto"))
    if place >= len(line):
        whole.print_help()
        raise SystemExit(2)
    options.command = line[place]
    if options.command not in NAMES:
        hint = suggestion(options.command, NAMES) or f"the commands are {', '.join(NAMES)}"
        raise Mistake(f"unknown command '{options.command:.60}'", hint)
    return _parsed(parser_of(options.command), line[place + 1 :], options)


def _place_of_command(line: Sequence[str]) -> int:
    """Return the index of the command, after the options of `bigactors` itself."""
    place = 0
    while place < len(line) and line[place].startswith("-"):
        place += 2 if line[place] == "--color" else 1
    return place


def _parsed(parser: Parser, line: Sequence[str], options: argparse.Namespace) -> argparse.Namespace:
    _, unknown = parser.parse_known_args(_joined(line), options)
    if unknown:
        raise _unknown(unknown[0], parser)
    return options


def _unknown(word: str, parser: Parser) -> Mistake:
    if not word.startswith("-"):
        return Mistake(f"'{word:.60}' is one argument too many", f"see {parser.prog} --help")
    option = word.partition("=")[0]
    hint = GONE.get(f"{parser.prog} {option}") or suggestion(option, parser.options())
    return Mistake(f"unknown option '{word:.60}'", hint or f"see {parser.prog} --help")


def _joined(line: Sequence[str]) -> list[str]:
    """Join `--within` or `--at` to a negative number, which would otherwise be parsed as an option."""
    joined: list[str] = []
    for word in line:
        if joined and joined[-1] in ("--within", "--at") and re.match(r"-[\d.]", word):
            joined[-1] += f"={word}"
        else:
            joined.append(word)
    return joined
