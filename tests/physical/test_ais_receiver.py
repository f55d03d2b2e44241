import pytest
from hypothesis import example, given
from hypothesis import strategies as st

from physical.ais_fragments import FRAGMENT_TABLE
from physical.ais_receiver import GROUP_TABLE, ReceiverState, hear
from physical.ais_reports import PositionReport, StaticReport
from physical.nmea import DecodingFailure, checksum

POSITION = b"!AIVDM,1,1,,B,35VwAv0300QcEQ`EGcpN40jD0PUQ,0*61"
NAME = (
    b"!AIVDM,2,1,9,B,55R3Vn82=ILTQ3KKS>1<D60Dq@E918U<F222221J1`?164vc03S1CCAD,0*2A",
    b"!AIVDM,2,2,9,B,`88888888888880,2*76",
)
PGHP = b"$PGHP,1,2010,6,11,11,46,11,390,231,45,992190934,1,2B*5B"
RMC = b"$GPRMC,213950.00,A,5250.53669,N,00542.34920,E,0.020,,070420,,,A*7D"


def tagged(body, sentence):
    return b"\\%s*%02X\\" % (body, checksum(body)) + sentence


def heard_all(*lines, now=None):
    """Hear lines one after the other: all reports, all reasons, the last state."""
    ear, reports, reasons = ReceiverState(), [], []
    for line in lines:
        heard = hear(ear, line, now)
        ear = heard.ear
        reports += heard.reports
        reasons += heard.reasons
    return reports, reasons, ear


def test_a_position_is_heard():
    heard = hear(ReceiverState(), POSITION + b"\r\n")
    assert heard.reports == (PositionReport(None, 3, 376427000, 37.346935, 23.44798, 0.0, None, 25.0),)
    assert (heard.pieces, heard.reasons) == (("position",), ())


def test_hearing_a_whole_message_leaves_the_state_the_same_object():
    ear = ReceiverState(clock=1.0)
    assert hear(ear, POSITION).ear is ear


def test_a_message_in_two_parts_is_heard_with_its_second():
    reports, reasons, ear = heard_all(*NAME)
    assert reports == [StaticReport(None, 5, 371255000, "SEA ENTERPRISE", 90)]
    assert (reasons, ear.fragments.waiting) == ([], ())


LOST = b"GPRMC,213951.00,V,,,,,,,070420,,,N"
VSI, APPENDED = b"$ARVSI,r1,1", POSITION + b",1276256770"
FIRST = tagged(b"g:1-2-7,s:r1,c:1671533231", VSI)
SECOND = tagged(b"g:2-2-7", POSITION)
NUMBERED_ALIKE = (
    tagged(b"g:1-3-7,s:r1,c:1671533231", VSI),
    tagged(b"g:1-3-7,s:r2,c:1671533241", VSI),
    tagged(b"g:2-3-7,s:r1", POSITION),
    tagged(b"g:2-3-7,s:r2", POSITION),
    tagged(b"g:3-3-7,s:r1", POSITION),
)
TIMES = {
    "the latest PGHP line": ([PGHP, POSITION], [1276256771.39]),
    "the latest RMC line": ([PGHP, RMC, POSITION], [1586295590.0]),
    "none once the fix is lost": ([RMC, b"$%s*%02X" % (LOST, checksum(LOST)), POSITION], [None]),
    "a tag block, of its own line": ([tagged(b"c:1671533231", POSITION), POSITION], [1671533231.0, None]),
    "the first line of a group": ([FIRST, SECOND], [1671533231.0]),
    "of a message in two lines": (
        [tagged(b"g:1-2-7,s:r1,c:1671533231", NAME[0]), tagged(b"g:2-2-7", NAME[1])],
        [1671533231.0],
    ),
    "a tag block alone": ([tagged(b"g:1-2-7,c:1671533231", b""), SECOND], [1671533231.0]),
    "none of a group that has ended": ([FIRST, SECOND, SECOND], [1671533231.0, None]),
    "none of a group of another length": ([tagged(b"g:1-3-7,c:1671533231", VSI), SECOND], [None]),
    "its own of a new group with an old number": (
        [FIRST, tagged(b"g:1-2-7,s:r2,c:1671533299", POSITION), SECOND],
        [1671533299.0, 1671533299.0],
    ),
    "of two receivers that number alike": (NUMBERED_ALIKE, [1671533231.0, 1671533241.0, 1671533231.0]),
    "none of other numbers": (
        [b"%s %s" % (each, POSITION) for each in (b"MMSI 376427000", b"10:47:11", b"127.0.0.1:10110", b"7")],
        [None] * 4,
    ),
    "none of numbers beyond a date": (
        [b"%s %s" % (each, POSITION) for each in (b"99999999999999", b"20221320104711")],
        [None] * 2,
    ),
}


@pytest.mark.parametrize("source", TIMES)
def test_the_time_of_a_report_is(source):
    lines, times = TIMES[source]
    assert [report.time for report in heard_all(*lines)[0]] == times


@pytest.mark.parametrize(
    ("lines", "time"),
    [
        ([RMC, POSITION], 7.0),
        ([APPENDED], 1276256770.0),
        ([PGHP, tagged(b"c:1671533231", APPENDED)], 1671533231.0),
    ],
    ids=["the recording's clock comes last", "an appended time comes before it", "a tag block first"],
)
def test_the_moment_of_reception_has_its_rank_among_times(lines, time):
    assert [report.time for report in heard_all(*lines, now=7.0)[0]] == [time]


