"""The ground station's state of one vehicle: takes messages and time, yields messages, properties and reports.

A pure state machine: no socket, no clock, no randomness.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field, replace
from functools import partial
from typing import Final

from adapters.mavlink import inventory, next_step, streams, takeover
from adapters.mavlink import item_polling as surveys
from adapters.mavlink import task as tasks
from adapters.mavlink.command import long, read_parameter
from adapters.mavlink.constants import AUTHORITY_PARAMETERS, AUTOPILOT_VERSION, REGULAR, Cmd, MissionType
from adapters.mavlink.item_merging import OnBoard, Unconfirmed
from adapters.mavlink.item_polling import Survey
from adapters.mavlink.link_loss import LinkState, watch
from adapters.mavlink.loiter_circle import circle, home_circle, room
from adapters.mavlink.message import MavlinkMessage, changed
from adapters.mavlink.objections import not_ours, objection
from adapters.mavlink.profiles import Profile, TakeOff, unknown_kind
from adapters.mavlink.streams import Streams
from adapters.mavlink.takeover import Helm
from adapters.mavlink.task import Progress, Task
from adapters.mavlink.telemetry import Telemetry, VehiclePosition, absorb, property_of, waited
from adapters.mavlink.vehicle_faults import FaultState, look
from adapters.mavlink.vehicle_identities import CONTROL, Craft, Stations
from adapters.mavlink.verified_upload import Sync
from adapters.plugin import (
    Aged,
    Command,
    Doubted,
    Follow,
    GiveBack,
    GoTo,
    HandOver,
    Hold,
    LinkRestored,
    Refused,
    Report,
    Return,
    Status,
    StatusText,
    TakenOver,
    Trouble,
)

AUTHORITY_UNKNOWN: Final = 10.0
"""Seconds after which a vehicle is published although its authority is unknown."""

STATUS_EVERY: Final = 1.0
ASK_AUTHORITY: Final = 1.0
CHECK_AUTHORITY: Final = 5.0

UNANSWERED: Final = 8
"""Unanswered questions after which a likely reason is reported; even a bad link passes one of them."""

MOST_QUESTIONS: Final = 10
"""Requests for a vehicle's parameters, one a second: it never answers for a parameter that it lacks."""

_ANSWERS: Final = frozenset(
    {
        "COMMAND_ACK",
        "MISSION_ACK",
        "MISSION_COUNT",
        "MISSION_ITEM_INT",
        "MISSION_REQUEST",
        "MISSION_REQUEST_INT",
    }
)

_SLOTS: Final = ("hand_over", "moving")

Shown = tuple[VehiclePosition | None, int | None, bool]
"""The basis of the last publication: position, authority, whether the link was lost."""


@dataclass(frozen=True)  # no slots: `changed`
class Pilot:
    """A ground station's state of one vehicle.

    Attributes:
        craft: Its description in the mission.
        stations: The stations that may command it.
        system: Its MAVLink system id.
        signs: Whether messages to it are signed.
        known: Its state according to its messages.
        link: The state of its link.
        streams: The messages requested of it.
        on_board: The missions, fences and rally points read back since anybody may have changed them.
        survey: The reading of the items on board.
        uploads: The uploads that were begun and are not confirmed.
        moving: The command that it carries out.
        hand_over: The hand-over in progress.
        helm: Whether it follows its orders.
        asked: Time of the last request for its authority.
        unanswered: The number of requests for it since the last answer.
        questions: The number of requests for its parameters since it booted.
        since: Time of its first position.
        shown: The basis of the last publication.
        status: Its last reported status.
        condition: The troubles of its position and home, with those already reported.
    """

    craft: Craft
    stations: Stations
    system: int
    signs: bool = False
    known: Telemetry = field(default_factory=Telemetry)
    link: LinkState = field(default_factory=LinkState)
    streams: Streams = field(default_factory=Streams)
    on_board: OnBoard = field(default_factory=dict)
    survey: Survey = field(default_factory=Survey)
    uploads: Mapping[MissionType, Unconfirmed] = field(default_factory=dict)
    moving: Task | None = None
    hand_over: Task | None = None
    helm: Helm = field(default_factory=Helm)
    asked: float | None = None
    unanswered: int = 0
    questions: int = 0
    since: float | None = None
    shown: Shown = (None, None, False)
    status: Status | None = None
    condition: FaultState = field(default_factory=FaultState)


