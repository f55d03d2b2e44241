"""MCAP files from elsewhere: compressed ones are read, damaged ones refused, and none takes more than it is worth."""

import io
import json
import os
import resource
import struct
import zlib

import lz4.frame
import pytest
import zstandard
from hypothesis import given, settings
from hypothesis import strategies as st
from mcap.writer import CompressionType, Writer

from adapters.recording.mcap_files import (
    MAGIC,
    MOST_BYTES,
    MOST_CHUNK,
    SPARE,
    McapReader,
    Message,
    RecordingError,
)

MANY = int(os.environ.get("BIGACTORS_FUZZ", "0")) // 10
DATA = [{"step": number, "of": "uav0"} for number in range(200)]
PACKERS = {"zstd": zstandard.compress, "lz4": lz4.frame.compress, "": bytes}


def written(compression, data=DATA):
    """Return an MCAP file as the library of its authors writes it."""
    file = io.BytesIO()
    writer = Writer(file, compression=compression, chunk_size=1024)
    writer.start()
    channel = writer.register_channel("steps", "json", writer.register_schema("x", "jsonschema", b"{}"))
    for number, each in enumerate(data):
        writer.add_message(channel, number * 10**9, json.dumps(each).encode(), number * 10**9)
    writer.finish()
    return file.getvalue()


def read(tmp_path, data):
    path = tmp_path / "x.mcap"
    path.write_bytes(data)
    reader = McapReader(path)
    return list(reader.messages()), not reader.ended


def record(kind, content):
    return struct.pack("<BQ", kind, len(content)) + content


def chunk(compression, data, size, checksum=0):
    name = compression.encode()
    return record(
        6, struct.pack("<QQQII", 0, 0, size, checksum, len(name)) + name + struct.pack("<Q", len(data)) + data
    )


CHANNEL = record(4, struct.pack("<HHI", 1, 0, 5) + b"steps" + struct.pack("<II", 4, 0) + bytes(4))
EMPTY = record(5, struct.pack("<HIQQ", 1, 0, 0, 0) + b"{}")


def test_messages_that_nobody_reads_are_not_parsed(tmp_path):
    path = tmp_path / "x.mcap"
    path.write_bytes(MAGIC + CHANNEL + EMPTY[:-2] + b"[[")
    with pytest.raises(RecordingError, match="cannot be read"):
        list(McapReader(path).messages())
    [message] = McapReader(path, unread=("st",)).messages()
    assert message == Message("steps", 0.0, None)


@pytest.mark.parametrize("compression", CompressionType)
def test_compressed_files_are_read(tmp_path, compression):
    messages, torn = read(tmp_path, written(compression))
    assert [message.data for message in messages] == DATA
    assert {message.topic for message in messages} == {"steps"}
    assert messages[7].time == 7.0
    assert not torn


@pytest.mark.parametrize("compression", PACKERS)
def test_a_chunk_yields_no_more_than_it_declares(tmp_path, compression):
    packed = PACKERS[compression](CHANNEL + EMPTY * 1_000)
    whole = len(CHANNEL + EMPTY * 1_000)
    messages, _ = read(tmp_path, MAGIC + chunk(compression, packed, whole))
    assert len(messages) == 1_000
    for size in (0, whole - 1, whole + 1, MOST_CHUNK + 1, 2**63):
        with pytest.raises(RecordingError, match="declares"):
            read(tmp_path, MAGIC + chunk(compression, packed, size))


@pytest.mark.parametrize("compression", CompressionType)
def test_a_file_that_grows_byte_by_byte_is_read_as_a_whole_one(tmp_path, compression):
    data, path = written(compression, DATA[:5]), tmp_path / "x.mcap"
    path.write_bytes(b"")
    reader = McapReader(path)
    found = []
    for size in range(len(data) + 1):
        path.write_bytes(data[:size])
        found += reader.messages()
    assert [message.data for message in found] == DATA[:5]
    assert reader.ended


@pytest.mark.parametrize("compression", CompressionType)
def test_reading_goes_on_from_any_message(tmp_path, compression):
    path = tmp_path / "x.mcap"
    path.write_bytes(written(compression))
    reader = McapReader(path)
    places = [reader.place for _ in reader.messages()]
    for number in range(0, 200, 7):
        rest = [message.data for message in reader.going_on(places[number]).messages()]
        assert rest == DATA[number + 1 :]


