"""The symbolic engine beside the fast one: the same counts, and what each takes.

    python benchmarks/symbolic.py [--minutes N] [MISSION ...]

A mission is a patrol as in `run.py` (`2x6+handover`) or a rendezvous (`rendezvous7`). Each engine runs in a process of
its own, nothing is looked at but the size. Both have to come to the same counts, unless one is cut at N minutes.
"""

import argparse
import sys
from collections.abc import Sequence

import rendezvous
from ours import Explored, explored
from run import patrol

DEFAULT = ["2x3+handover", "2x6+handover", "rendezvous7", "3x3"]
ENGINES = ("fast", "symbolic")


def text_of(name: str) -> str:
    """Write a mission; raises ValueError where there is none of that name."""
    robots = name.removeprefix("rendezvous")
    return rendezvous.mission_text(int(robots)) if robots != name else patrol(name).text


def measured(name: str, minutes: float) -> dict[str, Explored]:
    """Run both engines; raises SystemExit where they differ."""
    text = text_of(name)
    runs = {engine: explored(text, "--engine", engine, "--minutes", str(minutes)) for engine in ENGINES}
    counts = {(run.configurations, run.transitions) for run in runs.values() if not run.bounds}
    if len(counts) > 1:
        raise SystemExit(f"{name}: the engines differ: {sorted(counts)}")
    return runs


def rows(name: str, runs: dict[str, Explored]) -> list[str]:
    """Return a line of the table for each engine."""
    return [
        f"| {name} | {engine} | {run.configurations:,}{' (cut)' if run.bounds else ''} | {run.transitions:,} "
        f"| {run.seconds:.1f} | {run.processor:.1f} | {run.memory:,.0f} |"
        for engine, run in runs.items()
    ]


def main(arguments: Sequence[str] | None = None) -> int:
    """Measure the missions that are asked for."""
    parser = argparse.ArgumentParser(description=(__doc__ or "").splitlines()[0])
    parser.add_argument("missions", nargs="*", default=DEFAULT, metavar="MISSION")
    parser.add_argument("--minutes", type=float, default=15.0, help="how long each at most")
    given = parser.parse_args(arguments)
    sys.stdout.write(
        "| mission | engine | configurations | transitions | seconds | processor s | peak MB |\n"
    )
    sys.stdout.write("| --- | --- | ---: | ---: | ---: | ---: | ---: |\n")
    for name in given.missions:
        sys.stdout.write("\n".join(rows(name, measured(name, given.minutes))) + "\n")
        sys.stdout.flush()
    return 0


if __name__ == "__main__":
    sys.exit(main())
