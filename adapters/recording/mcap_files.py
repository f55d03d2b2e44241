"""MCAP files of JSON messages: flushed messages survive, and a file is readable up to a torn end."""

from __future__ import annotations

import json
import os
import struct
import zlib
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass
from io import BytesIO
from pathlib import Path
from typing import Any, BinaryIO, Final, NamedTuple

from adapters.private_files import open_private, writing
from physical import PhysicalError, open_file, read_json
from physical.wordings import install_extra

MOST_WINDOW: Final = 1 << 24
"""The most bytes of a decompressor's window, which it keeps in memory."""


def opened(compression: str, data: bytes, size: int) -> bytes:
    """Return decompressed data, at most one byte more than its declared size.

    Raises:
        ValueError: The data are not compressed in this way, or no installed library can open them.
    """
    find = OPENERS.get(compression)
    if find is None:
        known = " or ".join(sorted(filter(None, OPENERS)))
        raise ValueError(f"it is compressed by '{compression:.20}', not by {known}")
    try:
        return find(data, size + 1)
    except ImportError as error:
        raise ValueError(
            f"the library of this compression is not installed: {install_extra('live')}"
        ) from error
    except (RuntimeError, EOFError, MemoryError) as error:
        raise ValueError(f"its {compression} is damaged: {error!s:.100}") from error


def _plain(data: bytes, most: int) -> bytes:
    return data[:most]


def _zstd(data: bytes, most: int) -> bytes:
    import zstandard  # noqa: PLC0415 - an extra

    try:
        with zstandard.ZstdDecompressor(max_window_size=MOST_WINDOW).stream_reader(BytesIO(data)) as reader:
            return reader.read(most)
    except zstandard.ZstdError as error:
        raise RuntimeError(str(error)) from error


def _lz4(data: bytes, most: int) -> bytes:
    import lz4.frame  # noqa: PLC0415 - an extra

    found: bytes = lz4.frame.LZ4FrameDecompressor().decompress(data, max_length=most)
    return found


OPENERS: Final[dict[str, Callable[[bytes, int], bytes]]] = {"": _plain, "zstd": _zstd, "lz4": _lz4}


MAGIC: Final = b"\x89MCAP0\r\n"
FOOTER, CHANNEL, MESSAGE, CHUNK = 0x02, 0x04, 0x05, 0x06
"""The kinds of records that are read (https://mcap.dev/spec); all others are skipped."""

RECORD, COUNT = struct.Struct("<BQ"), struct.Struct("<Q")
SAID, CHUNKED = struct.Struct("<HIQQ"), struct.Struct("<QQQII")
"""The heads of messages and chunks.

Of a message: channel, number, log time, publish time. Of a chunk: start, end, bytes after decompression, their
checksum, and the length of its compression's name.
"""

MOST_BYTES = 8 * 2**20
"""The longest record that is read; missions hold a megabyte."""

MOST_CHUNK = 32 * 2**20
"""The most decompressed bytes of one chunk."""

MOST_TIMES, SPARE = 64, 16 * 2**20
"""The most decompressed bytes of all chunks: a multiple of their compressed bytes, and a constant besides."""

NANOSECONDS = 1_000_000_000


_COMPACT: Final = json.JSONEncoder(ensure_ascii=False, separators=(",", ":"), allow_nan=False)


class RecordingError(ValueError):
    """A file that is no recording, or that this installation cannot read, for the reason in the message."""


@dataclass(frozen=True, slots=True)
class Message:
    """One message: its topic, its time (seconds since 1970 UTC), and its data, None if it is unread."""

    topic: str
    time: float
    data: Any


Schema = tuple[str, dict[str, Any]]
"""The name of a schema, and the schema."""


