"""A flight of a verified mission: its preparation, its recording and its course."""

from __future__ import annotations

import asyncio
import sys
import time
from argparse import Namespace
from collections.abc import Callable, Iterator, Sequence
from contextlib import AsyncExitStack, ExitStack, closing, contextmanager
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Any

from adapters.live.commanded import Commanded
from adapters.live.core import resumed, started
from adapters.live.due_times import DueTimes
from adapters.live.live_state import LiveState
from adapters.live.loop import Ending, LiveRun, NotAsAssumed, NotHeard, PluginFailed, settle
from adapters.live.operator_findings import Finding, Reported
from adapters.live.operator_socket import listening
from adapters.live.overrides import Overrides
from adapters.live.plan import Plan
from adapters.live.run_watchers import Watcher
from adapters.plugin import Plugin
from adapters.recording.mcap_files import RecordingError
from adapters.recording.writing import Recorder
from adapters.ros import RosSending
from adapters.simulated import run as run_simulated
from bigactors import __version__
from bigactors.commands.run.connections import fences_of, plugins_of
from bigactors.commands.run.console_beside import console_beside, recorded
from bigactors.commands.run.preflight_checks import check_flyable, watchable
from bigactors.commands.run.starting import Start, StartChecks, check_start, stand_by
from bigactors.commands.run.station_flight import Company, company_of, parting_json
from bigactors.exits import Exit
from bigactors.files import check_writable
from bigactors.flight_watchers import Log, Tape, Terminal
from bigactors.mission_lookup import checkable, digest_of, fixed_places, locate, open_mission, text_json
from bigactors.mistakes import Mistake, unreadable
from bigactors.recordings import Resumed, resume
from bigactors.signatures import load_trusted
from bigactors.sockets import socket_of
from bigactors.terminal import flying_output, paint, say, tell
from bigactors.vehicle_lines import situation, standing
from bigactors.verdict_files import Licence, find_verdict, licence_for
from physical import PhysicalError
from physical.wordings import counted
from semantics.state.setting import Control, Scheduler
from specs.elaboration import ElaboratedMission, Variation


@dataclass(frozen=True, slots=True)
class Flight:
    """A prepared run.

    Attributes:
        options: The command line's options.
        mission: The mission under fcfs and timed control.
        licence: The verdict that permits it, None with `--unverified`.
        plan: The constants of the run.
        state: The first state.
        plugins: Its vehicles and feeds.
        resumed: The run that it resumes, if any.
        log: The telemetry log, if any.
        company: Its station among several, None for the only one.
        rate: Its seconds in a real second; None for as many as can be computed.
        start: Its start, by itself or by an operator.
    """

    options: Namespace
    mission: ElaboratedMission
    licence: Licence | None
    plan: Plan
    state: LiveState
    plugins: tuple[Plugin, ...]
    resumed: Resumed | None
    log: Log | None = None
    company: Company | None = None
    rate: float | None = 1.0
    start: Start = field(default_factory=Start)

    def resting(self, finding: Finding) -> tuple[str, ...]:
        """Return the properties whose verdicts depend on a broken assumption: all that were decided by exploration."""
        broken = finding.kind == "broken assumption" and self.licence is not None
        return self.licence.resting if broken and self.licence is not None else ()


def run_mission(options: Namespace) -> Exit:
    """Fly a mission that has a verdict that everything holds, or with `--unverified`."""
    with flying_output():
        return _run(prepare(options), options)


def _run(flight: Flight, options: Namespace) -> Exit:
    terminal = Terminal(flight.resting, tuple(flight.plan.vehicles))
    if flight.resumed is not None:
        terminal.goes_on(flight.resumed.broken, flight.resumed.taken)
        if flight.mission.setting.timing is not None and flight.resumed.timers is None:
            tell("the recording lacks the start of the mission: all clocks begin anew")
        if flight.mission.setting.strays and not flight.resumed.ways:
            tell(
                "the recording lacks the ways of vehicles: how far they stray is watched from their next flights on"
            )
    try:
        with record(flight) as tape, _published(options.publish) as ros:
            lookers = (
                terminal,
                tape,
                flight.company and flight.company.sharing,
                ros,
            )  # record first, then print
            try:
                preflight = None if tape is None else tape.preflight
                flown = fly(flight, tuple(looker for looker in lookers if looker), preflight)
                ending = asyncio.run(flown) if flight.rate == 1.0 else run_simulated(flown, flight.rate)
                if tape is not None:
                    tape.reason = ending.reason
            finally:
                terminal.ends()
    except (NotAsAssumed, NotHeard, PluginFailed) as error:
        return _not_begun(error)
    except KeyboardInterrupt:
        tell(f"interrupted: vehicles go on with their last command{standing(terminal.state or flight.state)}")
        return Exit.INCOMPLETE
    return conclude(ending, broken=terminal.broken, property_broken=terminal.property_broken)