@dataclass(frozen=True)  # no slots: `changed`
class Outcome:
    """The results of one input; `seen` are reports for people alone."""

    pilot: Pilot
    sent: tuple[MavlinkMessage, ...] = ()
    reports: tuple[Report, ...] = ()
    published: tuple[Aged, ...] = ()
    seen: tuple[Status | StatusText, ...] = ()


def command(pilot: Pilot, told: Command, now: float) -> Outcome:
    """Take on a command; raises Refused if it is known to be impossible."""
    if isinstance(told, GiveBack):
        pilot = inventory.unsure(pilot)
        return Outcome(changed(pilot, helm=takeover.given_back(pilot.known), moving=None))
    if pilot.helm.taken:
        raise Refused(f"it was taken over: {pilot.helm.taken}", "an operator may give it back")
    reason = objection(told, pilot.craft, pilot.stations, pilot.known, inventory.kept(pilot))
    if reason and isinstance(told, Hold | Return):
        return _stops_in_vain(pilot, told, reason, now)
    if reason:
        raise Refused(reason)
    _check_not_rejected(pilot.moving, told)
    checked = pilot.known.profile is not None
    if isinstance(told, HandOver):
        station = pilot.stations.ids[told.join.removeprefix(CONTROL)]
        task = Task(told, station, since=now, boots=pilot.known.boots, checked=checked, surveyed=True)
        return Outcome(changed(pilot, hand_over=task))
    outside = () if not isinstance(told, Return) else inventory.out_of_fence(pilot, now)
    if isinstance(told, Hold | Return):
        pilot = changed(pilot, hand_over=None)  # a vehicle that stops stays ours
    elif not _continues(pilot.moving, told):
        pilot = inventory.read_again(pilot, told, now)
    surveyed = inventory.is_surveyed(pilot) or isinstance(told, Hold | Return)
    task = Task(told, since=now, boots=pilot.known.boots, checked=checked, surveyed=surveyed)
    return Outcome(changed(pilot, moving=_continued(pilot.moving, task)), reports=outside)


def _stops_in_vain(pilot: Pilot, told: Hold | Return, reason: str, now: float) -> Outcome:
    """Reject an order to stop; the command that it was to end does not resume if the vehicle obeys us again."""
    ended = tasks.rejected(Task(told, since=now, boots=pilot.known.boots), reason, now)
    reports = () if ended.report is None else (ended.report,)
    return Outcome(changed(pilot, moving=ended.task, hand_over=None), reports=reports)


def _check_not_rejected(before: Task | None, told: Command) -> None:
    """Refuse a rejected request again: a moving place must not take a vehicle back from its pilot.

    An order to stop stays due until it is done.
    """
    if isinstance(told, Hold | Return):
        return
    if before is not None and before.rejection and before.command.request == told.request:
        raise Refused(f"the request was rejected: {before.rejection}", "request it again")


def _continues(before: Task | None, told: Command) -> bool:
    """Return whether a command is the earlier one with a moved place."""
    if before is None or before.command.request != told.request:
        return False
    return isinstance(told, Follow) or not before.over


def _continued(before: Task | None, task: Task) -> Task:
    """Continue a task whose place has moved: it keeps its start, and a path continues with the current item."""
    follows = isinstance(task.command, Follow)
    if before is None or not _continues(before, task.command):
        return task
    return replace(
        task,
        height=before.height,
        above=before.above,
        begun=before.begun and not follows,
        resumes=before.resumes or (before.begun and follows),
        passed=before.passed,
        boots=before.boots,
    )


def hear(pilot: Pilot, message: MavlinkMessage, now: float) -> Outcome:
    """Take a message of the vehicle to us, or to all."""
    return _with_its_words(_heard(pilot, message, now), now)


