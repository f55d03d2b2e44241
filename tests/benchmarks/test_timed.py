"""The timed family has the counts and the verdicts that are known."""

from pathlib import Path

import pytest
from scripts import script

from checker import Engine, check
from specs import parse_bytes
from specs.elaboration import elaborate

timed_family = script("timed_family")
timed = script("timed")


@pytest.mark.parametrize("engine", [Engine.REFERENCE, Engine.FAST])
def test_uavs_are_there_in_time_and_home_on_their_batteries(engine):
    source, tree = parse_bytes("timed.mission", timed_family.text(1, 3).encode())
    report = check(elaborate(tree, source, Path()), engine=engine)
    assert (report.configurations, report.transitions) == (25, 31)
    assert {each.outcome.value for each in report.verdicts} == {"holds"}
    # 3 ticks until it takes off, then 3 flights of 6.05 km at 18 m/s, 34 ticks each, with a tick between two
    assert report.verdicts["there"].note == "after 17:50 at the latest"


def test_a_row_says_how_many_zones_there_are(monkeypatch):
    monkeypatch.delenv("TCHECKER", raising=False)
    assert timed.row(1, 3).startswith("1 UAVs, 3 places: 25 configurations, 25 zones in ")
