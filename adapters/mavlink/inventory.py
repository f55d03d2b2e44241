"""A pilot's beliefs about the items on board: those read back since anybody may have changed them."""

from __future__ import annotations

from collections.abc import Collection, Iterator, Mapping
from typing import Final, Protocol, TypeVar

from adapters.mavlink import item_polling as surveys
from adapters.mavlink.constants import MissionType
from adapters.mavlink.item_merging import OnBoard, Unconfirmed, before_upload
from adapters.mavlink.item_polling import Survey, changed_by
from adapters.mavlink.items import Items
from adapters.mavlink.message import MavlinkMessage, changed
from adapters.mavlink.next_step import Load, Step
from adapters.mavlink.refuges import beyond_fence
from adapters.mavlink.task import Task
from adapters.mavlink.telemetry import Telemetry
from adapters.mavlink.vehicle_identities import Craft
from adapters.mavlink.verified_upload import Sync
from adapters.plugin import Command, Follow, Hold, Report, Return, Trouble


class Believer(Protocol):
    """The part of a pilot that concerns the items on board; frozen, and copied by `changed`."""

    @property
    def craft(self) -> Craft:
        """The vehicle's description."""

    @property
    def system(self) -> int:
        """Its system id."""

    @property
    def known(self) -> Telemetry:
        """Its state."""

    @property
    def on_board(self) -> OnBoard:
        """The items believed to be on board."""

    @property
    def uploads(self) -> Mapping[MissionType, Unconfirmed]:
        """The uploads that were begun and are not confirmed."""

    @property
    def survey(self) -> Survey:
        """The reading of it."""

    @property
    def moving(self) -> Task | None:
        """The command that it carries out."""


Pilot = TypeVar("Pilot", bound=Believer)

MOST_ATTEMPTS: Final = 8
"""Uploads that are remembered of those begun one after the other, none of them confirmed."""

JUST_NOW: Final = 5.0
"""Seconds for which an order relies on earlier readings, unless a change shows."""

HEADING: Final = 5.0
FLOWN: Final = 10.0
NOW_AND_THEN: Final = 60.0
"""Seconds after which a mission is read again: before it is flown, while it is flown, and otherwise."""


def unsure(
    pilot: Pilot, kinds: Collection[MissionType] = tuple(MissionType), *, quiet: bool = False
) -> Pilot:
    """Return a pilot that no longer believes its items of some kinds, until they are read again.

    `quiet`: the polygon fence still counts as switched on.
    """
    on_board = {kind: items for kind, items in pilot.on_board.items() if kind not in kinds}
    known = pilot.known
    if MissionType.FENCE in kinds and not quiet:
        known = changed(known, polygon=False)
    return changed(pilot, on_board=on_board, survey=surveys.doubt(pilot.survey, kinds), known=known)


def read_again(pilot: Pilot, told: Command, now: float) -> Pilot:
    """Read again the items that an order depends on, unless that was just done: a path its mission, a start all kinds.

    While a vehicle was held, or flew home, anybody may have changed its items.
    """
    if pilot.moving is not None and isinstance(pilot.moving.command, Hold | Return):
        return unsure(pilot)
    needed = [*MissionType] if not pilot.known.flying else []
    needed += [MissionType.MISSION] if isinstance(told, Follow) else []
    stale = [kind for kind in needed if now - pilot.survey.read.get(kind, now) > JUST_NOW]
    return unsure(pilot, stale, quiet=True) if stale else pilot


def is_surveyed(pilot: Believer) -> bool:
    """Return whether the vehicle's position and items on board are certain, or could not be read."""
    return pilot.known.position is not None and all(
        kind in pilot.on_board or kind in pilot.survey.given_up for kind in MissionType
    )


def out_of_fence(pilot: Believer, now: float) -> tuple[Report, ...]:
    """Report that a vehicle's return leads it out of its fence."""
    fence = pilot.craft.fence
    reasons = () if fence is None else beyond_fence(fence, pilot.known, pilot.on_board)
    return tuple(Trouble(pilot.craft.entity, now, "returns outside its fence", reason) for reason in reasons)


def overheard(pilot: Pilot, message: MavlinkMessage) -> Pilot:
    """Take a message between the vehicle and another station: drop the beliefs that it may change."""
    kinds = changed_by(message, pilot.system)
    return unsure(pilot, kinds, quiet=True) if kinds else pilot


