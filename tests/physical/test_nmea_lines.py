from hypothesis import example, given
from hypothesis import strategies as st

from physical.nmea import DecodingFailure, TagBlock, checksum
from physical.nmea_lines import Framed, framed_in

SENTENCE = b"!AIVDM,1,1,,B,,0*25"


def tag(body):
    return b"\\%s*%02X\\" % (body, checksum(body))


def test_a_sentence_alone_is_found():
    assert framed_in(SENTENCE) == (Framed(SENTENCE),)


def test_a_sentence_ends_with_its_checksum_or_where_the_next_begins():
    assert [framed.sentence for framed in framed_in(SENTENCE + b" and more")] == [SENTENCE]
    assert [framed.sentence for framed in framed_in(b"!AIVDM,1,1,,B" + SENTENCE)] == [
        b"!AIVDM,1,1,,B",
        SENTENCE,
    ]
    assert [framed.sentence for framed in framed_in(b"!AIVDM,1,1,,B,,0")] == [b"!AIVDM,1,1,,B,,0"]


def test_a_tag_block_alone_is_a_frame_without_a_sentence():
    assert framed_in(tag(b"c:5")) == (Framed(b"", TagBlock(5.0)),)


def test_a_tag_block_that_is_damaged_or_torn_is_told():
    for before in (b"\\c:5*00\\", b"\\c:5*50", b"\\1G2:7,c:1772596000"):
        (framed,) = framed_in(before + SENTENCE)
        assert (framed.tag, framed.time, framed.reasons) == (None, None, (DecodingFailure.TAG_BLOCK,))


def test_a_line_without_a_sentence_has_none():
    for line in (b"", b"AIVDM,1,1", b"costs $5", b"! $ \\", b"\\c:5"):
        assert framed_in(line) == ()


@given(st.binary(max_size=200) | st.text("!$\\*,AIVDM\\c:0123456789 ", max_size=200).map(str.encode))
@example(b"\\" * 5000)
@example(b"!A," * 2000)
@example(b"\\a\\" * 2000)
def test_no_line_raises_and_sentences_do_not_overlap(line):
    frames = framed_in(line)
    at = 0
    for framed in frames:
        at = line.index(framed.sentence, at) + len(framed.sentence)
