"""Robots of a ROS 2 graph as vehicles: positions in, goals out, by the Zenoh router of `rmw_zenoh`.

ROS has no message for a robot that follows a goal: its positions show it. It has none for *hold* and *return* either:
these are services in the address, else goals at the robot's position, or at its first one.
"""

from __future__ import annotations

import asyncio
import math
import re
import time
from collections.abc import Iterator
from dataclasses import dataclass, replace
from typing import Any, Final

from adapters.assigned import Assigned
from adapters.plugin import (
    Accepted,
    Aged,
    Arrived,
    Command,
    Follow,
    GiveBack,
    GoTo,
    Hold,
    LinkLost,
    LinkRestored,
    Refused,
    Rejected,
    Return,
    Status,
    World,
)
from adapters.rate_limit import Troubles
from adapters.ros.errand import Errand, moved, seen, waypoints
from adapters.ros.position_messages import (
    EMPTY,
    PATH,
    STAMPED,
    TRIGGER,
    TYPES,
    RosPosition,
    hash_of,
    read_answer,
    typestore,
    write_goal,
    write_path,
)
from adapters.ros.ros_node import REPORT, RouterLink, read_at, read_options
from adapters.ros.wire import NODE, UNHASHED, Publisher, Topic, attachment, gid_of, key_of, subscriptions_of
from physical import Geometry, PhysicalError, PhysicalProperty, circle, contains, point

STAYS: Final = 10.0
"""Metres around a point within which a robot that holds or returns counts as there."""

SILENCE: Final = 5.0
"""Seconds without a position after which a robot is lost."""

AGAIN: Final = 5.0
"""Seconds after which a goal is sent again that the robot does not follow."""

PATIENCE: Final = 60.0
"""Seconds in which a robot must be seen to follow."""

ANSWERED: Final = 5.0
"""Seconds in which a service must answer."""

MOST_TOKENS: Final = 1_000
OPTIONS: Final = ("at", "goal", "path", "hold", "return")
HINT: Final = (
    "write NAME=ros:tcp:HOST:PORT[?domain=N&at=TOPIC&goal=TOPIC&path=TOPIC&hold=SERVICE&return=SERVICE]"
)
TOPIC: Final = re.compile(r"/?[A-Za-z_][A-Za-z0-9_]*(/[A-Za-z_][A-Za-z0-9_]*)*")


@dataclass(slots=True)
class Robot:
    """A vehicle, its topics and services by the options' words, and its state."""

    assigned: Assigned
    names: dict[str, str]
    errand: Errand | None = None
    asked: Hold | Return | None = None
    newest: Command | None = None
    at: RosPosition | None = None
    home: Geometry | None = None
    heard: float | None = None
    told: float | None = None
    lost: bool = False


