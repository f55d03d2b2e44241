"""MCAP files of JSON messages: flushed messages survive, and a file is readable up to a torn end."""

from __future__ import annotations

import json
import os
import struct
import zlib
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from io import BytesIO
from pathlib import Path
from typing import Any, BinaryIO, Final

from adapters.recording.decompression import opened
from adapters.written_files import open_private, writing
from physical import PhysicalError, open_file, read_json
from physical.messages import install_extra

MAGIC: Final = b"\x89MCAP0\r\n"
FOOTER, CHANNEL, MESSAGE, CHUNK = 0x02, 0x04, 0x05, 0x06
"""The kinds of records that are read (https://mcap.dev/spec); all others are passed over."""

RECORD, COUNT = struct.Struct("<BQ"), struct.Struct("<Q")
SAID, CHUNKED = struct.Struct("<HIQQ"), struct.Struct("<QQQII")
"""How a message begins: channel, number, when logged, when published. How a chunk does: from when, until when, bytes
that it yields, their checksum, and how long the name of its compression is."""

MOST_BYTES = 8 * 2**20
"""The longest record that is read; missions hold a megabyte."""

MOST_CHUNK = 32 * 2**20
"""The most bytes that one chunk yields."""

MOST_TIMES, SPARE = 64, 16 * 2**20
"""All chunks yield so many times the bytes that they take at the most, and so many bytes besides."""

NANOSECONDS = 1_000_000_000


class RecordingError(ValueError):
    """A file that is no recording, or that this installation cannot read; the message says why."""


@dataclass(frozen=True, slots=True)
class Message:
    """One message: its topic, when it was written (seconds since 1970 UTC), and its data."""

    topic: str
    time: float
    data: Any


class McapWriter:
    """Writes messages; without chunks, so that nothing is lost that was flushed."""

    def __init__(self, path: Path, schemas: Mapping[str, tuple[str, dict[str, Any]]]) -> None:
        """Begin a file; `schemas` gives each topic the name of its schema, and the schema."""
        self._path = path
        self._file: BinaryIO = open_private(path, "xb")
        self._writer = _writer()(self._file, use_chunking=False, use_statistics=True)
        self._writer.start(profile="", library="bigactors")
        self._channels: dict[str, int] = {}
        for topic, (name, schema) in schemas.items():
            data = json.dumps(schema, ensure_ascii=False).encode()
            number = self._writer.register_schema(name, "jsonschema", data)
            self._channels[topic] = self._writer.register_channel(topic, "json", number)
        self.flush()

    def write(self, topic: str, time: float, data: Any) -> None:
        """Write a message; `flush` makes it last. Bytes of a path that are no UTF-8 are written as JSON's escapes."""
        said = json.dumps(data, ensure_ascii=False, separators=(",", ":"), allow_nan=False)
        encoded = said.encode(errors="backslashreplace")
        at = round(time * NANOSECONDS)
        with writing(self._path):
            self._writer.add_message(self._channels[topic], at, encoded, at)

    def flush(self) -> None:
        """Hand what was written to the system: a killed process loses none of it."""
        with writing(self._path):
            self._file.flush()

    def close(self) -> None:
        """End the file with its index; what can't be written any more is left out, and the file is closed."""
        if not self._file.closed:
            with writing(self._path), self._file:
                self._writer.finish()


@dataclass(slots=True)
class Reading:
    """A file being read.

    Attributes:
        torn: Whether the file ends amid a record, or without its index: the run was killed.
    """

    torn: bool = False

    def messages(self, path: Path) -> Iterator[Message]:
        """Yield the messages of a file in the order written.

        Raises:
            RecordingError: It is no MCAP file, or a message of it is no JSON.
        """
        topics: dict[int, str] = {}
        self.torn = True
        with open_file(path) as file:
            if file.read(len(MAGIC)) != MAGIC:
                raise RecordingError("this is no recording: it does not begin as MCAP")
            for kind, content in _unchunked(file):
                try:
                    if kind == CHANNEL:
                        topics[_number(content)] = _topic(content)
                    elif kind == MESSAGE:
                        yield _message(content, topics)
                except (struct.error, KeyError, UnicodeDecodeError) as error:
                    raise RecordingError(
                        f"this is no recording: a record is damaged: {error!s:.100}"
                    ) from error
                if kind == FOOTER:
                    self.torn = False
                    return


def _unchunked(file: BinaryIO) -> Iterator[tuple[int, bytes]]:
    """Yield whole records, those of chunks too: which may yield so many times the bytes that they take."""
    left = SPARE
    for kind, content in _records(file, os.fstat(file.fileno()).st_size):
        if kind != CHUNK:
            yield kind, content
            continue
        try:
            found = _opened(content)
        except (struct.error, ValueError) as error:
            raise RecordingError(f"this is no recording: a chunk is damaged: {error!s:.150}") from error
        left += MOST_TIMES * len(content) - len(found)
        if left < 0:
            raise RecordingError(f"its chunks yield more than {MOST_TIMES} times the bytes that they take")
        inner = BytesIO(found)
        yield from _records(inner, len(found))
        if inner.tell() != len(found):
            raise RecordingError("this is no recording: a chunk ends amid a record")


def _records(file: BinaryIO, size: int) -> Iterator[tuple[int, bytes]]:
    """Yield the kind and the content of whole records, up to the end or where it is torn."""
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
        raise ValueError(f"it declares {length:,} bytes, and {size:,} that they yield")
    found = opened(compression, data, size)
    if len(found) != size:
        raise ValueError(f"it yields other than the {size:,} bytes that it declares")
    if checksum and zlib.crc32(found) != checksum:
        raise ValueError("its checksum is not that of what it yields")
    return found


def _number(content: bytes) -> int:
    return int.from_bytes(content[:2], "little")


def _topic(content: bytes) -> str:
    """Return the topic of a channel, after its number and its schema's."""
    (length,) = struct.unpack_from("<I", content, 4)
    return content[8 : 8 + length].decode()


def _message(content: bytes, topics: Mapping[int, str]) -> Message:
    channel, _, time, _ = SAID.unpack_from(content)
    return Message(topics[channel], time / NANOSECONDS, _parsed(content[SAID.size :]))


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
