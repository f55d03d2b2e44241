"""The contract of every plugin as pytest tests, for plugins of this project and of others.

    class TestMine(PluginContract):
        @asynccontextmanager
        async def connect(self, folder):
            yield Connection(Mine("mine", ...), told, spoil)

Its tests run in an event loop whose clock jumps (`adapters.simulated.clock`), so that a minute takes no time. The
plugin's peer must run in the same loop, or answer at once. A failure, a `ContractBrokenError`, names the broken
clause; docs/reference/plugins.md lists the clauses under "The contract". Needs the extra `testing`.
"""

from __future__ import annotations

import asyncio
from collections import Counter
from collections.abc import AsyncIterator, Callable, Coroutine
from contextlib import AbstractAsyncContextManager, asynccontextmanager, suppress
from dataclasses import dataclass, field
from enum import Enum
from itertools import pairwise
from pathlib import Path
from typing import Any, Final, TypeVar

from adapters.plugin import (
    Accepted,
    Aged,
    Arrived,
    Command,
    Gone,
    GoTo,
    HandOver,
    Plugin,
    Published,
    Refused,
    Report,
    Status,
    Trouble,
    entity_of,
)
from adapters.recording.recording_reader import read_recording
from adapters.recording.schemas import SCHEMAS
from adapters.recording.writing import Recorder
from adapters.simulated.clock import run
from physical import Geometry, PhysicalProperty, contains, point

EPOCH: Final = 1_600_000_000.0
"""The first reading of a test's clock, in seconds since 1970 UTC."""

PAGE: Final = "docs/reference/plugins.md#the-contract"
Found = TypeVar("Found")


class Clause(Enum):
    """A clause of the contract, in the words of its documentation page."""

    INTERFACE = "it has all of the interface, and a printable name"
    STAMPED = "each publication is stamped, never in the future, and names its source"
    REFUSES = "it refuses a command for an entity that it does not own, by name, and reports nothing of it"
    JUNK = "unusable input does not end it, and is reported as a Trouble with its name"
    REPORTS = "its reports fit the recording, and a vehicle's Status comes at most once a second"
    ENDS = "cancelled, it ends, leaves no task behind, publishes nothing more, and can run again"
    DRIVES = "a vehicle's state confirms a command: Accepted, then Arrived, from inside the place"


class ContractBrokenError(AssertionError):
    """A plugin breaks a clause of the contract."""

    def __init__(self, clause: Clause, seen: str) -> None:
        super().__init__(
            f"the contract is broken: {clause.value}\n  but: {seen}\n  see {PAGE} ({clause.name})"
        )
        self.clause = clause


def require(clause: Clause, kept: object, seen: str) -> None:
    """Raise ContractBrokenError unless a clause is kept."""
    if not kept:
        raise ContractBrokenError(clause, seen)


@dataclass(frozen=True)
class Connection:
    """A plugin that does not run yet, and its peer.

    Attributes:
        plugin: The plugin.
        fed: Returns a context within which the peer feeds it data to publish.
        spoil: Sends it unusable input; None if the peer sends such input from the beginning.
        drives: A vehicle that it owns, and a distant place to which the vehicle can go; None for a feed.
    """

    plugin: Plugin
    fed: Callable[[], AbstractAsyncContextManager[Any]]
    spoil: Callable[[], object] | None = None
    drives: tuple[str, Geometry] | None = None


