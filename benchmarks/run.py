"""Measure the patrol beside SPIN: assert the counts, then run both in turns, with cold and warm starts.

Both run on one core and on two. The reference engine takes part where there are few configurations.

Usage: `python benchmarks/run.py [--turns N] [--output FILE] AGENTSxSIDE[+handover] ...`
"""

import argparse
import json
import statistics
import sys
import tempfile
from collections.abc import Callable, Iterable, Sequence
from dataclasses import asdict, dataclass
from pathlib import Path

from machine import describe
from ours import Explored, explored
from patrol import COUNTS, mission_text, promela_text, starts
from spin import Searched, agree, missing, prepared, prepared_for, searched

RESULTS = Path(__file__).parent / "results" / "patrol.json"

FEW = 20_000
"""Up to so many configurations the reference engine takes part."""

FAST, ONE_CORE = "bigactors, fast, two cores", "bigactors, fast, one core"
REFERENCE = "bigactors, reference"
SPIN, SPIN_TWO = "SPIN, no reduction", "SPIN, no reduction, two cores"


@dataclass(frozen=True, slots=True)
class Size:
    """A patrol: how many UAVs, on a grid of how many cells a side, and whether they are handed over."""

    agents: int
    side: int
    handover: bool = False

    def __str__(self) -> str:
        return f"{self.agents}, {self.side}×{self.side}{', hand-over' if self.handover else ''}"

    @property
    def text(self) -> str:
        """The mission."""
        return mission_text(self.agents, self.side, self.handover)

    @property
    def counts(self) -> tuple[int, int] | None:
        """Its configurations and transitions, where they are known."""
        return COUNTS.get((self.agents, self.side, self.handover))


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


DEFAULT = [Size(1, 3, handover=True), Size(2, 2), Size(2, 3, handover=True), Size(2, 6, handover=True)]

Run = Explored | Searched


def say(text: str) -> None:
    """Say how far the measuring is."""
    sys.stderr.write(f"{text}\n")
    sys.stderr.flush()


def measure(size: Size, turns: int) -> dict[str, list[Run]]:
    """Run the tools in turns; raises SystemExit unless every run has the counts that are known."""
    with tempfile.TemporaryDirectory() as folder:
        say(f"{size}: SPIN is compiled, and its depth is looked for")
        text = promela_text(size.agents, size.side, size.handover)
        alone, two = (Path(folder) / name for name in ("alone", "two"))
        alone.mkdir()
        two.mkdir()
        model = prepared(text, alone)
        model_of_two = prepared_for(2, text, two, model.depth)
        tools: dict[str, Callable[[], Run]] = {
            FAST: lambda: explored(size.text, "--threads", "2"),
            ONE_CORE: lambda: explored(size.text, "--cores", "1"),
            SPIN: lambda: searched(model),
            SPIN_TWO: lambda: searched(model_of_two),
        }
        if size.counts is not None and size.counts[0] <= FEW:
            tools[REFERENCE] = lambda: explored(size.text, "--engine", "reference")
        runs: dict[str, list[Run]] = {name: [] for name in tools}
        for turn in range(turns):
            for name, tool in tools.items():
                runs[name].append(tool())
                say(f"  turn {turn + 1}, {name}: {runs[name][-1].seconds:.2f} s")
    _assert_counts(size, runs)
    return runs


def _assert_counts(size: Size, runs: dict[str, list[Run]]) -> None:
    theirs = _counts([*runs[SPIN], *runs[SPIN_TWO]])
    ours = _counts(run for name, several in runs.items() if "SPIN" not in name for run in several)
    if len(ours) != 1 or size.counts not in (None, *ours) or not all(agree(*ours, each) for each in theirs):
        counts = sorted(ours | theirs)
        raise SystemExit(f"{size}: the counts are {counts}, and should all be {size.counts}")
    for run in (*runs[FAST], *runs[ONE_CORE]):
        if isinstance(run, Explored) and run.bounds:
            raise SystemExit(f"{size}: incomplete, {', '.join(run.bounds)}")