class RosVehicles:
    """A plugin that drives robots of ROS 2.

    Arguments:
        name: Its name in reports.
        address: The Zenoh router's, with options: see `HINT`.
        vehicles: The robots. A topic that does not begin with `/` is in the namespace of the robot's name.
    """

    def __init__(self, name: str, address: str, vehicles: tuple[Assigned, ...]) -> None:
        where, self._domain, options = read_options(address, OPTIONS, HINT)
        if where.scheme != "tcp":
            raise PhysicalError("address", f"{address!r:.100}: no robot is commanded there", HINT)
        self._name = name
        self._robots = {each.entity: Robot(each, _names(each.entity, options)) for each in vehicles}
        names = [topic for robot in self._robots.values() for topic in robot.names.values()]
        if twice := sorted({topic for topic in names if names.count(topic) > 1}):
            raise PhysicalError(
                "address", f"{twice[0]:.60} is given twice", "a name without / is in each robot's namespace"
            )
        self._troubles = Troubles(name)
        self._link = RouterLink(where, self._domain, self._troubles)
        self._tokens: set[str] = set()
        self._publishers: dict[Topic, Publisher] = {}
        self._calls: set[asyncio.Task[None]] = set()
        self._session: Any = None
        self.local: str | None = None
        """Our name in the graph, once the router has answered."""

    @property
    def name(self) -> str:
        """Its name in reports."""
        return self._name

    def owns(self, entity: str) -> bool:
        """Return whether it drives a vehicle."""
        return entity in self._robots

    async def command(self, command: Command) -> None:
        """Take on a command; raises Refused if this robot cannot carry it out."""
        robot = self._robots.get(command.entity)
        if robot is None:
            raise Refused(f"{command.entity} is none of the robots at {self._name}")
        match command:
            case GoTo() | Follow():
                _check(command, robot)
                same = robot.errand is not None and robot.errand.order.request == command.request
                robot.errand = moved(robot.errand, command) if robot.errand and same else Errand(command)
                robot.asked = None
            case Hold() | Return():
                word = type(command).__name__.lower()
                if word in robot.names:
                    robot.errand, robot.asked = None, command
                else:
                    robot.errand, robot.asked = Errand(_as_goal(command, robot)), None
            case GiveBack():
                return  # other senders' goals are not seen, so it was never taken over
            case _:
                raise Refused(f"{command.entity} speaks ROS, which has no {type(command).__name__}")
        robot.newest = command

    async def run(self, world: World) -> None:
        """Receive and send until cancelled."""
        typestore()  # report a missing extra at once
        topics = {robot.names["at"]: robot for robot in self._robots.values()}
        keys = [key_of(self._domain, Topic(at, each, "*")) for at in topics for each in TYPES]

        def take(topic: Topic, raw: bytes) -> None:
            robot = topics[topic.name]
            place = read_at(topic, raw, world.now(), robot.assigned.time_to_live)
            self._publish(world, robot, place)

        try:
            async with self._link.opened(keys, take) as self._session:
                kept = [self._listen(each) for each in self._subscribed()]
                self.local = str(self._session.zid())
                while kept:
                    await asyncio.sleep(REPORT)
                    self._link.report(world)
                    for robot in self._robots.values():
                        self._serve(world, robot)
        finally:
            for call in self._calls:
                call.cancel()
            self._session = self.local = None
            self._publishers.clear()
            self._tokens.clear()
            self._troubles.report(world, now=True)

    # --- messages of a robot ----------------------------------------------------------------------

    def _publish(self, world: World, robot: Robot, place: RosPosition) -> None:
        now, given, at = world.now(), robot.assigned, place.geometry
        robot.at, robot.home = place, robot.home or at
        if robot.lost:
            robot.lost = False
            world.report(LinkRestored(given.entity, now))
        robot.heard = now
        here = PhysicalProperty(
            given.entity, given.kind, at, channels=given.channels, time=place.time, source=self._name
        )
        world.publish(Aged(here, given.time_to_live))
        if robot.told is None or now - robot.told >= 1.0:
            robot.told = now
            world.report(Status(given.entity, now, self._name, heard=now, home=robot.home.vertices[0]))
        if robot.errand is not None and robot.errand.sent is not None:
            self._follow(world, robot, seen(robot.errand, at))

    def _follow(self, world: World, robot: Robot, errand: Errand) -> None:
        """Report the progress of an errand that a position shows."""
        before, robot.errand, order = robot.errand, errand, errand.order
        if errand.followed and not (before and before.followed):
            world.report(Accepted(order.request, order.entity, world.now()))
        if errand.done:
            world.report(Arrived(order.request, order.entity, world.now()))
            robot.errand = None

    # --- messages to a robot ----------------------------------------------------------------------

    def _serve(self, world: World, robot: Robot) -> None:
        """Update whether a robot is lost; send the goal that it does not follow yet."""
        now, entity = world.now(), robot.assigned.entity
        silent = robot.heard is not None and now - robot.heard >= SILENCE
        if robot.heard is not None and not robot.lost and (silent or not self._link.is_reached()):
            robot.lost = True
            world.report(LinkLost(entity, now, robot.heard))
        if robot.errand is not None:
            self._send(world, robot, robot.errand)
        if robot.asked is not None:
            call = asyncio.ensure_future(self._ask(world, robot, robot.asked))
            robot.asked = None
            self._calls.add(call)
            call.add_done_callback(self._calls.discard)

    def _send(self, world: World, robot: Robot, errand: Errand) -> None:
        now, order = world.now(), errand.order
        if errand.sent is None:
            errand = replace(errand, began=now)
        elif errand.followed or now - errand.sent < AGAIN:
            return
        elif now - errand.began >= PATIENCE:
            robot.errand = None
            reason = self._objection(robot, order) or "it does not come nearer to its destination"
            world.report(Rejected(order.request, order.entity, now, reason))
            return
        robot.errand = replace(errand, sent=now)
        if objection := self._objection(robot, order):
            self._troubles.note("no robot accepts the goal", objection)
        height = math.nan if robot.at is None else robot.at.height
        raw = (
            write_goal(*waypoints(order)[0], now, height)
            if isinstance(order, GoTo)
            else write_path(waypoints(order), now, height)
        )
        for topic in self._takers(robot, order):
            if topic not in self._publishers:
                number = len(self._publishers) + 1  # the node is number 0
                self._publishers[topic] = Publisher(self._session, self._domain, topic, number, lasts=False)
            self._publishers[topic].put(raw)

    async def _ask(self, world: World, robot: Robot, command: Hold | Return) -> None:
        """Call a service, and report its answer."""
        service = robot.names[type(command).__name__.lower()]
        try:
            done, reason = await asyncio.to_thread(_called, self._session, self._domain, service)
        except PhysicalError as problem:
            done, reason = False, problem.message
        if robot.newest is not command:
            return  # another command has replaced it
        if not done:
            world.report(Rejected(command.request, command.entity, world.now(), f"{service}: {reason:.200}"))
            return
        world.report(Accepted(command.request, command.entity, world.now()))
        if isinstance(command, Hold):
            world.report(Arrived(command.request, command.entity, world.now()))

    # --- subscribers ------------------------------------------------------------------------------

    def _subscribed(self) -> Iterator[str]:
        for robot in self._robots.values():
            yield subscriptions_of(self._domain, robot.names["goal"], STAMPED)
            yield subscriptions_of(self._domain, robot.names["path"], PATH)

    def _listen(self, tokens: str) -> Any:
        """Track the subscribers of a topic."""

        def changed(sample: Any) -> None:  # in a thread of Zenoh
            token = str(sample.key_expr)
            if "PUT" not in str(sample.kind):
                self._tokens.discard(token)
            elif len(self._tokens) < MOST_TOKENS:
                self._tokens.add(token)

        return self._session.liveliness().declare_subscriber(tokens, changed, history=True)

    def _takers(self, robot: Robot, order: GoTo | Follow) -> list[Topic]:
        """Return a goal's topic once for each subscribed hash of its type that is ours, or ROS 2 Humble's."""
        name, kind = _goal_of(robot, order)
        hashes = {token.split("/")[-2] for token in tuple(self._tokens) if f"/{_mangled(name)}/" in token}
        return [Topic(name, kind, each) for each in sorted(hashes & {hash_of(kind), UNHASHED})]

    def _objection(self, robot: Robot, order: GoTo | Follow) -> str:
        """Return an objection if a goal has no subscriber, else an empty text."""
        name, kind = _goal_of(robot, order)
        return "" if self._takers(robot, order) else f"no node subscribes to {name} as {kind}"


