"""A command in progress: its current step, its status, and its end."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import Final

from adapters.mavlink import command as telling
from adapters.mavlink import verified_upload as syncing
from adapters.mavlink.constants import Cmd, MissionType, Result
from adapters.mavlink.items import Items
from adapters.mavlink.loiter_circle import goal
from adapters.mavlink.message import MavlinkMessage
from adapters.mavlink.next_step import FollowsCommand, Load, Step, StepInput, Tell, Wait, passing
from adapters.plugin import Accepted, Arrived, Command, Follow, GoTo, Rejected, Report, Trouble
from physical import Geometry

PATIENCE: Final = 45.0
"""Seconds for one step, or for an upload without progress, while the vehicle is heard."""

BOOT_PATIENCE: Final = 120.0
"""Seconds for a vehicle to get ready: its filters settle, its receiver finds satellites."""


@dataclass(frozen=True, slots=True)
class Task:
    """A command in progress.

    Attributes:
        command: The command.
        station: For a HandOver, the system id of the station that gets the authority.
        height: Metres above the mission's home at which it is carried out, once known.
        above: Metres above sea level of that home, if commanded heights are above sea level.
        step: The current step.
        since: Time of the step's start, of the vehicle's return to the link, or of an upload's last progress.
        reached: The progress of an upload.
        doing: The step's exchange of messages.
        accepted: Whether the state has shown that the vehicle follows it.
        over: Whether it has arrived or was rejected.
        rejection: The reason of its rejection, if any.
        begun: Whether the mission was seen at its first item, or the vehicle has reported its resumption.
        resumes: Whether the path has moved: the vehicle continues with the current item.
        passed: The number of places of a path in which it was seen, in their order.
        furthest: The highest mission item at which it was seen since it began the mission.
        boots: The vehicle's number of boots for which this holds.
        checked: Whether it is possible for this kind of vehicle.
        surveyed: Whether it is possible with the items on board.
        complained: Whether a delay of this step was reported.
        waypoint: The point around which the vehicle will stay.
    """

    command: Command
    station: int = 0
    height: float | None = None
    above: float | None = None
    step: Step | None = None
    since: float = 0.0
    reached: tuple[int, int, int] = (0, 0, 0)
    doing: telling.RepeatedMessage | syncing.Sync | None = None
    accepted: bool = False
    over: bool = False
    rejection: str | None = None
    begun: bool = False
    resumes: bool = False
    passed: int = 0
    furthest: int = 0
    boots: int = 0
    checked: bool = False
    surveyed: bool = False
    complained: bool = False
    waypoint: Geometry | None = None


@dataclass(frozen=True, slots=True)
class Progress:
    """The progress of a task: messages to send, a report, and items confirmed on board."""

    task: Task
    sent: tuple[MavlinkMessage, ...] = ()
    report: Report | None = None
    on_board: Mapping[MissionType, Items] | None = None


def hear(task: Task, message: MavlinkMessage, now: float) -> Progress:
    """Pass a message from the vehicle to the current exchange."""
    if isinstance(task.doing, telling.RepeatedMessage):
        return Progress(replace(task, doing=telling.hear(task.doing, message)))
    if isinstance(task.doing, syncing.Sync):
        sync, sent = syncing.hear(task.doing, message, now)
        return Progress(replace(task, doing=sync), sent)
    return Progress(task)


def advance(task: Task, step: Step, vehicle: StepInput, *, lost: bool, now: float) -> Progress:
    """Pursue `step`, the first missing one."""
    task = _followed(task, vehicle, now)
    if isinstance(step, FollowsCommand):
        return _underway(task, step, now)
    if step != task.step:
        task = replace(
            task,
            begun=task.begun and not isinstance(step, Load),
            step=step,
            since=now,
            reached=(0, 0, 0),
            doing=_exchange(step, vehicle),
            complained=False,
        )
    if isinstance(task.doing, syncing.Sync) and task.doing.speaker != vehicle.speaker:
        # Handed over: the vehicle does not let another station continue an exchange.
        task = replace(task, since=now, reached=(0, 0, 0), doing=_exchange(step, vehicle))
    if isinstance(task.doing, syncing.Sync) and task.doing.reached != task.reached:
        grows = task.doing.reached > task.reached  # on a bad link an upload may begin again, and go on
        task = replace(task, since=now if grows else task.since, reached=task.doing.reached)
    if lost:
        return Progress(replace(task, since=now))
    if now - task.since > _patience(step):
        return rejected(task, _failure(step, task, vehicle) + vehicle.known.last_words(now), now)
    return _complained(_pursued(task, vehicle, now), vehicle, now)


def undone(task: Task, step: Step, boots: int) -> str:
    """Return the step that a vehicle with a completed command no longer shows, or an empty text."""
    if not task.accepted or boots != task.boots or isinstance(step, FollowsCommand | Wait):
        return ""
    if isinstance(step, Load):
        return f"the {step.what} on board is not the one sent: somebody has changed it"
    return f"it has left its task: it would need the command {step.why}"


def seen(task: Task, vehicle: StepInput) -> Task:
    """Record the places of its path that a vehicle passes, in their order, while it flies its mission."""
    flies = (task.begun or task.resumes) and vehicle.known.mode == vehicle.profile.auto
    if not isinstance(task.command, Follow) or not flies:
        return task
    passed = passing(task.command, vehicle)
    return task if passed == task.passed else replace(task, passed=passed)


def _complained(progress: Progress, vehicle: StepInput, now: float) -> Progress:
    """Report a vehicle's first temporary refusal: the command is repeated, and that may take a while."""
    task = progress.task
    no, step = "" if task.doing is None else task.doing.objection, task.step
    if not no or task.complained or progress.report or not isinstance(step, Tell | Load):
        return progress
    words = vehicle.known.last_words(now)
    was_told = f"was commanded {step.why}" if isinstance(step, Tell) else f"was sent its {step.what}"
    again = "the command is repeated for" if isinstance(step, Tell) else "the upload is repeated for at most"
    detail = f"it {was_told}, and answers {no}{words}; {again} {PATIENCE:.0f} s"
    report = Trouble(task.command.entity, now, "refused for now", detail)
    return replace(progress, task=replace(task, complained=True), report=report)


