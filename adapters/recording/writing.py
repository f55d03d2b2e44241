"""Write the recording of a run in progress."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from pathlib import Path
from typing import Any

from adapters.live.state import Answer, Finding, GivingBack, Heard, Turn
from adapters.plugin import Report
from adapters.recording.encoding import arrival_json, command_json, finding_json, report_json, step_json
from adapters.recording.mcap_files import McapWriter, Message
from adapters.recording.schemas import RUN, SCHEMAS


class Recorder:
    """Writes what comes in and what follows from it; a turn's commands are on file before they are sent."""

    def __init__(self, path: Path, run: dict[str, Any], now: float) -> None:
        self._file = McapWriter(path, SCHEMAS)
        self._file.write("run", now, {"schema": RUN["properties"]["schema"]["const"], **run})
        self._file.flush()

    def arrival(self, heard: Heard, now: float) -> None:
        """Write what a plugin published."""
        self._file.write("arrivals", now, arrival_json(heard))

    def report(self, report: Report, now: float) -> None:
        """Write what a plugin reported."""
        self._file.write("reports", now, report_json(report))

    def turn(self, turn: Turn, now: float, verdicts: Callable[[Finding], tuple[str, ...]]) -> None:
        """Write what a turn came to, and hand it to the system if there is anything that must not be lost."""
        for step in turn.steps:
            self._file.write("steps", step.time, step_json(step))
        for command in turn.commands:
            self._file.write("commands", now, command_json(command))
        for finding in turn.findings:
            self._file.write("findings", now, finding_json(finding, verdicts(finding)))
        for answer in turn.answers:
            self._file.write(*_answer_json(answer, now))
        if turn.steps or turn.commands or turn.findings or turn.answers:
            self._file.flush()

    def copy(self, messages: Iterable[Message]) -> None:
        """Write the messages of another recording: this one stands by itself."""
        for message in messages:
            self._file.write(message.topic, message.time, message.data)
        self._file.flush()

    def flush(self) -> None:
        """Hand what was written to the system."""
        self._file.flush()

    def close(self, reason: str, now: float) -> None:
        """End the recording."""
        self._file.write("end", now, {"reason": reason})
        self._file.close()


def _answer_json(answer: Answer, now: float) -> tuple[str, float, dict[str, Any]]:
    said = answer.saying
    if isinstance(said, GivingBack):
        return "given_back", now, {"vehicle": said.vehicle, "refusal": answer.refusal}
    return "sayings", now, {"agent": said.agent, "message": said.message, "refusal": answer.refusal}