def conclude(ending: Ending, *, broken: bool, property_broken: bool = False) -> Exit:
    """Print the end of a run, and return its exit code."""
    what = [*(["an assumption"] if broken else []), *(["a property"] if property_broken else [])]
    breach = f"; {' and '.join(what)} {'were' if len(what) > 1 else 'was'} broken" if what else ""
    say(f"{ending.reason} after {counted(ending.state.number, 'step')}{breach}{standing(ending.state)}")
    if what:
        return Exit.VIOLATED
    overrides = ending.state.overrides
    done = ending.reason == "the mission has ended" and not (overrides.taken or overrides.owing)
    return Exit.HOLDS if done else Exit.INCOMPLETE


def prepare(options: Namespace) -> Flight:
    """Read everything, and refuse a run that cannot be flown; raises Mistake."""
    sources = {name: Path(file) for name, file in options.source}
    live = Variation(Scheduler.FCFS, Control.TIMED, sources)
    mission = checkable(open_mission(options.file, live))
    licence = _licence(options, mission)
    log = None if options.record is None else Log(_log_beside(options.record))
    plugins, owners = plugins_of(options, mission, log)
    check_flyable(mission)
    strict = licence is not None and licence.scheduler is Scheduler.FCFS
    plan = Plan(mission.initial, owners, mission.precautions, strict, fixed=mission.fixed)
    before = None if options.resume is None else resume(options.resume, mission)
    company = company_of(options, mission, before)
    if company is not None:
        plan, plugins = company.plan(plan, mission), company.plugins(plugins)
    plan = replace(plan, invariants=watchable(mission, plan.first))
    state = started(plan)
    if before is not None:
        known = LiveState(
            before.configuration,
            before.steps,
            commanded=Commanded.resumed(before.orders, before.ways),
            overrides=Overrides(before.taken, before.standing_orders),
            due=DueTimes(timers=before.timers, stopped=before.until),
            reported=Reported(count=len(before.broken)),
        )
        state = resumed(plan, known, time.time())
    start = Start(waits=options.console is not None and not options.at_once)
    rate: float = options.speed
    return Flight(options, mission, licence, plan, state, plugins, before, log, company, rate, start)


def _licence(options: Namespace, mission: ElaboratedMission) -> Licence | None:
    name = options.file
    path = find_verdict(str(locate(name)), options.verdict)
    if options.unverified:
        if options.trust is not None:
            raise Mistake(
                "--unverified asks for no verdict, --trust for a signed one", "leave one of the two out"
            )
        warning = "nothing was verified of this run: --unverified"
        tell(paint(warning, "red", sys.stderr), "!")
        return None
    if path is None:
        hint = f"bigactors check --control timed --verdict {Path(name).stem}.verdict.json {name}, or --unverified"
        raise Mistake("there is no verdict that this mission holds", hint, name)
    return licence_for(name, path, mission, None if options.trust is None else load_trusted(options.trust))


def _log_beside(recording: str) -> Path:
    """Return the path of the telemetry log beside a recording; raises Mistake if either cannot be written."""
    try:
        check_writable(recording)
    except ValueError as error:  # the path has a zero byte
        raise Mistake("this is no path of a file", place=repr(recording)) from error
    path = Path(recording).with_suffix(".tlog")
    if path == Path(recording):
        raise Mistake("the telemetry log is called so", "give the recording the suffix .mcap", recording)
    if path.is_symlink():
        raise Mistake("this is a symbolic link", "remove it, or record under another name", str(path))
    check_writable(str(path))
    return path


@contextmanager
def record(flight: Flight) -> Iterator[Tape | None]:
    """Record the body and its end if a recording or a console is requested; a console reads a recording."""
    options = flight.options
    with recorded(options) as path, ExitStack() as stack:
        if flight.log is not None:
            stack.callback(flight.log.close)
        tape = None if path is None else _tape(flight, path)
        if path is not None:
            stack.callback(_forget, flight.start, path)
        stack.enter_context(console_beside(options, path, socket_of(flight.mission.name, options.socket)))
        if tape is not None:
            stack.enter_context(_ending(tape))
        yield tape


def _forget(start: Start, path: Path) -> None:
    """Remove the recording of a run that did not begin, so that the next run can use its name."""
    if not start.begun:
        path.unlink(missing_ok=True)


