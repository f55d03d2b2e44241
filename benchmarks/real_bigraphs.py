"""Read and explore the `.big` and `.bgm` files in a folder, beside BigraphER, and say where they differ.

Usage: `python benchmarks/real_bigraphs.py [FOLDER] [--seconds N] [--times N] [--states N] [--bigrapher PATH] [--output
FILE]`. The folder may be named by the variable BIGRAPHS instead; the files are other people's, so none are in the
project. Seconds are of processor time and memory is the peak, both of the whole command, `bigactors big full` or
`bigrapher full`, start included. BigraphER is stopped when it has taken `--times` as long, after a second at the
earliest, and after `--seconds` where ours did not end either.
"""

import argparse
import json
import os
import re
import shutil
import sys
from collections.abc import Iterator, Sequence
from dataclasses import asdict, dataclass
from math import ceil
from pathlib import Path

from machine import describe, run_peer

RESULTS = Path(__file__).parent / "results" / "real_bigraphs.json"
PRINTED = re.compile(r"(States|Transitions):\D*?(\d+)\s*$", re.MULTILINE)
SUMMARY = re.compile(
    r": ([\d,]+) states?, ([\d,]+) transitions?, .* (?:complete|incomplete: (.*)), [\d.]+ s$", re.MULTILINE
)
COLOURS = re.compile(r"\x1b\[[0-9;]*m")


@dataclass(frozen=True, slots=True)
class Run:
    """What one tool made of one file: its counts, or why there are none."""

    states: int | None
    transitions: int | None
    why: str
    seconds: float
    megabytes: float


def ours(path: Path, seconds: int, states: int) -> Run:
    """Run `bigactors big full` on one file."""
    limits = ("--max-states", str(states), "--max-time", str(2 * seconds))
    command = [sys.executable, "-m", "bigactors", "big", "full", *limits, str(path)]
    printed, used, memory, code = _ended(command, seconds)
    counted = SUMMARY.search(printed)
    if counted is None:
        why = (
            f"ended by a signal after {used:.0f} s" if code < 0 else f"not read: {_first_line(printed, path)}"
        )
        return Run(None, None, why, used, memory)
    states_found, transitions = (int(number.replace(",", "")) for number in counted.groups()[:2])
    return Run(states_found, transitions, counted[3] or "", used, memory)


def bigrapher(program: str, path: Path, seconds: int, states: int) -> Run:
    """Run BigraphER on one file."""
    printed, used, memory, code = _ended([program, "full", "-M", str(states), str(path)], seconds)
    counted = {name: int(number) for name, number in PRINTED.findall(printed)}
    why = "" if code == 0 and len(counted) == 2 else _last_line(printed)
    if code < 0:
        why = f"ended by a signal after {used:.0f} s"
    elif counted.get("States", 0) >= states:
        why = f"the limit of {states:,} states was reached"
    return Run(counted.get("States"), counted.get("Transitions"), why, used, memory)


def _ended(command: Sequence[str], seconds: int) -> tuple[str, float, float, int]:
    """Run a command within seconds of processor time; return what it printed, its seconds, megabytes and status."""
    ran = run_peer(command, seconds=seconds)
    return COLOURS.sub("", ran.printed), ran.seconds, ran.memory, ran.status


def _first_line(printed: str, path: Path) -> str:
    return printed.partition("\n")[0].removeprefix(f"{path}:")


def _last_line(printed: str) -> str:
    return next(
        (line.strip() for line in reversed(printed.splitlines()) if line.strip()), "nothing is printed"
    )


def differ(left: Run, right: Run | None) -> bool:
    """Say whether both came to an end, and to different counts."""
    if right is None or left.why or right.why:
        return False
    return (left.states, left.transitions) != (right.states, right.transitions)


def row(name: str, left: Run, right: Run | None) -> str:
    """Return one line of the table."""
    peer = _cells(right) if right else ("",) * 4
    cells = [name, *_cells(left), *peer, "**differs**" if differ(left, right) else ""]
    return f"| {' | '.join(cells)} |"


def _cells(run: Run) -> tuple[str, ...]:
    counts = "" if run.states is None else f"{run.states:,} / {run.transitions:,}"
    return counts, run.why.replace("|", "\\|")[:90], f"{run.seconds:.2f}", f"{run.megabytes:.0f}"


HEAD = """\
| file | states / transitions | why not all | s | MB | BigraphER's | why not all | s | MB | |
| --- | ---: | --- | ---: | ---: | ---: | --- | ---: | ---: | --- |
"""


def table(folder: Path, given: argparse.Namespace) -> Iterator[tuple[str, dict[str, object]]]:
    """Yield for each file its line, and the same as data."""
    for path in sorted(
        each for each in folder.rglob("*.*") if each.suffix in (".big", ".bgm") and each.is_file()
    ):
        name, peer = str(path.relative_to(folder)), path.suffix == ".big" and given.bigrapher
        left = ours(path, given.seconds, given.states)
        patience = given.seconds if left.why else max(1, ceil(given.times * left.seconds))
        right = bigrapher(given.bigrapher, path, patience, given.states) if peer else None
        data = {"file": name, "ours": asdict(left), "bigrapher": None if right is None else asdict(right)}
        yield row(name, left, right), {**data, "differs": differ(left, right)}


def main(arguments: Sequence[str] | None = None) -> int:
    """Run both tools on all files, print the table, and keep it; 1 if any counts differ."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument(
        "folder", nargs="?", type=Path, default=os.environ.get("BIGRAPHS"), help="where the files are"
    )
    parser.add_argument(
        "--seconds", type=int, default=60, help="processor seconds for each file (default 60)"
    )
    parser.add_argument("--times", type=float, default=11, help="BigraphER's patience (default 11)")
    parser.add_argument("--states", type=int, default=100_000, help="states of each file (default 100,000)")
    parser.add_argument("--bigrapher", default=shutil.which("bigrapher"), help="the program to compare with")
    parser.add_argument("--output", type=Path, default=RESULTS, help="where the figures are kept")
    given = parser.parse_args(arguments)
    if given.folder is None:
        sys.stdout.write("no folder of .big and .bgm files: name one, or set BIGRAPHS to it\n")
        return 0
    if not Path(given.folder).is_dir():
        parser.error(f"{given.folder} is no folder")
    sys.stdout.write(HEAD)
    kept: list[dict[str, object]] = []
    limits = f"{given.states:,} states, {given.seconds} s; BigraphER is stopped at {given.times:g} times our seconds"
    found = {"machine": describe(), "limits": limits, "rows": kept}
    given.output.parent.mkdir(parents=True, exist_ok=True)
    for line, data in table(Path(given.folder), given):
        sys.stdout.write(f"{line}\n")
        sys.stdout.flush()
        kept.append(data)
        given.output.write_text(json.dumps(found, indent=1) + "\n", encoding="utf-8")
    differing = sum(bool(data["differs"]) for data in kept)
    sys.stdout.write(f"\n{len(kept)} files, {differing} with other counts than BigraphER's\n")
    return 1 if differing else 0


if __name__ == "__main__":
    sys.exit(main())
