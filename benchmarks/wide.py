"""Measure wide missions: fleets that look and move on, growing in vehicles and in places, in full and by partial order.

Usage: `python benchmarks/wide.py [--most N] [--most-reduced N] [--output FILE] [UAVSxROWSxCOLUMNS ...]`. A search ends
at so many configurations; how many transitions it has followed by then is asserted where it is known. At last a fleet
is searched whose UAVs have nothing to do with one another: partial order decides it, and both counts are asserted.
"""

import argparse
import json
import sys
from collections.abc import Sequence
from dataclasses import asdict, dataclass
from pathlib import Path

from machine import describe
from ours import Explored, explored
from patrol import box, centre, neighbours
from run import say

RESULTS = Path(__file__).parent / "results" / "wide.json"

SIZES = ("2x6x6", "12x6x6", "25x10x10", "50x10x10", "50x10x20")
MOST, MOST_REDUCED = 300_000, 1_000_000
APART = 50
"""UAVs of the fleet that have nothing to do with one another."""

TRANSITIONS = {
    ("2x6x6", 300_000): 817_735,
    ("12x6x6", 300_000): 3_636_018,
    ("25x10x10", 300_000): 7_500_204,
    ("50x10x10", 300_000): 15_000_000,
    ("50x10x20", 300_000): 15_000_000,
}
"""Followed in full, as they were also before rules were asked less: the same trees in another order."""


SIGNATURE = "signature {\n  kind Cell contains UAV\n  kind UAV driven\n}"


@dataclass(frozen=True, slots=True)
class Fleet:
    """UAVs on a grid; each asks what is in its cell, then moves on to a cell beside it."""

    uavs: int
    rows: int
    columns: int

    def __str__(self) -> str:
        return f"{self.uavs}x{self.rows}x{self.columns}"

    @property
    def text(self) -> str:
        """The mission."""
        return mission_text(self.uavs, self.rows, self.columns)


def fleet(text: str) -> Fleet:
    """Read `50x10x20`.

    Raises:
        ValueError: It is not three numbers.
    """
    uavs, rows, columns = map(int, text.split("x"))
    return Fleet(uavs, rows, columns)


def mission_text(uavs: int, rows: int, columns: int) -> str:
    """Write the mission of a fleet whose UAVs start as far apart as the grid lets them."""
    cells = rows * columns
    places = [f"  cell{cell}: Cell = {box(cell, columns)}" for cell in range(cells)]
    places += [f"  uav{i}: UAV = point {centre(i * cells // uavs, columns)}" for i in range(uavs)]
    moves = {cell: neighbours(cell, columns, rows) for cell in range(cells)}
    cases = [
        f"    case obs if cell{cell} in obs =>\n      choose "
        + " or ".join(f"{{ control(MOVE_HOST_TO cell{there}) }}" for there in beside)
        for cell, beside in moves.items()
    ]
    agents = [f"BigActor a{i} hosted_at uav{i} with_behavior {{ patrol() }}" for i in range(uavs)]
    world = "world {\n" + "\n".join(places) + "\n}"
    body = "loop {\n  observe(CHILDREN(PARENT(HOST)))\n  react {\n" + "\n".join(cases) + "\n  }\n}"
    behaviour = f"def patrol() = {{\n{body}\n}}"
    return "\n\n".join(["mission fleet", SIGNATURE, world, behaviour, "\n".join(agents)]) + "\n"


def text_of_rounds(uavs: int) -> str:
    """Write the mission of a fleet whose UAVs each go round four cells of their own, for ever, and look into each."""
    cells = range(4 * uavs)
    places = [f"  cell{cell}: Cell = {box(cell, 20)}" for cell in cells]
    places += [f"  uav{i}: UAV = point {centre(4 * i, 20)}" for i in range(uavs)]
    look = "observe(PARENT(HOST)) react { case obs => skip }"
    legs = [[f"  {look} control(MOVE_HOST_TO cell{4 * i + k})" for k in (1, 2, 3, 0)] for i in range(uavs)]
    agents = [
        "\n".join([f"BigActor a{i} hosted_at uav{i} with_behavior {{ loop {{", *round_of, "} }"])
        for i, round_of in enumerate(legs)
    ]
    world = "world {\n" + "\n".join(places) + "\n}"
    return "\n\n".join(["mission rounds", SIGNATURE, world, *agents]) + "\n"


def measure_apart(uavs: int) -> Explored:
    """Explore the fleet whose UAVs have nothing to do with one another, by partial order on one core.

    Raises:
        SystemExit: It has more configurations than one after another go through.
    """
    found = explored(text_of_rounds(uavs), "--cores", "1", "--reduce")
    counts = (found.configurations, found.transitions)
    if counts != (19 * uavs + 1, 20 * uavs):
        raise SystemExit(f"{uavs} apart: {counts[0]:,} configurations, {counts[1]:,} transitions")
    return found


def measure(size: Fleet, most: int, most_reduced: int) -> dict[str, Explored]:
    """Explore a fleet in full and by partial order, on one core each.

    Raises:
        SystemExit: It has other counts than are known.
    """
    found = {
        "in full": explored(size.text, "--cores", "1", "--most", str(most)),
        "by por": explored(size.text, "--cores", "1", "--most", str(most_reduced), "--reduce"),
    }
    known = TRANSITIONS.get((str(size), most))
    if known is not None and found["in full"].transitions != known:
        raise SystemExit(f"{size}: {found['in full'].transitions:,} transitions, not {known:,}")
    return found


def row(size: str, way: str, found: Explored) -> dict[str, object]:
    """Print what was found, and return what is kept of it."""
    say(
        f"{size} {way}: {found.configurations:,} configurations, {found.transitions:,} transitions, "
        f"{found.rate:,.0f} a second, learning {found.learning / max(found.seconds, 1e-9):.0%}, "
        f"{found.rule_runs:,} runs of rules, {found.bytes_per_configuration:.0f} B"
    )
    return {"size": size, "way": way, **asdict(found)}


def main(arguments: Sequence[str] | None = None) -> int:
    """Measure what was asked for, print and write it."""
    parser = argparse.ArgumentParser(description=(__doc__ or "").splitlines()[0])
    parser.add_argument(
        "sizes", nargs="*", type=fleet, metavar="UAVSxROWSxCOLUMNS", default=list(map(fleet, SIZES))
    )
    parser.add_argument("--most", type=int, default=MOST, help="end each search at so many configurations")
    parser.add_argument("--most-reduced", type=int, default=MOST_REDUCED, help="the same by partial order")
    parser.add_argument("--output", type=Path, default=RESULTS)
    given = parser.parse_args(arguments)
    rows = []
    for size in given.sizes:
        for way, found in measure(size, given.most, given.most_reduced).items():
            rows.append(row(str(size), way, found))
    rows.append(row(f"{APART} apart", "by por", measure_apart(APART)))
    given.output.write_text(
        json.dumps({"machine": describe(), "most": given.most, "rows": rows}, indent=1) + "\n"
    )
    return 0


if __name__ == "__main__":
    sys.exit(main())
