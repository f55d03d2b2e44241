"""Watchers of a flying mission: the operator's terminal, and the recording."""

from __future__ import annotations

import errno
import math
import os
import sys
import time
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import contextmanager, suppress
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any, BinaryIO

from adapters.live.batch import Heard
from adapters.live.live_state import LiveState
from adapters.live.operator_findings import Finding
from adapters.live.run_watchers import SHOWN_RULES, Watcher
from adapters.live.turn_result import LiveStep, Turn
from adapters.mavlink.tlog import entry
from adapters.plugin import Report, Status
from adapters.private_files import open_private, writing
from adapters.recording.writing import Recorder
from bigactors.mistakes import Mistake
from bigactors.progress import Watch
from bigactors.terminal import is_terminal, paint, say_text, tell
from bigactors.vehicle_lines import vehicles_line

DONE = {"hold": "vehicles hold", "return": "vehicles return"}
"""The effect of each fallback in words."""

EVERY = 1.0
"""Seconds between two updates of the vehicles' line on a terminal."""

SELDOM = 60.0
"""Seconds of silence after which other output gets a line about the vehicles."""

MOST_BREACHES = 10
"""The most breaches of the earlier run that a resumed run prints."""

Resting = Callable[[Finding], tuple[str, ...]]
"""Returns the properties whose verdicts depend on a finding's assumption."""


@dataclass(slots=True)
class Terminal(Watcher):
    """Prints world-changing steps, the displays of agents, findings, and a line about the vehicles.

    Attributes:
        resting: Returns the verdicts that depend on a finding's assumption.
        vehicles: The vehicles of the run.
        broken: Whether an assumption broke, or the recording or a plugin failed.
        property_broken: Whether an invariant about ways was false of what was seen.
        state: The state after the last turn.
    """

    resting: Resting
    vehicles: Sequence[str] = ()
    broken: bool = field(default=False)
    property_broken: bool = field(default=False)
    began: float | None = None
    state: LiveState | None = None
    _said: dict[str, Status] = field(default_factory=dict)
    _line: Watch = field(default_factory=lambda: Watch("", sys.stderr))
    _spoke: float = -math.inf
    _drawn: float = -math.inf

    def goes_on(self, broken: Sequence[Finding], taken: Mapping[str, str]) -> None:
        """Print the breaches of the resumed run, and the vehicles that are taken over."""
        self.broken = any(map(_breaks, broken))
        self.property_broken = any(map(_breaks_property, broken))
        told = tuple(dict.fromkeys((finding.kind, finding.message, finding.fallback) for finding in broken))
        for kind, message, fallback in told[:MOST_BREACHES]:
            back = f"; {DONE[fallback]}, as the mission says" if fallback in DONE else ""
            tell(f"{message}{back}", f"{kind}, before it was resumed:")
        if len(told) > MOST_BREACHES:
            tell(f"  and {len(told) - MOST_BREACHES:,} more")
        if told:
            tell("  it goes on once the world is as the mission assumes again, or with --unverified")
        for vehicle, how in sorted(taken.items()):
            tell(
                f"{vehicle}: {how}; this run does not command it until `bigactors give-back {vehicle}`",
                "taken over:",
            )

    def reported(self, report: Report, now: float) -> None:  # noqa: ARG002 - the protocol
        """Store a vehicle's status for its line. Print nothing: important reports become findings."""
        if isinstance(report, Status):
            self._said[report.entity] = report

    def turned(self, turn: Turn, now: float) -> None:
        """Print the result of a turn."""
        if self.began is None:
            self.began = self._spoke = now
        self.state = turn.state
        lines = [line for step in turn.steps for line in self._told(step)]
        if lines or turn.findings:
            self.ends()
            self._spoke = now
        with _flying_on():
            say_text("".join(f"{line}\n" for line in lines), flush=True)
        for finding in turn.findings:
            self.broken |= _breaks(finding)
            self.property_broken |= _breaks_property(finding)
            with _flying_on():
                self._tell(finding)
        if self.vehicles:
            with _flying_on():
                self._tell_of_vehicles(turn.state, now)

    def ends(self) -> None:
        """Clear the vehicles' line before other output."""
        with _flying_on():
            self._line.clear()

    def _told(self, step: LiveStep) -> Iterator[str]:
        """Yield the lines of a step."""
        label, at = step.transition.label, self._at(step.time)
        if label.rule in SHOWN_RULES:
            yield f"{at} {label}"
        yield from (f"{at} {label.agent}: {text}" for text in step.transition.shown)

    def _at(self, time: float) -> str:
        return f"{time - (time if self.began is None else self.began):8.1f} s "

    def _tell_of_vehicles(self, state: LiveState, now: float) -> None:
        """Print a line about the vehicles: on a terminal always, in one place; elsewhere after a long silence."""
        if is_terminal(sys.stderr):
            wall = time.monotonic()
            if wall - self._drawn >= EVERY:
                self._drawn = wall
                self._line.rewrite(f"{self._at(now)} {vehicles_line(self.vehicles, state, self._said, now)}")
        elif now - self._spoke >= SELDOM:
            self._spoke = now
            say_text(f"{self._at(now)} {vehicles_line(self.vehicles, state, self._said, now)}\n", flush=True)

    def _tell(self, finding: Finding) -> None:
        tell(finding.message, f"{finding.kind}:")
        if finding.kind == "broken assumption":
            verdicts = self.resting(finding)
            if verdicts:
                tell(f"  these verdicts rest on it: {', '.join(verdicts)}")
        if finding.fallback:
            done = DONE.get(finding.fallback, "the mission goes on")
            tell(f"  {paint(done, 'yellow', sys.stderr)}, as the mission says")


