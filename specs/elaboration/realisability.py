"""The control phase: controls that can never be executed, as far as the text shows."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass, field
from typing import Final

from physical import Geometry, PhysicalError, area, band_contains, nearest_placement
from semantics.behaviours.commands import COMMANDS, HOST, Command
from semantics.behaviours.expressions import Expression, Host, Literal
from semantics.behaviours.reaction_rules import NodeVariable, PlaceTerm
from semantics.state.physical_model import Placed
from specs import syntax as s
from specs.codes import Code
from specs.elaboration.bodies import Bodies, body_key, possible_hosts
from specs.elaboration.mission_mistakes import a
from specs.elaboration.mobility import Mobility
from specs.elaboration.names import Names
from specs.elaboration.rule_schemas import Schema
from specs.elaboration.statements import ControlSite
from specs.elaboration.world import InitialWorld

MOST_HOSTS: Final = 50
"""The most possible hosts of a bigActor whose controls are checked; with more, only runs check them."""

MOST_HOLES: Final = 50
"""The most smaller places that are considered when fitting a node; with more, only runs check the fit."""


@dataclass(frozen=True, slots=True)
class Someone:
    """The known facts about a node: its name, only its kind, or neither."""

    kind: str | None
    name: str | None = None

    @property
    def shown(self) -> str:
        """The node in a message."""
        return f"'{self.name}'" if self.name is not None else a(self.kind or "node")


@dataclass(frozen=True, slots=True)
class Ground:
    """The known facts about the initial world.

    Attributes:
        names: The declarations of the mission.
        world: Its entities.
        mobility: Its moving entities.
        fixed: The entities whose place never changes.
        holes: For a kind and a place, the smaller places in reach that may contain such a node instead, once computed.
    """

    names: Names
    world: InitialWorld
    mobility: Mobility
    fixed: frozenset[str]
    holes: dict[tuple[str, str], tuple[tuple[str, Placed], ...]] = field(default_factory=dict)

    def node(self, name: str) -> Someone:
        """Return the known facts about a node by its name."""
        return Someone(self.names.kinds.get(name), name)

    def obstacle(self, node: Someone, place: Someone) -> tuple[str, str] | None:
        """Return why a node can never be moved into a place, and a hint; None if it may be possible."""
        if node.name is not None and node.name == place.name:
            return f"'{node.name}' cannot be put into itself", "choose another place"
        if node.kind is None:
            return None
        if not self._mobile(node):
            hint = self._drivable() if self._is_area(node) else f"declare it: kind {node.kind} driven"
            return f"nothing can drive {node.shown}" + (f" ({a(node.kind)})" if node.name else ""), hint
        if place.kind is None:
            return None
        if not self.names.signature[place.kind].may_contain(node.kind):
            return f"{a(place.kind)} cannot contain {a(node.kind)}", self._instead(node.kind, place)
        return self._room(node, place)

    def _instead(self, kind: str, place: Someone) -> str:
        """Return a hint for placing an entity of a kind: another place, or a declaration; a point can only carry it."""
        there = self.names.holding(kind)
        if there and place.name is not None and not self._is_area(place):
            driven = self.names.signature[place.kind or ""].driven
            aboard = f", or declare it: kind {place.kind} carries {kind}" if driven else ""
            return f"name a place that may contain {a(kind)}: {', '.join(there)}{aboard}"
        return f"declare it: kind {place.kind} contains {kind}"

    def _is_area(self, node: Someone) -> bool:
        placed = self.world.placements.get(node.name or "")
        return isinstance(placed, Placed) and not placed.geometry.is_point

    def _drivable(self) -> str:
        """Return a hint that lists the entities that can be driven."""
        kinds = self.names.kinds.items()
        driven = [name for name, kind in sorted(kinds) if self.names.signature[kind].driven]
        return (
            f"these entities are driven: {', '.join(driven[:5])}"
            if driven
            else "declare a driven kind: kind UAV driven"
        )

    def bars(self, node: Someone, place: Someone) -> tuple[str, str] | None:
        """Return why a node can never pass a place on its way, and a hint; None if it may be possible."""
        if node.name is not None and node.name == place.name:
            return f"'{node.name}' is the moving node itself", "name the places that it passes"
        if node.kind is None or place.kind is None:
            return None
        if self.names.signature[place.kind].may_contain(node.kind):
            return None
        message = f"{place.shown} is no place to pass: {a(place.kind)} cannot contain {a(node.kind)}"
        return message, f"pass another, or {self._instead(node.kind, place)}"

    def _mobile(self, node: Someone) -> bool:
        carried = (
            {node.name} & self.mobility.carried
            if node.name is not None
            else {name for name in self.mobility.carried if self.names.kinds.get(name) == node.kind}
        )
        return self.names.signature[node.kind or ""].driven or bool(carried)

    def _room(self, node: Someone, place: Someone) -> tuple[str, str] | None:
        if node.kind is None or node.name is None or place.name is None or place.kind is None:
            return None
        shape, target = self.world.shape(node.name), self.world.placements.get(place.name)
        unknown = place.name not in self.fixed or node.name in self.mobility.drifting | self.mobility.coming
        if (
            unknown
            or shape is None
            or target is None
            or node.kind in self.names.signature[place.kind].carries
        ):
            return None
        if not isinstance(target, Placed) or target.geometry.is_point:
            return (
                f"'{place.name}' is a point, and has no room for '{node.name}'",
                "give it a border: box, circle or polygon; points of a file: keep Waypoint as Location radius 50 m",
            )
        if not band_contains(target.altitude, shape.altitude):
            message = f"the altitudes of '{node.name}' are not within those of '{place.name}'"
            return message, "give the place a wider band, or none"
        try:
            fits = nearest_placement(shape.geometry, target.geometry, self._holes(node, place, target, shape))
        except PhysicalError as error:
            return error.message, error.hint
        if fits is None:
            return (
                f"'{place.name}' has no room for '{node.name}'",
                "make the place larger, or other places in it smaller",
            )
        return None

    def _holes(self, node: Someone, place: Someone, target: Placed, shape: Placed) -> tuple[Geometry, ...]:
        """Return the immobile places that `drive` would find around the node, instead of its target place."""
        kind, within = node.kind or "", place.name or ""
        if (kind, within) not in self.holes:  # many nodes of a kind go to the same place
            self.holes[kind, within] = tuple(self._smaller(kind, within, target))
        found = {
            hole.geometry
            for name, hole in self.holes[kind, within]
            if name != node.name and band_contains(hole.altitude, shape.altitude)
        }
        return tuple(sorted(found)) if len(found) <= MOST_HOLES else ()

    def _smaller(self, kind: str, place: str, target: Placed) -> Iterator[tuple[str, Placed]]:
        """Yield the smaller immobile places at a place's latitudes that may contain nodes of a kind."""
        size, (south, north) = (area(target.geometry), place), _latitudes(target.geometry)
        for name in self.fixed - {place}:
            hole = self.world.placements.get(name)
            holding = kind in self.names.signature[self.names.kinds[name]].contains
            if not holding or not isinstance(hole, Placed) or hole.geometry.is_point:
                continue
            low, high = _latitudes(hole.geometry)
            if south <= high and low <= north and (area(hole.geometry), name) < size:
                yield name, hole


