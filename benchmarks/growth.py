"""Measure how rate and memory change while a search grows: one search of the patrol, looked at on its way, and plotted.

Usage: `python benchmarks/growth.py [--most N] [--output FILE] [--plot FILE] [SIZE]`, by default 3x5 up to 10⁸. What the
search learns and loads falls before its first mark, a quarter of the next, which is no row of the table.
"""

import argparse
import json
import sys
from collections.abc import Sequence
from itertools import pairwise
from pathlib import Path

from machine import describe
from ours import explored
from run import Size, patrol, say

RESULTS = Path(__file__).parent / "results" / "growth.json"
PLOT = Path(__file__).parents[1] / "docs" / "pictures" / "growth.svg"

FIRST = 1_000_000

Mark = dict[str, float]


def marks(most: int, first: int = FIRST) -> list[int]:
    """Return at which sizes to look: 1, 2, 5, 10 times the first and so on, after one at which all is learned.

    >>> marks(100, 10)
    [2, 10, 20, 50, 100]
    """
    found, factor = [first // 4], 1
    while first * factor <= most:
        found += [first * factor * step for step in (1, 2, 5) if first * factor * step <= most]
        factor *= 10
    return found


def growing(seen: Sequence[Mark]) -> list[Mark]:
    """Return each mark with the rates since the one before; what is expanded counts, not what is only stored."""
    rows = []
    for before, after in pairwise(seen):
        seconds = after["seconds"] - before["seconds"]
        if after["expanded"] > before["expanded"]:
            per_second = {
                f"{what}_per_second": (after[what] - before[what]) / max(seconds, 1e-9)
                for what in ("expanded", "transitions")
            }
            rows.append(after | per_second)
    return rows


def plot(rows: Sequence[Mark], title: str, path: Path) -> None:
    """Draw rate and bytes over the number of configurations."""
    import matplotlib as mpl  # noqa: PLC0415

    mpl.use("Agg")
    mpl.rcParams["svg.hashsalt"] = "growth"  # the same figures make the same file
    from matplotlib import pyplot as plt  # noqa: PLC0415

    figure, (rates, room) = plt.subplots(2, 1, sharex=True, figsize=(7, 5.5), layout="constrained")
    sizes = [row["configurations"] for row in rows]
    rates.plot(sizes, [row["expanded_per_second"] / 1e6 for row in rows], "o-", label="configurations")
    rates.plot(sizes, [row["transitions_per_second"] / 1e6 for row in rows], "s--", label="transitions")
    rates.set(ylabel="million a second", xscale="log", title=title)
    rates.legend()
    room.plot(sizes, [row["bytes_per_configuration"] for row in rows], "o-")
    room.axhline(40, color="grey", linestyle=":", label="the aim")
    room.legend()
    room.set(xlabel="configurations", ylabel="bytes a configuration")
    for axes in (rates, room):
        axes.set_ylim(bottom=0)
        axes.grid(visible=True, alpha=0.3)
    path.parent.mkdir(parents=True, exist_ok=True)
    figure.savefig(path, metadata={"Date": None} if path.suffix == ".svg" else None)
    plt.close(figure)


def main(arguments: Sequence[str] | None = None) -> int:
    """Search, keep what was seen on the way, and plot it."""
    parser = argparse.ArgumentParser(description=(__doc__ or "").splitlines()[0])
    parser.add_argument("size", nargs="?", type=patrol, default=Size(3, 5), metavar="SIZE")
    parser.add_argument("--most", type=int, default=100 * FIRST, help="where to stop (default 10⁸)")
    parser.add_argument("--first", type=int, default=FIRST, help="where the table begins (default 10⁶)")
    parser.add_argument("--output", type=Path, default=RESULTS, help="where the figures are kept")
    parser.add_argument("--plot", type=Path, default=PLOT, help="an SVG or PNG file")
    given = parser.parse_args(arguments)
    machine = describe()
    explored(Size(2, 2).text)  # from here on compiled loops are cached
    say(f"{given.size}: one search, up to {given.most:,} configurations")
    wanted = marks(given.most, given.first)
    found = explored(given.size.text, "--marks", ",".join(map(str, wanted)))
    if not found.bounds and given.size.counts not in (None, (found.configurations, found.transitions)):
        raise SystemExit(
            f"{given.size}: {found.configurations}, {found.transitions} is not {given.size.counts}"
        )
    rows = growing(found.marks)
    rates = [row["transitions_per_second"] for row in rows]
    kept = {
        "machine": machine,
        "size": str(given.size),
        "bounds": found.bounds,
        "configurations": found.configurations,
        "transitions": found.transitions,
        "rule_runs": found.rule_runs,
        "peak_memory": found.memory,
        "bytes_per_configuration": found.bytes_per_configuration,
        "rate_kept": {
            "configurations": rows[-1]["expanded_per_second"] / rows[0]["expanded_per_second"],
            "transitions": rates[-1] / rates[0],
        },
        "marks": rows,
    }
    given.output.parent.mkdir(parents=True, exist_ok=True)
    given.output.write_text(json.dumps(kept, indent=1) + "\n", encoding="utf-8")
    plot(rows, f"patrol, {given.size}", given.plot)
    from tables import growth_tables  # noqa: PLC0415  # it reads what was kept

    sys.stdout.write(growth_tables(kept))
    return 0


if __name__ == "__main__":
    sys.exit(main())
