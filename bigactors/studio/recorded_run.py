"""Runs from files: a trace of the checker, or a live run, whose steps a seen world has decided."""

from __future__ import annotations

import base64
import binascii
from collections.abc import Mapping
from dataclasses import dataclass, replace
from pathlib import Path
from tempfile import NamedTemporaryFile
from typing import Any

from adapters.recording.recording_reader import is_recording
from bigactors.files import read_json
from bigactors.mistakes import Mistake
from bigactors.recordings import open_recording, trace_of
from checker import Trace, replay
from semantics.properties.property import watching
from semantics.state.setting import Control, Scheduler, Setting
from specs.elaboration import ElaboratedMission


@dataclass(frozen=True, slots=True)
class RecordedRun:
    """A run from a file, replayed.

    Attributes:
        trace: Its steps.
        times: The time of each step in seconds; empty if it has none, or dates of the mission's clock.
    """

    trace: Trace
    times: tuple[float, ...] = ()

    def is_made_of_choices(self, setting: Setting) -> bool:
        """Return whether each step is a choice under the scheduler and the control of a setting: none was seen."""
        own = self.trace.initial.setting
        alike = (own.scheduler, own.control) == (setting.scheduler, setting.control)
        return alike and self.trace.in_turn and all(step.sight is None for step in self.trace.steps)


def run_in_file(path: Path, mission: ElaboratedMission) -> RecordedRun:
    """Return the run in a trace or a recording; raises Mistake, ReplayError, ValueError."""
    if not is_recording(str(path)):
        return run_in_trace(read_json(str(path)), mission)
    recording = open_recording(str(path))
    times = tuple(message.time for message in recording.of("steps"))
    return RecordedRun(trace_of(recording, _under(mission, Scheduler.FCFS, Control.TIMED)), times)


def run_in_bytes(content: object, mission: ElaboratedMission) -> RecordedRun:
    """Return the run in the content of a file, in base 64; raises Mistake, ReplayError, ValueError."""
    try:
        data = base64.b64decode(content if isinstance(content, str) else "", validate=True)
    except binascii.Error as error:
        raise ValueError("the file's content is not base 64") from error
    with NamedTemporaryFile(prefix="bigactors-") as file:
        file.write(data)
        file.flush()
        try:
            return run_in_file(Path(file.name), mission)
        except Mistake as mistake:
            raise ValueError(mistake.message) from mistake  # its place would be the temporary file


def run_in_trace(data: Any, mission: ElaboratedMission) -> RecordedRun:
    """Return the run of a trace's plain data; raises ReplayError, ValueError."""
    written = data if isinstance(data, Mapping) else {}
    scheduler = Scheduler(written.get("scheduler", mission.setting.scheduler))
    control = Control(written.get("control", mission.setting.control))
    return RecordedRun(replay(_under(mission, scheduler, control).initial, data))


def _under(mission: ElaboratedMission, scheduler: Scheduler, control: Control) -> ElaboratedMission:
    """Return the mission under a scheduler and a control, with all that its properties need."""
    varied = mission.under(scheduler, control)
    return replace(varied, begin=lambda setting: watching(mission.begin(setting), mission.properties))
