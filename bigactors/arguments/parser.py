"""The argument parser: argparse with the error messages of bigactors."""

import argparse
from collections.abc import Callable
from dataclasses import dataclass
from typing import NoReturn

from bigactors.mistakes import Mistake


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


@dataclass(frozen=True, slots=True)
class Command:
    """One command.

    Attributes:
        name: What it is called; its module in `bigactors.commands` has the same name.
        summary: What it does, in the list of commands.
        description: What it does, in its own help.
        examples: Lines as they could be typed.
        fill: Adds its arguments and options.
    """

    name: str
    summary: str
    description: str
    examples: tuple[str, ...]
    fill: Callable[[Parser], None]
