"""The missions that ship: their exact counts, verdicts and lengths of traces (default scheduler, monitor not counted)."""

from dataclasses import dataclass, field
from functools import lru_cache
from pathlib import Path

import pytest

from checker import Limits, Report, check
from specs.elaboration import load_mission

MISSIONS = Path(__file__).parents[2] / "specs" / "missions"


@dataclass(frozen=True)
class Expected:
    """Counts, and for each property that is violated the lengths of its shortest traces by kind."""

    configurations: int
    transitions: int
    violated: dict[str, dict[str, int]] = field(default_factory=dict)
    witnesses: dict[str, int] = field(default_factory=dict)


SHIPPED: dict[str, Expected] = {}


@lru_cache(maxsize=2)
def checked(name: str) -> Report:
    mission = load_mission(MISSIONS / f"{name}.mission")
    return check(mission.initial, mission.properties, Limits(configurations=200_000))


def test_every_mission_that_ships_is_listed_here():
    assert sorted(path.stem for path in MISSIONS.glob("*.mission")) == sorted(SHIPPED)


@pytest.mark.parametrize("name", SHIPPED)
def test_the_counts_are_exact_and_complete(name):
    report = checked(name)
    expected = SHIPPED[name]
    assert (report.configurations, report.transitions) == (expected.configurations, expected.transitions)
    assert report.complete


@pytest.mark.parametrize("name", SHIPPED)
def test_the_verdicts_and_the_lengths_of_their_traces_are_as_expected(name):
    report = checked(name)
    violated = {
        verdict.property.name: {violation.kind: len(violation.trace) for violation in verdict.violations}
        for verdict in report.verdicts
        if verdict.outcome.value == "violated"
    }
    assert violated == SHIPPED[name].violated
    assert report.exit_code == (1 if violated else 0)


@pytest.mark.parametrize("name", SHIPPED)
def test_what_is_to_be_reachable_is_reached_by_a_shortest_witness(name):
    reached = {v.property.name: len(v.witness) for v in checked(name).verdicts if v.property.kind == "reachable" and v.witness}
    assert reached == SHIPPED[name].witnesses