def with_known(pilot: Pilot, known: Telemetry) -> Pilot:
    """Take on a state; if it shows a possible change of the items on board, they are read again."""
    before, pilot = pilot.known, changed(pilot, known=known)
    if known.boots != before.boots:
        return changed(pilot, on_board={}, survey=Survey(), questions=0)
    if known.profile is not None and known.mode == known.profile.auto != before.mode:
        pilot = _flies_it(pilot)
    if (known.total, known.numbers) == (before.total, before.numbers):
        return pilot
    own = _uploaded(pilot)  # an upload shows in the vehicle's numbers, too; it is read back at its end
    return unsure(pilot, tuple(kind for kind in _renumbered(pilot, before) if kind is not own), quiet=True)


def _flies_it(pilot: Pilot) -> Pilot:
    """Read again the mission that a vehicle now flies; drop the belief in it while the order is pending."""
    if _is_pending(pilot):
        return unsure(pilot, (MissionType.MISSION,), quiet=True)
    return changed(pilot, survey=surveys.soon(pilot.survey, MissionType.MISSION))


def about_to_fly(pilot: Pilot) -> Pilot:
    """Read again the mission that has just been set to its first item, before the vehicle flies it."""
    profile, known = pilot.known.profile, pilot.known
    if profile is None or known.mode == profile.auto:
        return pilot
    return unsure(pilot, (MissionType.MISSION,), quiet=True)


def _is_pending(pilot: Believer) -> bool:
    return pilot.moving is not None and not pilot.moving.accepted and not pilot.moving.over


def _renumbered(pilot: Believer, before: Telemetry) -> Iterator[MissionType]:
    """Yield the kinds that have changed on board, according to MISSION_CURRENT."""
    known, mission = pilot.known, pilot.on_board.get(MissionType.MISSION, ())
    first = known.profile is not None and known.profile.dialect.home_is_item
    if known.total not in (before.total, max(0, len(mission) - first)):
        yield MissionType.MISSION
    if known.numbers is not None and before.numbers is not None:
        pairs = zip(MissionType, known.numbers, before.numbers, strict=True)
        yield from (kind for kind, now, then in pairs if now != then)


def read_on(pilot: Pilot, message: MavlinkMessage, now: float) -> tuple[Pilot, tuple[MavlinkMessage, ...]]:
    """Pass an answer to the reading of the items on board."""
    if message.name not in surveys.ANSWERS or _uploads(pilot):
        return pilot, ()
    survey, sent, kind = surveys.hear(pilot.survey, message, now)
    pilot = changed(pilot, survey=survey)
    if kind is not None:
        pilot = found(pilot, kind, survey.found[kind])
    return pilot, sent


def begun(pilot: Pilot, step: Step | None) -> Pilot:
    """Remember an upload, and what was there before it."""
    if not isinstance(step, Load):
        return pilot
    known = pilot.uploads.get(step.kind, Unconfirmed(step.before))
    if step.items in known.attempts:
        return pilot
    attempts = (*known.attempts, step.items)[-MOST_ATTEMPTS:]
    return changed(pilot, uploads={**pilot.uploads, step.kind: Unconfirmed(known.before, attempts)})


def found(pilot: Pilot, kind: MissionType, items: Items) -> Pilot:
    """Take the items read back; an upload is over once they are its own, or somebody else's."""
    upload = pilot.uploads.get(kind)
    if upload is not None and (items in upload.attempts or not upload.explains(items)):
        pilot = changed(pilot, uploads={each: of for each, of in pilot.uploads.items() if each is not kind})
    return changed(pilot, on_board={**pilot.on_board, kind: items})


def kept(pilot: Believer) -> OnBoard:
    """Return the items on board, as they were before an upload of ours that was broken off."""
    return {kind: before_upload(items, pilot.uploads.get(kind)) for kind, items in pilot.on_board.items()}


def _uploads(pilot: Believer) -> bool:
    return _uploaded(pilot) is not None


def _uploaded(pilot: Believer) -> MissionType | None:
    """Return the kind of the items that we are uploading, or None."""
    task = pilot.moving
    if task is None or task.over or not isinstance(task.doing, Sync):
        return None
    return task.doing.kind


def surveyed(pilot: Pilot, now: float) -> tuple[Pilot, tuple[MavlinkMessage, ...]]:
    """Read the items on board a vehicle that obeys us, again from time to time, and more often those that it flies."""
    profile, known = pilot.known.profile, pilot.known
    if profile is None or _uploads(pilot):
        return pilot, ()
    mission = HEADING if _is_pending(pilot) else FLOWN if known.mode == profile.auto else NOW_AND_THEN
    every = {
        MissionType.MISSION: mission,
        MissionType.FENCE: NOW_AND_THEN / 2,
        MissionType.RALLY: NOW_AND_THEN,
    }
    survey, sent = surveys.tick(pilot.survey, every, pilot.on_board, pilot.system, now)
    return changed(pilot, survey=survey), sent
