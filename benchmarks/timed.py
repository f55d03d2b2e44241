"""Zones beside TChecker's: `make bench-time`, which prints a table; TCHECKER names its program `tck-reach`.

A mission of the timed family is explored, which runs the rules once in each configuration, and then once more, when
the automaton is known: so long the compiled loops take. TChecker searches the same automaton (`bigactors export`) with
subsumption (`-a covreach`); its time is what it says of its search alone, without what it works out before.
"""

import argparse
import os
import re
import resource
import subprocess
import sys
import tempfile
import time
from pathlib import Path

from timed_family import text

from checker.engines.choose import explore
from checker.engines.contract import Engine, Exploration
from checker.engines.zones.interchange import model_of
from checker.engines.zones.search import Search
from checker.engines.zones.tchecker import tchecker_text
from checker.engines.zones.zone_times import ZoneTimes
from specs.elaboration import load_mission

KNOWN = {(1, 3): (25, 25), (2, 2): (682, 1_889), (2, 3): (2_490, 7_103)}
"""How many configurations and zones some of the family have."""


def main() -> None:
    """Print a row for each mission."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("cases", nargs="*", default=["1x3", "2x2", "2x3"], metavar="UAVSxPLACES")
    for case in parser.parse_args().cases:
        uavs, places = map(int, case.split("x"))
        print(row(uavs, places), flush=True)  # noqa: T201


def row(uavs: int, places: int) -> str:
    """Explore one mission by both."""
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder, f"timed_family_{uavs}_{places}.mission")
        path.write_text(text(uavs, places), encoding="utf-8")
        began = time.process_time()
        found = explore(load_mission(path).initial, engine=Engine.FAST)
        seconds = time.process_time() - began
        assert isinstance(found.times, ZoneTimes)
        size = (found.size, found.times.search.count)
        assert KNOWN.get((uavs, places), size) == size, size
        ours = f"{size[0]:,} configurations, {size[1]:,} zones in {seconds:.2f} s, {again(found.times)}"
        return f"{uavs} UAVs, {places} places: {ours}{beside(found, Path(folder))}"


def again(times: ZoneTimes) -> str:
    """Search the automaton that is known, and say how quickly."""
    network = times.network
    network.automaton.forget()
    began = time.process_time()
    search = Search(network.automaton, network.first, network.first_ages)
    search.finish(lambda: None)
    seconds = time.process_time() - began
    assert search.count == times.search.count
    peak = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss >> (20 if sys.platform == "darwin" else 10)
    return f"known: {search.count / seconds:,.0f} zones/s, {peak:,} MiB in all"


def beside(found: Exploration, folder: Path) -> str:
    """Let TChecker search the same automaton, if it is here."""
    program = os.environ.get("TCHECKER")
    if program is None:
        return ""
    assert isinstance(found.times, ZoneTimes)
    model = folder / "model.tck"
    model.write_text(tchecker_text(model_of(found.times, None, "family")), encoding="utf-8")
    said = subprocess.run([program, "-a", "covreach", str(model)], capture_output=True, text=True, check=True)
    told = dict(re.findall(r"^([A-Z_]+) (\S+)$", said.stdout, re.MULTILINE))
    states, seconds = int(told["STORED_STATES"]), float(told["RUNNING_TIME_SECONDS"])
    peak = int(told["MEMORY_MAX_RSS"]) >> 10
    return f"; TChecker: {states:,} zones, {states / seconds:,.0f} zones/s, {peak:,} MiB"


if __name__ == "__main__":
    main()