def _as_goal(command: Hold | Return, robot: Robot) -> GoTo:
    """Return a goal for a hold or return, which ROS lacks; raises Refused for a robot without a position."""
    if robot.at is None or robot.home is None:
        raise Refused(f"{command.entity} was not heard yet")
    where = robot.home if isinstance(command, Return) else robot.at.geometry
    return GoTo(command.request, command.entity, circle(where.vertices[0], STAYS))


def _goal_of(robot: Robot, order: GoTo | Follow) -> tuple[str, str]:
    return (robot.names["goal"], STAMPED) if isinstance(order, GoTo) else (robot.names["path"], PATH)


def _mangled(name: str) -> str:
    return name.replace("/", "%")


def _names(entity: str, options: dict[str, str]) -> dict[str, str]:
    """Return the names of a robot's topics and services; raises PhysicalError."""
    defaults = {"at": "fix", "goal": f"/{NODE}/{entity}/goal", "path": f"/{NODE}/{entity}/path"}
    names = defaults | options
    for word, name in names.items():
        if not TOPIC.fullmatch(name):
            raise PhysicalError("address", f"{word}={name!r:.60} is no name that ROS allows", HINT)
    return {word: name if name.startswith("/") else f"/{entity}/{name}" for word, name in names.items()}


def _check(order: GoTo | Follow, robot: Robot) -> None:
    """Refuse orders that a robot cannot carry out, and places outside its fence."""
    fence, entity = robot.assigned.fence, robot.assigned.entity
    if order.altitude is not None:
        raise Refused(
            f"{entity} cannot be sent to a height: ROS heights are above the ellipsoid, the mission's above sea level"
        )
    if fence is not None and not all(contains(fence, point(*each)) for each in waypoints(order)):
        raise Refused(f"{order.name or 'the way'} is outside the fence of {entity}")


def _called(session: Any, domain: int, service: str) -> tuple[bool, str]:
    """Call a Trigger, under any hash of its type; raises PhysicalError."""
    key = key_of(domain, Topic(service, TRIGGER, "*"))
    told = attachment(1, time.time_ns(), gid_of(f"{session.zid()}{service}"))
    try:
        answers = list(session.get(key, payload=EMPTY, attachment=told, timeout=ANSWERED))
    except Exception as error:  # Zenoh's
        raise PhysicalError("ros", f"{error!s:.200}") from error
    for answer in answers:
        if answer.ok is not None:
            return read_answer(answer.ok.payload.to_bytes())
    return False, "no such service answers"
