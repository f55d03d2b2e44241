"""The report of a recorded flight as a page."""

from __future__ import annotations

from pathlib import Path

from adapters.console.flight_report import flight_report
from adapters.console.history import History
from adapters.recording.recorded_tracks import recorded_tracks
from adapters.recording.recording_reader import is_recording
from bigactors.commands.console.recorded_history import rules_of
from bigactors.files import write_text
from bigactors.mistakes import Mistake
from bigactors.terminal import tell


def write_report(path: str, output: str) -> None:
    """Write the report of a recording; raises Mistake for a trace."""
    if not is_recording(path):
        raise Mistake("a report is of a recorded flight", "run --record writes a recording", path)
    history = History(Path(path), rules_of)
    while history.read_on(1.0):
        pass
    facts = history.facts
    assert facts.run is not None, "it was replayed before"
    write_text(output, flight_report(facts, recorded_tracks(Path(path), facts.run.vehicles)))
    tell(f"report written to {output}")
