"""Explore a mission in its own process, and report time and memory.

Usage: `python benchmarks/ours.py FILE.mission [options]` prints one JSON object, the fields of `Explored`. The other
scripts call `explored`, which starts such a process, so that its peak of memory and its start are its own.
"""

import argparse
import json
import os
import subprocess
import sys
import tempfile
import time
from collections.abc import Sequence
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

from machine import resident

if TYPE_CHECKING:
    from checker import Exploration
    from specs.elaboration import ElaboratedMission

ROOT = Path(__file__).parents[1]

LONGEST = 3600
"""Seconds after which a process is given up."""


@dataclass(slots=True)
class Explored:
    """What an exploration found and took.

    Attributes:
        configurations: How many.
        transitions: How many.
        bounds: The limits that were met; none where it is complete.
        seconds: Of the whole exploration, with what it compiled, loaded and learned.
        compiling: Seconds of it in which loops were compiled; none where they were cached.
        learning: Seconds of it in which rules were run in Python and remembered.
        importing: Seconds before it: importing, parsing, elaborating.
        wall: Seconds of the process from its start to its end.
        processor: Seconds of the processor, whatever else it did meanwhile, from the start to the exploration's end.
        memory: Of the process at its peak, in MB.
        bytes_per_configuration: What rows, parent links and the visited set take.
        rule_runs: How often rules were run in Python.
        allowed: How many transitions the visited configurations allow.
    """

    configurations: int
    transitions: int
    bounds: list[str]
    seconds: float
    compiling: float = 0.0
    learning: float = 0.0
    importing: float = 0.0
    wall: float = 0.0
    processor: float = 0.0
    memory: float = 0.0
    bytes_per_configuration: float | None = None
    rule_runs: int | None = None
    allowed: int | None = None

    @property
    def searching(self) -> float:
        """Seconds of the exploration in which nothing was compiled and nothing learned."""
        return max(self.seconds - self.compiling - self.learning, 0.0)

    @property
    def rate(self) -> float:
        """Configurations a second."""
        return self.configurations / max(self.seconds, 1e-9)


def explored(text: str, *options: str, cache: Path | None = None) -> Explored:
    """Explore a mission in a new process; options are those of the command line.

    Args:
        text: The mission.
        options: See `python benchmarks/ours.py --help`.
        cache: Where compiled loops are kept, instead of beside their sources.

    Raises:
        SystemExit: The process failed.
    """
    paths = [str(ROOT), *filter(None, [os.environ.get("PYTHONPATH")])]
    environment = os.environ | {"PYTHONPATH": os.pathsep.join(paths)}
    if cache is not None:
        environment["NUMBA_CACHE_DIR"] = str(cache)
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "measured.mission"
        path.write_text(text, encoding="utf-8")
        command = [sys.executable, __file__, str(path), *options]
        began = time.monotonic()
        done = subprocess.run(
            command, env=environment, capture_output=True, text=True, check=False, timeout=LONGEST
        )
        wall = time.monotonic() - began
    if done.returncode:
        raise SystemExit(f"the exploration failed:\n{done.stderr}")
    found = Explored(**json.loads(done.stdout))
    found.wall = wall
    return found


# --- in the process ---------------------------------------------------------------------------------------------------


def main(arguments: Sequence[str] | None = None) -> int:
    """Explore what was asked for and print what it took."""
    began = time.monotonic()
    parser = argparse.ArgumentParser(description=(__doc__ or "").splitlines()[0])
    parser.add_argument("mission", type=Path, metavar="FILE")
    parser.add_argument("--engine", choices=("fast", "reference"), default="fast")
    parser.add_argument("--reduce", action="store_true", help="by partial order")
    parser.add_argument("--cores", type=int, help="on how many cores at most")
    parser.add_argument("--threads", type=int, help="on how many threads at most")
    parser.add_argument("--most", type=int, help="how many configurations at most")
    given = parser.parse_args(arguments)
    if given.cores is not None:
        os.sched_setaffinity(0, sorted(os.sched_getaffinity(0))[: given.cores])
    from checker.engines.fast.compiled.numba_loading import ALONE  # noqa: PLC0415  # its time is measured

    ALONE.set(True)  # as the command line does: nobody else compiles in this process
    with Compiling() as compiled:
        import checker.engines.fast.explorer  # noqa: F401, PLC0415  # its time is measured, apart from the search's

        learned = _timed_learning()
        found = _explore(given, began)
    found.compiling, found.learning = sum(compiled), sum(learned)
    sys.stdout.write(json.dumps(asdict(found)) + "\n")
    return 0


class Compiling:
    """Collect the seconds in which numba compiles: it tells of each time."""

    def __enter__(self) -> list[float]:
        from numba.core import event  # noqa: PLC0415  # only this process needs it

        self.seconds: list[float] = []
        self.timer = event.install_timer("numba:compile", self.seconds.append)
        self.timer.__enter__()
        return self.seconds

    def __exit__(self, *raised: Any) -> None:
        self.timer.__exit__(*raised)


def _timed_learning() -> list[float]:
    """Collect the seconds of each time that rules are run in Python, parts that are learned on the way among them."""
    from checker.engines.fast.model.learner import CodedSource, Learner  # noqa: PLC0415

    seconds, learn, begun = [], Learner.learn, list[float]()

    def timed(learner: Learner, tree: int, source: CodedSource) -> None:
        begun.append(time.perf_counter())
        learn(learner, tree, source)
        began = begun.pop()
        if not begun:  # a part's time is its transition's, too
            seconds.append(time.perf_counter() - began)

    Learner.learn = timed  # type: ignore[method-assign]  # in this process only, which does nothing else
    return seconds


def _explore(given: argparse.Namespace, began: float) -> Explored:
    from specs.elaboration import load_mission  # noqa: PLC0415

    mission = load_mission(given.mission)
    started = time.monotonic()
    found = _search(mission, given)
    seconds = time.monotonic() - started
    result = Explored(found.size, found.transitions, list(map(str, found.bounds)), seconds)
    result.processor = time.process_time()
    result.importing = started - began
    result.memory = resident()
    result.rule_runs, result.allowed = found.rule_runs, found.allowed or None
    if found.survey is not None:
        search = found.survey.search
        result.bytes_per_configuration = search.bytes_used / search.size
    return result


def _search(mission: "ElaboratedMission", given: argparse.Namespace) -> "Exploration":
    from checker import Engine, Limits, Reduction, explore  # noqa: PLC0415  # its time is measured
    from checker.reduction import Reduced  # noqa: PLC0415

    reducer = None
    if given.reduce:
        formulas = [each.formula for each in mission.properties if each.kind.has_proposition]
        reducer = Reduced(mission.initial, [Reduction.POR], formulas)
    limits = Limits(configurations=given.most)
    engine = Engine(given.engine)
    return explore(mission.initial, limits=limits, engine=engine, reduce=reducer, threads=given.threads)


if __name__ == "__main__":
    sys.exit(main())
