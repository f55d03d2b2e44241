import json
import os
import zlib

import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st
from test_merge import word

from adapters.plugin import Aged, Gone
from adapters.stations import journal as journals
from adapters.stations.entries import (
    Believed,
    Broke,
    Entry,
    Hosted,
    Posted,
    Said,
    Took,
    VehicleSent,
    entry_of,
    entry_text,
)
from adapters.stations.journal import Journal, JournalError
from physical import Band, PhysicalProperty, Velocity, box

MANY = int(os.environ.get("BIGACTORS_FUZZ", "0")) // 10
EVERYTHING = PhysicalProperty(
    "a", "UAV", box((1, 2), (3, 4)), Band(1, 2), ("c", "d"), "b", 5.0, "gcs0", Velocity(1.5, 2)
)


def said(entity, time):
    return word("gcs0", 1, time, entity=entity).content


@pytest.fixture
def opened(tmp_path):
    """Open the log of a station; what is open at the end is closed."""
    found = []

    def opening(**other):
        found.append(Journal(tmp_path / "x.log", **{"station": "gcs0", "digest": "d", **other}))
        return found[-1]

    yield opening
    for journal in found:
        journal.close()


def test_a_restarted_station_goes_on_counting_and_knows_what_it_has_said(opened):
    journal = opened()
    journal.add([said("a", 1.0), said("b", 1.0), Posted("gcs1", 1, {}), Took("gcs1", 3)])
    last = journal.last
    journal.close()
    again = opened()
    assert again.last == last
    assert (again.sent("gcs1"), again.took("gcs1"), again.waiting("gcs1")) == (1, 3, 1)
    (entry,) = again.add([said("a", 2.0)])
    assert entry.number == last + 1
    found, upto = again.after(0, 10)
    assert [each.number for each in found] == [last - 2, last - 1, last, last + 1]
    assert upto == last + 1
    assert again.after(last - 2, 1) == ([found[1]], last - 1)


def test_a_log_that_was_lost_begins_above_every_number_it_may_have_had(opened, tmp_path):
    journal = opened()
    last = journal.add([said("a", 1.0)] * 100)[-1].number
    journal.close()
    (tmp_path / "x.log").unlink()
    assert opened().add([said("a", 1.0)])[0].number + 1_000 > last


def test_what_was_taken_is_posted_no_more_and_its_number_is_not_given_again(opened):
    journal = opened()
    journal.add([Posted("gcs1", number, {}) for number in (1, 2, 3)])
    journal.taken("gcs1", 2)
    assert journal.waiting("gcs1") == 1
    journal._rewrite()
    journal.close()
    again = opened()
    assert (again.sent("gcs1"), again.waiting("gcs1"), again.last) == (3, 1, journal.last)


def test_the_file_is_tidied_and_stays_small(opened, tmp_path, monkeypatch):
    monkeypatch.setattr(journals, "SPARE", 50)
    journal = opened()
    for time in range(1_000):
        journal.add([said("a", float(time)), said("b", float(time))])
    assert len((tmp_path / "x.log").read_text().splitlines()) < 70
    last = journal.last
    journal.close()
    again = opened()
    assert again.last == last
    assert again.word(("said", "a")) == said("a", 999.0)


def test_what_a_killed_process_has_left_of_a_line_is_cut_off(opened, tmp_path):
    journal = opened()
    journal.add([said("a", 1.0), said("b", 1.0)])
    journal.close()
    path = tmp_path / "x.log"
    path.write_bytes(path.read_bytes()[:-20])
    again = opened()
    assert again.word(("said", "b")) is None
    again.add([said("b", 2.0)])
    again.close()
    assert opened().word(("said", "b")) == said("b", 2.0)


def full(opened):
    """Return what a closed log knows of entities a and b, and what it has posted."""
    journal = opened()
    journal.add([said("a", 1.0), said("b", 1.0)])
    journal.add([Posted("gcs1", 1, {})])
    journal.close()
    return journal.last


