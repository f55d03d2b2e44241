"""Measure both engines of the explorer beside SPIN on the patrol: counts are asserted equal, then all run in turns.

Usage: `python benchmarks/run.py [--turns N] AGENTSxSIDE[+handover] ...`, by default 1x3+handover 2x2.
"""

import argparse
import multiprocessing
import resource
import statistics
import sys
import tempfile
import time
from collections.abc import Callable, Sequence
from concurrent.futures import ProcessPoolExecutor
from dataclasses import dataclass
from functools import partial
from pathlib import Path

from patrol import mission_text, promela_text, starts
from spin import Searched, missing, search

from checker import Engine, Limits, explore
from specs import parse_bytes
from specs.elaboration import elaborate


@dataclass(frozen=True, slots=True)
class Size:
    """A patrol: how many UAVs, on a grid of how many cells a side, and whether they are handed over."""

    agents: int
    side: int
    handover: bool = False

    def __str__(self) -> str:
        return f"{self.agents}, {self.side}×{self.side}{', hand-over' if self.handover else ''}"


def patrol(text: str) -> Size:
    """Read `2x3` or `2x3+handover`.

    Raises:
        ValueError: It is neither, or does not fit its grid.
    """
    grid, plus, handover = text.partition("+")
    agents, side = map(int, grid.split("x"))
    if plus and handover != "handover":
        raise ValueError(text)
    starts(agents, side)
    return Size(agents, side, bool(plus))


Tool = Callable[[Size], Searched]


def explore_patrol(size: Size, engine: Engine) -> Searched:
    """Explore the mission in a process of its own, so that its peak of memory is its own."""
    with ProcessPoolExecutor(1, multiprocessing.get_context("spawn")) as pool:
        return pool.submit(_explore, size, engine).result()


def _explore(size: Size, engine: Engine) -> Searched:
    began = time.monotonic()
    source, tree = parse_bytes("patrol.mission", mission_text(size.agents, size.side, size.handover).encode())
    initial = elaborate(tree, source, Path()).initial
    preparing = time.monotonic() - began
    found = explore(initial, limits=Limits(configurations=None), engine=engine)
    if not found.complete:
        raise SystemExit(f"the exploration is incomplete: {', '.join(found.bounds)}")
    memory = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024
    return Searched(len(found.configurations), found.transitions, found.seconds, memory, preparing)


def search_patrol(size: Size) -> Searched:
    """Let SPIN search the same model."""
    with tempfile.TemporaryDirectory() as folder:
        return search(promela_text(size.agents, size.side, size.handover), Path(folder))


TOOLS: dict[str, Tool] = {
    "bigactors, fast": partial(explore_patrol, engine=Engine.FAST),
    "bigactors, reference": partial(explore_patrol, engine=Engine.REFERENCE),
    "SPIN, no reduction": search_patrol,
}


def measure(size: Size, turns: int) -> dict[str, Searched]:
    """Run the tools in turns and return each one's median turn; every run must have the same counts."""
    runs: dict[str, list[Searched]] = {name: [] for name in TOOLS}
    for _ in range(turns):
        for name, tool in TOOLS.items():
            runs[name].append(tool(size))
    counts = {(run.configurations, run.transitions) for several in runs.values() for run in several}
    if len(counts) != 1:
        raise SystemExit(f"{size}: the counts differ: {sorted(counts)}")
    return {name: _median(several) for name, several in runs.items()}


def _median(runs: Sequence[Searched]) -> Searched:
    middle = statistics.median_low(run.seconds for run in runs)
    return next(run for run in runs if run.seconds == middle)


def table(measured: dict[Size, dict[str, Searched]]) -> str:
    """Lay out what was measured, one line for each tool and size."""
    lines = [
        "| UAVs, grid | tool | configurations | transitions | prepare s | search s | states/s | peak MB |",
        "| --- | --- | ---: | ---: | ---: | ---: | ---: | ---: |",
    ]
    for size, tools in measured.items():
        lines += [f"| {size} | {name} | {_figures(run)} |" for name, run in tools.items()]
    return "\n".join(lines) + "\n"


def _figures(run: Searched) -> str:
    rate = run.configurations / max(run.seconds, 1e-9)
    return (
        f"{run.configurations:,} | {run.transitions:,} | {run.preparing:.2f} | {run.seconds:.3f}"
        f" | {rate:,.0f} | {run.memory:,.0f}"
    )


def main(arguments: Sequence[str] | None = None) -> int:
    """Measure the sizes that were asked for and print the table."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument(
        "sizes",
        nargs="*",
        type=patrol,
        default=[Size(1, 3, handover=True), Size(2, 2)],
        metavar="AGENTSxSIDE[+handover]",
    )
    parser.add_argument(
        "--turns", type=int, default=3, help="how often each tool runs; the median is printed"
    )
    given = parser.parse_args(arguments)
    if missing():
        parser.exit(2, f"not installed: {', '.join(missing())} (Debian: apt-get install spin gcc)\n")
    measured = {size: measure(size, given.turns) for size in given.sizes}
    sys.stdout.write(table(measured))
    return 0


if __name__ == "__main__":
    sys.exit(main())
