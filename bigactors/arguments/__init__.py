"""The command line's grammar: commands, arguments, options, and their help.

It imports nothing that takes time to load, so that help is there at once. A command is a module here with its
arguments, one of the same name in `bigactors.commands` that runs it, and its place in `COMMANDS`.
"""

import argparse
import re
from collections.abc import Sequence
from typing import Final

from bigactors import __version__
from bigactors.arguments import (
    big,
    check,
    demo,
    explain,
    fmt,
    give_back,
    keygen,
    new,
    replay,
    run,
    say,
    show,
    simulate,
    world,
)
from bigactors.arguments.common import EXITS
from bigactors.arguments.parser import Command, Parser
from bigactors.arguments.values import FORMATS
from bigactors.mistakes import Mistake, suggestion

__all__ = ["COMMANDS", "FORMATS", "Command", "Parser", "make_parser", "parse_arguments"]

COMMANDS: Final[dict[str, Command]] = {
    each.COMMAND.name: each.COMMAND
    for each in (
        new,
        check,
        show,
        simulate,
        run,
        say,
        give_back,
        keygen,
        replay,
        world,
        big,
        explain,
        fmt,
        demo,
    )
}
"""The commands by name, in the order of the help."""


def make_parser() -> tuple[Parser, dict[str, Parser]]:
    """Return the parser of the whole line, and those of the commands in the order of their help."""
    whole = Parser(
        prog="bigactors",
        description=(
            "Logical-space programming: check a mission in every interleaving, draw it, fly it, replay it."
        ),
        epilog="bigactors COMMAND --help describes a command, with examples.\n\n" + EXITS,
    )
    whole.add_argument("--version", action="version", version=f"bigactors {__version__}")
    commands = whole.add_subparsers(dest="command", metavar="COMMAND", title="commands", parser_class=Parser)
    made: dict[str, Parser] = {}
    for each in COMMANDS.values():
        shown = "examples:\n" + "\n".join(f"  {example}" for example in each.examples)
        made[each.name] = commands.add_parser(
            each.name, help=each.summary, description=each.description, epilog=shown
        )
        each.fill(made[each.name])
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