class McapWriter:
    """Writes messages without chunks, so that no flushed message is lost."""

    def __init__(self, path: Path, schemas: Mapping[str, Schema]) -> None:
        """Begin a file; `schemas` gives each topic its schema."""
        self._path = path
        self._file: BinaryIO = open_private(path, "xb")
        self._writer = _writer()(self._file, use_chunking=False, use_statistics=True)
        self._writer.start(profile="", library="bigactors")
        self._channels: dict[str, int] = {}
        self._schemas: dict[str, int] = {}
        for topic, schema in schemas.items():
            self.declare(topic, schema)
        self.flush()

    def declare(self, topic: str, schema: Schema) -> None:
        """Add a topic, unless it is there."""
        if topic in self._channels:
            return
        name, data = schema[0], json.dumps(schema[1], ensure_ascii=False).encode()
        with writing(self._path):
            if name not in self._schemas:
                self._schemas[name] = self._writer.register_schema(name, "jsonschema", data)
            self._channels[topic] = self._writer.register_channel(topic, "json", self._schemas[name])

    def write(self, topic: str, time: float, data: Any) -> None:
        """Write a message; `flush` makes it last. Bytes of a path that are no UTF-8 are written as JSON's escapes."""
        encoded = _COMPACT.encode(data).encode(errors="backslashreplace")
        at = round(time * NANOSECONDS)
        with writing(self._path):
            self._writer.add_message(self._channels[topic], at, encoded, at)

    def flush(self) -> None:
        """Pass the written messages to the system: a killed process loses none of them."""
        with writing(self._path):
            self._file.flush()

    def close(self) -> None:
        """End the file with its index; the file is closed even if that cannot be written."""
        if not self._file.closed:
            with writing(self._path), self._file:
                self._writer.finish()


class Place(NamedTuple):
    """A position for further reading.

    Attributes:
        offset: The byte of the file, between two records; 0 before the beginning.
        within: The number of messages read of a chunk at that byte.
        room: The remaining allowance of decompressed bytes, beyond each chunk's own multiple.
    """

    offset: int = 0
    within: int = 0
    room: int = SPARE


class McapReader:
    """Reads the messages of a file that may still grow: a torn record at its end is not written yet.

    Attributes:
        place: The position after the last message read.
        ended: Whether the file's footer was read: no record follows.
    """

    def __init__(self, path: Path, *, unread: tuple[str, ...] = ()) -> None:
        """Begin without reading; the data of topics with a prefix in `unread` will not be parsed."""
        self.place = Place()
        self.ended = False
        self._path = path
        self._unread = unread
        self._topics: dict[int, str] = {}
        self._size = -1  # the size at which all was read

    def grows(self) -> bool:
        """Return whether the file has changed since all of it was read; raises OSError."""
        return self._path.stat().st_size != self._size

    def going_on(self, place: Place) -> McapReader:
        """Return another reader of the file, from a place that this one has passed."""
        other = McapReader(self._path, unread=self._unread)
        other.place, other._topics = place, self._topics
        return other

    def messages(self) -> Iterator[Message]:
        """Yield the complete messages, from `place` on, in the order written.

        Raises:
            RecordingError: It is no MCAP file, or a message of it is no JSON.
            OSError: It cannot be opened.
        """
        with open_file(self._path) as file:
            if not self.place.offset and not self._begins(file):
                return
            size = os.fstat(file.fileno()).st_size
            if size < self.place.offset:
                raise RecordingError("it has become shorter than it was")
            file.seek(self.place.offset)
            for kind, content in _records(file, size):
                after = self.place._replace(offset=self.place.offset + RECORD.size + len(content))
                if kind == CHUNK:
                    yield from self._unpacked(content, after)
                elif (message := self._taken(kind, content)) is not None:
                    self.place = after
                    yield message
                else:
                    self.place = after
                if kind == FOOTER:
                    self.ended = True
                    return
            self._size = size

    def _begins(self, file: BinaryIO) -> bool:
        """Return whether a file has a complete MCAP beginning; raises RecordingError for another one."""
        begin = file.read(len(MAGIC))
        if not MAGIC.startswith(begin):
            raise RecordingError("this is no recording: it does not begin as MCAP")
        if begin == MAGIC:
            self.place = Place(len(MAGIC))
        return begin == MAGIC

    def _unpacked(self, content: bytes, after: Place) -> Iterator[Message]:
        """Yield the messages of a chunk, within the bound on the decompressed bytes of all chunks."""
        try:
            found = _opened(content)
        except (struct.error, ValueError) as error:
            raise RecordingError(f"this is no recording: a chunk is damaged: {error!s:.150}") from error
        room = after.room + MOST_TIMES * len(content) - len(found)
        if room < 0:
            raise RecordingError(f"its chunks yield more than {MOST_TIMES} times the bytes that they take")
        inner = BytesIO(found)
        taken = (self._taken(kind, inside) for kind, inside in _records(inner, len(found)))
        messages = (message for message in taken if message is not None)
        for number, message in enumerate(messages, 1):
            if number > self.place.within:
                self.place = self.place._replace(within=number)
                yield message
        if inner.tell() != len(found):
            raise RecordingError("this is no recording: a chunk ends amid a record")
        self.place = Place(after.offset, 0, room)

    def _taken(self, kind: int, content: bytes) -> Message | None:
        """Return the message in a record, None for any other record; remember the topics of channels."""
        try:
            if kind == MESSAGE:
                return self._message(content)
            if kind == CHANNEL:
                self._topics[_number(content)] = _topic(content)
        except (struct.error, KeyError, UnicodeDecodeError) as error:
            raise RecordingError(f"this is no recording: a record is damaged: {error!s:.100}") from error
        return None

    def _message(self, content: bytes) -> Message:
        channel, _, time, _ = SAID.unpack_from(content)
        topic = self._topics[channel]
        data = None if topic.startswith(self._unread) else _parsed(content[SAID.size :])
        return Message(topic, time / NANOSECONDS, data)


