"""Write the tables of docs/explanation/performance.md from the benchmarks' results, between its markers.

Usage: `python benchmarks/tables.py [--results FOLDER] [--page FILE]`. What was not measured yet stays.
"""

import argparse
import json
import re
import sys
from collections import Counter
from collections.abc import Callable, Iterable, Sequence
from itertools import groupby
from pathlib import Path
from typing import Any

RESULTS = Path(__file__).parent / "results"
PAGE = Path(__file__).parents[1] / "docs" / "explanation" / "performance.md"

RATIOS = {
    "two cores, SPIN's one = 1": "configurations_per_second",
    "one, SPIN's one = 1": "on_one_core",
    "two, SPIN's two = 1": "two_beside_two",
    "two, our one = 1": "two_beside_one",
    "two, all learned, SPIN's one = 1": "search_alone",
    "memory, SPIN's = 1": "memory",
}
"""What is compared with the patrol in SPIN, by the heads of its columns."""

LIBRARIES = ("python", "numba", "numpy")

Kept = dict[str, Any]


def patrol_tables(kept: Kept) -> str:
    """Lay out the patrol beside SPIN: each tool, the ratios, and the phases of a cold and a warm start."""
    tools = [
        (each["size"], name, *_run(run)) for each in kept["sizes"] for name, run in each["median"].items()
    ]
    beside = [
        (
            each["size"],
            f"{each['configurations']:,}",
            *(_ratio(each["ratio_to_spin"], ratio) for ratio in RATIOS.values()),
        )
        for each in kept["sizes"]
    ]
    start = kept["start"]
    phases = [
        (name, *(f"{seconds:.2f}" for seconds in start[name]["phases"].values())) for name in ("cold", "warm")
    ]
    heads = (
        "UAVs, grid|tool|configurations|transitions|seconds|configurations/s|peak MB|bytes each|rules run in Python",
        "|".join(("UAVs, grid", "configurations", *RATIOS)),
        f"start ({start['size']})|import, load|compile|learn|search, load loops|whole process",
    )
    tables = (_table(head, rows) for head, rows in zip(heads, (tools, beside, phases), strict=True))
    return "\n".join([*tables, machine(kept, "spin", "gcc")])


def _ratio(ratios: Kept, name: str) -> str:
    """Return a ratio as text; what was measured before it was asked for has none."""
    return f"{ratios[name]:.2f}" if name in ratios else ""


def _run(run: Kept) -> tuple[str, ...]:
    each, runs = run.get("bytes_per_configuration"), run.get("rule_runs")
    return (
        f"{run['configurations']:,}",
        f"{run['transitions']:,}",
        f"{run['seconds']:.2f}",
        f"{run['configurations_per_second']:,.0f}",
        f"{run['memory']:,.0f}",
        "" if each is None else f"{each:.1f}",
        "" if runs is None else f"{runs:,}",
    )


def wide_table(kept: Kept) -> str:
    """Lay out the fleets, in full and by partial order."""
    rows = [
        (
            each["size"].replace(" apart", " UAVs apart").replace("x", " UAVs, ", 1).replace("x", " × "),
            each["way"],
            f"{each['configurations']:,}",
            f"{each['transitions']:,}",
            f"{each['configurations'] / each['seconds']:,.0f}",
            f"{each['learning'] / each['seconds']:.0%}",
            f"{each['rule_runs']:,}",
            f"{each['bytes_per_configuration']:.0f}",
        )
        for each in kept["rows"]
    ]
    head = "fleet, grid|searched|configurations|transitions|configurations/s|learning|rules run in Python|bytes each"
    return f"{_table(head, rows)}\n{machine(kept)}"


def bigraph_table(kept: Kept) -> str:
    """Lay out generated families of bigraphical systems, beside BigraphER."""
    head = "case|states / transitions|s|states/s|bytes/state|BigraphER, s|times its rate"
    rows = [
        (each["case"], *_explored(each["ours"]), *_beside_bigrapher(each["ours"], each["bigrapher"]))
        for each in kept["rows"]
    ]
    return f"{_table(head, rows)}\n{machine(kept)}"


def _explored(ours: Kept) -> tuple[str, ...]:
    return (
        f"{ours['states']:,} / {ours['transitions']:,}",
        f"{ours['seconds']:.2f}",
        f"{ours['states'] / ours['seconds']:,.0f}",
        f"{ours['bytes_per_state']:,.0f}",
    )