def _breaks(finding: Finding) -> bool:
    """Return whether a finding voids the verification: a broken assumption, or a failure with a fallback."""
    return finding.kind == "broken assumption" or (finding.kind == "failed" and bool(finding.fallback))


def _breaks_property(finding: Finding) -> bool:
    return finding.kind == "broken property"


@contextmanager
def _flying_on() -> Iterator[None]:
    """Report an output that can't be written; this does not end the flight."""
    try:
        yield
    except Mistake as mistake:
        with suppress(Mistake):
            tell(str(mistake))


@dataclass(slots=True)
class Tape(Watcher):
    """Writes arrivals, reports and turns into a recording.

    Attributes:
        recorder: The recording.
        resting: The properties that depend on the assumption of a finding.
        reason: Why the run has ended.
    """

    recorder: Recorder
    resting: Resting
    reason: str = "the run has ended"

    def arrived(self, heard: Heard, now: float) -> None:
        """Record an arrival."""
        self.recorder.arrival(heard, now)

    def reported(self, report: Report, now: float) -> None:
        """Record a report."""
        self.recorder.report(report, now)

    def turned(self, turn: Turn, now: float) -> None:
        """Record a turn: its commands are on file before they are sent."""
        self.recorder.turn(turn, now, self.resting)

    def preflight(self, said: dict[str, Any], now: float) -> None:
        """Record the checks before the start, and their state."""
        self.recorder.preflight(said, now)


class Log:
    """A telemetry log: every frame received and sent, with its time, in the format of other ground stations."""

    def __init__(self, path: Path) -> None:
        self._path = path
        self._file: BinaryIO | None = None

    def __call__(self, time: float, frame: bytes) -> None:
        """Write a frame at once, so that it survives the process."""
        if self._file is None:
            self._file = open_private(self._path, "ab", buffering=0)
        said = entry(time, frame)
        with writing(self._path):
            if self._file.write(said) < len(said):
                raise OSError(errno.ENOSPC, os.strerror(errno.ENOSPC))

    def close(self) -> None:
        """Close the log."""
        if self._file is not None:
            self._file.close()