def test_the_first_sentence_of_a_group_begins_another_though_the_station_is_the_same():
    lines = [
        tagged(b"g:%d-2-%d%s" % (line, number % 2, b",s:r1,c:%d" % time if line == 1 else b""), sentence)
        for number, time in enumerate((1671533231, 1671533241, 1671533251, 1671533261))
        for line, sentence in ((1, b"$ARVSI,r1,1"), (2, POSITION))
    ]
    reports, _, _ = heard_all(*lines)
    assert [report.time for report in reports] == [1671533231.0, 1671533241.0, 1671533251.0, 1671533261.0]


def test_a_damaged_tag_block_costs_its_time_but_not_the_sentence():
    reports, reasons, _ = heard_all(b"\\c:1671533231*00\\" + POSITION)
    assert [report.time for report in reports] == [None]
    assert reasons == [DecodingFailure.TAG_BLOCK]


def test_other_sentences_comments_and_blank_lines_bring_nothing():
    for line in (b"", b"  \r\n", b"# synthetic", b"$GPGSV,3,1,10*00", b"!AIABM,1,1,1,B,,0*00"):
        heard = hear(ReceiverState(), line)
        assert (heard.reports, heard.reasons) == ((), ())


def test_a_damaged_time_leaves_the_clock_as_it_was():
    heard = hear(ReceiverState(clock=1.0), PGHP[:-1] + b"0")
    assert (heard.ear.clock, heard.reasons) == (1.0, (DecodingFailure.CHECKSUM,))


def test_what_a_logger_writes_around_a_sentence_is_passed_over_but_for_its_time():
    for before, after in (
        (b"", b" ( MSG: 1, signalpower: -65.2, timestamp: 20221220104711)"),
        (b"1671533231.000 ", b""),
        (b"2022-12-20T10:47:11Z: ", b""),
        (b"[2022-12-20 11:47:11,000+01:00] ", b""),
        (b'{"class": "AIS", "rxuxtime": 1671533231, "nmea": "', b'\\r\\n"}'),
        (b'{"nmea": ["', b'"], "time": 1671533231000}'),
        (b"", b",d-106,r003669945,1671533231"),
        (tagged(b"s:rORBCOMM", b"") + tagged(b"c:1671533231", b""), b""),
        (b"1999-01-01T00:00:00Z " + tagged(b"c:1671533231", b""), b",1306879500"),
    ):
        heard = hear(ReceiverState(), before + POSITION + after)
        assert [report.time for report in heard.reports] == [1671533231.0], before + after
        assert (heard.reasons, heard.pieces) == ((), ("position",))


def test_sentences_in_one_line_are_all_heard():
    heard = hear(ReceiverState(), POSITION * 3 + NAME[0] + NAME[1])
    assert heard.pieces == ("position",) * 3 + ("part of a message", "message with a name or a type of ship")
    heard = hear(ReceiverState(), b"1671533231 " + POSITION + b" 1671533232 " + POSITION + POSITION)
    assert [report.time for report in heard.reports] == [1671533231.0, 1671533232.0, 1671533232.0]
    heard = hear(ReceiverState(), POSITION + b",1671533231" + POSITION + POSITION + b",1671533232")
    assert [report.time for report in heard.reports] == [1671533231.0, 1671533232.0, 1671533232.0]


LINES = [
    POSITION,
    *NAME,
    PGHP,
    RMC,
    tagged(b"g:1-2-7,s:r1,c:1671533231", NAME[0]),
    tagged(b"g:2-2-7", NAME[1]),
]


@st.composite
def mutated(draw):
    """A real line with some bytes replaced, removed or put in; its checksum made right again, or not."""
    line = bytearray(draw(st.sampled_from(LINES)))
    for _ in range(draw(st.integers(0, 4))):
        place = draw(st.integers(0, len(line)))
        line[place : place + draw(st.integers(0, 3))] = draw(st.binary(max_size=2))
    text = bytes(line)
    start, star = max(text.rfind(b"!"), text.rfind(b"$"), 0), text.rfind(b"*")
    if draw(st.booleans()) and star > start:
        text = text[: star + 1] + b"%02X" % checksum(text[start + 1 : star])
    return text


@given(st.lists(mutated() | st.binary(max_size=60) | st.sampled_from(LINES), max_size=30))
@example([b"\\", b"\\\\", b"\\*", b"!*00", b"$*00", b"!VDM*00", b"\\g:--*2A\\!"])
def test_no_lines_raise_and_the_state_stays_small(lines):
    reports, reasons, ear = heard_all(*lines)
    assert all(isinstance(report, PositionReport | StaticReport) for report in reports)
    assert all(isinstance(reason, DecodingFailure) for reason in reasons)
    assert len(ear.fragments.waiting) <= FRAGMENT_TABLE
    assert len(ear.groups) <= GROUP_TABLE


def test_the_state_is_bounded_however_many_groups_and_parts_are_heard():
    first = b"AIVDM,2,1,%d,%c,55R3Vn82,0"
    bodies = [first % (number % 10, 65 + number % 26) for number in range(500)]
    lines = [b"!%s*%02X" % (body, checksum(body)) for body in bodies]
    tags = [b"g:1-2-%d,c:1671533231" % number for number in range(500)]
    _, _, ear = heard_all(*(tagged(tag, line) for tag, line in zip(tags, lines, strict=True)))
    assert (len(ear.fragments.waiting), len(ear.groups)) == (FRAGMENT_TABLE, GROUP_TABLE)