@dataclass
class World:
    """A world that stores the publications and reports of plugins, in the event loop's time."""

    published: list[Published] = field(default_factory=list)
    reports: list[Report] = field(default_factory=list)

    def publish(self, published: Published) -> None:
        """Store a publication."""
        self.published.append(published)

    def report(self, report: Report) -> None:
        """Store a report."""
        self.reports.append(report)

    def now(self) -> float:
        """Return the time."""
        return EPOCH + asyncio.get_running_loop().time()

    def of(self, kind: type[Found], **wanted: object) -> list[Found]:
        """Return the reports of a type whose attributes have the wanted values."""
        return [
            report
            for report in self.reports
            if isinstance(report, kind)
            and all(getattr(report, name) == value for name, value in wanted.items())
        ]

    def troubles(self) -> set[str]:
        """Return the descriptions of the reported troubles."""
        return {report.what for report in self.of(Trouble)}

    def property(self, entity: str) -> PhysicalProperty | None:
        """Return the last property published of an entity; None if there is none or it is gone."""
        newest = next((each for each in reversed(self.published) if entity_of(each) == entity), None)
        said = newest.property if isinstance(newest, Aged) else newest
        return None if isinstance(said, Gone) else said


async def until(what: Callable[[], Found], seconds: float = 600.0, every: float = 0.2) -> Found:
    """Wait until a condition holds, and return its value; raises AssertionError at the timeout."""
    loop = asyncio.get_running_loop()
    end = loop.time() + seconds
    while not (found := what()):
        if loop.time() >= end:
            raise AssertionError(f"{what} did not come to hold in {seconds} s")
        await asyncio.sleep(every)
    return found


@asynccontextmanager
async def running(*coroutines: Coroutine[Any, Any, Any]) -> AsyncIterator[None]:
    """Run coroutines beside a test; their failure fails the test."""
    tasks = [asyncio.ensure_future(coroutine) for coroutine in coroutines]
    try:
        yield
        for task in tasks:
            if task.done():
                task.result()
    finally:
        for task in tasks:
            task.cancel()
            with suppress(asyncio.CancelledError):
                await task


async def opened(plugin: Plugin) -> None:
    """Wait until a plugin has opened its links: a listening plugin shows its address in `local` or `port`."""
    await asyncio.sleep(0.5)
    await until(lambda: getattr(plugin, "local", True) and getattr(plugin, "port", True))


async def _troubles(connection: Connection, world: World) -> list[Trouble]:
    """Send unusable input repeatedly until some is reported: the first may arrive before the plugin listens."""
    for _ in range(20):
        if connection.spoil is not None:
            connection.spoil()
        await asyncio.sleep(3)
        if troubles := world.of(Trouble):
            return troubles
    return []


async def _heard(clause: Clause, world: World) -> None:
    try:
        await until(lambda: world.published)
    except AssertionError:
        raise ContractBrokenError(clause, "nothing of its input is published in ten minutes") from None