@pytest.mark.fuzz
@settings(suppress_health_check=[HealthCheck.function_scoped_fixture], max_examples=max(100, MANY))
@given(draw=st.data())
def test_a_line_that_was_altered_is_never_believed(opened, tmp_path, draw):
    path = tmp_path / "x.log"
    path.unlink(missing_ok=True)
    last = full(opened)
    data = bytearray(path.read_bytes())
    at = draw.draw(st.integers(0, len(data) - 1))
    begin = data.rindex(b"\n", 0, -1)
    data[at] ^= draw.draw(st.integers(1, 255))
    path.write_bytes(data)
    lines = path.read_bytes().split(b"\n")
    try:
        again = opened()
    except JournalError as error:
        assert str(path) in str(error)  # noqa: PT017 - which of both depends on the byte
        return
    assert again.dropped.startswith(
        f"{path}:{len(lines) - 1 if lines[-1] == b'' else len(lines)}: the last entry"
    )
    assert at >= begin
    assert (again.word(("said", "b")) == said("b", 1.0)) == (
        at > begin
    )  # else two lines have become the last
    assert again.word(("said", "a")) == said("a", 1.0)
    assert again.waiting("gcs1") == 0
    assert again.last > last
    again.close()


def test_a_damaged_last_entry_is_dropped_and_its_number_is_not_given_again(opened, tmp_path):
    last, path = full(opened), tmp_path / "x.log"
    path.write_bytes(path.read_bytes().replace(b'"gcs1"', b'"gcs2"'))
    again = opened()
    assert again.dropped == f"{path}:5: the last entry was dropped: its checksum does not match its content"
    assert again.last > last
    again.close()
    clean = opened()
    assert clean.dropped == ""
    assert clean.word(("said", "b")) == said("b", 1.0)


@pytest.mark.parametrize(
    "spoil",
    [
        lambda lines: [*lines[:2], *lines[3:]],
        lambda lines: [*lines[:2], lines[3], lines[2], lines[4]],
        lambda lines: [*lines[:3], lines[2], *lines[3:]],
        lambda lines: [*lines[:3], lines[3].replace(b'"b"', b'"c"'), lines[4]],
        lambda lines: [*lines[:3], bytes(len(lines[3])), lines[4]],
        lambda lines: [*lines[:3], b"x" * 2**20, lines[4]],
    ],
)
def test_a_damaged_line_with_others_behind_it_names_its_place_and_what_to_do(opened, tmp_path, spoil):
    full(opened)
    path = tmp_path / "x.log"
    lines = path.read_bytes().splitlines()
    path.write_bytes(b"\n".join(spoil(lines)) + b"\n")
    with pytest.raises(JournalError, match=r"x\.log:[345]: the log is damaged: .*: move it away"):
        opened()


@pytest.mark.parametrize("kept", [0.1, 0.2])
def test_a_log_of_which_not_even_the_beginning_is_left_is_refused(opened, tmp_path, kept):
    full(opened)
    path = tmp_path / "x.log"
    path.write_bytes(path.read_bytes()[: int(path.stat().st_size * kept)])
    with pytest.raises(JournalError, match="the log is damaged"):
        opened()


def of_version_1(path):
    """Write a log as the first version did, without checksums."""
    lines = [line.partition(" ")[2] for line in path.read_text().splitlines()]
    path.write_text("\n".join([lines[0].replace("station/3", "station/1"), *lines[1:]]) + '\n{"torn')


def of_version_2(path):
    """Write a log as the second version did, with checksums."""
    lines, summed = [line.partition(" ")[2] for line in path.read_text().splitlines()], 0
    with path.open("w") as file:
        for line in [lines[0].replace("station/3", "station/2"), *lines[1:]]:
            summed = zlib.crc32(line.encode(), summed)
            file.write(f"{summed:08x} {line}\n")
        file.write("torn")


