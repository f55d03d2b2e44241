"""Recordings of live runs: every arrival, request and step in one MCAP file, readable after `kill -9`.

The schemas of its messages are in `schemas`, and documented in docs/reference/recording.md.
"""

from adapters.recording.mcap_files import Message, RecordingError
from adapters.recording.reading import Recording, is_recording, read_recording
from adapters.recording.schemas import SCHEMAS
from adapters.recording.writing import Recorder

__all__ = ["SCHEMAS", "Message", "Recorder", "Recording", "RecordingError", "is_recording", "read_recording"]
