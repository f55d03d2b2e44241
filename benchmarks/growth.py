"""Measure how rate and memory change as a search grows: sample one search of the patrol, and plot it.

Usage: `python benchmarks/growth.py [--most N] [--no-peer] [--output FILE] [--plot FILE] [SIZE]`, by default 3x5 up to
10⁸. Learning and loading mostly precede the first mark, a quarter of the next, which is not a row of the table. SPIN
then searches the same, breadth-first as we do, since the necessary depth of a stack is not known in advance.
"""

import argparse
import json
import sys
import tempfile
from collections.abc import Mapping, Sequence
from dataclasses import asdict
from itertools import pairwise
from pathlib import Path
from typing import Any

from machine import describe
from ours import Explored, explored
from patrol import promela_text
from run import Size, patrol, say
from spin import Bounds, Searched, agree, bounded, has_peer

RESULTS = Path(__file__).parent / "results" / "growth.json"
PLOT = Path(__file__).parents[1] / "docs" / "pictures" / "growth.svg"

FIRST = 1_000_000

Mark = dict[str, float]
Row = dict[str, Any]


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


NEAR = 0.1
"""Up to which part of its size one of SPIN's marks may be apart from ours, to stand beside it."""


def peer(size: Size, bounds: Bounds) -> Searched:
    """Have SPIN search the same patrol as far as bounds allow."""
    promela = promela_text(size.agents, size.side, size.handover)
    say(f"SPIN: {size}, up to {bounds.configurations:,} configurations")
    with tempfile.TemporaryDirectory() as folder:
        return bounded(promela, Path(folder), bounds, breadth_first=True)


def beside(rows: Sequence[Mark], seen: Sequence[Mapping[str, float]]) -> list[dict[str, float] | None]:
    """Return for each row what SPIN had at that size, with its rate since the row before; None where it said nothing.

    Bytes are those of all that SPIN takes for itself, by its own account: states, hash table, queues.
    """
    found, before = list[dict[str, float] | None](), {"transitions": 0.0, "seconds": 0.0}
    for row in rows:
        mark = min(seen, key=lambda mark: abs(mark["configurations"] - row["configurations"]), default=None)
        if mark is None or not _near(row, mark) or mark["seconds"] <= before["seconds"]:
            found.append(None)
            continue
        rate = (mark["transitions"] - before["transitions"]) / (mark["seconds"] - before["seconds"])
        each = mark["memory"] * 2**20 / mark["configurations"]
        found.append({**mark, "transitions_per_second": rate, "bytes_per_configuration": each})
        before = dict(mark)
    return found


def _near(row: Mark, mark: Mapping[str, float]) -> bool:
    return abs(mark["configurations"] / row["configurations"] - 1) < NEAR


def ratios(rows: Sequence[Row]) -> dict[str, float] | None:
    """Compare rates since the start, and memory for each configuration, at the last size that both reached."""
    both = [(row, row["peer"]) for row in rows if row.get("peer")]
    if not both:
        return None
    ours, spin = both[-1]
    rate = (ours["transitions"] / ours["seconds"]) / (spin["transitions"] / spin["seconds"])
    each = (ours["memory"] / ours["configurations"]) / (spin["memory"] / spin["configurations"])
    return {"transitions_per_second": rate, "memory": each}


def plot(rows: Sequence[Row], title: str, path: Path) -> None:
    """Draw rate and bytes over the number of configurations, and SPIN's beside them."""
    import matplotlib as mpl  # noqa: PLC0415

    mpl.use("Agg")
    mpl.rcParams["svg.hashsalt"] = "growth"  # the same figures make the same file
    from matplotlib import pyplot as plt  # noqa: PLC0415

    figure, (rates, room) = plt.subplots(2, 1, sharex=True, figsize=(7, 5.5), layout="constrained")
    sizes = [row["configurations"] for row in rows]
    rates.plot(sizes, [row["expanded_per_second"] / 1e6 for row in rows], "o-", label="configurations")
    rates.plot(sizes, [row["transitions_per_second"] / 1e6 for row in rows], "s--", label="transitions")
    spin = [row["peer"] for row in rows if row.get("peer")]
    reached = [mark["configurations"] for mark in spin]
    if spin:
        peers = [mark["transitions_per_second"] / 1e6 for mark in spin]
        rates.plot(reached, peers, "^:", color="grey", label="transitions, SPIN")
        room.plot(
            reached, [mark["bytes_per_configuration"] for mark in spin], "^:", color="grey", label="SPIN"
        )
    rates.set(ylabel="million a second", xscale="log", title=title)
    rates.legend()
    room.plot(sizes, [row["bytes_per_configuration"] for row in rows], "o-", label="bigactors")
    most = [row["most_bytes_per_configuration"] for row in rows]
    room.plot(sizes, most, "s--", label="bigactors at most, since the mark before")
    room.axhline(40, color="grey", linestyle="--", label="the aim")
    room.legend()
    room.set(xlabel="configurations", ylabel="bytes a configuration")
    for axes in (rates, room):
        axes.set_ylim(bottom=0)
        axes.grid(visible=True, alpha=0.3)
    path.parent.mkdir(parents=True, exist_ok=True)
    figure.savefig(path, metadata={"Date": None} if path.suffix == ".svg" else None)
    plt.close(figure)