def _records(file: BinaryIO, size: int) -> Iterator[tuple[int, bytes]]:
    """Yield the kind and the content of whole records, up to the end or a torn record."""
    while len(head := file.read(RECORD.size)) == RECORD.size:
        kind, length = RECORD.unpack(head)
        if length > MOST_BYTES:
            raise RecordingError(f"this is no recording: a record of {length:,} bytes, over {MOST_BYTES:,}")
        if length > size - file.tell():
            return
        yield kind, file.read(length)


def _opened(content: bytes) -> bytes:
    """Return the records of a chunk; raises ValueError, struct.error."""
    *_, size, checksum, named = CHUNKED.unpack_from(content)
    at = CHUNKED.size + named
    compression = content[CHUNKED.size : at].decode()
    (length,) = COUNT.unpack_from(content, at)
    data = content[at + COUNT.size :]
    if length != len(data) or size > MOST_CHUNK:
        raise ValueError(f"it declares {length:,} bytes, and {size:,} after decompression")
    found = opened(compression, data, size)
    if len(found) != size:
        raise ValueError(f"it does not decompress to the {size:,} bytes that it declares")
    if checksum and zlib.crc32(found) != checksum:
        raise ValueError("its checksum does not match its content")
    return found


def _number(content: bytes) -> int:
    return int.from_bytes(content[:2], "little")


def _topic(content: bytes) -> str:
    """Return the topic of a channel, after its number and its schema's."""
    (length,) = struct.unpack_from("<I", content, 4)
    return content[8 : 8 + length].decode()


def _parsed(data: bytes) -> Any:
    try:
        return read_json(data, MOST_BYTES)
    except PhysicalError as error:
        raise RecordingError(f"a message cannot be read: {error.message:.150}") from error


def _writer() -> Any:
    try:
        from mcap.writer import Writer  # noqa: PLC0415 - an extra
    except ImportError as error:
        raise _missing() from error
    return Writer


def _missing() -> RecordingError:
    return RecordingError(f"recordings need mcap, which is not installed: {install_extra('live')}")
