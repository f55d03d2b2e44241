"""Detect that a vehicle was taken over: by a pilot, another ground station, a fail-safe or itself.

All these and a reboot look the same from here: the vehicle is in a mode that was not ordered here, is disarmed, or
flies elsewhere. Any command would overrule its new controller, so none is sent until an operator gives the vehicle
back.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from types import MappingProxyType
from typing import Final

from adapters.mavlink.item_merging import OnBoard, may_be_landing
from adapters.mavlink.profiles import Profile, TakeOff
from adapters.mavlink.telemetry import Telemetry
from adapters.plugin import Command, Follow, GoTo, Hold, Return

STRANGE: Final = 3.0
"""Seconds of heartbeats that must show a deviation before it counts: a single one can be late."""


@dataclass(frozen=True, slots=True)
class Helm:
    """The orders of a vehicle, and its deviations from them.

    Attributes:
        modes: The modes of the command that it was last seen to obey, none before the first; during a deviation, all
            modes that would end it.
        armed: Whether it was armed since.
        boots: Its number of boots when it last followed its orders.
        strange: The start of its deviation.
        taken: The reason why it gets no more commands; empty while it does.
    """

    modes: frozenset[int] = frozenset()
    armed: bool = False
    boots: int = 0
    strange: float | None = None
    taken: str = ""

    @property
    def held(self) -> bool:
        """Whether the vehicle follows its orders: then observations of it count, and it may be commanded."""
        return self.strange is None and not self.taken


def watch(
    helm: Helm,
    known: Telemetry,
    profile: Profile,
    command: Command | None,
    undone: str = "",
    on_board: OnBoard = MappingProxyType({}),
) -> Helm:
    """Compare a vehicle's state with its last command; `undone` is the part that it no longer carries out."""
    if helm.taken or known.mode is None or known.beat is None:
        return helm
    if isinstance(command, Return) and known.armed is False:
        return Helm(boots=known.boots)  # it has landed, and nothing is ordered
    lands = isinstance(command, Return) and may_be_landing(known, on_board)
    why = ("" if lands else _otherwise(helm, known, profile, command)) or undone
    if not why:
        return _as_ordered(helm, known, profile, command)
    if helm.strange is None:
        return replace(helm, strange=known.beat, modes=_allowed(helm, profile, command))
    return replace(helm, taken=why) if known.beat - helm.strange > STRANGE else helm


def given_back(known: Telemetry) -> Helm:
    """Return the helm of a vehicle that an operator has given back, in any mode."""
    return Helm(frozenset() if known.mode is None else frozenset({known.mode}), boots=known.boots)


def modes_of(command: Command | None, profile: Profile) -> frozenset[int]:
    """Return the modes that a vehicle goes through while it carries out a command."""
    rises = frozenset() if profile.climb is None else frozenset({profile.climb})
    match command:
        case GoTo() if profile.takeoff is not TakeOff.MISSION:
            return rises | {profile.guided}
        case Follow() if profile.takeoff not in (TakeOff.COMMAND, TakeOff.MODE):
            return frozenset({profile.auto})
        case GoTo() | Follow():
            return rises | {profile.guided, profile.auto}
        case Hold():
            return frozenset({profile.hold})
        case Return():
            return frozenset({profile.home})
    return frozenset()


def _otherwise(helm: Helm, known: Telemetry, profile: Profile, command: Command | None) -> str:
    """Return its deviation in mode or arming, or an empty text; a disarmed vehicle may be handled freely."""
    if helm.armed and known.armed is False:
        booted = "it has booted anew and is disarmed" if known.boots != helm.boots else "it was disarmed"
        return f"{booted}, and is not armed again"
    if not (helm.armed or known.armed):
        return ""
    if known.mode in _allowed(helm, profile, command):
        return ""
    return f"it is in {profile.mode_name(known.mode)}, by itself or by a command from elsewhere"


def _allowed(helm: Helm, profile: Profile, command: Command | None) -> frozenset[int]:
    """Return the ordered modes; a command during a deviation adds none."""
    if helm.strange is not None:
        return helm.modes
    before = helm.modes or frozenset({profile.guided, profile.auto})  # left so by another run
    return before | modes_of(command, profile)


def _as_ordered(helm: Helm, known: Telemetry, profile: Profile, command: Command | None) -> Helm:
    ordered = modes_of(command, profile)
    modes = ordered if known.mode in ordered else helm.modes
    return Helm(modes, helm.armed or (command is not None and known.armed is True), known.boots)
