"""Measure the patrol with Ray workers beside the fast explorer: assert the counts, then print rates and bytes.

Usage: `python benchmarks/cluster.py [--threads N,N] [--workers N,N] [--output FILE] AGENTSxSIDE[+handover] ...`. Each
is measured twice, and the faster one counts: the first may have started workers and loaded loops. All workers run on
this machine: with more workers than cores the figures say what work costs, not how much faster it is done.
"""

import argparse
import importlib.metadata
import json
import sys
import tempfile
import time
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from machine import describe
from patrol import COUNTS
from run import Size, patrol

from checker import Cluster, Engine, Exploration, Keeping, Limits, Progress, explore
from semantics.state.configuration import Configuration
from specs import parse_bytes
from specs.elaboration import elaborate, load_mission

ROOT = Path(__file__).parents[1]
RESULTS = Path(__file__).parent / "results" / "cluster.json"
CHAIN = "look_before_entry"
"""A mission of which most layers have one configuration: what it takes is the rounds."""

TURNS = 2
CREWS = (2, 4, 8, 16)
"""How many workers there are where rounds are timed."""


def initial(size: Size) -> Configuration:
    """Return where a patrol starts."""
    source, mission = parse_bytes("patrol.mission", size.text.encode())
    return elaborate(mission, source, Path()).initial


@dataclass(frozen=True, slots=True)
class Means:
    """What a patrol is explored with.

    Attributes:
        engine: Which engine.
        count: How many threads the fast one has, or how many workers explore with Ray.
    """

    engine: Engine
    count: int

    def __str__(self) -> str:
        things = "worker" if self.engine is Engine.RAY else "thread"
        return f"{self.engine.value}, {self.count} {things}{'s' * (self.count > 1)}"


def measured(size: Size, means: Means) -> dict[str, Any]:
    """Explore a patrol and return what it took; the rate is that of the second half, when nearly all is learned."""
    marks: list[tuple[float, int]] = []
    began = time.monotonic()

    def look(progress: Progress) -> None:
        marks.append((time.monotonic() - began, progress.configurations))

    with tempfile.TemporaryDirectory() as folder:
        found = explore(
            initial(size),
            limits=Limits(configurations=None),
            report=look,
            every=0.05,
            engine=means.engine,
            keeping=Keeping(folder) if means.engine is Engine.RAY else None,
            cluster=Cluster(means.count) if means.engine is Engine.RAY else Cluster(),
            threads=means.count if means.engine is Engine.FAST else None,
        )
        kept = sum(path.stat().st_size for path in Path(folder).rglob("shard-*.checkpoint"))
    count = len(found.configurations)
    assert (count, found.transitions) == COUNTS[size.agents, size.side, size.handover]
    marks = [mark for mark in marks if mark[1] >= count / 2] or [(0.0, 0), (found.seconds, count)]
    (begun, half), (ended, last) = marks[0], marks[-1]
    rate = (last - half) / max(ended - begun, 1e-9)
    about = {
        "engine": str(means),
        "seconds": found.seconds,
        "second_half_per_second": rate,
        "layers": found.depth,
    }
    return about | {"configurations": count, "transitions": found.transitions} | _bytes(found, kept)


def best(size: Size, means: Means) -> dict[str, Any]:
    """Return what the fastest of some explorations took."""
    return min((measured(size, means) for _ in range(TURNS)), key=lambda run: run["seconds"])


def _bytes(found: Exploration, kept: int) -> dict[str, float]:
    """Return bytes for each configuration: in memory, sent between workers, and in checkpoints."""
    count, survey = len(found.configurations), found.survey
    if hasattr(survey, "space"):
        return {"bytes_used": survey.space.bytes_used / count}
    standings = survey.found.every("standing")
    used, sent = (sum(getattr(each, name) for each in standings) / count for name in ("used", "sent"))
    return {"bytes_used": used, "bytes_sent": sent, "bytes_kept": kept / count}


def milliseconds_a_round(workers: int) -> float:
    """Return what a round takes that has next to nothing to do."""
    start = load_mission(ROOT / "specs" / "missions" / f"{CHAIN}.mission").initial
    found = [explore(start, engine=Engine.RAY, cluster=Cluster(workers)) for _ in range(3)]
    return min(1000 * each.seconds / each.depth for each in found)


def lines(results: list[dict[str, Any]]) -> Iterator[str]:
    """Yield a table."""
    yield "| UAVs, grid | engine | configurations | seconds | second half, a second | bytes each | bytes sent each |"
    yield "| --- | --- | ---: | ---: | ---: | ---: | ---: |"
    for each in results:
        sent = f"{each['bytes_sent']:.1f}" if "bytes_sent" in each else ""
        yield (
            f"| {each['size']} | {each['engine']} | {each['configurations']:,} | {each['seconds']:.1f} "
            f"| {each['second_half_per_second']:,.0f} | {each['bytes_used']:.1f} | {sent} |"
        )


def counts(text: str) -> list[int]:
    """Read numbers that are divided by commas."""
    return [int(each) for each in text.split(",")]


def main() -> None:
    """Measure, print and keep."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("sizes", nargs="*", type=patrol, default=[Size(2, 6)])
    parser.add_argument(
        "--threads", type=counts, default="1,2", help="of the fast explorer, divided by commas"
    )
    parser.add_argument("--workers", type=counts, default="2,4", help="with Ray, divided by commas")
    parser.add_argument("--output", type=Path, default=RESULTS)
    given = parser.parse_args()
    means = [Means(Engine.FAST, each) for each in given.threads]
    means += [Means(Engine.RAY, each) for each in given.workers]
    machine = describe() | {"ray": importlib.metadata.version("ray")}
    results = [{"size": str(size)} | best(size, each) for size in given.sizes for each in means]
    rounds = {str(each): milliseconds_a_round(each) for each in CREWS}
    sys.stdout.write("\n".join(lines(results)) + "\n")
    words = ", ".join(f"{value:.1f} ms with {each}" for each, value in rounds.items())
    sys.stdout.write(f"a round takes {words} workers\n")
    kept = {"machine": machine, "runs": results, "milliseconds_a_round": rounds}
    given.output.parent.mkdir(parents=True, exist_ok=True)
    given.output.write_text(json.dumps(kept, indent=2) + "\n", encoding="utf-8")


if __name__ == "__main__":
    main()
