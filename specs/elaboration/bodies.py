"""The behaviours phase: the bodies of bigActors and behaviours, and their calls."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property

from semantics.analysis.traversal import reachable
from semantics.analysis.unpaced_loops import unpaced
from semantics.behaviours.commands import COMMANDS
from semantics.behaviours.expressions import Expression, Literal
from semantics.behaviours.program import Behaviour, Program
from semantics.behaviours.statements import Block, Loop
from semantics.fixpoints import closure
from specs import syntax as s
from specs.codes import Code
from specs.elaboration.initial_actors import InitialActor
from specs.elaboration.names import Names
from specs.elaboration.patterns import warn_of_hiding
from specs.elaboration.rule_schemas import CommandReactions, Maker, Schema
from specs.elaboration.statements import ElaboratedBody, SpawnSite, StatementNumbers


@dataclass
class Bodies:
    """All bodies of a mission.

    Attributes:
        agents: The bodies of the initial bigActors, by name.
        behaviours: The bodies of behaviours, by name.
        parameters: The unique names of each behaviour's parameters.
        schemas: The rules that controls name, inline rules included.
    """

    agents: dict[str, ElaboratedBody] = field(default_factory=dict)
    behaviours: dict[str, ElaboratedBody] = field(default_factory=dict)
    parameters: dict[str, tuple[str, ...]] = field(default_factory=dict)
    schemas: dict[str, Schema] = field(default_factory=dict)

    def all(self) -> Iterator[ElaboratedBody]:
        """Yield every body."""
        yield from self.agents.values()
        yield from self.behaviours.values()

    @cached_property
    def spawned(self) -> dict[str, list[SpawnSite]]:
        """The `spawn` sites of each spawned bigActor."""
        found: dict[str, list[SpawnSite]] = {}
        for body in self.all():
            for site in body.spawns:
                found.setdefault(site.name, []).append(site)
        return found

    def reached(self, start: ElaboratedBody) -> tuple[ElaboratedBody, ...]:
        """Return the bodies that one runs: itself and those that it calls, transitively."""
        found: dict[int, ElaboratedBody] = {}
        waiting = [start]
        while waiting:
            body = waiting.pop()
            if id(body) not in found:
                found[id(body)] = body
                called = (self.behaviours.get(call.behaviour) for call in body.calls)
                waiting += [each for each in called if each is not None]
        return tuple(found.values())

    def running(self, agent: str) -> tuple[ElaboratedBody, ...]:
        """Return the bodies that an initial or spawned bigActor may run."""
        starts = [self.agents[agent]] if agent in self.agents else []
        spawned = {site.behaviour for site in self.spawned.get(agent, ())}
        starts += [self.behaviours[name] for name in sorted(spawned & self.behaviours.keys())]
        return tuple({id(body): body for start in starts for body in self.reached(start)}.values())


def declare_behaviours(mission: s.Mission, names: Names, actors: Iterable[InitialActor]) -> None:
    """Declare rules, behaviours and bigActors before their bodies, so that these may refer to each other."""
    for rule in mission.each(s.Rule):
        if names.declare("rule", rule.name.text, rule.name):
            names.rules[rule.name.text] = rule
    for definition in mission.each(s.Definition):
        if names.declare("behaviour", definition.name.text, definition.name):
            names.behaviours[definition.name.text] = definition
    for actor in actors:
        if names.declare("agent", actor.name, actor.where):
            names.agents[actor.name] = actor.host
    _declare_spawned(mission, names)


def _declare_spawned(mission: s.Mission, names: Names) -> None:
    there = set(names.agents)
    for node in s.walk(mission):
        if isinstance(node, s.Spawn) and node.name is not None:
            name = node.name.text
            if name in there:
                hint = "give the spawned one another name"
                names.findings.add(
                    Code.DUPLICATE_NAME, node.name, f"a bigActor '{name}' is there already", hint
                )
            elif name not in names.agents and names.declare("agent", name, node.name):
                names.agents[name] = None


def elaborate_bodies(
    mission: s.Mission, names: Names, actors: tuple[InitialActor, ...], schemas: Mapping[str, Schema]
) -> tuple[Bodies, Program]:
    """Return all bodies, and the program with their numbered statements."""
    bodies = Bodies(schemas=dict(schemas))
    program = StatementNumbers(names, bodies.schemas)
    first: dict[str, int] = {}
    copies: dict[int, int] = {}
    for actor in actors:
        body, start = ElaboratedBody(actor.name, is_agent=True), len(program.statements)
        bodies.agents.setdefault(actor.name, body)
        program.body(body, actor.body, {}, actor.constants)
        before = start - first.setdefault(actor.family or actor.name, start)
        copies |= {number: number - before for number in range(start, len(program.statements)) if before}
    for definition in mission.each(s.Definition):
        body, name = ElaboratedBody(definition.name.text, is_agent=False), definition.name.text
        parameters = _parameters(definition, names)
        bodies.behaviours.setdefault(name, body)
        bodies.parameters.setdefault(name, tuple(parameters.values()))
        program.body(body, definition.body, parameters, {})
    _check_recursion(bodies, names)
    warn_of_hiding(names)
    for number in _outermost(bodies):
        loop = program.statements[number]
        if isinstance(loop, Loop):
            program.statements[number] = replace(loop, outermost=True)
    behaviours = {
        name: Behaviour(name, bodies.parameters[name], body.block) for name, body in bodies.behaviours.items()
    }
    reactions: dict[str, CommandReactions | Maker] = {
        name: CommandReactions(command, names.kinds) for name, command in COMMANDS.items()
    }
    reactions |= {name: Maker(schema, names.kinds) for name, schema in bodies.schemas.items()}
    statements, lines = tuple(program.statements), tuple(program.lines)
    declared = {
        key: names.findings.source.line(span.start)
        for key, span in names.spans.items()
        if key[0] in ("rule", "behaviour")
    }
    begun = {name: body.block for name, body in bodies.agents.items()}
    homes = {actor.name: actor.host.text for actor in actors}
    whole = Program(
        statements, behaviours, reactions, lines, program.branch_lines, declared, begun, homes, copies
    )
    if not names.findings:
        _warn_of_unpaced(bodies, whole, program.nodes, names)
    return bodies, whole


def _warn_of_unpaced(bodies: Bodies, program: Program, written: Sequence[s.Node], names: Names) -> None:
    """Warn once of each loop that makes requests and never waits, with all bigActors that run it."""
    found: dict[s.Span, tuple[s.Node, int, list[str]]] = {}
    for agent, block in _running(bodies):
        for loop in sorted(reachable(program, block)):
            asked = unpaced(program, loop)
            if asked:
                first = written[min(asked)]
                found.setdefault(first.span, (first, program.line(loop), []))[2].append(agent)
    for node, line, agents in found.values():
        several = sorted(set(agents))
        who = ", ".join(several[:3]) + (" and others" if len(several) > 3 else "")
        message = f"{who} {'asks' if len(several) == 1 else 'ask'} for this in a loop that never waits (line {line})"
        names.findings.warn(Code.NEVER_WAITS, node, message, _LET_WAIT)


_LET_WAIT = "let each turn wait: observe(PARENT(HOST)) react { case here: Observation => skip }"


def _running(bodies: Bodies) -> Iterator[tuple[str, Block]]:
    """Yield each initial or spawned bigActor with its initial code."""
    yield from ((name, body.block) for name, body in bodies.agents.items())
    for name, sites in bodies.spawned.items():
        for site in sites:
            body = bodies.behaviours.get(site.behaviour)
            if body is not None:
                yield name, body.block


def _parameters(definition: s.Definition, names: Names) -> dict[str, str]:
    found: dict[str, str] = {}
    for parameter in definition.parameters:
        if parameter.text in found:
            message = f"behaviour '{definition.name.text}' has two parameters '{parameter.text}'"
            names.findings.add(Code.DUPLICATE_NAME, parameter, message, "rename one of the two")
            found[f"{parameter.text}#{len(found)}"] = f"{parameter.text}#{definition.name.text}#{len(found)}"
        else:
            found[parameter.text] = f"{parameter.text}#{definition.name.text}"
    return found


# --- calls ----------------------------------------------------------------------------------------------------


def _check_recursion(bodies: Bodies, names: Names) -> None:
    """Report calls that may recurse to their own behaviour and are not tail calls."""
    if not bodies.behaviours:
        return
    group = _components(
        {name: [call.behaviour for call in body.calls] for name, body in bodies.behaviours.items()}
    )
    for name, body in bodies.behaviours.items():
        for call in body.calls:
            if not call.tail and group.get(call.behaviour) == group[name]:
                message = f"'{name}' calls '{call.behaviour}' again before it is done"
                if call.behaviour == name:
                    message = f"'{name}' calls itself before it is done"
                hint = "call it as the last thing, outside of loops, or write a loop instead"
                names.findings.add(Code.UNBOUNDED_RECURSION, call.where, message, hint)


def _components(graph: Mapping[str, Iterable[str]]) -> dict[str, int]:
    """Return the number of each node's strongly connected component."""
    import networkx as nx  # noqa: PLC0415 - slow to import, and needed only where a behaviour is defined

    calls = nx.DiGraph({name: list(called) for name, called in graph.items()})
    return {
        name: number for number, group in enumerate(nx.strongly_connected_components(calls)) for name in group
    }


