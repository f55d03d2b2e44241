"""The command `bigactors`: parse the line, run the command, exit with its code; signals end it like Ctrl-C."""

from __future__ import annotations

import gc
import os
import sys
from collections.abc import Callable, Sequence
from typing import Final

from bigactors.ending_signals import as_process, ending_as_ctrl_c
from bigactors.exits import Exit
from bigactors.mistakes import Mistake, describe_bug
from bigactors.terminal import COLOUR, safe_output, tell

OBJECTS_BETWEEN_COLLECTIONS: Final = 200_000
"""Python's default of 700 rescans the imported objects again and again: a tenth of the time of a small check."""


def main(line: Sequence[str] | None = None) -> int:
    """Run one command line (default: this process's) and return its exit code."""
    gc.set_threshold(OBJECTS_BETWEEN_COLLECTIONS)
    with ending_as_ctrl_c():
        return _answered(sys.argv[1:] if line is None else line)


def script() -> int:
    """Run this process's command line; the process must end with the returned exit code."""
    code = as_process(_completed_or_run)
    gc.freeze()  # the process ends: a last scan of all objects takes a quarter of a small check
    return code


def _completed_or_run() -> int:
    if "_ARGCOMPLETE" in os.environ:  # a shell asks for completions
        from bigactors.commands.completion import complete  # noqa: PLC0415 - it builds the parsers of all commands

        complete()
    return main()


def _answered(line: Sequence[str]) -> int:
    try:
        with safe_output():
            return run(line)
    except Mistake:  # the output itself cannot be written
        return Exit.MISTAKE


def run(line: Sequence[str]) -> int:
    """Run one command line and report its errors."""
    return reported(lambda: _run(line))


def _run(line: Sequence[str]) -> int:
    from bigactors.arguments import parse_arguments  # noqa: PLC0415 - Ctrl-C is answered while it is imported
    from bigactors.arguments.parser import command_of  # noqa: PLC0415

    options = parse_arguments(line)
    COLOUR.set(options.color)
    return int(command_of(options.command).run(options))


def reported(command: Callable[[], int]) -> int:
    """Run a command, report its errors, and return the exit code."""
    try:
        return command()
    except SystemExit as end:  # after --help and --version
        return int(end.code or 0)
    except Mistake as mistake:
        tell(str(mistake), "" if mistake.place else "bigactors:")
        return Exit.MISTAKE
    except KeyboardInterrupt:
        tell("bigactors: interrupted, nothing is decided")
        return Exit.INCOMPLETE
    except Exception as error:  # any other exception is our bug
        tell(describe_bug(error))
        return Exit.BUG
