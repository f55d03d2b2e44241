"""Watchers of a flying mission: the operator's terminal, and the recording."""

from __future__ import annotations

import errno
import os
import sys
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import contextmanager, suppress
from dataclasses import dataclass, field
from pathlib import Path
from typing import BinaryIO

from adapters.live.state import Finding, Heard, Turn
from adapters.mavlink.tlog import entry
from adapters.plugin import Report
from adapters.recording.writing import Recorder
from adapters.written_files import open_private, writing
from bigactors.mistakes import Mistake
from bigactors.terminal import paint, say_text, tell

TOLD = frozenset({"env", "say", "command", "commit", "actuate", "migrate", "spawn"})
"""The rules whose steps are shown to the operator; the recording has the others too."""

DONE = {"hold": "vehicles hold", "return": "vehicles return"}
"""What is done when the mission falls back."""

MOST_BREACHES = 10
"""How much of what broke in a run is said when another goes on from it."""

Resting = Callable[[Finding], tuple[str, ...]]
"""Returns the properties whose verdicts depend on a finding's assumption."""


@dataclass(slots=True)
class Terminal:
    """Prints steps that change the world, the displays of agents, and findings.

    Attributes:
        resting: The verdicts that depend on a finding's assumption.
        broken: Whether an assumption broke, or the recording or a plugin failed.
        taken: The vehicles that were taken over, and how.
    """

    resting: Resting
    broken: bool = field(default=False)
    began: float | None = None
    taken: Mapping[str, str] = field(default_factory=dict)

    def goes_on(self, broken: Sequence[Finding], taken: Mapping[str, str]) -> None:
        """Say what broke in the run that this one goes on from, and who is taken over."""
        self.broken, self.taken = any(map(_breaks, broken)), taken
        told = tuple(dict.fromkeys((finding.kind, finding.message, finding.fallback) for finding in broken))
        for kind, message, fallback in told[:MOST_BREACHES]:
            back = f"; {DONE[fallback]}, as the mission says" if fallback in DONE else ""
            tell(f"{message}{back}", f"{kind}, before it was resumed:")
        if len(told) > MOST_BREACHES:
            tell(f"  and {len(told) - MOST_BREACHES:,} more")
        if told:
            tell("  it goes on where the world is as the mission says again, or by --unverified")
        for vehicle, how in sorted(taken.items()):
            tell(
                f"{vehicle}: {how}; nobody here commands it until `bigactors give-back {vehicle}`",
                "taken over:",
            )

    def arrived(self, heard: Heard, now: float) -> None:
        """Print nothing: positions are too frequent."""

    def reported(self, report: Report, now: float) -> None:
        """Print nothing: important reports become findings."""

    def turned(self, turn: Turn, now: float) -> None:
        """Print the result of a turn."""
        self.began = now if self.began is None else self.began
        self.taken = turn.state.taken
        for step in turn.steps:
            label = step.transition.label
            at = f"{step.time - self.began:8.1f} s "
            lines = [f"{at} {label}"] if label.rule in TOLD else []
            with _flying_on():
                say_text(
                    "".join(
                        f"{line}\n"
                        for line in (
                            *lines,
                            *(f"{at} {label.agent}: {text}" for text in step.transition.shown),
                        )
                    )
                )
        for finding in turn.findings:
            self.broken |= _breaks(finding)
            with _flying_on():
                self._tell(finding)
        with _flying_on():
            say_text("", flush=True)

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
    """Tell whether the run is not as it was verified: a late request alone is foreseen."""
    return finding.kind == "broken assumption" or (finding.kind == "failed" and bool(finding.fallback))


@contextmanager
def _flying_on() -> Iterator[None]:
    """Report an output that can't be written; this does not end the flight."""
    try:
        yield
    except Mistake as mistake:
        with suppress(Mistake):
            tell(str(mistake))


@dataclass(frozen=True, slots=True)
class Tape:
    """Writes everything into a recording."""

    recorder: Recorder
    resting: Resting

    def arrived(self, heard: Heard, now: float) -> None:
        """Record an arrival."""
        self.recorder.arrival(heard, now)

    def reported(self, report: Report, now: float) -> None:
        """Record a report."""
        self.recorder.report(report, now)

    def turned(self, turn: Turn, now: float) -> None:
        """Record a turn: its commands are on file before they are sent."""
        self.recorder.turn(turn, now, self.resting)


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
        """End the log."""
        if self._file is not None:
            self._file.close()
