"""Recordings of live runs: every arrival, request and step in one MCAP file, readable after `kill -9`.

`schemas` has the schemas of its messages, and docs/reference/recording.md documents them.
"""

from adapters.recording.mcap_files import Message, RecordingError
from adapters.recording.recording_reader import Recording, is_recording, read_recording
from adapters.recording.schemas import SCHEMAS
from adapters.recording.writing import Recorder

__all__ = ["SCHEMAS", "Message", "Recorder", "Recording", "RecordingError", "is_recording", "read_recording"]
