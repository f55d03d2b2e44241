"""The public contract of plugins: a plugin that breaks a clause is told which."""

import asyncio
from contextlib import asynccontextmanager, nullcontext
from pathlib import Path

import pytest

from adapters.plugin import Accepted, Aged, Arrived, Refused, Status, Trouble
from bigactors.testing import Clause, Connection, ContractBrokenError, PluginContract
from physical import PhysicalProperty, box, point

ROOT = Path(__file__).parents[2]
SEA = box((37.1, -8.5), (37.0, -8.6))
TESTS = [name for name in vars(PluginContract) if name.startswith("test_")]


class Buoy:
    """A plugin that keeps to the contract; each of its subclasses breaks one clause."""

    name = "buoy"

    def __init__(self):
        self.asked = []

    def owns(self, entity):
        return entity == "boat0"

    async def command(self, command):
        if not self.owns(command.entity):
            raise Refused(f"{command.entity} is none of mine")
        self.asked.append(command.request)

    async def run(self, world):
        while True:
            self.publish(world, world.now())
            world.report(Status("boat0", world.now(), self.name))
            world.report(Trouble(self.name, world.now(), "bad line"))
            for request in self.asked:
                self.answer(world, request)
            self.asked.clear()
            await asyncio.sleep(1)

    def publish(self, world, time):
        world.publish(
            Aged(PhysicalProperty("boat0", "Boat", point(37.05, -8.55), time=time, source=self.name), 30.0)
        )

    def answer(self, world, request):
        world.report(Accepted(request, "boat0", world.now()))
        world.report(Arrived(request, "boat0", world.now()))


class Unnamed(Buoy):
    name = "buoy\n"


class Early(Buoy):
    def publish(self, world, time):
        super().publish(world, time + 60)


class Obedient(Buoy):
    async def command(self, command):
        self.asked.append(command.request)


class Silent(Buoy):
    async def run(self, world):
        while True:
            self.publish(world, world.now())
            await asyncio.sleep(1)


class Talkative(Buoy):
    def publish(self, world, time):
        super().publish(world, time)
        world.report(Status("boat0", time, self.name))


class Stubborn(Buoy):
    async def run(self, world):
        self.left = asyncio.ensure_future(super().run(world))
        await asyncio.Event().wait()


class Hasty(Buoy):
    def answer(self, world, request):
        world.report(Arrived(request, "boat0", world.now()))


def broken_by(plugin, folder):
    """Return the clauses that a kind of plugin breaks."""

    class Contract(PluginContract):
        @asynccontextmanager
        async def connect(self, _folder):
            yield Connection(plugin(), nullcontext, lambda: None, ("boat0", SEA))

    broken = set()
    for name in TESTS:
        try:
            getattr(Contract(), name)(folder)
        except ContractBrokenError as error:
            broken |= {each for each in Clause if f"({each.name})" in str(error)}
    return broken


@pytest.mark.parametrize(
    ("plugin", "clauses"),
    [
        (Buoy, set()),
        (Unnamed, {Clause.INTERFACE}),
        (Early, {Clause.STAMPED}),
        (Obedient, {Clause.REFUSES}),
        (Silent, {Clause.JUNK, Clause.REPORTS, Clause.DRIVES}),
        (Talkative, {Clause.REPORTS}),
        (Stubborn, {Clause.ENDS}),
        (Hasty, {Clause.DRIVES}),
    ],
)
def test_a_plugin_that_breaks_a_clause_is_told_which(plugin, clauses, tmp_path):
    assert broken_by(plugin, tmp_path) == clauses


def test_each_clause_is_told_by_the_page_that_failures_name():
    page = (ROOT / "docs/reference/plugins.md").read_text(encoding="utf-8")
    assert [each for each in Clause if f"| {each.name} | {each.value} |" not in page] == []
