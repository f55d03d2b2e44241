"""Explore the UAV family and others, and compare with BigraphER: assert the counts, then print time and memory.

Usage: `python benchmarks/bigraph_systems.py [--bigrapher PATH] [--growth] [--output FILE]`. Where BigraphER is not
found, its seconds are those measured once on another machine, and marked *quoted*. Seconds are of processor time, so
that two programs on a busy machine can be compared.
"""

import argparse
import json
import multiprocessing
import resource
import shutil
import signal
import sys
import tempfile
import time
import tracemalloc
from collections.abc import Iterator, Sequence
from concurrent.futures import ProcessPoolExecutor
from dataclasses import asdict, dataclass
from pathlib import Path

from bigraph_shapes import SHAPES, Model
from machine import describe, run_peer
from uav_family import Case, counts, text

from bigraphs.exploration import explore
from bigraphs.notation import read_system
from bigraphs.system import System

RESULTS = Path(__file__).parent / "results" / "bigraphs.json"


def uavs(case: Case) -> Model:
    """Return a member of the UAV family."""
    return Model(str(case), text(case), *counts(case))


QUOTED: dict[Model, tuple[float, bool]] = {
    uavs(Case("row", 3, 4, distinct=False, open=True)): (3.2, True),
    uavs(Case("row", 4, 4, distinct=False, open=True)): (27.0, True),
    uavs(Case("row", 3, 4, distinct=True, open=True)): (53.0, True),
    uavs(Case("row", 4, 4, distinct=True, open=True)): (75.0, False),
    uavs(Case("ring", 5, 6, distinct=False, open=False)): (59.0, True),
    uavs(Case("3x3", 2, 9, distinct=False, open=True)): (62.0, True),
    uavs(Case("3x3", 3, 9, distinct=False, open=False)): (28.0, True),
}
"""BigraphER 1.9.3's seconds, November 2026, and whether it had ended by then."""

MANY = 10_000
"""From how many states on the memory of the whole process tells what a state takes."""

GROWTH = [Case("row", *size, distinct=True, open=True) for size in ((5, 4), (5, 5), (6, 5))]
"""Members of the UAV family up to a million states."""


@dataclass(frozen=True, slots=True)
class Measured:
    """One run of ours: what it found, in what processor time, and how much memory each state took."""

    states: int
    transitions: int
    seconds: float
    bytes_per_state: float


@dataclass(frozen=True, slots=True)
class Peer:
    """What BigraphER took; it may not have ended by then."""

    seconds: float
    ended: bool
    source: str


def measure(model: Model) -> Measured:
    """Explore a model in a process of its own; raises SystemExit if the counts are wrong."""
    with ProcessPoolExecutor(1, multiprocessing.get_context("spawn")) as pool:
        found = pool.submit(_measure, model).result()
    expected = model.states, model.transitions
    if (found.states, found.transitions) != expected:
        raise SystemExit(
            f"{model.title}: {found.states} states and {found.transitions} transitions, not {expected}"
        )
    return found


def _measure(model: Model) -> Measured:
    system = read_system(model.text)
    before = _peak()
    began = time.process_time()
    found = explore(system)
    seconds = time.process_time() - began
    if not found.complete:
        raise SystemExit(f"{model.title}: incomplete, {found.reason}")
    grown = _peak() - before if len(found) > MANY else _traced(system)
    return Measured(len(found), len(found.targets), seconds, grown / len(found))


def _peak() -> int:
    return resource.getrusage(resource.RUSAGE_SELF).ru_maxrss * 1024


def _traced(system: System) -> int:
    """Return the most bytes that exploring takes, in a second run: few states drown in what Python takes itself."""
    tracemalloc.start()
    explore(system)
    return tracemalloc.get_traced_memory()[1]


def beside(model: Model, program: str | None, limit: int) -> Peer | None:
    """Run BigraphER on a model, or quote what it took; None for models that are too large for it, or not quoted."""
    if program is None:
        return Peer(*QUOTED[model], "quoted") if model in QUOTED else None
    if model.states > MANY:
        return None
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "case.big"
        path.write_text(model.text, encoding="utf-8")
        ran = run_peer([program, "full", "-M", "1000000", str(path)], seconds=limit)
    ended = ran.status == 0
    if ended:
        _check_peer(model, ran.printed)
    elif ran.status not in (-signal.SIGXCPU, -signal.SIGKILL):
        raise SystemExit(f"{model.title}: BigraphER ended with {ran.status}:\n{ran.printed}")
    return Peer(ran.seconds, ended, "measured")


def _check_peer(model: Model, printed: str) -> None:
    words = printed.replace("\x1b", " ").split()
    numbers = [int(word) for word in words if word.isdigit()]
    expected = model.states, model.transitions
    if not set(expected) <= set(numbers):
        raise SystemExit(f"{model.title}: BigraphER does not print {expected}:\n{printed}")


def row(model: Model, ours: Measured, peer: Peer | None) -> str:
    """Return one line of the table."""
    rate = ours.states / ours.seconds
    figures = f"{ours.states:,} / {ours.transitions:,} | {ours.seconds:.3f} | {rate:,.0f} | {ours.bytes_per_state:,.0f}"
    if peer is None:
        return f"| {model.title} | {figures} | | |"
    more = "" if peer.ended else "more than "
    seconds, ratio = f"{peer.seconds:.1f} {peer.source}", f"{peer.seconds / ours.seconds:,.1f}"
    return f"| {model.title} | {figures} | {more}{seconds} | {more}{ratio} |"


HEAD = """\
| case | states / transitions | s | states/s | bytes/state | BigraphER s | ratio |
| --- | ---: | ---: | ---: | ---: | ---: | ---: |
"""


def table(
    models: Sequence[Model], program: str | None, limit: int
) -> Iterator[tuple[str, dict[str, object]]]:
    """Yield for each case its line, and the same as data."""
    for model in models:
        ours, peer = measure(model), beside(model, program, limit)
        data = {
            "case": model.title,
            "ours": asdict(ours),
            "bigrapher": None if peer is None else asdict(peer),
        }
        yield row(model, ours, peer), data


def main(arguments: Sequence[str] | None = None) -> int:
    """Measure, print the table, and keep it."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument(
        "--bigrapher", default=shutil.which("bigrapher"), help="the program to measure beside"
    )
    parser.add_argument(
        "--limit",
        type=int,
        default=600,
        help="seconds of processor time that BigraphER is given (default 600)",
    )
    parser.add_argument("--growth", action="store_true", help="larger cases, too, up to a million states")
    parser.add_argument("--output", type=Path, default=RESULTS, help="where the figures are kept")
    given = parser.parse_args(arguments)
    models = [*QUOTED, *SHAPES, *map(uavs, GROWTH if given.growth else ())]
    sys.stdout.write(HEAD)
    kept = []
    for line, data in table(models, given.bigrapher, given.limit):
        sys.stdout.write(f"{line}\n")
        sys.stdout.flush()
        kept.append(data)
    given.output.parent.mkdir(parents=True, exist_ok=True)
    given.output.write_text(
        json.dumps({"machine": describe(), "rows": kept}, indent=1) + "\n", encoding="utf-8"
    )
    return 0


if __name__ == "__main__":
    sys.exit(main())