def _beside_bigrapher(ours: Kept, peer: Kept | None) -> tuple[str, str]:
    if peer is None:
        return "", ""
    more, quoted = "" if peer["ended"] else "more than ", " quoted" if peer["source"] == "quoted" else ""
    return f"{more}{peer['seconds']:.1f}{quoted}", f"{more}{peer['seconds'] / ours['seconds']:,.1f}"


OUTCOMES = ("equal", "different", "stopped", "not read", "not run")
"""What became of a file in BigraphER, beside ours."""


def real_bigraph_table(kept: Kept) -> str:
    """Lay out the real files by repository, beside BigraphER; the results have a row for each file."""
    head = "|".join(("repository", "files", "read", "s", "largest MB", *OUTCOMES, "stopped after, ours = 1"))
    lines = [
        _repository(name, list(rows))
        for name, rows in groupby(kept["rows"], key=lambda row: row["file"].partition("/")[0])
    ]
    return "\n".join([_table(head, lines), f"Limits: {kept['limits']}.\n", machine(kept)])


def _repository(name: str, rows: Sequence[Kept]) -> tuple[str, ...]:
    ours, outcomes = [row["ours"] for row in rows], Counter(map(_outcome, rows))
    ratios = [
        row["bigrapher"]["seconds"] / row["ours"]["seconds"]
        for row in rows
        if _outcome(row) == "stopped" and not row["ours"]["why"]
    ]
    return (
        name,
        f"{len(rows)}",
        f"{sum(run['states'] is not None for run in ours)}",
        f"{sum(run['seconds'] for run in ours):.1f}",
        f"{max(run['megabytes'] for run in ours):.0f}",
        *(str(outcomes[outcome] or "") for outcome in OUTCOMES),
        f"at least {min(ratios):.1f}" if ratios else "",
    )


def _outcome(row: Kept) -> str:
    peer = row["bigrapher"]
    if peer is None:
        return "not run"
    if "signal" in peer["why"]:
        return "stopped"
    if peer["states"] is None:
        return "not read"
    return "equal" if _counts(row["ours"]) == _counts(peer) else "different"


def _counts(run: Kept) -> tuple[int | None, int | None, bool]:
    return run["states"], run["transitions"], bool(run["why"])


def _table(head: str, rows: Iterable[Sequence[str]]) -> str:
    names = head.split("|")
    lines = [names, ["---", *("---:" for _ in names[1:])], *rows]
    return "".join(f"| {' | '.join(line)} |\n" for line in lines)


def machine(kept: Kept, *peers: str) -> str:
    """Return a line about the machine, with the versions of our libraries and of the peers."""
    on = kept["machine"]
    numbers = {name: re.search(r"\d+(\.\d+)+", on["versions"].get(name, "")) for name in (*LIBRARIES, *peers)}
    versions = ", ".join(f"{name} {number[0]}" for name, number in numbers.items() if number)
    return (
        f"Measured {on['day']} on {on['processor']}, {on['cores']} cores, {on['memory_gb']} GB, load average"
        f" {on['load_average']}; {versions}.\n"
    )


TABLES: dict[str, Callable[[Kept], str]] = {
    "patrol": patrol_tables,
    "wide": wide_table,
    "bigraphs": bigraph_table,
    "real_bigraphs": real_bigraph_table,
}


def filled(page: str, name: str, table: str) -> str:
    """Return a page with what stands between the markers of a name replaced.

    Raises:
        ValueError: The page does not have them.
    """
    begin, end = f"<!-- begin {name} -->", f"<!-- end {name} -->"
    pattern = re.compile(f"{re.escape(begin)}.*?{re.escape(end)}", re.DOTALL)
    if not pattern.search(page):
        raise ValueError(f"the page has no markers {begin} and {end}")
    return pattern.sub(lambda _: f"{begin}\n\n{table}\n{end}", page)


def main(arguments: Sequence[str] | None = None) -> int:
    """Write every table that was measured into the page."""
    parser = argparse.ArgumentParser(description=(__doc__ or "").splitlines()[0])
    parser.add_argument("--results", type=Path, default=RESULTS, metavar="FOLDER")
    parser.add_argument("--page", type=Path, default=PAGE, metavar="FILE")
    given = parser.parse_args(arguments)
    page = given.page.read_text(encoding="utf-8")
    for name, table in TABLES.items():
        kept = given.results / f"{name}.json"
        if kept.exists():
            page = filled(page, name, table(json.loads(kept.read_text(encoding="utf-8"))))
    given.page.write_text(page, encoding="utf-8")
    return 0


if __name__ == "__main__":
    sys.exit(main())
