"""The live loop: plugins publish into it, `advance` moves the configuration, commands go out; it never blocks.

Input is checked at the entry (`validation`); after that no input ends a run. If the recording or a plugin fails, the
mission's response to a broken assumption follows.

Between two turns only the newest position of each entity is kept, but all reports and messages.
"""

from __future__ import annotations

import asyncio
import gc
import math
import time
from collections import OrderedDict
from collections.abc import Callable, Container, Mapping, Sequence
from dataclasses import dataclass, field, replace

from adapters.live.batch import Batch, Heard, Said, Saying, flaw_of, legible_report
from adapters.live.core import advance, is_over, is_refused, watch
from adapters.live.live_state import LiveState
from adapters.live.operator_findings import Finding
from adapters.live.plan import Plan
from adapters.live.run_watchers import Watcher, Watchers
from adapters.live.turn_result import Answer, Turn
from adapters.plugin import (
    Command,
    Failed,
    Follow,
    GoTo,
    HandOver,
    Hold,
    Plugin,
    Published,
    Refused,
    Rejected,
    Report,
    Return,
    Seen,
    Sent,
    Status,
    entity_of,
)
from adapters.rate_limit import Troubles
from adapters.silence_clock import Listening
from physical import is_text

GATHER = 0.002
"""Seconds of gathering arrivals before the next turn."""

SLICE = 2
"""Steps taken before the loop reads new input."""

IDLE = 0.5
"""Seconds until a turn without input: outdated positions leave P."""

AHEAD = 1.0
"""Seconds by which the system's clock may be ahead of the loop's: less is an ordinary clock adjustment."""

AT_ONCE = 200
"""Positions of entities that the mission does not name (strangers) in one turn."""

MOST_WAITING = 20_000
"""Waiting positions of strangers; beyond it the oldest are dropped, and that is reported."""

MOST_SAYINGS = 1_000
"""Waiting messages of operators; more are refused, with an answer to their senders."""


@dataclass(frozen=True, slots=True)
class Ending:
    """The end of a run: a reason in words, and the last state."""

    reason: str
    state: LiveState


class NotAsAssumed(Exception):
    """The world does not satisfy the mission's environment section at the start of the run.

    Attributes:
        findings: The differences.
    """

    def __init__(self, findings: Sequence[Finding]) -> None:
        super().__init__("; ".join(finding.message for finding in findings))
        self.findings = tuple(findings)


class NotHeard(Exception):
    """Vehicles of the mission were not heard before the start of the run, or have no position.

    Attributes:
        vehicles: Their names.
        heard: Whether all of them were heard at all.
    """

    def __init__(self, vehicles: Sequence[str], statuses: Mapping[str, Status] | None = None) -> None:
        lacking = {name: statuses[name].lacks for name in vehicles if name in statuses} if statuses else {}
        silent = [name for name in vehicles if name not in lacking]
        words = [f"nothing was heard of {', '.join(silent)}"] if silent else []
        words += [
            f"{name} is heard, and {why or 'has not reported its type yet'}" for name, why in lacking.items()
        ]
        super().__init__("; ".join(words))
        self.vehicles = tuple(vehicles)
        self.heard = not silent


class PluginFailed(Exception):
    """A plugin or the recording failed before the run began; the message has its name and the reason."""


