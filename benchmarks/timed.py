"""Zones beside TChecker's: `make bench-time`, which prints a table; TCHECKER names its program `tck-reach`.

A mission of the timed family is explored, which learns the rules on the way, and then once more, when the automaton is
known: so long the compiled loops take. Under `program_order` the UAVs are independent. TChecker gets the file of
`bigactors export` with endurance, which has a process for each of them. It searches that in local time (`-a concur19`),
with `--clock global` under one clock (`-a covreach`). Zones are those that were followed, of both. Seconds are the
processor's, of TChecker its whole run's.
"""

import argparse
import os
import re
import resource
import sys
import tempfile
import time
from concurrent.futures import ProcessPoolExecutor
from multiprocessing import get_context
from pathlib import Path

from machine import run_peer
from timed_family import text

from checker import Limits, ZoneClock
from checker.engines.choose import explore
from checker.engines.contract import Engine, Exploration
from checker.engines.timed.zone_answers import ZoneTimes
from checker.engines.zones.automaton_export import model_of
from checker.engines.zones.tchecker import tchecker_text
from checker.engines.zones.zone_search import Search
from semantics.properties.kinds import PropertyKind
from semantics.properties.property import Property
from specs.elaboration import load_mission

KNOWN = {
    ("fcfs", 1, 3): (25, 25),
    ("fcfs", 2, 2): (682, 1_889),
    ("fcfs", 2, 3): (2_490, 7_103),
    ("fcfs", 3, 1): (5_393, 28_544),
    ("program_order", 2, 3): (365, 893),
    ("program_order", 3, 1): (1_044, 5_527),
    ("program_order", 3, 3): (6_017, 41_399),
    ("program_order", 3, 7): (40_465, 316_391),
    ("program_order", 4, 1): (10_122, 164_287),
}
"""How many configurations, and zones under one clock, some of the family have; in local time there is one for each."""


def main() -> None:
    """Print a row for each mission."""
    parser = argparse.ArgumentParser(description=__doc__)
    default = ["fcfs:2x3", "fcfs:3x1", "fcfs:3x2", "2x3", "3x1", "3x3", "3x7", "4x1", "5x1"]
    parser.add_argument("cases", nargs="*", default=default, metavar="[fcfs:]UAVSxPLACES")
    parser.add_argument("--most", type=int, default=2_000_000, help="so many zones are explored at the most")
    parser.add_argument("--clock", type=ZoneClock, default=ZoneClock.LOCAL, help="local or global")
    given = parser.parse_args()
    # Each in a process of its own, whose memory is then that of its search.
    with ProcessPoolExecutor(1, mp_context=get_context("spawn"), max_tasks_per_child=1) as fresh:
        for case in given.cases:
            scheduler, _, size = case.rpartition(":")
            uavs, places = map(int, size.split("x"))
            printed = fresh.submit(row, uavs, places, scheduler or "program_order", given.most, given.clock)
            print(printed.result(), flush=True)  # noqa: T201


def row(
    uavs: int, places: int, scheduler: str, most: int | None = None, clock: ZoneClock = ZoneClock.LOCAL
) -> str:
    """Explore one mission by both."""
    with tempfile.TemporaryDirectory() as folder:
        began = time.process_time()
        found = explored(text(uavs, places, scheduler=scheduler), Path(folder), most, clock)
        seconds = time.process_time() - began
        assert isinstance(found.times, ZoneTimes)
        size = (found.size, found.times.search.count)
        expected = KNOWN.get((scheduler, uavs, places), size)
        assert (expected if not found.times.search.is_local else (size[0],) * 2) == size, size
        assert found.size == expected[0]
        known = again(found.times) if found.complete else f"{found.bounds[0]} was met"
        ours = f"{size[0]:,} configurations, {size[1]:,} zones in {seconds:.2f} s, {known}"
        peer = (
            beside(text(uavs, places, scheduler=scheduler), Path(folder), clock)
            if found.complete and scheduler == "program_order"
            else ""
        )
        return f"{uavs} UAVs, {places} places, {scheduler}: {ours}{peer}"


def explored(
    mission: str, folder: Path, most: int | None = None, clock: ZoneClock = ZoneClock.LOCAL
) -> Exploration:
    """Explore a mission by zones, up to a number of them."""
    path = folder / "timed_family.mission"
    path.write_text(mission, encoding="utf-8")
    initial = load_mission(path).initial
    return explore(initial, engine=Engine.FAST, limits=Limits(configurations=most), clock=clock)


def again(times: ZoneTimes) -> str:
    """Search the automaton that is known, and say how quickly."""
    network = times.network
    peak = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss >> (20 if sys.platform == "darwin" else 10)
    network.automaton.forget()
    began = time.process_time()
    is_local = times.search.is_local
    search = Search(network.automaton, network.first, network.first_ages, is_local=is_local)
    search.finish(lambda: None)
    seconds = time.process_time() - began
    assert search.count == times.search.count
    return f"known: {search.count / seconds:,.0f} zones/s, {peak:,} MiB in all"


def beside(mission: str, folder: Path, clock: ZoneClock) -> str:
    """Let TChecker search the same zones, if it is here."""
    program = os.environ.get("TCHECKER")
    if program is None:
        return ""
    model = folder / "network.tck"
    model.write_text(exported(mission, folder), encoding="utf-8")
    algorithm = "concur19" if clock is ZoneClock.LOCAL else "covreach"
    ran = run_peer([program, "-a", algorithm, str(model)])
    if ran.status:
        raise SystemExit(f"TChecker ended with {ran.status}:\n{ran.printed}")
    told = dict(re.findall(r"^([A-Z_]+) (\S+)$", ran.printed, re.MULTILINE))
    zones, seconds, peak = int(told["VISITED_STATES"]), ran.seconds, round(ran.memory)
    return f"; TChecker: {zones:,} zones in {seconds:.2f} s, {zones / seconds:,.0f} zones/s, {peak:,} MiB"


def exported(mission: str, folder: Path) -> str:
    """Return a mission for TChecker, a process for each UAV."""
    found = explored(mission, folder)
    assert isinstance(found.times, ZoneTimes)
    endurance = Property(PropertyKind.ENDURANCE, "endurance")
    return tchecker_text(model_of(found.times, endurance, "family", divided=True))


if __name__ == "__main__":
    main()