def rejected(task: Task, reason: str, now: float) -> Progress:
    """End a task without success."""
    command = task.command
    report = Rejected(command.request, command.entity, now, reason)
    return Progress(replace(task, over=True, rejection=reason), report=report)


def _followed(task: Task, vehicle: StepInput, now: float) -> Task:
    """Update the task from the vehicle's state."""
    known = vehicle.known
    if known.boots != task.boots:  # a reboot voids all progress
        task = replace(
            task,
            boots=known.boots,
            step=None,
            since=now,
            accepted=False,
            begun=False,
            resumes=False,
            passed=0,
            furthest=0,
        )
    if task.begun:
        return replace(task, furthest=max(task.furthest, known.current or 0))
    return replace(task, begun=True, furthest=0) if _begins(task, vehicle) else task


def _begins(task: Task, vehicle: StepInput) -> bool:
    """Return whether the vehicle is at the commanded item; if it was there before, only its answer shows this."""
    message = task.step.message if isinstance(task.step, Tell) else None
    if message is not None and message.name == "MISSION_SET_CURRENT":
        return bool(vehicle.known.current == message["seq"])
    asked = {} if message is None else message.fields
    if asked.get("command") != Cmd.SET_MISSION_CURRENT:
        return False
    if task.resumes:
        return isinstance(task.doing, telling.RepeatedMessage) and task.doing.answer == Result.ACCEPTED
    return vehicle.known.current == asked.get("param1")


def _underway(task: Task, step: FollowsCommand, now: float) -> Progress:
    if (task.step, task.doing) != (step, None):
        task = replace(task, step=step, doing=None, waypoint=step.waypoint)
    if step.done and not task.over:
        return Progress(replace(task, accepted=True, over=True), report=Arrived(*_shown(task, now)))
    if not task.accepted:
        return Progress(replace(task, accepted=True), report=accepted(task, now))
    return Progress(task)


def accepted(task: Task, now: float) -> Accepted:
    """Return the report that the vehicle visibly follows a command."""
    return Accepted(*_shown(task, now))


def _shown(task: Task, now: float) -> tuple[str, str, float, Geometry | None, Geometry | None]:
    """Return the common fields of the reports on a command that a vehicle follows."""
    command = task.command
    place = goal(command) if isinstance(command, GoTo | Follow) else None
    return command.request, command.entity, now, place, task.waypoint


def _exchange(step: Step, vehicle: StepInput) -> telling.RepeatedMessage | syncing.Sync | None:
    match step:
        case Tell():
            return telling.RepeatedMessage(step.message)
        case Load():
            ready = vehicle.known.armed is True or vehicle.known.healthy is True
            return syncing.begin(step.items, step.kind, vehicle.system, vehicle.speaker, ready=ready)
    return None


def _patience(step: Step) -> float:
    return BOOT_PATIENCE if isinstance(step, Wait) else PATIENCE


def _pursued(task: Task, vehicle: StepInput, now: float) -> Progress:
    refusal = task.doing.refusal if task.doing is not None else None
    if refusal:
        return rejected(task, refusal + vehicle.known.last_words(now), now)
    if isinstance(task.doing, telling.RepeatedMessage):
        told, sent = telling.tick(task.doing, now)
        return Progress(replace(task, doing=told), sent)
    if isinstance(task.doing, syncing.Sync):
        sync, sent = syncing.tick(task.doing, now)
        done = {sync.kind: sync.items} if sync.confirmed else None
        return Progress(replace(task, doing=sync), sent, on_board=done)
    return Progress(task)


def _failure(step: Step, task: Task, vehicle: StepInput) -> str:
    other = f"; {vehicle.deaf}" if vehicle.deaf else ""
    match step:
        case Wait():
            return f"{step.why}, for {_patience(step):.0f} s{other}"
        case Tell():
            no = task.doing.objection if isinstance(task.doing, telling.RepeatedMessage) else ""
            answer = f", but answered {no}" if no else ""
            return f"it was commanded {step.why}, and did not obey in {PATIENCE:.0f} s{answer}{other}"
        case Load():
            no = (
                f", but answered {task.doing.objection}"
                if task.doing is not None and task.doing.objection
                else ""
            )
            return f"the {step.what} could not be confirmed on board in {PATIENCE:.0f} s{no}{other}"
    raise AssertionError(step)
