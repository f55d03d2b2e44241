"""`bigactors check --watch`: check missions again at each save of one of their files."""

import os
import sys
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from contextlib import suppress
from pathlib import Path
from time import strftime
from typing import Final, TypeAlias

from bigactors.checking import Checked, FailedMission
from bigactors.commands.check.file_changes import interrupted_by_save, look, wait_for_save
from bigactors.exits import Exit
from bigactors.files import read_bytes
from bigactors.mission_lookup import locate
from bigactors.mistakes import Mistake
from bigactors.terminal import is_terminal, say, say_text
from checker import Interruption
from specs import MissionError, parse_bytes
from specs.elaboration import Variation, files_named
from specs.preprocessing import MAX_BYTES

CLEAR: Final = "\033[H\033[2J"

Results: TypeAlias = Sequence[Checked | FailedMission]
Verdicts: TypeAlias = Mapping[str, Mapping[str, str]]
"""The last outcome of each property, by mission."""


def check_at_each_save(
    names: Sequence[str],
    variation: Variation,
    check: Callable[[Interruption], Iterable[Checked | FailedMission]],
    report: Callable[[Results], Exit],
) -> Exit:
    """Check missions now and at each save until Ctrl-C; return the exit code of the last completed check.

    Raises:
        Mistake: A mission does not exist at the start.
    """
    for name in names:
        locate(name)  # a misspelt name is a mistake, not a file to wait for
    code, verdicts, files = Exit.INCOMPLETE, dict[str, Mapping[str, str]](), dict[str, tuple[Path, ...]]()
    why = "checking " + ", ".join(names)
    with suppress(KeyboardInterrupt):
        while True:
            files = {name: files_of(name, variation, files.get(name, ())) for name in names}
            seen = look(path for each in files.values() for path in each)
            _begin(why)
            with interrupted_by_save(seen) as (interruption, saved):
                results = list(check(interruption))
            if not saved.is_set():
                if any(result.interrupted for result in results):
                    break
                for line in changes_text(verdicts, results):
                    say(line)
                code = report(results)
                verdicts |= verdicts_of(results)
                say(f"\n{_now()} waiting for a save of {_called(seen)}; Ctrl-C ends")
                say_text("", flush=True)
            why = f"{_called(wait_for_save(seen))} saved, checking again"
    say()
    return code


def files_of(name: str, variation: Variation, before: tuple[Path, ...] = ()) -> tuple[Path, ...]:
    """Return the files of a mission: its own and those of its world; while it does not parse, the previous ones."""
    try:
        path = locate(name)
        _, tree = parse_bytes(name, read_bytes(str(path), MAX_BYTES))
    except (Mistake, MissionError):
        return before or (Path(name),)
    return (path, *(variation.sources.get(file, path.parent / file) for file in files_named(tree)))


def verdicts_of(results: Results) -> dict[str, Mapping[str, str]]:
    """Return the outcome of each property, for each mission that could be checked."""
    return {
        result.name: {each.property.name: each.outcome.value for each in result.report.verdicts}
        for result in results
        if isinstance(result, Checked)
    }


def changes_text(before: Verdicts, results: Results) -> Iterator[str]:
    """Yield the outcomes that changed since the last successful check of a mission."""
    for name, after in verdicts_of(results).items():
        if name not in before:
            continue
        about = f"{name}: " if len(results) > 1 else ""
        asked = dict.fromkeys((*after, *before[name]))
        lines = [
            f"  changed: {about}{each} {before[name].get(each, 'not asked')} → {after.get(each, 'not asked')}"
            for each in asked
            if before[name].get(each) != after.get(each)
        ]
        yield from lines or [f"  {about}no verdict changed"]


def _begin(why: str) -> None:
    """Clear the screen, or print an empty line where the output is no terminal; then print the reason for the check."""
    clears = is_terminal(sys.stdout) and os.environ.get("TERM") != "dumb"
    say_text(f"{CLEAR if clears else ''}{_now()} {why}\n", flush=True)


def _now() -> str:
    return strftime("[%H:%M:%S]")


def _called(paths: Iterable[Path]) -> str:
    return ", ".join(dict.fromkeys(path.name for path in paths))
