"""Recordings of live runs as missions with traces, for replay and resumption."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from contextlib import suppress
from dataclasses import dataclass, field
from pathlib import Path

from adapters.live.command_planning import stopping
from adapters.live.flown_ways import FlownWay
from adapters.live.operator_findings import Finding, is_breach
from adapters.live.overrides import StandingOrder
from adapters.live.timing_monitor import Timers, begun, stepped
from adapters.live.turn_result import Outgoing
from adapters.recording.mcap_files import Message, RecordingError
from adapters.recording.recording_reader import Recording, read_recording
from bigactors.mission_lookup import digest_of, from_text
from bigactors.mistakes import Mistake, unreadable
from checker import ReplayError, Trace, replay
from checker.traces import SCHEMA
from physical import PhysicalError
from semantics.live_policy import Fallback
from semantics.state.configuration import Configuration, Transition
from semantics.state.observation_serialization import geometry_of
from semantics.state.setting import Control, Scheduler
from semantics.state.station_partition import Parting, Passage, parcel_of, parted
from specs.elaboration import ElaboratedMission, Variation


def open_recording(path: str) -> Recording:
    """Return the content of a recording; raises Mistake."""
    try:
        return read_recording(Path(path))
    except RecordingError as error:
        raise Mistake(str(error), place=path) from error
    except OSError as error:
        raise unreadable(path, error) from error


def mission_of(recording: Recording) -> ElaboratedMission:
    """Return the mission of a recorded run. Its text is in the recording; the files that it names are read again."""
    return from_text(recording.run, Variation(Scheduler.FCFS, Control.TIMED))


def trace_of(recording: Recording, mission: ElaboratedMission) -> Trace:
    """Return the steps of a recording, replayed through the rules; raises ReplayError, Mistake."""
    parting = parting_of(recording)
    first = mission.initial if parting is None else parted(mission.initial, parting)
    try:
        return replay(first, recording.trace(SCHEMA))
    except ValueError as error:
        raise Mistake(str(error)) from error


def parting_of(recording: Recording) -> Parting | None:
    """Return the part of the mission that a recording covers, None for the whole; raises Mistake."""
    match recording.run.get("station"):
        case None:
            return None
        case {"here": str(here), "hosts": dict(hosts), "sent": dict(sent), "took": dict(took)}:
            words = [here, *hosts, *hosts.values(), *sent, *took]
            counts = [*sent.values(), *took.values()]
            if all(isinstance(word, str) for word in words) and all(type(count) is int for count in counts):
                return Parting(here, hosts, sent, took)
    raise Mistake("its run does not name its station")


@dataclass(frozen=True, slots=True)
class Resumed:
    """A run that another one resumes.

    Attributes:
        configuration: Its last configuration.
        steps: The number of its steps.
        orders: The number of its commands to vehicles.
        messages: The messages to record again: steps, take-overs, returns of control, operators' orders, and breaches.
        broken: Its breaches of assumptions, with their fallbacks.
        taken: The reason for each vehicle that is still taken over.
        station: The part of the mission that it flew, None for the whole.
        left: The parcels sent to other stations, in order.
        standing_orders: The operator's standing order for each vehicle that one took over.
        timers: The start times of all timed activities; None if the recording has no start time.
        until: The time of its last message.
        ways: The last way of each vehicle that its mission commanded.
    """

    configuration: Configuration
    steps: int
    orders: int
    messages: tuple[Message, ...]
    broken: tuple[Finding, ...]
    taken: Mapping[str, str]
    station: Parting | None = None
    left: tuple[Outgoing, ...] = ()
    standing_orders: Mapping[str, StandingOrder] = field(default_factory=dict)
    timers: Timers | None = None
    until: float = 0.0
    ways: Mapping[str, FlownWay] = field(default_factory=dict)


def resume(path: str, mission: ElaboratedMission) -> Resumed:
    """Return the last state of a recorded run; raises Mistake for one of another mission."""
    recording = open_recording(path)
    if recording.run["digest"] != digest_of(mission):
        raise Mistake(
            "it records another mission, or another version flew it",
            "resume it with the mission and the version that it records",
            path,
        )
    try:
        trace = trace_of(recording, mission)
    except ReplayError as error:
        raise Mistake(f"it cannot be resumed: {error}", place=path) from error
    kept = tuple(message for message in recording.messages if message.topic == "steps" or _goes_on(message))
    found = (_finding(message) for message in kept if message.topic == "findings")
    taken = _still_taken(message for message in kept if message.topic in ("reports", "given_back", "orders"))
    return Resumed(
        trace.configurations[-1],
        len(trace),
        len(recording.of("commands")),
        kept,
        tuple(found),
        {name: each if isinstance(each, str) else each.reason for name, each in taken.items()},
        parting_of(recording),
        tuple(_left(trace)),
        {name: each for name, each in taken.items() if isinstance(each, StandingOrder)},
        None if mission.setting.timing is None else _timers(trace, kept),
        recording.until,
        ways_of(recording.of("ways")),
    )


def ways_of(messages: Iterable[Message]) -> dict[str, FlownWay]:
    """Return the last way of each vehicle, of those that have one."""
    ways: dict[str, FlownWay] = {}
    for message in messages:
        match message.data:
            case {
                "vehicle": str(vehicle),
                "way": {"to": str(to), "points": [*points], "passed": int(passed)},
            }:
                with suppress(ValueError, PhysicalError):
                    found = tuple(geometry_of({"ring": [each]}) for each in points)
                    ways[vehicle] = FlownWay(found, to, max(1, min(passed, len(found))))
            case {"vehicle": str(vehicle)}:
                ways.pop(vehicle, None)
    return {vehicle: way for vehicle, way in ways.items() if way.points}


def _timers(trace: Trace, messages: Iterable[Message]) -> Timers | None:
    """Return the start times of all timed activities at the end of a recorded run."""
    timers, c, steps = None, trace.initial, iter(trace.steps)
    for message in messages:
        match message.topic, message.data:
            case "clocks", {"began": int() | float() as began, "rested": int() | float() as rested}:
                timers = (timers or begun(c, began)).counted(began, rested, message.time)
            case "steps", said:
                step, date = next(steps), said.get("date", message.time)
                c = step.target
                if timers is not None:
                    timed = date if isinstance(date, int | float) else message.time
                    timers = stepped(timers, Transition(step.label, c), timed)
    return timers


def _goes_on(message: Message) -> bool:
    """Return whether a message other than a step still matters in a resumed run."""
    said = message.data
    match message.topic:
        case "clocks":
            return True
        case "reports":  # a vehicle was taken over
            return bool(said.get("report") == "TakenOver")
        case "given_back":
            return not (said.get("refusal") or said.get("at"))
        case "orders":
            return not said.get("refusal")
        case "findings":
            return is_breach(_finding(message))
    return False


def _finding(message: Message) -> Finding:
    """Return the finding that a message records."""
    kind, about, told, fallback = (
        str(message.data.get(key) or "") for key in ("kind", "about", "message", "fallback")
    )
    return Finding(kind, about, told, message.time, fallback)


def _still_taken(messages: Iterable[Message]) -> dict[str, str | StandingOrder]:
    """Return the vehicles that are still taken over, each with the reason or the operator's order."""
    taken: dict[str, str | StandingOrder] = {}
    for message in messages:
        if message.topic == "reports":
            taken[str(message.data.get("entity"))] = str(message.data.get("reason"))
        elif message.topic == "orders":
            taken |= _ordered(message)
        else:
            taken.pop(str(message.data.get("vehicle")), None)
    return taken


def _ordered(message: Message) -> dict[str, StandingOrder]:
    """Return the standing order for each vehicle that an operator's order addressed."""
    match message.data:
        case {"order": "hold" | "return" as order, "requests": dict(requests), **more}:
            by, fallback = str(more.get("by") or ""), Fallback(order)
            told = {str(name): str(request) for name, request in requests.items()}
            return {
                name: StandingOrder(stopping(fallback, request, name), by) for name, request in told.items()
            }
    return {}


def _left(trace: Trace) -> Iterator[Outgoing]:
    """Yield the parcels that left for other stations, with the agent's state before the step."""
    for step, before in zip(trace.steps, trace.configurations, strict=False):
        if isinstance(step.sight, Passage) and step.sight.parcel is None:
            parcel = parcel_of(before, step.sight.agent)
            assert parcel is not None
            yield Outgoing(step.sight.station, step.sight.number, parcel)