@contextmanager
def _published(address: str | None) -> Iterator[RosSending | None]:
    """Publish the run for ROS, if requested."""
    if address is None:
        yield None
        return
    try:
        sending = RosSending(address)
    except PhysicalError as problem:
        raise Mistake(problem.message, problem.hint or "", f"--publish ros={address:.100}") from problem
    with closing(sending):
        yield sending


@contextmanager
def _ending(tape: Tape) -> Iterator[None]:
    """Record the end of the run."""
    try:
        yield
    except KeyboardInterrupt:
        tape.reason = "interrupted"
        raise
    except BaseException as error:
        tape.reason = str(error) or type(error).__name__
        raise
    finally:
        try:
            tape.recorder.close(tape.reason, time.time())
        except OSError as error:
            tell(f"the recording has no end: {error.strerror}", f"{error.filename}:")


def _tape(flight: Flight, path: Path) -> Tape:
    try:
        kinds, fixed = flight.mission.setting.kinds, fixed_places(flight.mission)
        recorder = Recorder(path, run_json(flight), time.time(), kinds, fixed)
    except RecordingError as error:
        raise Mistake(str(error), place=str(path)) from error
    except FileExistsError as error:
        hint = "name another with --record, or remove it; --resume goes on from a recording"
        raise Mistake("there is a file already", hint, str(path)) from error
    except OSError as error:
        raise unreadable(str(path), error) from error
    if flight.resumed is not None:
        recorder.copy(flight.resumed.messages)
    return Tape(recorder, flight.resting)


def run_json(flight: Flight) -> dict[str, Any]:
    """Return the flown mission, its verdict and its settings as plain data."""
    options, mission = flight.options, flight.mission
    return {
        "mission": options.file,
        **text_json(mission, options.file, {name: Path(file) for name, file in options.source}),
        "digest": digest_of(mission),
        "version": __version__,
        "verified": flight.licence is not None,
        "verdict": None if flight.licence is None else flight.licence.data,
        "strict": flight.plan.strict,
        "vehicles": dict(flight.plan.vehicles),
        "fences": fences_of(flight.plugins),
        "limits": [
            {
                "request": limit.request,
                "agent": limit.agent,
                "seconds": limit.seconds,
                "fallback": limit.fallback.value,
            }
            for limit in mission.precautions.limits
        ],
        "resumes": options.resume,
        "rate": flight.rate,
        "station": None if flight.company is None else parting_json(flight.company.parting),
    }


async def fly(
    flight: Flight,
    watchers: Sequence[Watcher],
    tell_preflight: Callable[[dict[str, Any], float], None] | None = None,
) -> Ending:
    """Start the run and fly it to its end; raises the errors of `LiveRun`."""
    options = flight.options
    async with AsyncExitStack() as stack:
        live = await stack.enter_async_context(LiveRun(flight.plan, flight.state, flight.plugins, watchers))

        def describe() -> str:
            return situation(flight.plan, live.state, live.inbox.statuses, live.clock())

        path = socket_of(flight.mission.name, options.socket)
        try:
            await stack.enter_async_context(
                listening(
                    path, live.inbox.say, describe, lambda: live.state.overrides.fates, flight.start.press
                )
            )
        except OSError as error:
            raise Mistake(error.strerror or str(error), "give another with --socket", str(path)) from error
        takes_over = options.take_over or flight.resumed is not None
        verdict = None if flight.licence is None else len(flight.licence.data.get("properties", ()))
        before = StartChecks(flight.mission, flight.plugins, verdict, options.wait, takes_over)
        if flight.start.waits:
            say("the run waits: press Start in the console when its list is done")
            sys.stdout.flush()
            await stand_by(live, flight.start, before, tell_preflight)
        else:
            await live.begin(options.wait, forced=options.unverified)
            await check_start(live, before)
        flight.start.begun = True
        if flight.company is not None:
            flight.company.sharing.begun = True
        settle()
        say(f"{flight.mission.name} begins; bigactors status, say, hold and return reach it at {path}")
        return await live.go(seconds=options.duration)


def _not_begun(error: Exception) -> Exit:
    if isinstance(error, NotAsAssumed):
        for finding in error.findings:
            tell(finding.message, "assumption broken:")
        tell("the run has not begun: put the world or the mission right, or give --unverified")
        return Exit.VIOLATED
    silent = isinstance(error, NotHeard) and not error.heard
    hint = "is the address right, and the vehicle switched on?" if silent else ""
    raise Mistake(str(error), hint) from error
