"""The time line: the same view for a time, however one comes there; and a file that is still being written."""

import json
import os
import random
from itertools import pairwise

import pytest
from hypothesis import given
from hypothesis import strategies as st
from recorded import BETWEEN, EAST, WEST, folded, messages, plain, read, rules_of_once, shown, uav
from scale import examples

from adapters.console import history as histories
from adapters.console.history import History
from adapters.recording.mcap_files import RecordingError


def at(history, time):
    return plain(history.at(time).forward(time))


def uav0(history):
    return history.newest().sections["vehicles"]["uav0"]


@pytest.fixture
def dense(monkeypatch):
    """Have checkpoints so near each other that a short recording has too many."""
    monkeypatch.setattr(histories, "APART", 7)
    monkeypatch.setattr(histories, "MOST_CHECKPOINTS", 8)


def test_a_prefix_folded_and_then_the_rest_is_the_whole_and_facts_that_others_hold_do_not_change(recording):
    told = messages(recording)
    whole = folded(told)
    for count in range(1, len(told), 13):
        before = folded(told[:count])
        seen = json.dumps(shown(before, before.time), default=str)
        after = folded(told[count:], facts=before)
        assert shown(after, after.time) == shown(whole, whole.time)
        assert json.dumps(shown(before, before.time), default=str) == seen


@pytest.mark.usefixtures("dense")
def test_at_any_time_the_view_is_that_of_all_that_was_told_until_then(recording):
    history, told = read(recording), messages(recording)
    assert (history.begin, history.head, history.ended) == (1000.0, 1062.0, "the mission has ended")
    whole = folded(told)
    for tenths in range(10_000, 10_640, 17):
        time = tenths / 10
        facts = folded(told, time)
        assert at(history, time) == shown(facts, max(facts.time, min(time, 1062.0)), whole), time


@pytest.mark.usefixtures("dense")
def test_seeking_in_a_flight_of_two_thousand_steps_is_folding_it_anew(spill_watch):
    history, told = read(spill_watch), messages(spill_watch)
    offsets = [checkpoint.place.offset for checkpoint in history._checkpoints]
    assert 4 <= len(offsets) <= 8
    gaps = [after - before for before, after in pairwise(offsets)]
    assert max(gaps) < os.path.getsize(spill_watch) / 2  # they are apart by messages, of which some are long
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


# --- a file that is being written ---------------------------------------------------------------------


def test_a_recording_cut_at_any_byte_is_read_up_to_there_and_then_to_its_end(recording, tmp_path):
    data, growing = recording.read_bytes(), tmp_path / "growing.mcap"
    last = data.rindex(b"the mission has ended")
    growing.write_bytes(data[: last - 200])
    history = read(growing)
    with growing.open("ab", buffering=0) as file:
        for place in range(last - 200, len(data)):
            file.write(data[place : place + 1])
            history.read_on(1.0)
            assert history.head <= 1062.0
    assert history.ended == "the mission has ended"
    assert plain(history.newest()) == plain(read(recording).newest())


@examples(30, deadline=None)
@given(st.lists(st.floats(0, 1), max_size=6))
def test_in_whatever_pieces_a_recording_is_written_it_comes_to_the_same(recording, tmp_path_factory, cuts):
    data = recording.read_bytes()
    path = tmp_path_factory.mktemp("pieces") / "r.mcap"
    path.write_bytes(b"")
    history = History(path, rules_of_once)
    for cut in [*sorted(cuts), 1]:
        path.write_bytes(data[: int(cut * len(data))])
        while history.read_on(0.001):
            pass
    assert plain(history.newest()) == plain(read(recording).newest())


def test_each_turn_is_seen_as_soon_as_it_is_written(tape):
    history = History(tape.path, rules_of_once)
    history.read_on(1.0)
    assert uav0(history)["believed"] == "west0"
    for now, place in enumerate((WEST, BETWEEN, EAST)):
        tape.turn(now, uav(place, now), sayings=[("op", "status")])
        assert not history.read_on(1.0)
        assert history.newest().sections["entities"]["uav0"]["at"] == place
    assert history.ended is None
    assert uav0(history)["believed"] == "east0"


def test_nothing_is_read_while_nothing_is_written(flight):
    history = read(flight.path)
    flight.path.chmod(0o000)  # whoever opens it now fails, unless they may do anything
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
    assert uav0(history)["believed"] == "west0"
    assert plain(history.at(1001.0).forward(1001.0))["clock"]["ended"] == history.ended


@pytest.mark.parametrize("spoil", [os.unlink, lambda path: os.truncate(path, 100)], ids=["gone", "shorter"])
def test_a_recording_that_is_gone_or_shorter_ends_it(flight, spoil):
    history = read(flight.path)
    spoil(flight.path)
    history.read_on(1.0)
    assert history.ended.startswith("the recording cannot be read any further")


def test_a_run_whose_recording_cannot_be_read_goes_on_and_is_read_again_when_it_can(flight, tmp_path):
    history = read(flight.path, live=True)
    away = flight.path.rename(tmp_path / "b")
    assert not history.read_on(1.0)
    assert (history.ended, "No such file" in history.trouble) == (None, True)
    flight.turn(1, uav(EAST, 1))
    away.rename(flight.path)
    history.read_on(1.0)
    assert (history.ended, history.trouble, history.head) == (None, "", 1001.0)


def test_a_run_that_is_silent_grows_old_only_while_it_is_live(flight, monkeypatch):
    live, replayed = read(flight.path, live=True), read(flight.path)
    assert uav0(live)["level"] == 0
    clock = histories.clocks.monotonic
    monkeypatch.setattr(histories.clocks, "monotonic", lambda: clock() + 6.0)
    assert uav0(live)["why"] == "nothing was heard of it for more than 5 s"
    assert uav0(replayed)["level"] == 0


def test_a_view_that_has_not_changed_is_the_same_object(recording):
    history = read(recording)
    assert history.newest() is history.newest()
    moment = history.at(1030.0)
    before, after = moment.forward(1030.0), moment.forward(1031.0)
    assert before.sections["mission"] is after.sections["mission"]
    assert before.sections["places"] is after.sections["places"]
    assert before.sections["entities"] is not after.sections["entities"]
