"""Detect that a vehicle was taken over: by a pilot, another ground station, a fail-safe or itself.

A pilot, another ground station, a fail-safe and a reboot look alike from here: the vehicle is in a mode that nobody
here ordered, disarmed, or goes elsewhere. Whoever sends it anything then overrules them, so nobody does until an
operator has given it back.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Final

from adapters.mavlink.profiles import Profile, TakeOff
from adapters.mavlink.telemetry import Telemetry
from adapters.plugin import Command, Follow, GoTo, Hold, Return

STRANGE: Final = 3.0
"""Seconds of heartbeats that must show that it is otherwise before that counts: one can come late."""


@dataclass(frozen=True, slots=True)
class Helm:
    """What was ordered of a vehicle, and whether it was seen to be otherwise.

    Attributes:
        modes: The modes of the command that it was last seen to obey, none before the first; while it is otherwise, all
            that would be as ordered.
        armed: Whether it was armed since.
        boots: How often it had booted when it was last as ordered.
        strange: Since when it is otherwise.
        taken: Why it takes no commands any more; empty while it does.
    """

    modes: frozenset[int] = frozenset()
    armed: bool = False
    boots: int = 0
    strange: float | None = None
    taken: str = ""

    @property
    def held(self) -> bool:
        """Whether the vehicle is as it was ordered: what is seen of it counts, and it may be told something."""
        return self.strange is None and not self.taken


def watch(helm: Helm, known: Telemetry, profile: Profile, command: Command | None, undone: str = "") -> Helm:
    """Compare what a vehicle shows with what it was told last; `undone` is what it should do and does not any more."""
    if helm.taken or known.mode is None or known.beat is None:
        return helm
    if isinstance(command, Return) and known.armed is False:
        return Helm(boots=known.boots)  # it has landed, and nothing is ordered
    why = _otherwise(helm, known, profile, command) or undone
    if not why:
        return _as_ordered(helm, known, profile, command)
    if helm.strange is None:
        return replace(helm, strange=known.beat, modes=_allowed(helm, profile, command))
    return replace(helm, taken=why) if known.beat - helm.strange > STRANGE else helm


def given_back(known: Telemetry) -> Helm:
    """Return the helm of a vehicle that an operator has given back, in whatever mode it is."""
    return Helm(frozenset() if known.mode is None else frozenset({known.mode}), boots=known.boots)


def modes_of(command: Command | None, profile: Profile) -> frozenset[int]:
    """Return the modes that a vehicle goes through while it carries out a command."""
    match command:
        case GoTo() if profile.takeoff is not TakeOff.MISSION:
            return frozenset({profile.guided})
        case Follow() if profile.takeoff is not TakeOff.COMMAND:
            return frozenset({profile.auto})
        case GoTo() | Follow():
            return frozenset({profile.guided, profile.auto})
        case Hold():
            return frozenset({profile.hold})
        case Return():
            return frozenset({profile.home})
    return frozenset()


def _otherwise(helm: Helm, known: Telemetry, profile: Profile, command: Command | None) -> str:
    """Return what of its mode and arming nobody here ordered; who is not armed may be handled by anybody."""
    if helm.armed and known.armed is False:
        booted = "it has booted anew and is disarmed" if known.boots != helm.boots else "it was disarmed"
        return f"{booted}, and is not armed again"
    if not (helm.armed or known.armed):
        return ""
    if known.mode in _allowed(helm, profile, command):
        return ""
    return f"it is in {profile.mode_name(known.mode)}, by itself or told by someone else"


def _allowed(helm: Helm, profile: Profile, command: Command | None) -> frozenset[int]:
    """Return the modes that are as ordered; what is told while it is otherwise makes nothing of it ordered."""
    if helm.strange is not None:
        return helm.modes
    before = helm.modes or frozenset({profile.guided, profile.auto})  # as another run has left it
    return before | modes_of(command, profile)


def _as_ordered(helm: Helm, known: Telemetry, profile: Profile, command: Command | None) -> Helm:
    ordered = modes_of(command, profile)
    modes = ordered if known.mode in ordered else helm.modes
    return Helm(modes, helm.armed or (command is not None and known.armed is True), known.boots)
