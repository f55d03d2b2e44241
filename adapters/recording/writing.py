"""Write the recording of a run in progress."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Callable, Collection, Iterable, Mapping
from pathlib import Path
from typing import Any, Final

from adapters.live.batch import Heard
from adapters.live.operator_findings import Finding
from adapters.live.turn_result import Turn
from adapters.live.watched import WatchedInvariant
from adapters.plugin import Report, Seen, entity_of
from adapters.rate_limit import Ration, Turns
from adapters.recording.encoding import (
    answer_json,
    arrival_json,
    clocks_json,
    command_json,
    finding_json,
    flights_json,
    invariant_json,
    report_json,
    seen_json,
    step_json,
    ways_json,
)
from adapters.recording.foxglove import FoxgloveMessage, Showing, simplified
from adapters.recording.mcap_files import McapWriter, Message
from adapters.recording.schemas import RUN, SCHEMAS
from physical import PhysicalProperty
from semantics.state.signature import Name

MOST_ARRIVALS: Final = 100
"""The most arrivals written in a second, for each entity of the mission, and for all others of one plugin."""

FIGURES_EVERY: Final = 1.0
"""Seconds between two figures of an invariant about ways that stays true, or false."""

AT_MOST: Final = 0.1
"""Seconds for which new messages may stay hidden from readers of the growing file."""


class Recorder:
    """Writes the input of a run and its consequences; a turn's commands are on file before they are sent.

    In a flood a bounded number of arrivals is written, and the number of the others; all steps are written, with their
    observations. Beside its messages it writes those for other programs (`foxglove`).
    """

    def __init__(
        self,
        path: Path,
        run: dict[str, Any],
        now: float,
        names: Collection[str] = (),
        fixed: Iterable[PhysicalProperty] = (),
    ) -> None:
        """Begin a recording; `names` are the entities of the mission, `fixed` its static places."""
        self._names = names
        self._showing = Showing(names)
        self._newest = now
        self._ration: Ration[tuple[str, str]] = Ration(MOST_ARRIVALS)
        self._turns: defaultdict[str, Turns[str]] = defaultdict(lambda: Turns(MOST_ARRIVALS))
        self._clocks: dict[str, float] = {}
        self._standing: dict[str, Mapping[Name, Any]] = {"deadlines": {}, "flights": {}, "ways": {}}
        self._invariants: dict[str, tuple[WatchedInvariant, float]] = {}
        self._file = McapWriter(path, {topic: simplified(schema) for topic, schema in SCHEMAS.items()})
        self._put("run", now, {"schema": RUN["properties"]["schema"]["const"], **run})
        self._show(now, self._showing.places(fixed, run.get("fences", {})))
        self._flush(now)

    def arrival(self, heard: Heard, now: float) -> None:
        """Write a plugin's publication, within the limit."""
        if self._takes(heard.plugin, entity_of(heard.published), now):
            self._write("arrivals", now, arrival_json(heard))

    def _takes(self, plugin: str, entity: str, now: float) -> bool:
        """Return whether an arrival is written; entities that the mission does not name take turns."""
        if entity in self._names:
            return self._ration.takes((plugin, entity), now)
        if self._turns[plugin].takes(entity, now):
            return True
        self._ration.leave_out((plugin, ""))
        return False

    def report(self, report: Report, now: float) -> None:
        """Write a plugin's report."""
        topic, data = seen_json(report) if isinstance(report, Seen) else ("reports", report_json(report))
        self._write(topic, now, data)

    def turn(self, turn: Turn, now: float, verdicts: Callable[[Finding], tuple[str, ...]]) -> None:
        """Write the results of a turn, and flush if there are any."""
        self._account(now, self._ration.left_out(now))
        clocks = clocks_json(turn.state.due.timers)
        if clocks != self._clocks:
            self._clocks = clocks
            self._put("clocks", now, clocks)
        for step in turn.steps:
            self._put("steps", step.time, step_json(step))
        self._stands("deadlines", "agent", "until", turn.state.due.timeouts, now)
        self._stands("flights", "vehicle", "takes", flights_json(turn.state.due.timers), now)
        self._stands("ways", "vehicle", "way", ways_json(turn.state), now)
        self._watched(turn.state.watched.standings, now)
        for command in turn.commands:
            self._put("commands", now, command_json(command))
        for finding in turn.findings:
            self._put("findings", now, finding_json(finding, verdicts(finding)))
        for answer in turn.answers:
            if (written := answer_json(answer)) is not None:
                self._put(written[0], now, written[1])
        if turn.steps or turn.commands or turn.findings or turn.answers or now - self._flushed >= AT_MOST:
            self._flush(now)

    def preflight(self, said: dict[str, Any], now: float) -> None:
        """Write the state of the checks before the start."""
        self._put("preflight", now, said)
        self._flush(now)

    def _stands(self, topic: str, of: str, what: str, standing: Mapping[Name, Any], now: float) -> None:
        """Write the value of each name that has changed; null for one that has ended."""
        before, self._standing[topic] = self._standing[topic], standing
        for name in sorted(standing.keys() | before.keys()):
            if (value := standing.get(name)) != before.get(name):
                self._put(topic, now, {of: name, what: value})

    def _watched(self, invariants: Iterable[WatchedInvariant], now: float) -> None:
        """Write the invariants about ways: at once when one becomes true or false, its new figure once a second."""
        for each in invariants:
            known = self._invariants.get(each.property)
            if known is None or (
                each != known[0] and (each.holds != known[0].holds or now - known[1] >= FIGURES_EVERY)
            ):
                self._invariants[each.property] = (each, now)
                self._put("invariants", now, invariant_json(each))

    def copy(self, messages: Iterable[Message]) -> None:
        """Write the messages of another recording, so that this one needs no other."""
        for message in messages:
            self._put(message.topic, message.time, message.data)
            match message:
                case Message("clocks", _, clocks):
                    self._clocks = clocks
                case Message("deadlines", _, {"agent": str(agent), "until": until}):
                    self._standing["deadlines"] = {**self._standing["deadlines"], agent: until}
        self._file.flush()

    def _write(self, topic: str, now: float, data: Any) -> None:
        """Write an input, and flush if that was not done for a while: others may read the growing file."""
        self._put(topic, now, data)
        if now - self._flushed >= AT_MOST:
            self._flush(now)

    def _put(self, topic: str, time: float, data: dict[str, Any]) -> None:
        """Write a message, and beside it the messages for other programs."""
        self._newest = max(self._newest, time)
        self._file.write(topic, time, data)
        self._show(time, self._showing.of(topic, time, data))

    def _show(self, time: float, shown: Iterable[FoxgloveMessage]) -> None:
        for topic, schema, data in shown:
            self._file.declare(topic, schema)
            self._file.write(topic, time, data)

    def _flush(self, now: float) -> None:
        self._file.flush()
        self._flushed = now

    def close(self, reason: str, now: float) -> None:
        """End the recording, at a time after all of its messages, by any clock."""
        self._account(now, self._ration.left_out())
        self._put("end", max(now, self._newest), {"reason": reason})
        self._file.close()

    def _account(self, now: float, left_out: Iterable[tuple[tuple[str, str], int]]) -> None:
        for (plugin, entity), count in left_out:
            self._put("left_out", now, {"plugin": plugin, "entity": entity, "arrivals": count})
