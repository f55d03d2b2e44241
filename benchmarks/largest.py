"""Find the largest oil spill and rendezvous that time and memory allow: in full, then reduced.

Usage: `python benchmarks/largest.py [--minutes N] [--gigabytes N] [--uavs N] [--spills N] [--robots N]
[--no-peer] [--peer-minutes N]`.
One more UAV or robot is added until a search meets a limit; from there on partial-order reduction goes on alike.
What was searched, SPIN searches too, within the same limits or in fewer minutes: full searches are asserted to have
the same counts.
"""

import argparse
import json
import sys
import tempfile
from collections.abc import Callable, Iterator, Sequence
from dataclasses import asdict, dataclass
from functools import partial
from pathlib import Path
from typing import Any

import oil_spill
import rendezvous
from machine import describe
from ours import Explored, explored
from run import say
from spin import Bounds, Searched, agree, bounded, has_peer

RESULTS = Path(__file__).parent / "results" / "largest.json"

COUNTS = {
    "oil_spill, 2 UAVs, 1 spill": (510, 1_438),
    "oil_spill, 2 UAVs, 2 spills": (1_530, 6_354),
    "oil_spill, 3 UAVs, 1 spill": (10_648, 36_017),
} | {f"rendezvous, {robots} robots": counts for robots, counts in rendezvous.COUNTS.items()}
"""What the reference explorer found: configurations and transitions, unreduced."""

ABOUT = 1.5
"""How far a guess of what a search takes may be off."""

Row = dict[str, object]


@dataclass(frozen=True, slots=True)
class Model:
    """A mission, and the same in Promela: to be searched in full, and by SPIN's partial order."""

    mission: str
    promela: str
    reducible: str


@dataclass(frozen=True, slots=True)
class Limits:
    """What one search may take, and for how long SPIN takes part: not at all where that is 0."""

    minutes: float
    gigabytes: float
    peer_minutes: float = 0.0

    def have_room(self, wanted: float, before: Explored) -> bool:
        """Tell whether so many configurations may find room and time, if each takes about what it took before."""
        memory = wanted * (before.bytes_per_configuration or 0)
        return memory < ABOUT * self.gigabytes * 2**30 and wanted / before.rate < ABOUT * self.minutes * 60

    def options(self) -> tuple[str, ...]:
        """Return them as `ours.py` takes them."""
        return ("--minutes", str(self.minutes), "--gigabytes", str(self.gigabytes))


def climb(family: str, models: dict[str, Model], limits: Limits) -> Iterator[Row]:
    """Explore models, each larger than the one before: in full until a limit is met, from there on reduced."""
    reduced, found = False, list[Explored]()
    for name, model in models.items():
        if not reduced:
            found.append(_search(name, model.mission, limits, found, reduced=False))
            yield _row(family, name, found[-1], reduced=False) | _beside(
                name, model.promela, found[-1], limits
            )
            if found[-1].bounds:
                reduced, found = True, []
        if reduced:
            found.append(_search(name, model.mission, limits, found, reduced=True))
            row = _row(family, name, found[-1], reduced=True)
            yield row | _beside(name, model.reducible, found[-1], limits, reduced=True)
            if found[-1].bounds:
                return


def _search(name: str, text: str, limits: Limits, before: list[Explored], *, reduced: bool) -> Explored:
    """Search, unless the last two searches let expect far more than there is room for."""
    wanted = expected(before)
    if wanted is not None and not limits.have_room(wanted, before[-1]):
        say(f"{name}: some {wanted:.1g} configurations are expected")
        return Explored(0, 0, [f"not tried: some {wanted:.0e} expected"], 0.0)
    return explored(text, "--engine", "fast", *(["--reduce"] if reduced else []), *limits.options())


def _beside(name: str, promela: str, ours: Explored, limits: Limits, *, reduced: bool = False) -> Row:
    """Have SPIN search what ours has searched; SystemExit where both are complete and their counts differ."""
    if not (limits.peer_minutes and ours.configurations):
        return {}
    with tempfile.TemporaryDirectory() as folder:
        bounds = Bounds(limits.peer_minutes, limits.gigabytes)
        peer = bounded(promela, Path(folder), bounds, reduced=reduced)
    counts, theirs = (ours.configurations, ours.transitions), (peer.configurations, peer.transitions)
    if not (reduced or ours.bounds or peer.bounds or agree(counts, theirs)):
        raise SystemExit(f"{name}: the counts are {counts}, and SPIN's are {theirs}")
    ended = ", ".join(peer.bounds) or "complete"
    say(f"  SPIN: {peer.configurations:,}, {ended}, {peer.seconds:.1f} s")
    figures = {key: value for key, value in asdict(peer).items() if key != "marks"}
    return {"peer": figures | {"ended": ended}, "ratio_to_spin": ratios(ours, peer)}


def ratios(ours: Explored, peer: Searched) -> dict[str, float]:
    """Return how many times SPIN's rate ours is, and what part of its configurations and of its memory for each."""
    return {
        "configurations_per_second": ours.rate / peer.rate,
        "configurations": ours.configurations / peer.configurations,
        "memory_each": (ours.memory / ours.configurations) / (peer.memory / peer.configurations),
    }