def _latitudes(geometry: Geometry) -> tuple[float, float]:
    return min(geometry.ring)[0], max(geometry.ring)[0]


def check_controls(bodies: Bodies, ground: Ground) -> None:
    """Report controls that can never be made true from any possible host of their bigActor."""
    for rule in bodies.schemas.values():
        if rule.name:
            _check_rule(rule, ground)
    hosts = possible_hosts(bodies, ground.names)
    for body in bodies.all():
        known = hosts.get(body_key(body), frozenset())
        there = tuple(
            name
            for name in sorted(ground.names.kinds if known is None else known)
            if name in ground.names.kinds
        )
        if len(there) > MOST_HOSTS:
            continue
        for site in body.controls if there else ():
            _check_site(site, there, bodies.schemas, ground)


def _check_rule(rule: Schema, ground: Ground) -> None:
    """Report moves that a named rule can make for no host and no arguments."""
    for move in rule.moves:
        node = _term(move.node, rule, {}, None, ground)
        place = _term(move.place, rule, {}, None, ground)
        if problem := ground.obstacle(node, place):
            ground.names.findings.add(Code.UNREALISABLE, move.where, *problem)


def _check_site(
    site: ControlSite, hosts: tuple[str, ...], schemas: Mapping[str, Schema], ground: Ground
) -> None:
    name, arguments = site.statement.name, site.statement.arguments
    if name in COMMANDS:
        _check_command(site, COMMANDS[name], hosts, ground)
    elif name in schemas and len(arguments) == len(schemas[name].parameters):
        _check_use(site, schemas[name], hosts, ground)


