import pytest
from hypothesis import given
from hypothesis import strategies as st

from physical.nmea import (
    DecodingFailure,
    Fragment,
    Sentence,
    TagBlock,
    address,
    checksum,
    clock_of,
    parse_sentence,
    parse_tag_block,
    part_of,
    together,
)


def closed(body, start=b"!"):
    return start + body + b"*%02X" % checksum(body)


def clock(body):
    sentence = parse_sentence(closed(body, b"$"))
    assert isinstance(sentence, Sentence)
    return clock_of(sentence)


def part(body):
    sentence = parse_sentence(closed(body))
    assert isinstance(sentence, Sentence)
    return part_of(sentence)


def test_a_sentence_with_the_right_checksum_is_split_into_its_fields():
    sentence = parse_sentence(b"!AIVDM,1,1,,B,,0*25")
    assert sentence == Sentence(b"!AIVDM,1,1,,B,,0*25", "AIVDM", (b"1", b"1", b"", b"B", b"", b"0"))


@pytest.mark.parametrize(
    ("text", "reason"),
    [
        (b"!AIVDM,1,1,,B,,0*26", DecodingFailure.CHECKSUM),
        (b"!AIVDM,1,1,,B,,1*25", DecodingFailure.CHECKSUM),
        (b"!AIVDM,1,1,,B,,0*zz", DecodingFailure.CHECKSUM),
        (b"!AIVDM,1,1,,B,,0*-1", DecodingFailure.CHECKSUM),
        (b"!AIVDM,1,1,,B,,0*2", DecodingFailure.NO_CHECKSUM),
        (b"!AIVDM,1,1,,B,,0", DecodingFailure.NO_CHECKSUM),
        (b"!AIVDM,1,1,,B,,0*25,1306879500", DecodingFailure.MALFORMED),
        (b"!AIVDM,1,1,,\xff,,0*25", DecodingFailure.MALFORMED),
    ],
)
def test_a_damaged_sentence_is_refused_with_its_reason(text, reason):
    assert parse_sentence(text) is reason


@pytest.mark.parametrize(
    ("text", "name"),
    [
        (b"$GPRMC,1", "GPRMC"),
        (b"!--VDM,1", "--VDM"),
        (b"AIVDM,1", ""),
        (b"", ""),
        (b"!", ""),
        (b"!\xff\xffVDM,1", ""),
    ],
)
def test_the_address_is_read_from_what_starts_like_a_sentence(text, name):
    assert address(text) == name


def test_a_part_carries_six_bits_a_character_less_the_fill_bits():
    assert part(b"AIVDM,2,1,9,B,55R3Vn,2") == Fragment(
        parse_sentence(closed(b"AIVDM,2,1,9,B,55R3Vn,2")).raw, "AI", b"9", b"B", 2, 1, b"55R3Vn", 34
    )


@pytest.mark.parametrize(
    ("body", "reason"),
    [
        (b"AIVDM,1,1,,B,,0", DecodingFailure.EMPTY),
        (b"AIVDM,1,1,,B,15[0,0", DecodingFailure.ARMOUR),
        (b"AIVDM,1,1,,B,15 0,0", DecodingFailure.ARMOUR),
        (b"AIVDM,1,2,,B,1550,0", DecodingFailure.MALFORMED),
        (b"AIVDM,0,0,,B,1550,0", DecodingFailure.MALFORMED),
        (b"AIVDM,x,1,,B,1550,0", DecodingFailure.MALFORMED),
        (b"AIVDM,10,1,,B,1550,0", DecodingFailure.MALFORMED),
        (b"AIVDM,1,1,,B,1550,6", DecodingFailure.MALFORMED),
        (b"AIVDM,1,1,,B,1550", DecodingFailure.MALFORMED),
        (b"AIVDM,1,1,,B,1550,0,0", DecodingFailure.MALFORMED),
        (b"AIVDM,1,1,,AB,1550,0", DecodingFailure.MALFORMED),
    ],
)
def test_a_sound_sentence_that_carries_no_payload_is_refused_with_its_reason(body, reason):
    assert part(body) is reason


