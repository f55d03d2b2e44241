import csv
import os
from collections import Counter
from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st

from physical.ais_recording import PIECES, has_sentences, read_recording, without_sentences
from physical.ais_reports import AisError
from physical.file_account import FileAccount
from physical.nmea import MAX_LINE, DecodingFailure

POSITION_KIND, PART_KIND, STATIC_KIND = (
    "position",
    "part of a message",
    "message with a name or a type of ship",
)
ROOT = Path(__file__).parents[2]
DATA = Path(os.environ.get("BIGACTORS_DATA", ROOT.parent / "shared" / "data")) / "ais"
SYNTHETIC = ROOT / "specs" / "missions" / "harbour_watch.nmea"
POSITION = b"!AIVDM,1,1,,B,35VwAv0300QcEQ`EGcpN40jD0PUQ,0*61\n"
PART = b"!AIVDM,2,1,9,B,55R3Vn82=ILTQ3KKS>1<D60Dq@E918U<F222221J1`?164vc03S1CCAD,0*2A\n"

needs_recordings = pytest.mark.skipif(
    not DATA.is_dir(), reason="the recordings are absent: set BIGACTORS_DATA to the folder that holds ais/"
)


def expected(name):
    """The positions on which pyais, gpsd and libais agree."""
    with (DATA / f"{name}.nmea.expected.csv").open(newline="") as file:
        return list(csv.DictReader(file))


def agrees(report, row):
    """Whether a report is that of a row: the same place to 1e-5 degree, and the same of all that the row has.

    Rows keep some headings of 511 and courses of 360: not available.
    """
    where = abs(report.lat - float(row["lat"])) <= 1e-5 and abs(report.lon - float(row["lon"])) <= 1e-5
    who = (report.msg_type, report.mmsi) == (int(row["msg_type"]), int(row["mmsi"]))
    when = not row["epoch_s"] or abs(report.time - float(row["epoch_s"])) < 1e-3
    moving = all(
        not row[column]
        or value == (None if float(row[column]) >= limit else pytest.approx(float(row[column])))
        for column, value, limit in (
            ("sog_kn", report.sog_kn, 102.3),
            ("cog_deg", report.cog_deg, 360),
            ("heading_deg", report.heading_deg, 360),
        )
    )
    return who and where and when and moving


def matched(name):
    """Pair the positions of a recording with the expected rows, both in order; the positions left over."""
    rows, extra = expected(name), []
    waiting = iter(rows)
    row = next(waiting, None)
    for report in read_recording(DATA / f"{name}.nmea").positions:
        if row is not None and agrees(report, row):
            row = next(waiting, None)
        else:
            extra.append(report)
    assert row is None, f"not found: {row}"
    return len(rows), extra


@needs_recordings
@pytest.mark.parametrize(("name", "count"), [("workum_2020", 141), ("greece_sample", 764)])
def test_every_position_that_three_decoders_agree_on_is_read_and_no_other(name, count):
    assert matched(name) == (count, [])


@needs_recordings
def test_north_sea_has_ten_positions_more_and_each_is_explained():
    count, extra = matched("north_sea_2010")
    assert count == 3122
    kinds = Counter(report.msg_type for report in extra)
    # message 17 is unscaled in pyais; gpsd does not know the talkers BY and SS, which sent the others
    assert kinds == {17: 5, 1: 3, 3: 1, 4: 1}
    talkers = {b"!BYVDM", b"!SSVDM"}
    lines = (DATA / "north_sea_2010.nmea").read_bytes().splitlines(keepends=True)
    theirs = read_recording(line for line in lines if line.split(b",")[0] in talkers).positions
    assert Counter((report.msg_type, report.mmsi, report.lat) for report in theirs) == Counter(
        (report.msg_type, report.mmsi, report.lat) for report in extra if report.msg_type != 17
    )


@needs_recordings
@pytest.mark.parametrize(
    ("name", "total", "taken", "reasons"),
    [
        (
            "workum_2020",
            1496,
            {POSITION_KIND: 141, "time": 164, PART_KIND: 12, STATIC_KIND: 21},
            {DecodingFailure.NOT_AVAILABLE: 3},
        ),
        (
            "north_sea_2010",
            8551,
            {POSITION_KIND: 3132, "time": 4051, PART_KIND: 449, STATIC_KIND: 498},
            {DecodingFailure.NOT_AVAILABLE: 28},
        ),
        (
            "greece_sample",
            898,
            {POSITION_KIND: 764, STATIC_KIND: 2},
            {
                DecodingFailure.EMPTY: 100,
                DecodingFailure.NOT_AVAILABLE: 4,
                "part of an incomplete message": 20,
            },
        ),
    ],
)
def test_what_could_not_be_used_of_a_real_recording_is_accounted_for(name, total, taken, reasons):
    tally = read_recording(DATA / f"{name}.nmea").tally
    left = dict(tally.left_out)
    assert (tally.total, dict(tally.taken)) == (total, taken)
    assert {kind: count for kind, count in left.items() if kind in reasons} == reasons
    assert all(kind.startswith(("sentence ", "message of type ")) for kind in left.keys() - reasons.keys())
    assert tally.adds_up


