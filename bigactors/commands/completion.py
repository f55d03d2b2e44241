"""`bigactors completion`: command lines completed in shells, by argcomplete."""

import argparse
import os
import re
from argparse import Namespace
from collections.abc import Callable, Iterable, Iterator
from pathlib import Path
from typing import Any, Final

from bigactors.arguments import make_parser
from bigactors.arguments.values import FORMATS, REDUCTIONS
from bigactors.exits import Exit
from bigactors.terminal import say_text

DESCRIPTION: Final = """\
Print a script that completes commands, options, missions that ship and names in missions. A shell reads it at its
start: the examples are lines for ~/.config/fish/config.fish, ~/.bashrc and ~/.zshrc (after compinit)."""

EXAMPLES: Final = (
    "bigactors completion fish | source",
    'eval "$(bigactors completion bash)"',
    'eval "$(bigactors completion zsh)"',
)

ARGUMENTS: Final = """\
  shell {bash,zsh,fish}  the shell that reads the script"""


SHELLS = ("bash", "zsh", "fish")


def run(options: Namespace) -> Exit:
    """Print the script for a shell."""
    say_text(script(options.shell))
    return Exit.HOLDS


MOST_BYTES: Final = 1_000_000
"""Bytes of a mission that are searched for names."""

Completer = Callable[..., Iterable[str]]


def complete() -> None:
    """Answer a shell's request for completions, and end the process."""
    import argcomplete

    whole, commands = make_parser()
    for name, parser in commands.items():
        for action in actions_of(parser):
            completer = completer_of(name, action)
            if completer is not None:
                action.completer = completer  # type: ignore[attr-defined]  # where argcomplete looks for it
    argcomplete.autocomplete(whole)


def actions_of(parser: argparse.ArgumentParser) -> Iterator[argparse.Action]:
    """Yield the arguments of a parser and of its subparsers."""
    for action in parser._actions:  # noqa: SLF001 - argparse has no other list of them
        yield action
        if isinstance(action.choices, dict):
            for task in action.choices.values():
                yield from actions_of(task)


def completer_of(command: str, action: argparse.Action) -> Completer | None:
    """Return the completer of an argument's values; None leaves it to the completion of files."""
    if action.metavar == "FILE" and not action.option_strings:
        return POSITIONAL.get(command)
    return BY_METAVAR.get(str(action.metavar))


def script(shell: str) -> str:
    """Return the script that a shell reads at its start to complete command lines of bigactors."""
    from argcomplete.shell_integration import shellcode

    return shellcode(["bigactors"], shell=shell)


# --- completers -----------------------------------------------------------------------------------------------


def files(prefix: str, *suffixes: str) -> Iterator[str]:
    """Yield the folders, and the files with one of the suffixes, whose path starts with the prefix."""
    folder, _, begin = prefix.rpartition("/")
    try:
        entries = sorted(os.scandir(f"{folder}/" if "/" in prefix else "."), key=lambda entry: entry.name)
    except OSError:
        return
    for entry in entries:
        if entry.name.startswith(begin) and (begin or not entry.name.startswith(".")):
            path = f"{folder}/{entry.name}" if "/" in prefix else entry.name
            if entry.is_dir():
                yield f"{path}/"
            elif entry.name.endswith(suffixes):
                yield path


def mission_files(prefix: str, **_: Any) -> Iterator[str]:
    """Yield mission files."""
    return files(prefix, ".mission")


def missions(prefix: str, **_: Any) -> Iterator[str]:
    """Yield mission files and the names of shipped missions."""
    from specs.missions import shipped_missions

    yield from mission_files(prefix)
    if "/" not in prefix:
        yield from shipped_missions()


def systems(prefix: str, **_: Any) -> Iterator[str]:
    """Yield files of bigraphs and the names of shipped examples."""
    from bigraphs.examples import example_names

    yield from files(prefix, ".big", ".bgm")
    yield from example_names()


def codes(**_: Any) -> list[str]:
    """Return the codes of diagnostics."""
    from specs.codes import Code

    return sorted(code.number for code in Code)


def named_by(pattern: str) -> Completer:
    """Return a completer of a pattern's matches in the mission on the line, or else in the missions of this folder."""

    def complete_names(parsed_args: argparse.Namespace, **_: Any) -> list[str]:
        texts = (text_of(path) for path in missions_on(parsed_args))
        return sorted({name for text in texts for name in re.findall(pattern, text, re.MULTILINE)})

    return complete_names


def missions_on(line: argparse.Namespace) -> list[Path]:
    """Return the mission on the line; without one, the missions in this folder."""
    from specs.missions import shipped_missions

    word = getattr(line, "file", None) or getattr(line, "mission", None)
    if word is None:
        return sorted(Path().glob("*.mission"))
    return [path if (path := Path(word)).is_file() else shipped_missions().get(word, path)]


def text_of(path: Path) -> str:
    """Return the beginning of a mission's text; empty for an unreadable file."""
    try:
        with path.open(encoding="utf-8", errors="replace") as file:
            return file.read(MOST_BYTES)
    except OSError:
        return ""


ENTITY: Final = r"^\s*(\w+)\s*:\s*\w+\s*(?:=|carried|absent)"
POSITIONAL: Final[dict[str, Completer]] = {
    "check": missions,
    "show": missions,
    "simulate": missions,
    "export": missions,
    "run": missions,
    "fmt": mission_files,
    "big": systems,
}
BY_METAVAR: Final[dict[str, Completer]] = {
    "AGENT": named_by(r"^\s*BigActor\s+(\w+)"),
    "CODE": codes,
    "FORMAT:FILE": lambda **_: [f"{name}:" for name in FORMATS],
    "NAMES": lambda **_: [*REDUCTIONS, ",".join(REDUCTIONS)],
    "NAME=FILE": named_by(r'\bfrom\s+"([^"\n]+)"'),
    "PLACE": named_by(ENTITY),
    "VEHICLE": named_by(ENTITY),
}