def _check_command(site: ControlSite, command: Command, hosts: tuple[str, ...], ground: Ground) -> None:
    """Report moves of a command that can never reach their destination, or never pass a place of the VIA."""
    arguments: dict[PlaceTerm, Expression] = {HOST: Host()}
    arguments |= zip(command.operands, site.statement.arguments, strict=False)
    for node, place in command.open.moves:
        movers = [_value(arguments.get(node), host, ground) for host in hosts]
        places = [_value(arguments.get(place), host, ground) for host in hosts]
        _report(site.where, map(ground.obstacle, movers, places), ground)
        for passed, via in zip(site.via, site.statement.arguments[len(command.operands) :], strict=True):
            ways = [_value(via, host, ground) for host in hosts]
            _report(passed, map(ground.bars, movers, ways), ground, Code.BAD_WAY)


def _check_use(site: ControlSite, rule: Schema, hosts: tuple[str, ...], ground: Ground) -> None:
    given = {}
    for parameter, value in zip(rule.parameters, site.statement.arguments, strict=True):
        name = value.value if isinstance(value, Literal) else None
        if isinstance(name, str) and name in ground.names.kinds:
            given[parameter.name] = name
            kind = ground.names.kinds[name]
            if parameter.kind not in (None, kind):
                wanted = f"'{parameter.shown}' of rule '{rule.name}' is {a(parameter.kind or '')}"
                message = f"'{name}' is {a(kind)}, and {wanted}"
                ground.names.findings.add(
                    Code.KIND_MISMATCH, site.where, message, "give it a node of that kind"
                )
                return
    able = [host for host in hosts if rule.involves(host, ground.names.kinds[host], given | {HOST: host})]
    said = rule.kinds.get(HOST)
    if not able:
        who = f"'{hosts[0]}'" if len(hosts) == 1 else "any of the hosts that it can have here"
        message = f"the redex does not involve the bigActor's host: {who}"
        ground.names.findings.add(Code.RULE_WITHOUT_HOST, site.where, message, "name HOST in the redex")
    elif said is not None and all(ground.names.kinds[host] != said for host in able):
        message = f"the host '{able[0]}' is {a(ground.names.kinds[able[0]])}, and not {a(said)}"
        ground.names.findings.add(Code.KIND_MISMATCH, site.where, message, "write HOST without a kind")
    else:
        for move in rule.moves:
            problems = (
                ground.obstacle(
                    _term(move.node, rule, given, host, ground), _term(move.place, rule, given, host, ground)
                )
                for host in able
            )
            _report(site.where, problems, ground)


def _report(
    where: s.Node,
    problems: Iterable[tuple[str, str] | None],
    ground: Ground,
    code: Code = Code.UNREALISABLE,
) -> None:
    """Report the first problem if every host has one."""
    first = None
    for problem in problems:  # one host without a problem is enough
        if problem is None:
            return
        first = first or problem
    if first is not None:
        ground.names.findings.add(code, where, *first)


def _value(expression: Expression | None, host: str, ground: Ground) -> Someone:
    if isinstance(expression, Host):
        return ground.node(host)
    name = expression.value if isinstance(expression, Literal) else None
    return ground.node(name) if isinstance(name, str) and name in ground.names.kinds else Someone(None)


def _term(term: object, rule: Schema, given: Mapping[str, str], host: str | None, ground: Ground) -> Someone:
    if isinstance(term, NodeVariable):
        return Someone(term.kind)
    if not isinstance(term, str):
        return Someone(None)
    name = host if term == HOST else given.get(term, term)
    return ground.node(name) if name in ground.names.kinds else Someone(rule.kinds.get(term))