@dataclass(slots=True)
class Inbox:
    """Input that waits for the next turn, newest positions only.

    Attributes:
        named: The entities of the mission; a turn takes all of their positions, and a slice of the strangers'.
        statuses: Each vehicle's last status.
    """

    watchers: Watchers
    now: Callable[[], float]
    named: Container[str] = ()
    statuses: dict[str, Status] = field(default_factory=dict)
    awake: asyncio.Event = field(default_factory=asyncio.Event)
    heard: dict[tuple[str, str], Heard] = field(default_factory=dict)
    strangers: OrderedDict[tuple[str, str], Heard] = field(default_factory=OrderedDict)
    troubles: Troubles = field(default_factory=lambda: Troubles("feeds"))
    reports: list[Report] = field(default_factory=list)
    sayings: list[tuple[Said, asyncio.Future[Answer]]] = field(default_factory=list)

    def publish(self, plugin: str, published: Published) -> None:
        """Take a plugin's publication; it replaces earlier ones on the same entity."""
        flaw = flaw_of(published)
        if flaw:
            self.troubles.note("unusable property", f"'{plugin}': {flaw}")
            return
        heard = Heard(plugin, published)
        self.watchers.arrived(heard, self.now())
        entity = entity_of(published)
        waiting = self.heard if entity in self.named else self.strangers
        waiting.pop((plugin, entity), None)  # in order: of two with the same time the later counts
        waiting[plugin, entity] = heard
        self.awake.set()
        if len(self.strangers) > MOST_WAITING:
            self.strangers.popitem(last=False)
            self.troubles.note("too much at once", "positions of entities that the mission does not name")

    def report(self, report: Report) -> None:
        """Take a plugin's report, with texts that can be printed and recorded."""
        report = legible_report(report)
        self.watchers.reported(report, self.now())
        if isinstance(report, Status):
            self.statuses[report.entity] = report
        if isinstance(report, Seen):
            return  # it causes no turn
        self.reports.append(report)
        self.awake.set()

    def say(self, said: Said) -> asyncio.Future[Answer]:
        """Take an operator's message; the answer comes with the next turn."""
        said = replace(said, number=len(self.sayings))
        answer: asyncio.Future[Answer] = asyncio.get_running_loop().create_future()
        if not all(map(is_text, said.texts)):
            answer.set_result(Answer(said, "this is no text in valid Unicode"))
        elif len(self.sayings) >= MOST_SAYINGS:
            answer.set_result(Answer(said, "too many messages at once; send it again"))
        else:
            self.sayings.append((said, answer))
            self.awake.set()
        return answer

    def take(self, missed: float = 0.0) -> tuple[Batch, list[asyncio.Future[Answer]]]:
        """Remove and return the waiting input; of the strangers only the oldest slice.

        `missed` are the seconds in which this process did not listen.
        """
        self.troubles.report(Ear("", self))
        said = tuple(saying for saying, _ in self.sayings)
        some = [self.strangers.popitem(last=False)[1] for _ in range(min(AT_ONCE, len(self.strangers)))]
        batch = Batch((*self.heard.values(), *some), tuple(self.reports), said, missed)
        answers = [answer for _, answer in self.sayings]
        self.heard, self.reports, self.sayings = {}, [], []
        if not self.strangers:
            self.awake.clear()
        return batch, answers


@dataclass(frozen=True, slots=True)
class Ear:
    """The `World` of one plugin."""

    plugin: str
    inbox: Inbox

    def publish(self, published: Published) -> None:
        """Take a publication on an entity."""
        self.inbox.publish(self.plugin, published)

    def now(self) -> float:
        """Return the time."""
        return self.inbox.now()

    def report(self, report: Report) -> None:
        """Take a report."""
        self.inbox.report(report)


class Clock:
    """A monotonic time in seconds since 1970 UTC: the event loop's clock, started at the system's.

    The loop's clock may stop while the machine is suspended; if the system's is ahead, this clock follows it.
    """

    def __init__(self) -> None:
        loop = asyncio.get_running_loop().time()
        self._offset = time.time() - loop
        self._follows = abs(time.monotonic() - loop) < AHEAD  # not in loops with a simulated clock

    def __call__(self) -> float:
        """Return the time."""
        now = self._offset + asyncio.get_running_loop().time()
        ahead = time.time() - now if self._follows else 0.0
        if ahead > AHEAD:
            self._offset += ahead
            return now + ahead
        return now


def settle() -> None:
    """Collect garbage once, and exempt all present objects from later collections, whose pauses would stop the run.

    Call it once in the process of one run, just before the start: present objects are never freed later. New objects
    are scanned less often, since reference counting frees nearly all of them.
    """
    gc.collect()
    gc.freeze()
    gc.set_threshold(10_000, 20, 50)