def test_a_file_that_becomes_shorter_is_no_longer_read(tmp_path):
    path = tmp_path / "x.mcap"
    path.write_bytes(written(CompressionType.NONE))
    reader = McapReader(path)
    next(reader.messages())
    path.write_bytes(MAGIC)
    with pytest.raises(RecordingError, match="shorter"):
        list(reader.messages())


def bombs(compression):
    """Return half a gigabyte of empty messages, compressed piece by piece, and how many bytes they are."""
    piece, times = EMPTY * 30_000, 512
    if compression == "zstd":
        packer = zstandard.ZstdCompressor().compressobj()
        return b"".join([*(packer.compress(piece) for _ in range(times)), packer.flush()]), len(piece) * times
    with lz4.frame.LZ4FrameCompressor() as packer:
        pieces = [packer.begin(), *(packer.compress(piece) for _ in range(times)), packer.flush()]
    return b"".join(pieces), len(piece) * times


@pytest.mark.parametrize("compression", ["zstd", "lz4"])
def test_a_small_chunk_takes_little_memory(tmp_path, compression):
    bomb, size = bombs(compression)
    assert len(bomb) < MOST_BYTES
    before = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss
    for declared in (size, MOST_CHUNK):
        with pytest.raises(RecordingError, match="declares"):
            read(tmp_path, MAGIC + chunk(compression, bomb, declared))
    assert resource.getrusage(resource.RUSAGE_SELF).ru_maxrss - before < 2 * MOST_CHUNK // 1024


def test_many_small_chunks_yield_no_more_than_they_are_worth(tmp_path):
    inner = CHANNEL + record(9, bytes(4 * 2**20)) * 7
    packed = zstandard.compress(inner)
    one = chunk("zstd", packed, len(inner))
    assert len(one) < 5_000
    with pytest.raises(RecordingError, match="yield more than 64 times the bytes"):
        read(tmp_path, MAGIC + one * (SPARE // len(inner) + 2))


@pytest.mark.parametrize("compression", PACKERS)
@pytest.mark.parametrize("spoil", [lambda data: data[:-40], lambda data: data[:9] + bytes(30) + data[39:]])
def test_malformed_chunks_are_refused(tmp_path, compression, spoil):
    inner = CHANNEL + b"".join(
        record(5, struct.pack("<HIQQ", 1, n, n, n) + b'{"n": %d}' % n) for n in range(99)
    )
    packed = spoil(PACKERS[compression](inner))
    with pytest.raises(RecordingError, match="damaged"):
        read(tmp_path, MAGIC + chunk(compression, packed, len(inner), zlib.crc32(inner)))


@pytest.mark.parametrize(
    ("data", "says"),
    [
        (chunk("brotli", b"", 0), "compressed by 'brotli'"),
        (record(5, b"short"), "a record is damaged"),
        (record(5, struct.pack("<HIQQ", 7, 0, 0, 0) + b"{}"), "a record is damaged"),
        (record(4, struct.pack("<HHI", 1, 0, 2) + b"\xff\xff"), "a record is damaged"),
        (CHANNEL + record(5, struct.pack("<HIQQ", 1, 0, 0, 0) + b"[" * 100_000), "nested too deeply"),
        (struct.pack("<BQ", 5, 2**63), "a record of 9,223,372,036,854,775,808 bytes"),
        (chunk("", EMPTY[:-1], len(EMPTY) - 1), "a chunk ends amid a record"),
    ],
)
def test_what_is_damaged_is_told(tmp_path, data, says):
    with pytest.raises(RecordingError, match=says):
        read(tmp_path, MAGIC + data)


@pytest.mark.fuzz
@settings(max_examples=max(100, MANY))
@given(st.sampled_from(list(CompressionType)), st.data())
def test_mutated_files_are_read_or_refused(tmp_path_factory, compression, draw):
    data = bytearray(written(compression, DATA[:20]))
    for _ in range(draw.draw(st.integers(1, 4))):
        at = draw.draw(st.integers(0, len(data) - 1))
        data[at : at + draw.draw(st.integers(0, 2))] = draw.draw(st.binary(max_size=3))
    try:
        messages, _ = read(tmp_path_factory.mktemp("mutated"), bytes(data))
    except RecordingError:
        return
    assert len(messages) <= 40
