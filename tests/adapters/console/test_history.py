"""The time line: the same view for a time, however one comes there; and a file that is still being written."""

import json
import os
import random
from itertools import pairwise

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from recorded import (
    BETWEEN,
    EAST,
    WEST,
    Tape,
    eventful,
    folded,
    messages,
    plain,
    rules_of_once,
    shown,
    uav,
)

from adapters.console import history as histories
from adapters.console.history import History
from adapters.recording.mcap_files import RecordingError


def read(path, **more):
    history = History(path, rules_of_once, **more)
    while history.read_on(0.01):
        pass
    return history


def at(history, time):
    return plain(history.at(time).forward(time))


@pytest.fixture(scope="module")
def recording(tmp_path_factory):
    return eventful(tmp_path_factory.mktemp("eventful") / "r.mcap").path


@pytest.fixture
def tape(tmp_path):
    with Tape(tmp_path / "r.mcap") as begun:
        yield begun


@pytest.fixture
def dense(monkeypatch):
    """Have checkpoints so near each other that a short recording has too many."""
    monkeypatch.setattr(histories, "APART", 7)
    monkeypatch.setattr(histories, "MOST_CHECKPOINTS", 8)


def test_a_prefix_folded_and_then_the_rest_is_the_whole(recording):
    told = messages(recording)
    whole = folded(told)
    for count in range(1, len(told), 7):
        facts = folded(told[count:], facts=folded(told[:count]))
        assert shown(facts, facts.time) == shown(whole, whole.time)


def test_facts_that_others_hold_do_not_change(recording):
    told = messages(recording)
    facts = folded(told[:100])
    before = json.dumps(shown(facts, facts.time), default=str)
    folded(told[100:], facts=facts)
    assert json.dumps(shown(facts, facts.time), default=str) == before


@pytest.mark.usefixtures("dense")
def test_at_any_time_the_view_is_that_of_all_that_was_told_until_then(recording):
    history, told = read(recording), messages(recording)
    assert (history.begin, history.head, history.ended) == (1000.0, 1062.0, "the mission has ended")
    whole = folded(told)
    for tenths in range(10_000, 10_640, 7):
        time = tenths / 10
        facts = folded(told, time)
        assert at(history, time) == shown(facts, max(facts.time, min(time, 1062.0)), whole), time


@pytest.mark.usefixtures("dense")
def test_seeking_in_a_flight_of_two_thousand_steps_is_folding_it_anew(spill_watch):
    history, told = read(spill_watch), messages(spill_watch)
    assert 4 <= len(history._checkpoints) <= 8
    whole, chance = folded(told), random.Random(7)
    times = sorted(chance.uniform(history.begin, history.head) for _ in range(6))
    moment = history.at(times[0])
    for time in times:
        facts = folded(told, time)
        expected = shown(facts, max(facts.time, time), whole)
        assert plain(moment.forward(time)) == expected  # going on
        assert at(history, time) == expected  # or coming there at once
    assert plain(moment.forward(times[0])) == at(history, times[0])  # and back
    assert plain(history.newest()) == shown(whole, whole.time)


@pytest.mark.usefixtures("dense")
def test_checkpoints_are_few_and_spread_over_the_recording(spill_watch):
    history = read(spill_watch)
    offsets = [checkpoint.place.offset for checkpoint in history._checkpoints]
    gaps = [after - before for before, after in pairwise(offsets)]
    assert len(offsets) <= 8
    assert max(gaps) < os.path.getsize(spill_watch) / 2  # they are apart by messages, of which some are long


# --- a file that is being written ---------------------------------------------------------------------


def test_a_recording_cut_at_any_byte_is_read_up_to_there_and_then_to_its_end(recording, tmp_path):
    data, whole = recording.read_bytes(), read(recording)
    growing = tmp_path / "growing.mcap"
    newest = plain(whole.newest())
    last = data.rindex(b"the mission has ended")
    growing.write_bytes(data[: last - 200])
    history = read(growing)
    for size in range(last - 200, len(data), 1):
        growing.write_bytes(data[:size])
        history.read_on(1.0)
        assert history.head <= 1062.0
    growing.write_bytes(data)
    history.read_on(1.0)
    assert history.ended == "the mission has ended"
    assert plain(history.newest()) == newest


