"""The mission's commands to vehicles that are not confirmed yet: flights and hand-overs."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass, field, replace

from adapters.live.flown_ways import FlownWay
from adapters.plugin import Accepted, Arrived, Follow, GoTo, HandOver
from physical import Geometry, waypoint
from semantics.state.signature import Name


@dataclass(frozen=True, slots=True)
class GivenCommand:
    """A command to a vehicle that is not confirmed yet.

    Attributes:
        command: The last command.
        agent: The agent whose request it serves.
        since: Time of its first sending.
        obeyed: Whether the vehicle's last reports show that it follows the command.
        through: Whether the vehicle has reported the end of its path.
        refused: Whether it was refused.
        waypoint: The point around which the vehicle will stay, if it has reported one.
        begin: The point from which the command leads.
        passed: The number of VIA places that are certainly behind the vehicle.
    """

    command: GoTo | Follow | HandOver
    agent: Name
    since: float
    obeyed: bool = False
    through: bool = False
    refused: bool = False
    waypoint: Geometry | None = None
    begin: Geometry | None = None
    passed: int = 0

    @property
    def way(self) -> FlownWay | None:
        """The points to which the command sends the vehicle; None for a hand-over."""
        if isinstance(self.command, HandOver) or self.goal is None:
            return None
        path = (self.command.place,) if isinstance(self.command, GoTo) else self.command.path
        begin = () if self.begin is None else (self.begin,)
        points = (*begin, *map(waypoint, path[:-1]), self.waypoint or waypoint(path[-1]))
        passed = len(path) - 1 if self.through else self.passed
        return FlownWay(points, self.command.name, passed + len(begin))

    @property
    def goal(self) -> Geometry | None:
        """The last place of the command, at its position when it was sent."""
        match self.command:
            case GoTo(place=place):
                return place
            case Follow(path=path):
                return path[-1]
        return None


Given = Mapping[Name, GivenCommand]
"""A command for each of some vehicles."""


@dataclass(frozen=True, slots=True)
class Commanded:
    """The commands of a run to its vehicles.

    Attributes:
        flights: The unconfirmed command of each vehicle in flight.
        hand_overs: The unconfirmed hand-over of each vehicle.
        count: The number of commands given so far, also fallbacks and operators' orders.
        rests: For each vehicle that has arrived, the point around which it stays.
        begins: For each vehicle that was never sent, the mission's point for it.
    """

    flights: Given = field(default_factory=dict)
    hand_overs: Given = field(default_factory=dict)
    count: int = 0
    rests: Mapping[Name, FlownWay] = field(default_factory=dict)
    begins: Mapping[Name, Geometry] = field(default_factory=dict)

    @classmethod
    def resumed(cls, count: int, ways: Mapping[Name, FlownWay]) -> Commanded:
        """Return the commands of a resumed run but for flights: each vehicle has the first point of its last way."""
        begins = {name: way.end for name, way in ways.items() if len(way.points) == 1 and not way.to}
        rests = {name: FlownWay(way.points[:1], way.to) for name, way in ways.items() if name not in begins}
        return cls(count=count, rests=rests, begins=begins)

    def __iter__(self) -> Iterator[GivenCommand]:
        """Iterate over all commands that are not confirmed yet."""
        yield from self.flights.values()
        yield from self.hand_overs.values()

    def of(self, entity: Name) -> Iterator[GivenCommand]:
        """Yield the unconfirmed commands of a vehicle."""
        return (given[entity] for given in (self.flights, self.hand_overs) if entity in given)

    def serving(self, agent: Name) -> frozenset[Name]:
        """Return the vehicles with an unconfirmed command that serves a request of an agent."""
        both = (*self.flights.items(), *self.hand_overs.items())
        return frozenset(entity for entity, given in both if given.agent == agent)

    def counted(self) -> Commanded:
        """Return the value after one more command."""
        return replace(self, count=self.count + 1)

    def flying(self, entity: Name, given: GivenCommand) -> Commanded:
        """Return the value with the command of a flight."""
        begins = {name: at for name, at in self.begins.items() if name != entity}
        return replace(self, flights={**self.flights, entity: given}, begins=begins)

    def arrived(self, entities: Iterable[Name]) -> Commanded:
        """Return the value without the flights of some vehicles: each stays around its last point."""
        over = frozenset(entities)
        ways = {name: each.way for name, each in self.flights.items() if name in over}
        rests = {name: FlownWay((way.end,), way.to) for name, way in ways.items() if way is not None}
        flights = {name: each for name, each in self.flights.items() if name not in over}
        return replace(self, flights=flights, rests={**self.rests, **rests})

    def overridden(self, entities: Iterable[Name]) -> Commanded:
        """Return the value in which nothing is known of the points at which some vehicles stay."""
        lost = frozenset(entities)
        if lost.isdisjoint(self.rests) and lost.isdisjoint(self.begins):
            return self
        rests = {name: way for name, way in self.rests.items() if name not in lost}
        begins = {name: at for name, at in self.begins.items() if name not in lost}
        return replace(self, rests=rests, begins=begins)

    def progressed(self, entity: Name, at: Geometry, near: float) -> Commanded:
        """Return the value after a sighting of a vehicle, which may have passed places of its VIA."""
        given = self.flights.get(entity)
        if given is None or not isinstance(given.command, Follow) or given.begin is None or given.way is None:
            return self
        way = given.way.progressed(at, near)
        return (
            self
            if way is given.way or way.passed - 1 <= given.passed
            else self.flying(entity, replace(given, passed=way.passed - 1))
        )

    def handing_over(self, entity: Name, given: GivenCommand) -> Commanded:
        """Return the value with a hand-over."""
        return replace(self, hand_overs={**self.hand_overs, entity: given})

    def handed_over(self, entity: Name) -> Commanded:
        """Return the value without a vehicle's hand-over, which is confirmed or given up."""
        if entity not in self.hand_overs:
            return self
        rest = {name: each for name, each in self.hand_overs.items() if name != entity}
        return replace(self, hand_overs=rest)

    def obeyed(self, entity: Name, report: Accepted | Arrived) -> Commanded:
        """Return the value after a vehicle's report that it follows the command of a request, or has completed it.

        A report about a place that has moved since is ignored: the vehicle gets a new command.
        """
        given = self.flights.get(entity)
        if given is None or given.command.request != report.request:
            return self
        if report.place is not None and report.place != given.goal:
            return self
        through = given.through or isinstance(report, Arrived)
        waypoint = report.waypoint or given.waypoint
        return self.flying(entity, replace(given, obeyed=True, through=through, waypoint=waypoint))

    def doubted(self, entity: Name) -> Commanded:
        """Return the value in which it is unknown whether a vehicle still follows its command."""
        given = self.flights.get(entity)
        return self if given is None else self.flying(entity, replace(given, obeyed=False))

    def refused(self, entity: Name, request: str) -> Commanded:
        """Return the value after a vehicle has refused the command of a request."""

        def after(given: Given) -> Given:
            command = given.get(entity)
            if command is None or command.command.request != request:
                return given
            return {**given, entity: replace(command, obeyed=False, refused=True)}

        return replace(self, flights=after(self.flights), hand_overs=after(self.hand_overs))