def _outermost(bodies: Bodies) -> Iterator[int]:
    """Yield the loops at the top of a bigActor, or of a behaviour that is only called at the end of its callers."""
    first = (call.behaviour for body in bodies.all() for call in body.calls if not call.top)
    inner = closure(
        first,
        lambda name: (
            [c.behaviour for c in bodies.behaviours[name].calls] if name in bodies.behaviours else []
        ),
    )
    for body in bodies.all():
        if body.is_agent or body.name not in inner:
            yield from body.loops


# --- hosts ----------------------------------------------------------------------------------------------------


def possible_hosts(bodies: Bodies, names: Names) -> dict[str, frozenset[str] | None]:
    """Return the possible hosts of the bigActors that run each body, by `body_key`; None for any host."""
    found: dict[str, set[str] | None] = {}
    for agent in names.agents:
        hosts = _hosts_of(agent, bodies, names)
        for body in bodies.running(agent):
            known = found.setdefault(body_key(body), set())
            found[body_key(body)] = None if known is None or hosts is None else known | hosts
    return {key: None if hosts is None else frozenset(hosts) for key, hosts in found.items()}


def body_key(body: ElaboratedBody) -> str:
    """Return the unique key of a body."""
    return body.name if body.is_agent else f"{body.name}()"


def _hosts_of(agent: str, bodies: Bodies, names: Names) -> set[str] | None:
    declared = names.agents[agent]
    places: list[Expression] = [] if declared is None else [Literal(declared.text)]
    places += [site.host for site in bodies.spawned.get(agent, ())]
    places += [host for body in bodies.running(agent) for host in body.migrations]
    literals = [place.value for place in places if isinstance(place, Literal)]
    named = [name for name in literals if isinstance(name, str)]
    return set(named) if len(named) == len(places) else None