@settings(max_examples=25, deadline=None)
@given(st.lists(st.floats(0, 1), max_size=6))
def test_in_whatever_pieces_a_recording_is_written_it_comes_to_the_same(recording, tmp_path_factory, cuts):
    data = recording.read_bytes()
    path = tmp_path_factory.mktemp("pieces") / "r.mcap"
    path.write_bytes(b"")
    history = History(path, rules_of_once)
    for cut in sorted(cuts):
        path.write_bytes(data[: int(cut * len(data))])
        while history.read_on(0.001):
            pass
    path.write_bytes(data)
    while history.read_on(0.001):
        pass
    assert plain(history.newest()) == plain(read(recording).newest())


def test_each_turn_is_seen_as_soon_as_it_is_written(tape):
    history = History(tape.path, rules_of_once)
    history.read_on(1.0)
    assert history.newest().sections["vehicles"]["uav0"]["believed"] == "west0"
    for now, place in enumerate((WEST, BETWEEN, EAST)):
        tape.turn(now, uav(place, now), sayings=[("op", "status")])
        assert not history.read_on(1.0)
        assert history.newest().sections["entities"]["uav0"]["at"] == place
    assert history.ended is None
    assert history.newest().sections["vehicles"]["uav0"]["believed"] == "east0"


def test_nothing_is_read_while_nothing_is_written(tape):
    tape.turn(0, uav(WEST, 0))
    history = read(tape.path)
    tape.path.chmod(0o000)  # whoever opens it now fails, unless they may do anything
    facts = history.facts
    assert not history.read_on(1.0)
    assert history.facts is facts
    assert not history._reader.grows()


def test_what_is_no_recording_is_refused_and_what_is_damaged_later_ends_it(recording, tmp_path):
    path = tmp_path / "x.mcap"
    path.write_bytes(b"hello")
    with pytest.raises(RecordingError, match="no recording"):
        read(path)
    data = recording.read_bytes()
    place = data.index(b"mmsi3") - 40
    path.write_bytes(data[:place] + b"\xff" * 30 + data[place + 30 :])
    history = read(path)
    assert history.ended.startswith("the recording cannot be read any further")
    assert history.newest().sections["vehicles"]["uav0"]["believed"] == "west0"
    assert plain(history.at(1001.0).forward(1001.0))["clock"]["ended"] == history.ended


def test_a_recording_that_is_gone_or_shorter_ends_it(tmp_path):
    for name, spoil in (("a", os.unlink), ("b", lambda path: os.truncate(path, 100))):
        with Tape(tmp_path / name) as tape:
            tape.turn(0, uav(WEST, 0))
            history = read(tape.path)
            spoil(tape.path)
            history.read_on(1.0)
            assert history.ended.startswith("the recording cannot be read any further")


def test_a_run_whose_recording_cannot_be_read_goes_on_and_is_read_again_when_it_can(tmp_path):
    with Tape(tmp_path / "a") as tape:
        tape.turn(0, uav(WEST, 0))
        history = read(tape.path, live=True)
        away = tape.path.rename(tmp_path / "b")
        assert not history.read_on(1.0)
        assert (history.ended, "No such file" in history.trouble) == (None, True)
        tape.turn(1, uav(EAST, 1))
        away.rename(tape.path)
        history.read_on(1.0)
        assert (history.ended, history.trouble, history.head) == (None, "", 1001.0)


def test_a_run_that_is_silent_grows_old_only_while_it_is_live(tape, monkeypatch):
    tape.turn(0, uav(WEST, 0))
    live, replayed = read(tape.path, live=True), read(tape.path)
    assert live.newest().sections["vehicles"]["uav0"]["level"] == 0
    clock = histories.clocks.monotonic
    monkeypatch.setattr(histories.clocks, "monotonic", lambda: clock() + 6.0)
    why = "nothing was heard of it for more than 5 s"
    assert live.newest().sections["vehicles"]["uav0"]["why"] == why
    assert replayed.newest().sections["vehicles"]["uav0"]["level"] == 0


def test_a_view_that_has_not_changed_is_the_same_object(recording):
    history = read(recording)
    assert history.newest() is history.newest()
    moment = history.at(1030.0)
    before, after = moment.forward(1030.0), moment.forward(1031.0)
    assert before.sections["mission"] is after.sections["mission"]
    assert before.sections["places"] is after.sections["places"]
    assert before.sections["entities"] is not after.sections["entities"]
