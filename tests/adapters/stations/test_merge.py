"""The merge by itself: whatever is lost, doubled, reordered or parted, all stations come to the same world."""

from functools import reduce

import pytest
from hypothesis import given
from hypothesis import strategies as st
from live_missions import EAST, TOUR, WEST, Run, plan_of

from adapters.live.batch import Heard
from adapters.live.fresh_placements import MOST_AHEAD
from adapters.plugin import Aged, Gone
from adapters.stations.entries import Entry, Said
from adapters.stations.merge import ABREAST, MOST_ENTITIES, Merge, newer
from physical import PhysicalProperty, point
from semantics.state.abstraction import as_it_is

NOW = 1_000.0
PLACES = (WEST, EAST, (37.03, -8.63), (37.011, -8.612))
STATIONS = ("gcs0", "gcs1", "gcs2")
DRIFTING = (
    TOUR
    + "environment { boat0 drifts among point (37.005, -8.605), point (37.005, -8.645)\n boat0 vanishes }"
)
PLAN = plan_of(DRIFTING)


def word(station, number, time, at=WEST, *, entity="boat0", channels=(), since=None, ttl=None, gone=False):
    said = PhysicalProperty(entity, "Vessel", point(*at), channels=channels, time=time)
    published = Gone(entity, time, station) if gone else said if ttl is None else Aged(said, ttl)
    return Entry(station, number, Said(published, time if since is None else since))


@st.composite
def histories(draw):
    """What each station said, in its order: times are often equal, sometimes ahead, never before its last one's."""
    entries = []
    for station in STATIONS:
        time = NOW - 20.0
        for number in range(1, draw(st.integers(0, 6)) + 1):
            time += draw(st.sampled_from([0.0, 1.0, 5.0, 24.0]))
            entries.append(
                word(
                    station,
                    number,
                    time,
                    draw(st.sampled_from(PLACES)),
                    entity=draw(st.sampled_from(["boat0", "boat1"])),
                    channels=draw(st.sampled_from([(), ("vhf",), ("wifi",)])),
                    since=time - draw(st.sampled_from([0.0, 3.0])),
                    ttl=draw(st.sampled_from([None, 4.0, 60.0])),
                    gone=draw(st.integers(0, 9)) == 0,
                )
            )
    return entries


def merged(entries):
    merge = Merge()
    for entry in entries:
        merge.hear(entry)
    return merge


def world(merge, now=NOW):
    return {entity: merge.holds(entity, now) for entity in sorted(merge.words)}


@given(histories(), st.randoms(use_true_random=False))
def test_all_come_to_the_same_world_in_whatever_order_and_however_often_they_hear(entries, random):
    for _ in range(3):
        heard = [*entries, *random.choices(entries, k=len(entries))] if entries else []
        random.shuffle(heard)
        assert world(merged(heard)) == world(merged(entries))


@given(histories(), st.randoms(use_true_random=False))
def test_parts_that_were_cut_off_from_each_other_agree_once_they_have_told_each_other(entries, random):
    sides = [[entry for entry in entries if random.random() < 0.6] for _ in STATIONS]
    apart = [merged(side) for side in sides]
    for merge in apart:
        for entry in random.sample(entries, len(entries)):
            merge.hear(entry)
    assert all(world(merge) == world(merged(entries)) for merge in apart)


@given(histories())
def test_what_was_superseded_may_be_lost(entries):
    newest = {(entry.station, entry.content.entity): entry for entry in entries}
    assert world(merged(newest.values())) == world(merged(entries))


@given(st.lists(st.integers(1, 5), min_size=1), st.randoms(use_true_random=False))
def test_the_newer_of_two_words_is_a_join(numbers, random):
    words = [word("gcs0", number, NOW, random.choice(PLACES)) for number in numbers]
    for a in words:
        assert newer(a, a) == a
        for b in words:
            assert newer(a, b) == newer(b, a)
    shuffled = random.sample(words, len(words))
    assert reduce(newer, words) == reduce(newer, shuffled)


@given(histories(), st.randoms(use_true_random=False))
def test_every_station_comes_to_the_same_a_of_p(entries, random):
    """The whole way: what holds is told to a live run as it changes, till all clocks agree that it has happened."""
    seen = []
    for order in (entries, random.sample(entries, len(entries)), sorted(entries, key=lambda e: e.station)):
        merge, run = Merge(), Run(PLAN)
        for entry in order:
            entity = merge.hear(entry)
            said = merge.holds(entity, NOW) if entity else None
            run.turn(NOW, *([Heard("stations", said.published)] if said else []))
        later = NOW + 300.0
        run.turn(later, *(Heard("stations", merge.holds(each, later).published) for each in merge.words))
        physical = as_it_is(run.state.configuration).structure.logical
        seen.append((physical.parent("boat0"), physical.parent("boat1"), physical.links("boat0")))
    assert seen[0] == seen[1] == seen[2]


