"""MCAP files of JSON messages: what was flushed is there whatever happens next, and is read up to a torn end."""

from __future__ import annotations

import json
import struct
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any, BinaryIO

from adapters.disk import writing

MOST_BYTES = 8 * 2**20
"""The longest record that is read; missions hold a megabyte."""

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
        self._file: BinaryIO = path.open("xb")
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
        exceptions, records, reader = _reader()
        topics: dict[int, str] = {}
        self.torn = True
        with path.open("rb") as file:
            try:
                for record in reader(file, record_size_limit=MOST_BYTES).records:
                    if isinstance(record, records.Channel):
                        topics[record.id] = record.topic
                    elif isinstance(record, records.Message):
                        yield Message(
                            topics[record.channel_id], record.log_time / NANOSECONDS, _parsed(record.data)
                        )
                    elif isinstance(record, records.Footer):
                        self.torn = False
            except (exceptions.EndOfFile, struct.error):  # it ends amid a record
                return
            except (exceptions.McapError, KeyError, ValueError, OverflowError, EOFError) as error:
                raise RecordingError(f"this is no recording: {error!s:.200}") from error


def _parsed(data: bytes) -> Any:
    try:
        return json.loads(data)
    except (ValueError, RecursionError) as error:
        raise RecordingError(f"a message is not JSON: {error!s:.100}") from error


def _writer() -> Any:
    try:
        from mcap.writer import Writer  # noqa: PLC0415 - an extra
    except ImportError as error:
        raise _missing() from error
    return Writer


def _reader() -> Any:
    try:
        from mcap import exceptions, records  # noqa: PLC0415 - an extra
        from mcap.stream_reader import StreamReader  # noqa: PLC0415 - the same
    except ImportError as error:
        raise _missing() from error
    return exceptions, records, StreamReader


def _missing() -> RecordingError:
    return RecordingError("recordings need the extra 'live': pip install 'bigactors[live]'")
