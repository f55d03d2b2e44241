"""The command line's grammar: commands, arguments, options, and their help.

It imports nothing slow, so that help appears at once. A command has a module here with its arguments, a module of the
same name in `bigactors.commands` that runs it, and a place in `NAMES`.
"""

import argparse
import re
from collections.abc import Callable, Sequence
from functools import partial
from importlib import import_module
from typing import Final

from bigactors import __version__
from bigactors.arguments.common import EXITS
from bigactors.arguments.parser import Command, Parser
from bigactors.arguments.values import FORMATS
from bigactors.mistakes import Mistake, suggestion

__all__ = ["FORMATS", "NAMES", "Command", "Parser", "make_parser", "parse_arguments", "parser_of"]

GROUPS: Final = {
    "write and check missions": (
        "new",
        "check",
        "simulate",
        "show",
        "replay",
        "export",
        "fmt",
        "lsp",
        "explain",
    ),
    "fly them": ("run", "console", "status", "say", "hold", "return", "give-back", "plugins", "keygen"),
    "places and bigraphs": ("world", "detect", "big"),
    "begin": ("demo", "completion"),
}
"""The commands in groups, in the order of the help."""

NAMES: Final = tuple(name for names in GROUPS.values() for name in names)

BEGINNING: Final = """\
examples:
  bigactors check oil_spill                  decide on a mission that ships
  bigactors show oil_spill                   draw its first configuration
  bigactors new patrol                       write one of your own
  bigactors check --watch patrol.mission     check it whenever it is saved

bigactors COMMAND --help describes a command, with examples. FILE is a mission file or the name of one that ships."""

GONE: Final = {
    "bigactors check --hash-compact": "it is gone, since a configuration takes some 24 bytes: --max-memory SIZE "
    "bounds memory, and --spill DIR moves configurations to files",
    "bigactors big --to": "it is gone with XMI: BigraphER's language is written",
    "bigactors big --initial": "it is gone with XMI: a whole model is written",
}
"""Options of earlier versions, each with its replacement."""


def command_of(name: str) -> Command:
    """Return a command; its module is loaded on request."""
    command: Command = import_module(f"bigactors.arguments.{name.replace('-', '_')}").COMMAND
    return command


def make_parser() -> tuple[Parser, dict[str, Parser]]:
    """Return the parser of the whole line, and the parsers of the commands in the order of the help."""
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
    commands = whole.add_subparsers(dest="command", metavar="COMMAND", help=argparse.SUPPRESS)
    return whole, {name: parser_of(name, partial(commands.add_parser, name)) for name in NAMES}


def _listed(group: str) -> str:
    """Return the commands of a group, each with its summary."""
    width = max(map(len, NAMES))
    return "\n".join(
        [f"{group}:", *(f"  {name:<{width}}  {command_of(name).summary}" for name in GROUPS[group])]
    )


def parser_of(name: str, make: Callable[..., Parser] = Parser) -> Parser:
    """Return the parser of a command's line."""
    command = command_of(name)
    shown = "examples:\n" + "\n".join(f"  {example}" for example in command.examples)
    parser = make(prog=f"bigactors {name}", description=command.description, epilog=shown)
    command.fill(parser)
    return parser


def parse_arguments(line: Sequence[str]) -> argparse.Namespace:
    """Return the options of a command line; raises Mistake, and SystemExit after --help and --version."""
    if line and line[0] in NAMES:  # build only this command's parser
        return _parsed(parser_of(line[0]), line[1:], argparse.Namespace(command=line[0], color="auto"))
    whole, _ = make_parser()
    if line and not line[0].startswith("-"):
        hint = suggestion(line[0], NAMES) or f"the commands are {', '.join(NAMES)}"
        raise Mistake(f"unknown command '{line[0]:.60}'", hint)
    options = _parsed(whole, line, argparse.Namespace(color="auto"))
    if options.command is None:
        whole.print_help()
        raise SystemExit(2)
    return options


def _parsed(parser: Parser, line: Sequence[str], options: argparse.Namespace) -> argparse.Namespace:
    _, unknown = parser.parse_known_args(_joined(line), options)
    if unknown:
        raise _unknown(unknown[0], parser)
    return options


def _unknown(word: str, parser: Parser) -> Mistake:
    if not word.startswith("-"):
        return Mistake(f"'{word:.60}' is one argument too many", f"see {parser.prog} --help")
    option = word.partition("=")[0]
    known = parser.format_usage().replace("[", " ").replace("]", " ").split()
    hint = GONE.get(f"{parser.prog} {option}") or suggestion(
        option, (each for each in known if each.startswith("--"))
    )
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
