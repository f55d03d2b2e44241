"""A simulated vehicle: its behaviour in each mode, and its start-up.

`protocol` and `reporting` handle commands and messages, `serving` handles packets.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final

from adapters.mavlink.constants import Fence
from adapters.simulated import fence_actions, mission_flight
from adapters.simulated.body import Body, Target, moved
from adapters.simulated.vehicle_state import CRITICAL, NO_FENCE, WARNING, State

READY_AFTER: Final = 19.0
"""Seconds after boot at which it has a fix, and could be armed; before, it reports a position near (0, 0)."""

COMPLAINS_EVERY: Final = 30.0
"""Seconds between two texts with the reason why it cannot be armed."""

ENDURANCE: Final = 7_200.0
"""Seconds for which a full battery lasts."""

LOW_BATTERY_RETURNS: Final = 3.0
"""PX4's COM_LOW_BAT_ACT for a return at a critical charge."""


@dataclass(slots=True)
class Vehicle(State):
    """A simulated vehicle."""

    @property
    def ready(self) -> bool:
        """Whether it could be armed."""
        return self.uptime >= READY_AFTER and not self.fault and not mission_flight.missing(self)

    def reboot(self, *, armed: bool = False) -> None:
        """Reboot, also in the air; its permanent memory stays. A watchdog's reboot keeps it armed."""
        self.booted = self.time
        self.armed = armed and self.armed
        self.current, self.target = 0, None
        self.mode = self.mode if self.armed else self.first_mode
        self.store.abandon()
        self.low, self.failed_safe = None, False
        self.fences = NO_FENCE
        if self.parameters.get("FENCE_ENABLE"):
            self.switch_fences(~Fence.ALT_MIN, on=True)

    def restart(self) -> None:
        """Reboot on the ground at home, like a simulator that was killed in flight and restarted."""
        self.reboot()
        self.body = Body(*self.home[:2], self.ground - self.home[2])

    # --- moving -----------------------------------------------------------------------------------

    def move(self, now: float) -> None:
        """Move until a time."""
        seconds, self.time = now - self.time, now
        profile = self.kind.profile
        self.store.flown = self.armed and self.mode == profile.auto
        fence_actions.switch_by_itself(self)
        self._complain()
        if not self.armed or seconds <= 0:
            return
        self.charge = max(0.0, self.charge - seconds / ENDURANCE)
        fence_actions.keep(self)
        self._watch_battery()
        self.told = self.told if self.mode == profile.auto else None
        self.refuge = self.refuge if self.mode == profile.home else None
        if self.mode == profile.auto:
            mission_flight.follow(self, seconds)
        elif self.mode == profile.climb:
            self._climb(seconds)
        elif self.mode == profile.guided and self.target:
            self.go(self.target, seconds)
        elif self.mode == profile.home:
            self._return(seconds)
        else:
            self._idle(seconds)

    def _complain(self) -> None:
        """Report the reason why it cannot be armed, every 30 s."""
        due = self.uptime >= READY_AFTER and self.uptime - self.complained >= COMPLAINS_EVERY
        if self.fault and due and not self.armed:
            self.complained = self.uptime
            self.words.append((CRITICAL, f"PreArm: {self.fault}"))

    def _return(self, seconds: float) -> None:
        """Go to the nearest rally point or home, or by the landing sequence, according to its parameters."""
        if self.refuge is None:
            self.refuge, self.lands = mission_flight.refuge(self), False
        if not self.lands and mission_flight.may_land(self):
            self.lands = True
            if mission_flight.land(self):
                return
        self.go(Target(*self.refuge, self.kind.profile.altitude, self.home_circle), seconds)

    def _climb(self, seconds: float) -> None:
        """Take off in the mode for it, and hold once it is high enough."""
        height = self.target.height if self.target else 0.0
        self.take_off(height, seconds)
        if self.body.height >= height - 1.0:
            self.stay()

    def holds(self, latitude: float, longitude: float, height: float) -> bool:
        """Return whether a position is inside all fences that are on."""
        return fence_actions.holds(self, latitude, longitude, height)

    def _watch_battery(self) -> None:
        """Return once the battery is low, if the parameters demand it; a later command overrules the return."""
        if self.kind.profile.dialect.typed:
            self._watch_charge()
            return
        if self.volts >= self.parameters["BATT_LOW_VOLT"] or self.failed_safe:
            self.low = None
            return
        self.low = self.time if self.low is None else self.low
        if self.time - self.low < self.parameters["BATT_LOW_TIMER"]:
            return
        self.failed_safe = True
        self.words.append((WARNING, f"Battery 1 is low {self.volts:.2f}V used 0 mAh"))
        if self.parameters["BATT_FS_LOW_ACT"] == self.kind.returns:
            self.mode = self.kind.profile.home

    def _watch_charge(self) -> None:
        """Return once the charge is critical, if COM_LOW_BAT_ACT demands it."""
        if self.charge > self.parameters["BAT_CRIT_THR"] or self.failed_safe:
            return
        self.failed_safe = True
        self.words.append((WARNING, "Critical battery, return"))
        if self.parameters["COM_LOW_BAT_ACT"] == LOW_BATTERY_RETURNS:
            self.mode = self.kind.profile.home

    def _idle(self, seconds: float) -> None:
        """Circle at its position, if it must move; else stop, at its present height."""
        limits = self.kind.limits
        if limits.must_move and self.flies:
            circling = self.body.course + limits.turn * seconds * 0.5
            self.body = moved(self.body, limits, circling, self.speed, self.body.height, seconds)
        elif not limits.must_move:
            self.body = moved(self.body, limits, self.body.course, 0.0, self.body.height, seconds)