class PluginContract:
    """The tests of one plugin: derive a class `Test...` from it, and define `connect`.

    Attributes:
        speed: Simulated seconds in a real second. None lets time jump whenever the loop is idle. That suits a plugin
            whose peer is in the same event loop or behind local sockets. A plugin that hears from a thread of its own
            needs a number: with 20, a minute takes three seconds.
    """

    speed: float | None = None

    def connect(self, folder: Path) -> AbstractAsyncContextManager[Connection]:
        """Return a new plugin and its peer; `folder` is empty."""
        raise NotImplementedError(f"{type(self).__name__} must define connect(self, folder)")

    def test_it_is_a_plugin_with_a_name(self, tmp_path: Path) -> None:
        """Check `Clause.INTERFACE`."""

        async def main() -> None:
            async with self.connect(tmp_path) as connection:
                plugin = connection.plugin
                require(
                    Clause.INTERFACE, isinstance(plugin, Plugin), f"{type(plugin).__name__} lacks some of it"
                )
                require(Clause.INTERFACE, plugin.name and plugin.name.isprintable(), f"it is {plugin.name!r}")

        run(main(), self.speed)

    def test_it_publishes_properties_that_are_stamped_and_never_in_the_future(self, tmp_path: Path) -> None:
        """Check `Clause.STAMPED`."""

        async def main() -> None:
            async with self.connect(tmp_path) as connection:
                world = World()
                async with running(connection.plugin.run(world)):
                    await opened(connection.plugin)
                    async with connection.fed():
                        await _heard(Clause.STAMPED, world)
                        await asyncio.sleep(5)
                for published in world.published:
                    require(Clause.STAMPED, not (flaw := _flaw(published, world.now())), flaw)

        run(main(), self.speed)

    def test_it_refuses_commands_for_what_it_does_not_own(self, tmp_path: Path) -> None:
        """Check `Clause.REFUSES`."""

        async def main() -> None:
            async with self.connect(tmp_path) as connection:
                plugin, world = connection.plugin, World()
                async with running(plugin.run(world)):
                    await opened(plugin)
                    require(Clause.REFUSES, not plugin.owns("nobody0"), "it owns nobody0")
                    at = point(37.0, -8.7)
                    for command in (
                        GoTo("r1", "nobody0", at),
                        HandOver("r2", "nobody0", "control:a", "control:b"),
                    ):
                        await _refused(plugin, command)
                    answers = [each for each in world.reports if isinstance(each, Accepted | Arrived)]
                    require(Clause.REFUSES, not answers, f"it reports {answers}")

        run(main(), self.speed)

    def test_junk_does_not_end_it_and_is_reported_with_its_name(self, tmp_path: Path) -> None:
        """Check `Clause.JUNK`."""

        async def main() -> None:
            async with self.connect(tmp_path) as connection:
                plugin, world = connection.plugin, World()
                task = asyncio.ensure_future(plugin.run(world))
                async with running(_blamed(task)):
                    await opened(plugin)
                    troubles = await _troubles(connection, world)
                    require(Clause.JUNK, troubles, "no Trouble is reported in a minute")
                    sources = {report.source for report in troubles}
                    require(Clause.JUNK, sources == {plugin.name}, f"the sources are {sorted(sources)}")
                    counted = all(report.what and report.count > 0 for report in troubles)
                    require(Clause.JUNK, counted, f"one lacks its name or its count: {troubles}")
                    async with connection.fed():
                        await _heard(Clause.JUNK, world)

        run(main(), self.speed)

    def test_all_that_it_reports_is_recorded_as_the_schemas_say(self, tmp_path: Path) -> None:
        """Check `Clause.REPORTS`."""
        world = World()

        async def main() -> tuple[Plugin, tuple[str, Geometry] | None]:
            async with self.connect(tmp_path) as connection, running(connection.plugin.run(world)):
                await opened(connection.plugin)
                async with connection.fed():
                    await asyncio.sleep(30)
                    if connection.spoil is not None:
                        connection.spoil()
                    await asyncio.sleep(3)
                return connection.plugin, connection.drives

        plugin, drives = run(main(), self.speed)
        _validate(world.reports, tmp_path / "contract.mcap")
        told = Counter(status.entity for status in world.of(Status))
        foreign = [entity for entity in told if not plugin.owns(entity)]
        require(Clause.REPORTS, not foreign, f"it has a Status of {foreign}, which it does not own")
        for entity in told:
            times = [status.time for status in world.of(Status, entity=entity)]
            close = any(after - before < 1.0 for before, after in pairwise(times))
            require(Clause.REPORTS, not close, f"{entity} has two within a second")
        silent = drives is not None and not told[drives[0]]
        require(Clause.REPORTS, not silent, "it has no Status of the vehicle that it drives")

    def test_it_ends_when_cancelled_and_can_run_again(self, tmp_path: Path) -> None:
        """Check `Clause.ENDS`."""

        async def main() -> None:
            async with self.connect(tmp_path) as connection:
                before = asyncio.all_tasks()
                for _ in range(2):
                    world = World()
                    task = asyncio.ensure_future(connection.plugin.run(world))
                    await opened(connection.plugin)
                    async with connection.fed():
                        await asyncio.sleep(15)
                    await _cancel(task)
                    count = len(world.published)
                    await asyncio.sleep(5)
                    require(Clause.ENDS, len(world.published) == count, "it publishes after its end")
                own = {task for task in asyncio.all_tasks() - before if not _is_a_servers(task)}
                require(Clause.ENDS, not own, f"these go on: {own}")

        run(main(), self.speed)

    def test_it_drives_its_vehicle_into_a_place(self, tmp_path: Path) -> None:
        """Check `Clause.DRIVES`, if the plugin drives a vehicle."""

        async def main() -> None:
            async with self.connect(tmp_path) as connection:
                if connection.drives is not None:
                    await _drive(connection, *connection.drives)

        run(main(), self.speed)