def expected(before: Sequence[Explored]) -> float | None:
    """Return how many configurations the next search may have, if it grows as the last one did.

    >>> expected([Explored(10, 0, [], 0.0), Explored(300, 0, [], 0.0)])
    9000.0
    """
    if len(before) < 2:
        return None
    return before[-1].configurations ** 2 / before[-2].configurations


def _row(family: str, name: str, found: Explored, *, reduced: bool) -> Row:
    counts = (found.configurations, found.transitions)
    if not reduced and not found.bounds and COUNTS.get(name, counts) != counts:
        raise SystemExit(f"{name}: the counts are {counts}, not {COUNTS[name]}")
    how = "reduced by por" if reduced else "in full"
    say(
        f"{name}, {how}: {found.configurations:,}, {', '.join(found.bounds) or 'complete'}, {found.seconds:.1f} s"
    )
    ended = ", ".join(found.bounds) or "complete"
    row = {"family": family, "name": name, "reduced": reduced, "complete": not found.bounds, "ended": ended}
    return row | asdict(found)


def largest(rows: Sequence[Row]) -> dict[str, Row]:
    """Return of each family the complete search of the last mission, in full and reduced."""
    return {
        f"{row['family']}, {'reduced' if row['reduced'] else 'in full'}": row
        for row in rows
        if row["complete"]
    }


def _spills(most: int, spills: int) -> dict[str, Model]:
    return {
        f"oil_spill, {uavs} UAVs, {spills} spill{'s' if spills > 1 else ''}": _spill(uavs, spills)
        for uavs in range(2, most + 1)
    }


def _spill(uavs: int, spills: int) -> Model:
    promela = oil_spill.promela_text(uavs, spills)
    return Model(oil_spill.mission_text(uavs, spills), promela, promela)


def _meetings(most: int) -> dict[str, Model]:
    return {f"rendezvous, {robots} robots": _meeting(robots) for robots in range(3, most + 1)}


def _meeting(robots: int) -> Model:
    texts = (rendezvous.promela_text(robots, channels=channels) for channels in (False, True))
    return Model(rendezvous.mission_text(robots), *texts)


def families(uavs: int, spills: int, robots: int) -> dict[str, Callable[[], dict[str, Model]]]:
    """Return what makes the models of each family, the larger the later."""
    found: dict[str, Callable[[], dict[str, Model]]] = {
        f"oil_spill, spills: {count}": partial(_spills, uavs, count) for count in range(1, spills + 1)
    }
    return found | {"rendezvous": partial(_meetings, robots)}


_NOTHING: dict[str, Any] = {"searches": []}


def _kept(path: Path) -> dict[str, Any]:
    """Return what was kept before; nothing where there is no such file."""
    return json.loads(path.read_text(encoding="utf-8")) if path.exists() else _NOTHING


def main(arguments: Sequence[str] | None = None) -> int:
    """Climb each family as far as the limits allow, and keep what was found."""
    parser = argparse.ArgumentParser(description=(__doc__ or "").splitlines()[0])
    parser.add_argument("--minutes", type=float, default=0.5, help="for each search (default 0.5)")
    parser.add_argument(
        "--gigabytes", type=float, default=4, help="for each search, in units of 2³⁰ bytes (default 4)"
    )
    parser.add_argument("--uavs", type=int, default=8, help="at most (default 8)")
    parser.add_argument("--spills", type=int, default=4, help="at most (default 4)")
    parser.add_argument("--robots", type=int, default=12, help="at most (default 12)")
    parser.add_argument(
        "--family",
        action="append",
        help="only this one, such as rendezvous; the others are left as they were kept",
    )
    parser.add_argument("--no-peer", action="store_true", help="without SPIN")
    parser.add_argument(
        "--peer-minutes", type=float, help="for each of SPIN's searches (default: as for ours)"
    )
    parser.add_argument("--output", type=Path, default=RESULTS, help="where the figures are kept")
    given = parser.parse_args(arguments)
    peer_minutes = given.minutes if given.peer_minutes is None else given.peer_minutes
    peer = has_peer(wanted=not given.no_peer and peer_minutes > 0)
    limits = Limits(given.minutes, given.gigabytes, peer_minutes if peer else 0.0)
    machine, rows = describe(), []
    before = _kept(given.output) if given.family else _NOTHING
    known = families(given.uavs, given.spills, given.robots)
    if unknown := set(given.family or ()) - known.keys():
        parser.error(f"no such family: {', '.join(sorted(unknown))}; there are {', '.join(known)}")
    for family, models in known.items():
        if given.family and family not in given.family:
            rows += [row for row in before["searches"] if row["family"] == family]
        else:
            rows += climb(family, models(), limits)
    kept = {
        "machine": machine,
        "limits": {
            what: max(most, before.get("limits", {}).get(what, 0))
            for what, most in (("minutes", limits.minutes), ("gigabytes", limits.gigabytes))
        },
        "largest": {name: row["name"] for name, row in largest(rows).items()},
        "searches": rows,
    }
    given.output.parent.mkdir(parents=True, exist_ok=True)
    given.output.write_text(json.dumps(kept, indent=1) + "\n", encoding="utf-8")
    from tables import largest_tables  # noqa: PLC0415  # it reads what was kept

    sys.stdout.write(largest_tables(kept))
    return 0


if __name__ == "__main__":
    sys.exit(main())