def _heard(pilot: Pilot, message: MavlinkMessage, now: float) -> Outcome:
    before, known = pilot.known, absorb(pilot.known, message, now)
    pilot = inventory.with_known(pilot, known)
    pilot = changed(pilot, streams=streams.hear(pilot.streams, message, now))
    pilot, answered = inventory.read_on(pilot, message, now)
    if known.position is not before.position:
        pilot = _with_passed(pilot, now)
    if message.name in _ANSWERS and pilot.moving is not None and not pilot.moving.over:
        heard = tasks.hear(pilot.moving, message, now)
        pilot, answered = changed(pilot, moving=heard.task), (*answered, *heard.sent)
    elif message.name != "HEARTBEAT":  # a take-over shows at once
        pilot, published, trouble = _publication(pilot, now)
        return Outcome(pilot, _spoken(pilot, answered), trouble, published)  # tasks continue at the next tick
    outcome = _advance(pilot, now)
    return changed(outcome, sent=_spoken(pilot, (*answered, *outcome.sent)))


def _with_passed(pilot: Pilot, now: float) -> Pilot:
    """Record the place of its path that a vehicle is in."""
    task, profile = pilot.moving, pilot.known.profile
    if task is None or profile is None or not pilot.helm.held or not isinstance(task.command, Follow):
        return pilot
    return changed(pilot, moving=tasks.seen(task, _vehicle(pilot, task, profile, now)))


def tick(pilot: Pilot, now: float) -> Outcome:
    """Advance to the time `now`."""
    pilot = changed(pilot, known=waited(pilot.known, now))
    return _with_its_words(_ticked(pilot, now), now)


def _ticked(pilot: Pilot, now: float) -> Outcome:
    link, change = watch(pilot.link, pilot.craft.entity, pilot.known, now)
    pilot = changed(pilot, link=link)
    if isinstance(change, LinkRestored):
        pilot = inventory.unsure(pilot, quiet=True)
    questions: tuple[MavlinkMessage, ...] = ()
    before = pilot.unanswered
    if pilot.known.heard is not None and not link.lost:
        pilot, questions = _asked(pilot, now)
        if _authority(pilot) is not None and _is_ours(pilot):
            pilot, more = inventory.surveyed(pilot, now)
            questions = (*questions, *more)
    condition, noticed = look(pilot.condition, pilot.craft.entity, pilot.known, now, lost=link.lost)
    pilot = changed(pilot, condition=condition)
    outcome = _advance(pilot, now)
    reports = (*(() if change is None else (change,)), *noticed, *outcome.reports)
    if before < UNANSWERED <= pilot.unanswered and pilot.known.signs and not pilot.signs:
        reports = (*reports, Trouble(pilot.craft.entity, now, "no answer", _deaf(pilot)))
    return changed(outcome, sent=_spoken(pilot, (*questions, *outcome.sent)), reports=reports)


def _with_its_words(outcome: Outcome, now: float) -> Outcome:
    """Add the vehicle's texts, and its status once a second while it is heard."""
    pilot, known = outcome.pilot, outcome.pilot.known
    entity, before = pilot.craft.entity, pilot.status
    seen: list[Status | StatusText] = [
        StatusText(entity, now, each.text, each.severity) for each in known.texts
    ]
    if known.texts:
        pilot = changed(pilot, known=replace(known, texts=()))
    if known.heard is not None and (before is None or now - before.time >= STATUS_EVERY):
        status = _status(pilot, now)
        if before is None or replace(status, time=before.time) != before:
            pilot, seen = changed(pilot, status=status), [*seen, status]
    return changed(outcome, pilot=pilot, seen=tuple(seen)) if seen else outcome


def _status(pilot: Pilot, now: float) -> Status:
    known, authority = pilot.known, _authority(pilot)
    profile = None if known.mode is None else known.profile
    surface = profile is not None and profile.takeoff is TakeOff.NONE
    station = pilot.stations.name_of(authority) or f"system {authority}"
    return Status(
        pilot.craft.entity,
        now,
        heard=known.heard,
        mode=None if profile is None else profile.mode_name(known.mode),
        armed=known.armed,
        battery=known.battery,
        heading=known.heading,
        authority=() if authority is None else (station,),
        height=None if known.position is None or surface else known.position.height,
        home=known.home,
        returning=None if profile is None else known.mode == profile.home,
        lacks=known.lacks(now),
        follows=None if profile is None else known.flying and known.mode == profile.auto,
        surface=surface,
    )