def _assert_counts(size: Size, found: Explored, counts: tuple[int, int] | None) -> None:
    mine = (found.configurations, found.transitions)
    if counts is not None and not found.bounds and not agree(mine, counts):
        raise SystemExit(f"{size}: {mine} is not {counts}")


def _figures(found: Explored, rows: Sequence[Row], spin: Searched | None) -> Row:
    """Return what is kept of a search and of its peer."""
    first, last = rows[0], rows[-1]
    return {
        "bounds": found.bounds,
        "configurations": found.configurations,
        "transitions": found.transitions,
        "rule_runs": found.rule_runs,
        "peak_memory": found.memory,
        "bytes_per_configuration": found.bytes_per_configuration,
        "rate_kept": {
            "configurations": last["expanded_per_second"] / first["expanded_per_second"],
            "transitions": last["transitions_per_second"] / first["transitions_per_second"],
        },
        "peer": spin and asdict(spin) | {"tool": "SPIN, breadth-first, no reduction"},
        "ratio_to_spin": ratios(rows),
        "marks": rows,
    }


def main(arguments: Sequence[str] | None = None) -> int:
    """Search, keep what was seen on the way, and plot it."""
    parser = argparse.ArgumentParser(description=(__doc__ or "").splitlines()[0])
    parser.add_argument("size", nargs="?", type=patrol, default=Size(3, 5), metavar="SIZE")
    parser.add_argument("--most", type=int, default=100 * FIRST, help="where to stop (default 10⁸)")
    parser.add_argument("--first", type=int, default=FIRST, help="where the table begins (default 10⁶)")
    parser.add_argument("--no-peer", action="store_true", help="without SPIN")
    parser.add_argument("--minutes", type=float, default=15, help="for SPIN at most (default 15)")
    parser.add_argument(
        "--gigabytes", type=float, default=16, help="for SPIN at most, in units of 2³⁰ bytes (default 16)"
    )
    parser.add_argument("--output", type=Path, default=RESULTS, help="where the figures are kept")
    parser.add_argument("--plot", type=Path, default=PLOT, help="an SVG or PNG file")
    given = parser.parse_args(arguments)
    machine = describe()
    explored(Size(2, 2).text)  # from here on compiled loops are cached
    say(f"{given.size}: one search, up to {given.most:,} configurations")
    found = explored(given.size.text, "--marks", ",".join(map(str, marks(given.most, given.first))))
    _assert_counts(given.size, found, given.size.counts)
    rows: list[Row] = [dict(row) for row in growing(found.marks)]
    spin = None
    if has_peer(wanted=not given.no_peer):
        spin = peer(given.size, Bounds(given.minutes, given.gigabytes, given.most))
        _assert_counts(given.size, found, None if spin.bounds else (spin.configurations, spin.transitions))
        rows = [row | {"peer": mark} for row, mark in zip(rows, beside(rows, spin.marks), strict=True)]
    kept = {"machine": machine, "size": str(given.size)} | _figures(found, rows, spin)
    given.output.parent.mkdir(parents=True, exist_ok=True)
    given.output.write_text(json.dumps(kept, indent=1) + "\n", encoding="utf-8")
    plot(rows, f"patrol, {given.size}", given.plot)
    from tables import growth_tables  # noqa: PLC0415  # it reads what was kept

    sys.stdout.write(growth_tables(kept))
    return 0


if __name__ == "__main__":
    sys.exit(main())