@pytest.mark.parametrize(
    ("body", "tag"),
    [
        (b"c:1671533231", TagBlock(time=1671533231.0)),
        (b"c:1671533231250", TagBlock(time=1671533231.25)),
        (b"s:r3669961,n:157036,i:something", TagBlock(source="r3669961")),
        (b"c:1671533231250125", TagBlock(time=1671533231.250125)),
        (b"c:1671533231250000000", TagBlock(time=1671533231.25)),
        (b"c:1671533231.25", TagBlock(time=1671533231.25)),
        (b"g:2-2-73874", TagBlock(group="73874", number=2, total=2)),
        (b"1G3:73874,s:r1", TagBlock(source="r1", group="73874", number=1, total=3)),
        (b"", TagBlock()),
    ],
)
def test_a_tag_block_gives_time_source_and_group(body, tag):
    assert parse_tag_block(body + b"*%02X" % checksum(body)) == tag


@pytest.mark.parametrize(
    "body",
    [
        b"c:yesterday",
        b"c:-5",
        b"c:1e999",
        b"c:" + b"9" * 400,
        b"c:9999999999",
        b"c:99999999999999999999",
        b"g:1-2",
        b"g:a-b-c",
        b"g:1-2-3-4",
        b"g:" + b"9" * 400 + b"-2-3",
    ],
)
def test_a_tag_block_that_cannot_be_read_is_refused(body):
    assert parse_tag_block(body + b"*%02X" % checksum(body)) is DecodingFailure.TAG_BLOCK


def test_tag_blocks_before_one_sentence_are_read_together():
    source, time, group = TagBlock(source="r1"), TagBlock(time=5.0), TagBlock(group="7", number=2, total=3)
    assert together([source, time, group]) == TagBlock(5.0, "r1", "7", 2, 3)
    assert together([TagBlock(time=4.0, source="r2"), time, source]) == TagBlock(4.0, "r2")
    assert together([]) is None


@pytest.mark.parametrize(
    ("body", "time"),
    [
        (b"GPZDA,213950.00,07,04,2020,00,00", 1586295590.0),
        (b"GPZDA,,,,,,", None),
        (b"PGHP,1,2010,6,11,11,46,11,390,231,45,992190934,1,2B", 1276256771.39),
        (b"GPRMC,213950.00,A,5250.53669,N,00542.34920,E,0.020,,070420,,,A", 1586295590.0),
        (b"GPRMC,213950.00,V,,,,,,,070420,,,N", None),  # no fix
        (b"GPRMC,000000,A,,,,,,,010180,,,A", 315532800.0),  # years begin in 1980
        (b"GPRMC,000000,A,,,,,,,010179,,,A", 3439756800.0),
    ],
)
def test_a_receiver_tells_its_time(body, time):
    assert clock(body) == time


@pytest.mark.parametrize(
    "body",
    [
        b"PGHP,1,2010,13,11,11,46,11,390",
        b"PGHP,1,2010",
        b"PGHP,1,2010,6,11,11,46,11," + b"9" * 400,
        b"GPRMC",
        b"GPRMC,213950.00,A",
        b"GPRMC,253950.00,A,,,,,,,070420,,,A",
        b"GPRMC,2139nan,A,,,,,,,070420,,,A",
        b"GPRMC,213950.00,A,,,,,,,310220,,,A",
        b"GPRMC,213950.00,A,,,,,,,07042020,,,A",
        b"GPZDA,213950.00",
        b"GPZDA,213950.00,31,02,2020,00,00",
        b"GPZDA,213950.00,07,04,9999,00,00",
        b"GPZDA,993950.00,07,04,2020,00,00",
    ],
)
def test_a_time_that_does_not_exist_is_refused(body):
    assert clock(body) is DecodingFailure.TIME


@given(st.lists(st.binary(max_size=12), max_size=14), st.sampled_from(["PGHP", "GPRMC", "GPZDA"]))
def test_no_fields_raise(fields, name):
    sentence = Sentence(b"", name, tuple(fields))
    assert isinstance(clock_of(sentence), float | DecodingFailure | None)
    assert isinstance(part_of(sentence), Fragment | DecodingFailure)