async def _drive(connection: Connection, entity: str, place: Geometry) -> None:
    """Send a vehicle into a place, and check the reports."""
    plugin, world = connection.plugin, World()
    require(Clause.DRIVES, plugin.owns(entity), f"it does not own {entity}")
    async with running(plugin.run(world)):
        await opened(plugin)
        async with connection.fed():
            await until(lambda: world.property(entity))
            await plugin.command(GoTo("r1", entity, place))
            with suppress(AssertionError):
                await until(lambda: [each for each in world.reports if isinstance(each, Arrived)])
            answers = [each for each in world.reports if getattr(each, "request", "") == "r1"]
            kinds = [type(each).__name__ for each in answers]
            right = kinds[:1] == ["Accepted"] and kinds[-1:] == ["Arrived"] and "Rejected" not in kinds
            require(Clause.DRIVES, right, f"in ten minutes it answers {answers or 'nothing'}")
            at = world.property(entity)
            inside = at is not None and contains(place, at.geometry)
            require(Clause.DRIVES, inside, f"{entity} is published at {at and at.geometry}")


def _flaw(published: object, now: float) -> str:
    """Return the flaw of a publication; empty if there is none."""
    match published:
        case Aged(PhysicalProperty(time=time, source=source), time_to_live):
            if time is None or not EPOCH <= time <= now or time_to_live <= 0 or not source:
                return f"{published} at {now:.0f}"
        case PhysicalProperty() | Gone():
            return ""
        case _:
            return f"{published!r} is none of PhysicalProperty, Aged and Gone"
    return ""


async def _refused(plugin: Plugin, command: Command) -> None:
    try:
        await plugin.command(command)
    except Refused as refusal:
        named = command.entity in refusal.reason
        require(Clause.REFUSES, named, f"the reason does not name {command.entity}: {refusal.reason}")
    else:
        raise ContractBrokenError(Clause.REFUSES, f"it takes {command}")


async def _blamed(task: asyncio.Task[None]) -> None:
    """Wait for a plugin's task, and report its end as the effect of junk."""
    try:
        await task
    except Exception as error:
        raise ContractBrokenError(Clause.JUNK, f"it ends by {type(error).__name__}: {error}") from error
    raise ContractBrokenError(Clause.JUNK, "it ends")


async def _cancel(task: asyncio.Task[None]) -> None:
    ended = task.done()
    task.cancel()
    try:
        await task
    except asyncio.CancelledError:
        return
    seen = "it ends before it is cancelled" if ended else "it does not let the cancellation pass"
    raise ContractBrokenError(Clause.ENDS, seen)


def _is_a_servers(task: asyncio.Task[Any]) -> bool:
    """Return whether a task belongs to a web server or client of the peer."""
    return "aiohttp" in repr(task) or "web" in repr(task)


def _validate(reports: list[Report], path: Path) -> None:
    """Record reports, and validate the recorded messages against the schemas of recordings."""
    import jsonschema  # noqa: PLC0415 - from the extra `testing`; only this needs it

    recorder = Recorder(path, {"mission": "", "text": "", "digest": ""}, EPOCH)
    for report in reports:
        recorder.report(report, report.time)
    recorder.close("done", max((report.time for report in reports), default=EPOCH))
    for message in read_recording(path).messages:
        try:
            jsonschema.validate(message.data, SCHEMAS[message.topic][1])
        except jsonschema.ValidationError as error:
            raise ContractBrokenError(Clause.REPORTS, f"{message.data}: {error.message}") from error