def _asked(pilot: Pilot, now: float) -> tuple[Pilot, tuple[MavlinkMessage, ...]]:
    """Request missing messages, the vehicle's authority, and its parameters."""
    profile = pilot.known.profile
    wanted = REGULAR if profile is None else profile.dialect.streams
    flow, missing = streams.tick(pilot.streams, pilot.system, now, (*wanted, *pilot.craft.streams))
    pilot = changed(pilot, streams=flow)
    unsure = _authority(pilot) is None or (pilot.hand_over is not None and not pilot.hand_over.over)
    more = () if _authority(pilot) is None else tuple(_untold(pilot))
    every = ASK_AUTHORITY if unsure or more else CHECK_AUTHORITY
    if pilot.asked is not None and now - pilot.asked < every:
        return pilot, missing
    unanswered = pilot.unanswered + 1 if _authority(pilot) is None else 0
    pilot = changed(pilot, asked=now, unanswered=unanswered, questions=pilot.questions + bool(more))
    return pilot, (*missing, *_who_commands(pilot), *more)


def _who_commands(pilot: Pilot) -> tuple[MavlinkMessage, ...]:
    """Ask as each station: a vehicle may answer only the one that it obeys, and its last answer may be lost."""
    known, profile = pilot.known.authority_parameter, pilot.known.profile
    possible = AUTHORITY_PARAMETERS if profile is None else profile.dialect.authority
    names = possible if known is None else (known,)
    asked = (read_parameter(pilot.system, name) for name in names)
    return tuple(
        replace(each, system=pilot.stations.ids[name]) for each in asked for name in pilot.stations.own
    )


def _untold(pilot: Pilot) -> Iterator[MavlinkMessage]:
    """Yield requests for a vehicle's missing parameters, as long as it may answer."""
    known = pilot.known
    if known.profile is None or pilot.questions >= MOST_QUESTIONS:
        return
    for name in known.profile.parameters:
        if name not in known.parameters:
            yield read_parameter(pilot.system, name)
    if known.version is None:
        yield long(Cmd.REQUEST_MESSAGE, pilot.system, AUTOPILOT_VERSION)


def is_known(pilot: Pilot) -> bool:
    """Return whether the vehicle's parameters and items on board have come, or were requested long enough."""
    told = (pilot.known.profile, pilot.known.home, pilot.known.position)
    known = all(each is not None for each in told)
    return known and not any(_untold(pilot)) and (pilot.survey.settled or not _is_ours(pilot))


def _spoken(pilot: Pilot, sent: tuple[MavlinkMessage, ...]) -> tuple[MavlinkMessage, ...]:
    speaker = pilot.stations.speaker(_authority(pilot))
    return tuple(message if message.system else replace(message, system=speaker) for message in sent)


def _advance(pilot: Pilot, now: float) -> Outcome:
    """Update the helm, advance the tasks, and publish changes."""
    pilot, lost = _watched(pilot, now)
    sent: list[MavlinkMessage] = []
    reports: list[Report] = [*lost]
    for slot in _SLOTS if pilot.helm.held else ():
        task: Task | None = getattr(pilot, slot)
        if task is None or task.over:
            continue
        progress = _progress(pilot, task, now)
        pilot = inventory.begun(pilot, progress.task.step)
        for kind, items in (progress.on_board or {}).items():
            survey = surveys.settle(pilot.survey, kind, items, now)
            pilot = inventory.found(changed(pilot, survey=survey), kind, items)
        pilot = _onwards(pilot, slot, progress.task)
        if progress.task.begun and not task.begun:
            pilot = inventory.about_to_fly(pilot)
        sent += progress.sent
        reports += [progress.report] if progress.report else []
    pilot, published, trouble = _publication(pilot, now)
    return Outcome(pilot, tuple(sent), (*reports, *trouble), published)


