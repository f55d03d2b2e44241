"""Write the recording of a run in progress."""

from __future__ import annotations

from collections.abc import Callable, Container, Iterable
from pathlib import Path
from typing import Any, Final

from adapters.live.state import Answer, Finding, GivingBack, Heard, Turn
from adapters.plugin import Report, entity_of
from adapters.ration import Ration
from adapters.recording.encoding import arrival_json, command_json, finding_json, report_json, step_json
from adapters.recording.mcap_files import McapWriter, Message
from adapters.recording.schemas import RUN, SCHEMAS

MOST_ARRIVALS: Final = 100
"""Arrivals that are written in a second, of each entity of the mission, and of all others that one plugin tells of."""


class Recorder:
    """Writes what comes in and what follows from it; a turn's commands are on file before they are sent.

    Of a flood of arrivals so many are written, and how many were left out; steps say what they were taken for, and are
    written all.
    """

    def __init__(self, path: Path, run: dict[str, Any], now: float, names: Container[str] = ()) -> None:
        """Begin a recording; `names` are the entities of the mission."""
        self._names = names
        self._ration: Ration[tuple[str, str]] = Ration(MOST_ARRIVALS)
        self._file = McapWriter(path, SCHEMAS)
        self._file.write("run", now, {"schema": RUN["properties"]["schema"]["const"], **run})
        self._file.flush()

    def arrival(self, heard: Heard, now: float) -> None:
        """Write what a plugin published, unless that is too much."""
        entity = entity_of(heard.published)
        if self._ration.takes((heard.plugin, entity if entity in self._names else ""), now):
            self._file.write("arrivals", now, arrival_json(heard))

    def report(self, report: Report, now: float) -> None:
        """Write what a plugin reported."""
        self._file.write("reports", now, report_json(report))

    def turn(self, turn: Turn, now: float, verdicts: Callable[[Finding], tuple[str, ...]]) -> None:
        """Write what a turn came to, and hand it to the system if there is anything that must not be lost."""
        self._account(now, self._ration.left_out(now))
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
        self._account(now, self._ration.left_out())
        self._file.write("end", now, {"reason": reason})
        self._file.close()

    def _account(self, now: float, left_out: Iterable[tuple[tuple[str, str], int]]) -> None:
        for (plugin, entity), count in left_out:
            self._file.write("left_out", now, {"plugin": plugin, "entity": entity, "arrivals": count})


def _answer_json(answer: Answer, now: float) -> tuple[str, float, dict[str, Any]]:
    said = answer.saying
    if isinstance(said, GivingBack):
        where = {"at": said.at} if said.at else {}
        return "given_back", now, {"vehicle": said.vehicle, **where, "refusal": answer.refusal}
    return "sayings", now, {"agent": said.agent, "message": said.message, "refusal": answer.refusal}
