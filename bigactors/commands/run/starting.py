"""The start of a run. With a console, it waits until an operator has seen the checks and presses Start."""

from __future__ import annotations

import asyncio
from collections.abc import Callable, Iterator
from dataclasses import dataclass, field
from typing import Any, Final

from adapters.live.core import obeying
from adapters.live.loop import LiveRun
from adapters.live.plan import Plan
from adapters.plugin import Plugin, Status, preflights
from bigactors.commands.run.preflight_checks import (
    check_idle,
    check_places,
    check_ways,
    get_to_know,
    unwatched,
)
from specs.elaboration import ElaboratedMission

EVERY: Final = 0.25
"""Seconds between two updates of the list of checks."""

Item = dict[str, Any]
"""A check before the start: its name `what`, its state `done`, its `detail`; for a `vehicle` its readiness, too."""

Telling = Callable[[dict[str, Any], float], None]
"""Takes the list of checks, and the time."""


@dataclass(slots=True)
class Start:
    """The start of a run by an operator's press.

    Attributes:
        waits: Whether an operator has to press Start.
        missing: The first unfinished check; empty if the run may start.
        begun: Whether it has begun.
        by: The operator who pressed Start.
        pressed: The event of that press.
    """

    waits: bool = False
    missing: str = "the vehicles are not known yet"
    begun: bool = False
    by: str = ""
    pressed: asyncio.Event = field(default_factory=asyncio.Event)

    def press(self, by: str) -> str:
        """Start the run for an operator; return the refusal, or an empty text."""
        if self.begun or self.pressed.is_set() or not self.waits:
            return "the run has started already"
        if self.missing:
            return f"it cannot start yet: {self.missing}"
        self.by = by
        self.pressed.set()
        return ""


@dataclass(frozen=True, slots=True)
class StartChecks:
    """The subject of the checks before the start of a run.

    Attributes:
        mission: The mission to fly.
        plugins: Its vehicles and feeds.
        verdict: The number of properties that hold; None for a run without a verdict.
        patience: Seconds within which each vehicle must report.
        takes_over: Whether the run takes over vehicles that fly missions of other operators.
    """

    mission: ElaboratedMission
    plugins: tuple[Plugin, ...]
    verdict: int | None
    patience: float
    takes_over: bool


async def stand_by(live: LiveRun, start: Start, before: StartChecks, tell: Telling | None) -> None:
    """Run the checks, report them to `tell`, and begin when Start is pressed; raises the errors of the checks."""
    checks = asyncio.create_task(check_start(live, before))
    forced = before.verdict is None
    begins = asyncio.create_task(live.begin(before.patience, forced=forced, start=start.pressed))
    told: dict[str, Any] | None = None
    try:
        while True:
            items = list(_items(live, before, checked=checks.done()))
            start.missing = next((f"{each['what']}: no" for each in items if not each["done"]), "")
            state = "begun" if begins.done() else "waits" if start.missing else "ready"
            now = {"state": state, "by": start.by, "items": items}
            if now != told and tell is not None:
                tell(now, live.clock())
            told = now
            if begins.done():
                return
            await asyncio.wait((checks, begins), timeout=EVERY, return_when=asyncio.FIRST_EXCEPTION)
            for task in (checks, begins):
                if task.done():
                    task.result()
    finally:
        for task in (checks, begins):
            task.cancel()
        await asyncio.gather(checks, begins, return_exceptions=True)


async def check_start(live: LiveRun, before: StartChecks) -> None:
    """Check, once all vehicles are heard, that they may be commanded and that places and ways fit them."""
    while not live.state.sightings.newest.keys() >= live.plan.vehicles.keys():
        await asyncio.sleep(EVERY)
    check_idle(live, takes_over=before.takes_over)
    await get_to_know(before.plugins, obeying(live.plan, live.state))
    check_places(before.mission, before.plugins)
    check_ways(live.plan, before.mission, before.plugins, live.state.sightings.newest)


# --- the list -----------------------------------------------------------------------------------------


def _held(count: int) -> str:
    return "1 property holds" if count == 1 else f"{count} properties hold"


def _items(live: LiveRun, before: StartChecks, *, checked: bool) -> Iterator[Item]:
    """Yield the checks in their order."""
    count = before.verdict
    what = "no verdict: nothing was verified of this run" if count is None else "the mission is verified"
    yield _item(what, detail="--unverified" if count is None else _held(count))
    for vehicle in sorted(live.plan.vehicles):
        said = live.inbox.statuses.get(vehicle)
        heard = vehicle in live.state.sightings.newest
        item = _item(f"{vehicle} is heard", done=heard, detail=_told(said) if said and heard else "")
        found = next(
            (each.readiness(vehicle) for each in preflights(before.plugins) if each.owns(vehicle)), None
        )
        more = {} if found is None else {"fence": found.fence, "refuses": list(found.refuses)}
        yield {**item, "vehicle": vehicle, **more}
    yield _item("places and fences fit the vehicles", done=checked)
    yield from _of_ways(live.plan, before.mission)


def _of_ways(plan: Plan, mission: ElaboratedMission) -> Iterator[Item]:
    """Yield the properties and assumptions about ways that the run watches, and those that it does not."""
    names = [each.name for each in plan.invariants]
    if names:
        yield _item("invariants about ways are watched", detail=", ".join(names))
    for line in unwatched(plan, mission):
        yield _item("not watched", detail=line)


def _item(what: str, *, done: bool = True, detail: str = "") -> Item:
    return {"what": what, "done": done, "detail": detail}


def _told(said: Status) -> str:
    """Return a vehicle's mode, arming and battery in words."""
    percent = None if said.battery is None else said.battery.percent
    parts = [
        said.mode,
        None if said.armed is None else "armed" if said.armed else "disarmed",
        None if percent is None else f"battery {percent:.0f} %",
    ]
    return ", ".join(part for part in parts if part)