def _watched(pilot: Pilot, now: float) -> tuple[Pilot, tuple[Report, ...]]:
    """Update whether the vehicle follows its orders; a take-over ends its commands."""
    profile, known = pilot.known.profile, pilot.known
    if profile is None:
        return pilot, ()
    if not _is_ours(pilot):
        pilot = inventory.unsure(pilot, quiet=True) if pilot.on_board else pilot
        return changed(pilot, helm=Helm(boots=known.boots)), ()
    command = None if pilot.moving is None else pilot.moving.command
    undone = _undone(pilot, profile, now)
    helm = takeover.watch(pilot.helm, known, profile, command, undone, pilot.on_board)
    before, pilot = pilot.helm, changed(pilot, helm=helm)
    if helm.taken and not before.taken:
        return _taken_over(pilot, now)
    if helm.held and not before.held:
        pilot = inventory.unsure(pilot, quiet=True)  # the other controller may have changed more
    return pilot, tuple(_changes(pilot, before, now))


def _changes(pilot: Pilot, before: Helm, now: float) -> Iterator[Report]:
    """Yield a report when the vehicle's command becomes doubtful, or certain again."""
    entity, task = pilot.craft.entity, pilot.moving
    if before.held and not pilot.helm.held:
        yield Doubted(entity, now)
    elif pilot.helm.held and not before.held and task is not None and task.accepted:
        yield tasks.accepted(task, now)


def _undone(pilot: Pilot, profile: Profile, now: float) -> str:
    """Return the part of its completed commands that the vehicle no longer carries out."""
    task = pilot.moving
    if task is None or not task.accepted:
        return ""
    step = next_step.next_step(task.command, task.station, _vehicle(pilot, task, profile, now))
    return tasks.undone(task, step, pilot.known.boots)


def _taken_over(pilot: Pilot, now: float) -> tuple[Pilot, tuple[Report, ...]]:
    """End the vehicle's commands: its actions from now on are not ours. The reason begins with its own words."""
    said = pilot.known.said(now)
    reason = f"it said {said}; {pilot.helm.taken}" if said else pilot.helm.taken
    pilot = changed(pilot, helm=replace(pilot.helm, taken=reason))
    reports: list[Report] = [TakenOver(pilot.craft.entity, now, reason)]
    for slot in _SLOTS:
        task: Task | None = getattr(pilot, slot)
        if task is not None and not task.over:
            ended = tasks.rejected(task, reason, now)
            pilot = _onwards(pilot, slot, ended.task)
            reports += [ended.report] if ended.report else []
    return pilot, tuple(reports)


def _authority(pilot: Pilot) -> int | None:
    return pilot.stations.obeyed(pilot.known.authority, pilot.known.profile)


def _is_ours(pilot: Pilot) -> bool:
    """Return whether we report on a vehicle; if its authority is unknown, only if we have commanded it."""
    stations, authority = pilot.stations, _authority(pilot)
    if authority is None:
        return set(stations.own) == set(stations.ids) or bool(pilot.helm.modes)
    return stations.name_of(authority) in stations.own


def _onwards(pilot: Pilot, slot: str, task: Task) -> Pilot:
    return changed(pilot, hand_over=task) if slot == "hand_over" else changed(pilot, moving=task)


def _progress(pilot: Pilot, task: Task, now: float) -> Progress:
    profile = pilot.known.profile
    if profile is None or pilot.known.mode is None:  # not heard yet, or of a kind that can't be commanded
        return _unknown(pilot, task, now)
    if not (task.checked and task.surveyed):
        judge = partial(
            objection, task.command, pilot.craft, pilot.stations, pilot.known, inventory.kept(pilot)
        )
        reason = judge(again=task.checked)
        if reason:
            return tasks.rejected(task, reason, now)
        task = replace(task, checked=True, surveyed=inventory.is_surveyed(pilot))
    foreign = not_ours(pilot.stations, pilot.known)
    if foreign and isinstance(task.doing, Sync):  # a task that was begun can't be ended here
        return tasks.rejected(task, foreign, now)
    task = _with_height(pilot, task)
    vehicle = _vehicle(pilot, task, profile, now)
    step = next_step.next_step(task.command, task.station, vehicle)
    return tasks.advance(task, step, vehicle, lost=pilot.link.lost, now=now)