def _without_fallbacks(turn: Turn) -> Turn:
    """Return a turn before an unverified run, which begins in spite of its findings: nothing holds or returns."""
    return replace(turn, findings=tuple(replace(each, fallback="") for each in turn.findings))


class LiveRun:
    """One run of a mission with plugins: `begin` waits for the world, `go` flies."""

    def __init__(
        self, plan: Plan, state: LiveState, plugins: Sequence[Plugin], watchers: Sequence[Watcher] = ()
    ) -> None:
        self.plan = plan
        self.state = state
        self.clock = Clock()
        self._watchers = Watchers(watchers)
        self.inbox = Inbox(self._watchers, self.clock, plan.first.setting.kinds)
        self._listening = Listening(self.clock())
        self._missed_before = 0.0
        self._plugins = tuple(plugins)
        self._commands: asyncio.Queue[Command] = asyncio.Queue()
        self._tasks: list[asyncio.Task[None]] = []
        self._begun = False

    async def __aenter__(self) -> LiveRun:
        for plugin in self._plugins:
            ear = Ear(plugin.name, self.inbox)
            self._tasks.append(asyncio.create_task(plugin.run(ear), name=plugin.name))
        self._tasks.append(asyncio.create_task(self._send_commands(), name="orders"))
        for order in self.state.overrides.orders.values():  # else a vehicle that was held looks taken over
            self._commands.put_nowait(order.command)
        return self

    async def __aexit__(self, *_: object) -> None:
        for task in self._tasks:
            task.cancel()
        await asyncio.gather(*self._tasks, return_exceptions=True)

    # --- beginning

    async def begin(
        self, patience: float, *, forced: bool = False, start: asyncio.Event | None = None
    ) -> None:
        """Wait for every vehicle, for a world that satisfies the mission's environment section, and for `start`.

        Raises:
            NotHeard: A vehicle was not heard in time.
            NotAsAssumed: The world differs, and the run is not forced.
        """
        until = self._listening.look(self.clock()) + patience
        while (missing := self._unheard()) or not (start is None or start.is_set()):
            if missing and self._listening.look(self.clock()) >= until:
                raise NotHeard(missing, self.inbox.statuses)
            await self._next(0.1)
            batch, answers = self.inbox.take(self._missed())
            turn = watch(self.plan, self.state, batch, self.clock())
            self._refuse(answers)
            broken = [finding for finding in turn.findings if finding.kind == "broken assumption"]
            if broken and not forced:
                raise NotAsAssumed(broken)
            self._take(_without_fallbacks(turn) if forced else turn)
            for failed in self._watchers.failures():
                raise PluginFailed(f"{failed.source}: {failed.reason}")
        self._begun = True
        if forced:
            overrides = self.state.overrides.lifted()
            self.state = replace(self.state, overrides=overrides)
        for given in self.state.commanded:
            if given.command.entity not in self.state.overrides.taken:  # a resumed run has compared it
                self._commands.put_nowait(given.command)

    def _unheard(self) -> list[str]:
        return sorted(set(self.plan.vehicles) - set(self.state.sightings.newest))

    def _refuse(self, answers: list[asyncio.Future[Answer]]) -> None:
        for answer in answers:
            if not answer.done():
                answer.set_result(Answer(Saying("", ""), "the mission has not begun"))

    # --- going

    async def go(self, until: Callable[[LiveState], bool] = is_over, seconds: float | None = None) -> Ending:
        """Turn until the run is over, or for some seconds."""
        self._listening.looked = (
            self.clock()
        )  # since `begin` arrivals were gathered, though there was no turn
        elapsed = asyncio.get_running_loop().time  # no date: a change of the system's clock ends no run
        end = None if seconds is None else elapsed() + seconds
        again: float | None = self.clock()
        while True:
            await self._next(self._patience(again, math.inf if end is None else end - elapsed()))
            turn = self._turn()
            again = turn.again
            if until(self.state):
                return Ending("the mission has ended", self.state)
            if again is None and is_refused(self.state):
                return Ending("all remaining requests were refused", self.state)
            if end is not None and elapsed() >= end:
                return Ending("the time is over", self.state)

    def _patience(self, again: float | None, left: float) -> float:
        due = math.inf if again is None else again - self.clock()
        return max(0.0, min(IDLE, due, left))

    def _turn(self) -> Turn:
        for failed in self._watchers.failures():
            self.inbox.report(failed)
        batch, answers = self.inbox.take(self._missed())
        turn = advance(self.plan, self.state, batch, self.clock(), SLICE)
        self._take(turn)
        for answer, said in zip(turn.answers, answers, strict=True):
            if not said.done():  # the sender may have disconnected
                said.set_result(answer)
        for command in (*turn.commands, *self._unrecorded()):
            if not (self.state.overrides.suspended and isinstance(command, GoTo | Follow | HandOver)):
                self._commands.put_nowait(command)
        return turn

    def _unrecorded(self) -> tuple[Command, ...]:
        """Take in a failure to record a turn at once: its commands are sent only if the mission continues."""
        failures = self._watchers.failures()
        if not failures:
            return ()
        turn = advance(self.plan, self.state, Batch(reports=failures), self.clock(), 0)
        self._take(turn)
        return turn.commands

    def _take(self, turn: Turn) -> None:
        self.state = turn.state
        self._watchers.turned(turn, self.clock())

    async def _next(self, patience: float) -> None:
        """Wait for input, and a moment longer to gather more."""
        self._check_plugins()
        await asyncio.sleep(0)
        missed = self._listening.missed
        try:
            async with asyncio.timeout(patience):  # wait_for may lose a cancellation
                await self.inbox.awake.wait()
        except TimeoutError:
            self._listening.look(self.clock())
            if self._listening.missed == missed:
                return
        await asyncio.sleep(GATHER)  # first take the input that waited in sockets during a stall

    def _missed(self) -> float:
        """Return the seconds without listening since the last call."""
        self._listening.look(self.clock())
        before, self._missed_before = self._missed_before, self._listening.missed
        return self._missed_before - before

    def _check_plugins(self) -> None:
        """Report plugins that have failed; a run that has not begun ends with the first."""
        for task in tuple(self._tasks):
            if task.done() and not task.cancelled() and (error := task.exception()) is not None:
                if not self._begun:
                    raise self._not_begun(task.get_name(), error)
                self._tasks.remove(task)
                self._fail(task.get_name(), error)

    def _not_begun(self, plugin: str, error: BaseException) -> BaseException:
        if not isinstance(error, OSError | ValueError):
            return error
        failed = Failed.by(error, plugin, self.clock())
        return PluginFailed(f"{failed.source}: {failed.reason}")

    def _fail(self, plugin: str, error: BaseException) -> None:
        """Report that a plugin failed; a bug goes to the event loop's exception handler too."""
        if isinstance(error, OSError | ValueError):
            self.inbox.report(Failed.by(error, plugin, self.clock()))
            return
        known = {"message": f"a bug of bigactors or of the plugin {plugin}", "exception": error}
        asyncio.get_running_loop().call_exception_handler(known)
        self.inbox.report(Failed(plugin, str(error) or type(error).__name__, self.clock()))

    # --- commands

    async def _send_commands(self) -> None:
        """Send commands to vehicles, one after the other, and report refusals."""
        while True:
            command = await self._commands.get()
            owner = next((plugin for plugin in self._plugins if plugin.owns(command.entity)), None)
            try:
                if owner is None:
                    raise Refused(f"no vehicle takes commands as {command.entity}")
                await owner.command(command)
                if isinstance(command, Hold | Return):
                    self.inbox.report(Sent(command.request, command.entity, self.clock()))
            except Refused as refused:
                reason = f"{refused.reason}{f' ({refused.hint})' if refused.hint else ''}"
                self.inbox.report(Rejected(command.request, command.entity, self.clock(), reason))
            except Exception as error:  # the other vehicles still need their commands
                self._fail("" if owner is None else owner.name, error)