def _counts(runs: Iterable[Run]) -> set[tuple[int, int]]:
    return {(run.configurations, run.transitions) for run in runs}


def median(runs: Sequence[Run]) -> Run:
    """Return the turn that took the median time."""
    middle = statistics.median_low(run.seconds for run in runs)
    return next(run for run in runs if run.seconds == middle)


def ratios(ours: Run, alone: Run, peer: Run, two: Run) -> dict[str, float]:
    """Return how many times SPIN's rate ours is, and our own on one core, and what part of SPIN's memory it takes."""
    return {
        "configurations_per_second": peer.seconds / ours.seconds,
        "on_one_core": peer.seconds / alone.seconds,
        "two_beside_two": two.seconds / ours.seconds,
        "two_beside_one": alone.seconds / ours.seconds,
        "memory": ours.memory / peer.memory,
        "search_alone": peer.seconds / (getattr(ours, "searching", None) or ours.seconds),
    }


def result(size: Size, runs: dict[str, list[Run]]) -> dict[str, object]:
    """Return what is kept of a size."""
    medians = {name: median(several) for name, several in runs.items()}
    return {
        "size": str(size),
        "configurations": medians[FAST].configurations,
        "transitions": medians[FAST].transitions,
        "ratio_to_spin": ratios(*(medians[name] for name in (FAST, ONE_CORE, SPIN, SPIN_TWO))),
        "median": {name: figures(run) for name, run in medians.items()},
        "turns": {name: [asdict(run) for run in several] for name, several in runs.items()},
    }


def figures(run: Run) -> dict[str, object]:
    """Return a run's figures, and its rate."""
    return asdict(run) | {"configurations_per_second": run.configurations / max(run.seconds, 1e-9)}


def cold_and_warm(size: Size) -> dict[str, object]:
    """Explore twice with a cache of compiled loops of its own: it is empty at first, and full then."""
    with tempfile.TemporaryDirectory() as folder:
        both = {name: explored(size.text, cache=Path(folder)) for name in ("cold", "warm")}
    return {"size": str(size)} | {name: figures(run) | {"phases": phases(run)} for name, run in both.items()}


def phases(run: Explored) -> dict[str, float]:
    """Part the seconds of a process: what is neither compiled nor learned is searched, or loaded for it."""
    return {
        "importing": run.importing,
        "compiling": run.compiling,
        "learning": run.learning,
        "searching": run.searching,
        "wall": run.wall,
    }


def main(arguments: Sequence[str] | None = None) -> int:
    """Measure the sizes that were asked for, and keep the figures."""
    parser = argparse.ArgumentParser(description=(__doc__ or "").splitlines()[0])
    parser.add_argument("sizes", nargs="*", type=patrol, default=DEFAULT, metavar="AGENTSxSIDE[+handover]")
    parser.add_argument("--turns", type=int, default=3, help="how often each tool runs; the median counts")
    parser.add_argument("--output", type=Path, default=RESULTS, help="where the figures are kept")
    given = parser.parse_args(arguments)
    if missing():
        parser.exit(2, f"not installed: {', '.join(missing())} (Debian: apt-get install spin gcc)\n")
    machine = describe()
    say("cold and warm start")
    start = cold_and_warm(given.sizes[0])
    sizes = [result(size, measure(size, given.turns)) for size in given.sizes]
    largest = max(sizes, key=lambda each: each["configurations"])
    kept = {
        "machine": machine,
        "turns": given.turns,
        "largest": largest["size"],
        "ratio_to_spin": largest["ratio_to_spin"],
        "sizes": sizes,
        "start": start,
    }
    given.output.parent.mkdir(parents=True, exist_ok=True)
    given.output.write_text(json.dumps(kept, indent=1) + "\n", encoding="utf-8")
    from tables import patrol_tables  # noqa: PLC0415  # it reads what was kept

    sys.stdout.write(patrol_tables(kept))
    return 0


if __name__ == "__main__":
    sys.exit(main())