def test_a_path_bytes_and_lines_give_the_same_recording():
    recording = read_recording(SYNTHETIC)
    assert read_recording(str(SYNTHETIC)) == recording
    assert read_recording(SYNTHETIC.read_bytes()) == recording
    assert read_recording(SYNTHETIC.read_bytes().split(b"\n")[:-1]) == recording


def test_lines_are_read_one_by_one():
    def lines():
        yield POSITION
        raise RuntimeError("asked for more")

    with pytest.raises(RuntimeError, match="asked for more"):
        read_recording(lines())


def test_an_empty_recording_has_no_reports():
    assert read_recording(b"").tally == FileAccount(0, *PIECES)


def test_an_overlong_line_is_counted_once_and_the_next_is_read():
    recording = read_recording(b"x" * (5 * MAX_LINE) + b"\n" + POSITION)
    assert recording.tally.left_out == ((DecodingFailure.OVERLONG.value, 1),)
    assert [report.mmsi for report in recording.positions] == [376427000]


def test_a_recording_beyond_the_limit_is_refused(tmp_path):
    path = tmp_path / "long.nmea"
    path.write_bytes(b"x" * 5000)
    for source in (path, path.read_bytes(), [b"x" * 50] * 100):
        with pytest.raises(AisError, match="longer than 4999 bytes"):
            read_recording(source, limit=4999)
        assert read_recording(source, limit=5000).tally.total > 0


@pytest.mark.parametrize("end", [b"\n", b"\r\n", b"\r"])
def test_lines_end_as_they_do_on_any_system(end):
    recording = read_recording(end.join([POSITION.strip()] * 500) + end)
    assert (len(recording.positions), recording.tally.total) == (500, 500)


def test_a_file_that_cannot_be_read_is_named(tmp_path):
    for path in (tmp_path / "absent.nmea", tmp_path):
        with pytest.raises(AisError, match="cannot read it") as caught:
            read_recording(path)
        assert caught.value.where == str(path)


def test_the_account_is_printed_reason_by_reason():
    binary = b"!AIVDM,1,1,,A,85Mwp`1Kf3aCnsNvBWLi=wQuNhA5t43N`5nCuI=p<IBfVqnMgPGs,0*47\n"
    recording = read_recording(POSITION + b"# noted\n" + PART + b"noise\n" + binary + b"$GPGSV,3,1,10*00\n")
    assert str(recording.tally).splitlines() == [
        "6 sentences and other lines: 1 comment, 1 position",
        "1 x line without a sentence, not read",
        "1 x message of type 8, without a position of its sender, not read",
        "1 x part of an incomplete message, not read",
        "1 x sentence GPGSV, not read",
    ]


def test_a_damaged_tag_block_is_counted_beside_its_sentence():
    tally = read_recording(b"\\c:1671533231*00\\" + POSITION).tally
    assert (tally.taken, tally.asides) == ((("position", 1),), ((DecodingFailure.TAG_BLOCK.value, 1),))


def test_a_file_without_sentences_of_ais_is_told_from_one_whose_sentences_are_of_no_use():
    assert not has_sentences(read_recording(b"Dear reader,\n$GPGGA,1*00\n").tally)
    assert has_sentences(read_recording(PART).tally)
    assert without_sentences(read_recording(POSITION).tally) is None
    damaged = POSITION.replace(b"*", b"*0")
    assert str(without_sentences(read_recording(damaged).tally)).endswith(": 1 x checksum wrong")
    assert has_sentences(read_recording(POSITION).tally)


lines = st.sampled_from([POSITION.strip(), PART.strip(), b"# c", b"noise", b"", b"$GPGSV,3,1,10*00"])
tags = st.sampled_from(
    [b"", b"\\c:1671533231*5D\\", b"\\c:1671533231*00\\", b"1671533231 ", b"\\g:1-2-3*00\\"]
)


@given(st.lists(st.tuples(tags, lines | st.binary(max_size=40)), max_size=40))
def test_the_account_adds_up_to_the_sentences_and_other_lines(parts):
    recording = read_recording(b"\n".join(tag + line for tag, line in parts))
    assert recording.tally.adds_up
    assert all(count > 0 for _, count in (*recording.tally.taken, *recording.tally.left_out))
    assert dict(recording.tally.taken).get("position", 0) == len(recording.positions)


@given(st.data())
def test_damage_to_some_lines_leaves_the_reports_of_the_others(data):
    lines = [line for line in SYNTHETIC.read_bytes().splitlines() if line[:3] == b"!AI" and line[7:8] == b"1"]
    damaged = data.draw(st.sets(st.integers(0, len(lines) - 1)))
    kept = read_recording(line for number, line in enumerate(lines) if number not in damaged)
    heard = read_recording(
        line[:-1] + b"?" if number in damaged else line for number, line in enumerate(lines)
    )
    assert heard.reports == kept.reports
