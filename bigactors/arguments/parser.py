"""The argument parser: argparse with the error messages of bigactors, and the module of a command."""

import argparse
import re
import textwrap
from collections.abc import Iterable, Iterator, Mapping
from importlib import import_module
from typing import Final, NoReturn, Protocol, cast, runtime_checkable

from bigactors.exits import Exit
from bigactors.mistakes import Mistake

SHARED: Final = frozenset({"help", "color"})
"""Arguments of every command: only the help of `bigactors` itself lists them."""


class Help(argparse.RawDescriptionHelpFormatter):
    """Wraps lines between words: options stay whole, and indented lines of a description stay separate.

    The usage has the arguments that a line must have; optional ones are listed below it.
    """

    def add_usage(
        self,
        usage: str | None,
        actions: Iterable[argparse.Action],
        groups: Iterable[argparse._MutuallyExclusiveGroup],  # noqa: ARG002 - argparse's signature
        prefix: str | None = None,
    ) -> None:
        """Add the usage, with `[options]` for all options that are listed."""
        listed = [action for action in actions if self._is_listed(action)]
        needed = [action for action in listed if action.required or not action.option_strings]
        if usage is None and len(needed) < len(listed):
            self._prog += " [options]"
        super().add_usage(usage, needed, [], prefix)

    def add_argument(self, action: argparse.Action) -> None:
        """Add the help of an argument."""
        if self._is_listed(action):
            super().add_argument(action)

    def _is_listed(self, action: argparse.Action) -> bool:
        return action.help != argparse.SUPPRESS and not (action.dest in SHARED and " " in self._prog)

    def _split_lines(self, text: str, width: int) -> list[str]:
        return _wrapped(" ".join(text.split()), width)

    def _fill_text(self, text: str, width: int, indent: str) -> str:  # noqa: ARG002 - argparse's signature
        return "\n".join(part for line in _lines(text) for part in _wrapped(line, width) or [""])


def _lines(text: str) -> Iterator[str]:
    """Yield each paragraph as one line, and indented and empty lines unchanged."""
    for paragraph in text.split("\n\n"):
        waiting: list[str] = []
        for line in paragraph.split("\n"):
            if line.startswith(" ") and waiting:
                yield " ".join(waiting)
                waiting = []
            if line.startswith(" "):
                yield line
            else:
                waiting.append(line)
        if waiting:
            yield " ".join(waiting)
        yield ""


def _wrapped(line: str, width: int) -> list[str]:
    column = re.match(r" +\S+(?: \S+)*  +", line) or re.match(r" +(?=\S)", line)
    further = " " * min(column.end() if column else 0, width // 2)
    return textwrap.wrap(
        line, width, subsequent_indent=further, break_long_words=False, break_on_hyphens=False
    )


class Parser(argparse.ArgumentParser):
    """Raises a Mistake for a wrong line; allows no abbreviations; uses colours only by `--color`."""

    def __init__(self, **settings: object) -> None:
        super().__init__(
            allow_abbrev=False,
            formatter_class=Help,
            **settings,  # type: ignore[arg-type]  # the settings of argparse
        )
        self.add_argument(
            "--color",
            choices=("auto", "always", "never"),
            metavar="WHEN",
            default=argparse.SUPPRESS,
            help="colours: always, never or auto (default)",
        )
        self.color = False  # since Python 3.14 argparse colours help, and so would the pages of docs/

    def options(self) -> list[str]:
        """Return the long names of its options."""
        shown = [action for action in self._actions if action.help != argparse.SUPPRESS]
        return [name for action in shown for name in action.option_strings if name.startswith("--")]

    def error(self, message: str) -> NoReturn:
        """Raise a parsing error as a mistake of the user."""
        raise Mistake(message, f"{self.prog} --help shows the possible arguments")


@runtime_checkable
class Command(Protocol):
    """The module of a command.

    Attributes:
        DESCRIPTION: Its purpose, for its help.
        EXAMPLES: Example command lines, for its help.
        ARGUMENTS: The sheet of its arguments (`sheets`); or its tasks, each with its purpose and its sheet.
    """

    DESCRIPTION: str
    EXAMPLES: tuple[str, ...]
    ARGUMENTS: str | Mapping[str, tuple[str, str]]

    def run(self, options: argparse.Namespace) -> Exit:
        """Do its work, and return the exit code."""


def command_of(name: str) -> Command:
    """Return a command; its module is loaded on request."""
    return cast("Command", import_module(f"bigactors.commands.{name.replace('-', '_')}"))