def test_of_equal_times_the_later_station_counts_everywhere():
    one, other = word("gcs0", 9, NOW, WEST), word("gcs1", 1, NOW, EAST)
    for order in ((one, other), (other, one)):
        assert merged(order).holds("boat0", NOW).published.geometry == point(*EAST)


def test_a_time_stamp_too_far_ahead_counts_when_its_time_has_come_and_keeps_nothing_else_out():
    early, sound = word("gcs0", 1, NOW + 3600.0, EAST), word("gcs1", 1, NOW - 1.0, WEST)
    merge = merged([early, sound])
    assert merge.holds("boat0", NOW).published.geometry == point(*WEST)
    assert merge.ahead(NOW) == [early]
    assert merge.holds("boat0", NOW + 3600.0 - MOST_AHEAD).published.geometry == point(*EAST)


def test_a_station_that_puts_its_clock_back_is_heard_again():
    merge = merged([word("gcs0", 1, NOW + 3600.0, EAST), word("gcs0", 2, NOW, WEST)])
    assert merge.holds("boat0", NOW).published.geometry == point(*WEST)
    assert merge.ahead(NOW) == []


def test_of_channels_the_latest_change_counts_though_another_station_has_seen_the_place_later():
    """A vehicle was handed on, and the other station has not read its new authority yet."""
    handed = word("gcs0", 1, NOW, WEST, channels=("control:gcs1",), since=NOW)
    stale = word("gcs1", 1, NOW + 1.0, EAST, channels=("control:gcs0",), since=NOW - 50.0)
    for order in ((handed, stale), (stale, handed)):
        holds = merged(order).holds("boat0", NOW + 1.0).published
        assert holds.geometry == point(*EAST)
        assert holds.channels == ("control:gcs1",)


def test_the_channels_of_a_station_that_fell_silent_count_no_more_than_its_place_does():
    silent = word("gcs0", 1, NOW, WEST, channels=("control:gcs0",), since=NOW, ttl=30.0)
    heard = word("gcs1", 1, NOW + 31.0, EAST, channels=("control:gcs1",), since=NOW - 5.0, ttl=30.0)
    assert merged([silent, heard]).holds("boat0", NOW + 31.0).published.property.channels == ("control:gcs1",)


def seen(station, time, clock, at, ttl=60.0):
    said = PhysicalProperty("uav0", "UAV", point(*at), time=time)
    return Entry(station, 1, Said(Aged(said, ttl, clock), time, owned=True))


def test_of_a_vehicle_the_newest_by_its_own_clock_counts_though_a_slow_link_stamps_it_later():
    fast, slow = seen("gcs0", NOW - 1.0, 7_300, EAST), seen("gcs1", NOW - 0.7, 7_000, WEST)
    for entries in ((fast, slow), (slow, fast)):
        held = merged(entries).holds("uav0", NOW)
        assert held.published.property.geometry == point(*EAST)
        assert (
            held.time == slow.content.time
        )  # whoever was shown the late one first takes this one all the same


def test_what_a_vehicle_told_before_it_booted_anew_counts_no_more_after_a_while():
    before, after = seen("gcs0", NOW - ABREAST - 0.1, 90_000, WEST), seen("gcs1", NOW, 2_000, EAST)
    assert merged([before, after]).holds("uav0", NOW).published.property.geometry == point(*EAST)


def test_what_has_grown_old_counts_no_more_by_its_clock_either():
    old, young = seen("gcs0", NOW - 2.0, 9_000, WEST, ttl=1.0), seen("gcs1", NOW, 8_000, EAST)
    assert merged([old, young]).holds("uav0", NOW).published.property.geometry == point(*EAST)


def test_one_station_may_not_speak_of_any_number_of_entities(monkeypatch):
    monkeypatch.setattr("adapters.stations.merge.MOST_ENTITIES", 10)
    assert MOST_ENTITIES >= 10_000
    merge = merged([word("gcs0", number, NOW, entity=f"e{number}") for number in range(1, 11)])
    with pytest.raises(ValueError, match="more than 10 entities"):
        merge.hear(word("gcs0", 11, NOW, entity="e11"))
    assert merge.hear(word("gcs0", 12, NOW, entity="e3")) == "e3"
