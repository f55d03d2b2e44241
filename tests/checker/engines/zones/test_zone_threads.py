"""Zones in several threads: whichever thread makes them, the same ones are kept, in the same order."""

from collections import Counter

import pytest
from checked_missions import load
from hypothesis import HealthCheck, given
from scale import examples, seeds
from shipped import TIMED
from timed_missions import timed_missions
from timed_reports import assert_alike
from timed_texts import text_of

from checker import Engine, Limits, ZoneClock, check, explore
from checker.engines.fast.search import pipeline
from checker.engines.zones import explorer, zone_chunks
from checker.engines.zones.timed_automaton import EDGE, FIRST
from checker.engines.zones.zone_tables import DROPPED, GATHERED, RECORD
from specs.elaboration import load_mission

SOME = Limits(configurations=400)


@pytest.fixture(autouse=True)
def small_chunks(monkeypatch):
    """Let small missions have many chunks, some of which are too large for their batch."""
    monkeypatch.setattr(zone_chunks, "WORTH", 1)
    monkeypatch.setattr(zone_chunks, "BOUNDS", 64)
    monkeypatch.setattr(explorer, "CHUNK", 64)


@pytest.fixture
def events(monkeypatch):
    """Count the chunks that other threads make; they sift all of them."""
    counted = Counter()

    def expand(self, part):
        counted["beside"] += 1
        self.expand(part)
        self.sift(part)

    monkeypatch.setattr(pipeline.Pipeline, "_expand_beside", expand)
    return counted


def seen(c, threads, **options):
    """Return all zones that an exploration kept, in order, with what it found."""
    found = explore(c, engine=Engine.FAST, threads=threads, **{"limits": SOME, **options})
    times = found.times
    search = getattr(times, "times", times).search
    zones = [(place, matrix.tolist()) for place, matrix in search]
    numbers = (found.depth, found.expanded, found.transitions, found.rules, found.bounds, found.origins)
    first = search.automaton.edges.used[FIRST::EDGE].tolist()
    return zones, search.layers, search.order.tolist(), numbers, first, list(found.configurations)


@pytest.mark.parametrize("clock", ZoneClock)
@pytest.mark.parametrize("name", TIMED)
def test_a_shipped_mission_has_the_same_zones_in_any_number_of_threads(name, clock, events):
    c = load_mission(name).initial
    assert seen(c, 2, clock=clock) == seen(c, 3, clock=clock) == seen(c, 1, clock=clock)
    assert events["beside"]


def test_a_zone_that_is_dropped_before_its_turn_would_not_be_kept(monkeypatch):
    c, dropped = load_mission("oil_spill_timed").initial, Counter()
    right = seen(c, 1)

    def make(self, part):
        making(self, part)
        self._sift(part)
        records = part.batch.records[: RECORD * int(part.batch.state[GATHERED]) : RECORD]
        dropped["zones"] += int((records == DROPPED).sum())

    making = zone_chunks.ZoneChunks._make
    monkeypatch.setattr(zone_chunks.ZoneChunks, "_make", make)
    assert seen(c, 1) == right
    assert dropped["zones"]


@pytest.mark.parametrize("name", TIMED)
def test_a_shipped_mission_gets_the_same_report_in_any_number_of_threads(name):
    mission = load_mission(name)
    assert_alike(*(check(mission, engine=Engine.FAST, threads=each, times=True) for each in (1, 3)))


@examples(90, 15, deadline=None, suppress_health_check=list(HealthCheck))
@given(timed_missions())
def test_a_generated_mission_has_the_same_zones_in_any_number_of_threads(c):
    for clock in ZoneClock:
        assert seen(c, 2, clock=clock) == seen(c, 1, clock=clock)


@seeds(300, 4)
def test_a_generated_text_gets_the_same_report_in_any_number_of_threads(seed):
    mission = load(text_of(seed), "")
    limits = Limits(configurations=120)
    assert_alike(*(check(mission, limits=limits, engine=Engine.FAST, threads=each) for each in (1, 2)))