def _vehicle(pilot: Pilot, task: Task, profile: Profile, now: float) -> next_step.StepInput:
    return next_step.StepInput(
        system=pilot.system,
        known=pilot.known,
        profile=profile,
        on_board=pilot.on_board,
        uploads=pilot.uploads,
        fence=pilot.craft.fence,
        circle=circle(pilot.craft, profile, pilot.known),
        home_circle=home_circle(pilot.craft, profile, pilot.known),
        room=room(pilot.craft, profile, pilot.known),
        height=task.height or 0.0,
        above=task.above,
        lacks=pilot.known.lacks(now),
        begun=task.begun,
        resumes=task.resumes,
        passed=task.passed,
        furthest=task.furthest,
        speaker=pilot.stations.speaker(_authority(pilot)),
        deaf=_deaf(pilot),
    )


def _deaf(pilot: Pilot) -> str:
    """Return a likely reason why a vehicle does not answer us, or an empty text."""
    if _authority(pilot) is not None:
        return ""
    if pilot.known.signs and not pilot.signs:
        return "it asks for signed packets: give its key, --key FILE"
    return "it does not report which station it obeys: it may obey another"


def _unknown(pilot: Pilot, task: Task, now: float) -> Progress:
    sort = pilot.known.sort
    if pilot.known.mode is None or sort is None or now - task.since <= takeover.STRANGE:
        return Progress(task)
    return tasks.rejected(task, unknown_kind(*sort), now)


def _with_height(pilot: Pilot, task: Task) -> Task:
    """Fix the height of a task as soon as the vehicle's own position allows.

    The commanded height is above sea level for a band, and whenever the vehicle's home has been moved.
    """
    known, profile, position = pilot.known, pilot.known.profile, pilot.known.position
    if task.height is not None or profile is None or position is None:
        return task
    band = task.command.altitude if isinstance(task.command, GoTo | Follow) else None
    height = next_step.height_of(band, profile, known, position, pilot.craft.height_of(profile))
    fixed = (band is not None or known.home_moved) and profile.takeoff is not TakeOff.NONE
    return replace(task, height=height, above=known.datum if fixed else None)


def _publication(pilot: Pilot, now: float) -> tuple[Pilot, tuple[Aged, ...], tuple[Report, ...]]:
    """Publish the vehicle if any published value has changed."""
    position, authority = pilot.known.position, _authority(pilot)
    if position is None or pilot.known.profile is None:  # a run begins when the kinds are known
        return changed(pilot, since=None), (), ()
    if pilot.since is None:
        pilot = changed(pilot, since=now)
    shown = (position, authority, pilot.link.lost)
    untold = authority is None and not pilot.link.lost
    if shown == pilot.shown or (untold and now - (pilot.since or now) < AUTHORITY_UNKNOWN):
        return pilot, (), ()
    differs = pilot.shown[1:] != shown[1:]
    trouble = _authority_trouble(pilot, now) if differs and not pilot.link.lost else ()
    said = property_of(pilot.craft, position, _channels(pilot))
    published = Aged(said, pilot.craft.time_to_live, pilot.known.placed or None)
    return changed(pilot, shown=shown), (published,), trouble


def _channels(pilot: Pilot) -> tuple[str, ...]:
    """Return the channels of the vehicle: none while it is not heard."""
    if pilot.link.lost:
        return ()
    station = pilot.stations.name_of(_authority(pilot)) if pilot.stations.in_mission else None
    authority = () if station is None else (CONTROL + station,)
    return (*pilot.craft.channels, *authority)


def _authority_trouble(pilot: Pilot, now: float) -> tuple[Report, ...]:
    authority = _authority(pilot)
    if pilot.stations.name_of(authority) is not None:
        return ()
    entity = pilot.craft.entity
    if authority is None:
        return (Trouble(entity, now, "authority not reported", _deaf(pilot)),)
    parameter = pilot.known.authority_parameter
    by = "" if parameter is None else f" ({parameter})"
    which = f"{entity} obeys system {authority}{by}, which is no station of the mission"
    remedy = "add it to the stations" + (
        "" if parameter is None else f", or set {parameter} to the id of one"
    )
    detail = f"{which}; {remedy}"
    return (Trouble(entity, now, "unknown authority", detail),)