@pytest.mark.parametrize("earlier", [of_version_1, of_version_2])
def test_a_log_of_an_earlier_version_is_read_and_written_anew_with_checksums(opened, tmp_path, earlier):
    journal, path = opened(), tmp_path / "x.log"
    journal.add([said("a", 1.0), said("b", 1.0)])
    journal.close()
    last = journal.last
    earlier(path)
    again = opened()
    assert again.word(("said", "b")) == said("b", 1.0)
    assert "the last entry was dropped: it is torn" in again.dropped
    again.close()
    assert path.read_text().split(" ")[1:3] == ['{"log":', '"bigactors.station/3",']
    assert opened().last == again.last > last


@pytest.mark.parametrize("earlier", [of_version_1, of_version_2])
def test_a_log_of_an_earlier_version_with_parcels_is_refused_since_texts_are_names_there(
    opened, tmp_path, earlier
):
    full(opened)
    earlier(tmp_path / "x.log")
    with pytest.raises(JournalError, match="has parcels of an earlier version: move it away"):
        opened()


def test_only_one_run_writes_a_log(opened):
    journal = opened()
    with pytest.raises(JournalError, match="another run of this station"):
        opened()
    journal.close()
    opened().close()


@pytest.mark.parametrize(
    ("other", "says"),
    [({"station": "gcs1"}, "is the log of station 'gcs0'"), ({"digest": "e"}, "is the log of mission 'd'")],
)
def test_the_log_of_another_station_or_mission_is_refused(opened, other, says):
    opened().close()
    with pytest.raises(JournalError, match=says):
        opened(**other)


@pytest.mark.parametrize("text", ["{}\n", "hello\n", '{"log": "bigactors.station/3"}\n'])
def test_what_is_no_log_is_refused(opened, tmp_path, text):
    (tmp_path / "x.log").write_text(text)
    with pytest.raises(JournalError, match="log"):
        opened()


@pytest.mark.parametrize(
    "content",
    [
        Said(EVERYTHING, 3.0, owned=True),
        Said(Aged(EVERYTHING, 60.0), 3.0),
        Said(Aged(EVERYTHING, 60.0, 7_300), 3.0, owned=True),
        Said(Gone("a", 5.0, "gcs0"), 5.0),
        VehicleSent("uav0", "east0", 5.0),
        VehicleSent("uav0", "", 5.0),
        Posted("gcs1", 3, {"x": [1]}),
        Posted("gcs1", 3, {}, {"gcs2": 7}),
        Hosted("op0", "gcs0", 5.0),
        Broke("it rains", 5.0),
        Believed("uav0", "links", ("control:gcs0",), 5.0),
        Believed("uav0", "parent", (), 5.0),
        Took("gcs1", 3),
    ],
)
def test_an_entry_is_read_as_it_was_written(content):
    entry = Entry("gcs0", 7, content)
    assert entry_of("gcs0", json.loads(entry_text(entry))) == entry


GOOD = json.loads(entry_text(Entry("gcs0", 7, Said(EVERYTHING, 3.0))))


@pytest.mark.parametrize(
    "data",
    [
        3,
        {},
        {"n": 0, "took": "a", "index": 1},
        {"n": True, "took": "a", "index": 1},
        {"n": 10**20, "took": "a", "index": 1},
        {"n": 1, "took": "a", "index": -1},
        {"n": 1, "sent": "a\n", "to": "", "time": 1},
        {"n": 1, "to": "a", "index": 1, "parcel": {}, "knows": {"gcs0": -1}},
        {"n": 1, "to": "a", "index": 1, "parcel": {}, "knows": [1]},
        {"n": 1, "broke": "x" * 9_000, "time": 1},
        GOOD | {"entity": "x" * 300},
        GOOD | {"time": float("nan")},
        GOOD | {"time": None},
        GOOD | {"since": "x"},
        GOOD | {"owned": 1},
        GOOD | {"at": {"ring": [[10**12, 0]]}},
        GOOD | {"at": {"ring": []}},
        GOOD | {"channels": ["x"] * 1000},
        GOOD | {"velocity": [1]},
        GOOD | {"altitude": ["x", 1]},
        GOOD | {"ttl": float("inf")},
    ],
)
def test_what_is_no_entry_is_refused(data):
    with pytest.raises(ValueError, match=r"."):
        entry_of("gcs0", data)
