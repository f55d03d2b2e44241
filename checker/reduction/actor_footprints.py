"""The footprints of actors, now and for ever, as functions of a few cells' values.

An agent doesn't wait for its requests, so it is several actors: its *program* (the rest of its code), its *line* (whose
first request may be served), and each *request* outside a line. A clause of the environment is one actor. The possible
next step of an actor depends only on its agent's code, requests and host, not on other agents. So does a bound on all
its later steps.
"""

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import replace
from functools import cache, lru_cache
from typing import NamedTuple

from checker.reduction.footprint_slots import NOTHING, SlotFootprint, joined
from checker.reduction.footprints import Footprints
from checker.reduction.race_footprints import Marks
from semantics.analysis.overapproximation import Overapproximation
from semantics.analysis.traversal import reachable
from semantics.analysis.value_flow import ValueFlow
from semantics.behaviours.expressions import Literal
from semantics.behaviours.statements import ControlBy, Migrate, Observe, React, Send, Spawn, Statement
from semantics.environment import Says
from semantics.state.agents import Code, code_cell, host_cell
from semantics.state.cell_values import Cell
from semantics.state.configuration import Configuration, Label
from semantics.state.eta import line_cell, sends_cell
from semantics.state.requests import CTR, FLY, MGR, OBS, READY, SND, Received, Request
from semantics.state.setting import Scheduler
from semantics.state.signature import Name

Requests = tuple[Request, ...]

InLine = Observe | ControlBy | Migrate
"""Statements whose requests wait in the line, if there is one."""

EVERYTHING = SlotFootprint(-1, -1, -1)
"""All slots, including those not numbered yet."""


class Actor(NamedTuple):
    """An independently moving part of an agent, or a clause of the environment.

    Attributes:
        kind: `program`, `line`, `request` or `clause`.
        owner: The agent; for a clause its number.
        request: The request of an actor of that kind.
    """

    kind: str
    owner: Name | int
    request: Request | None = None


class Acting(NamedTuple):
    """The footprints of an actor: of its next step, of all its steps, and of those among them that bypass its line."""

    now: SlotFootprint
    ever: SlotFootprint
    aside: SlotFootprint


class Actors:
    """The footprints of a mission's actors; c must be the initial configuration of the exploration.

    Attributes:
        everything: The union of all actors' footprints.
    """

    def __init__(self, c: Configuration) -> None:
        self.setting = c.setting
        self.program = c.setting.program
        self.ordered = c.setting.scheduler is not Scheduler.UNORDERED
        bounds = Overapproximation(c)
        self.roles = ValueFlow(c.setting, bounds)
        self.footprints = Footprints(bounds, self.roles)
        self._hosts = cache(self.roles.hosts)
        # No slot of a control is ever settled.
        self._of_control = cache(self._control)  # many statements have equal controls
        self._of_reaction = lru_cache(maxsize=1 << 16)(self.footprints.control)
        self._forget()
        everything = joined([*map(self.clause, self.setting.environment), *self._lives(c)])
        self.footprints.settle(everything)
        self.everything = replace(everything, merges=everything.merges & ~self.footprints.settled)
        self._forget()  # they were bounded without the settled slots

    def _forget(self) -> None:
        self.marks = Marks(self.footprints)
        self._known_agent = lru_cache(maxsize=1 << 16)(self._agent)
        self._of_request = lru_cache(maxsize=1 << 16)(self._request)
        self._of_statement = cache(self._statement)  # as many as agents times statements
        self._reached_by = lru_cache(maxsize=1 << 14)(self._reached)
        self.clause = cache(self.footprints.clause)

    def _lives(self, c: Configuration) -> Iterator[SlotFootprint]:
        for agent in self.roles.agents:
            pending = (
                [self._of_request(agent, each.request) for each in c.eta.of(agent)]
                if agent in c.alpha
                else []
            )
            yield joined([*pending, self._life(agent)])

    # --- of a configuration -----------------------------------------------------------------------------------

    def local(self, agent: Name) -> tuple[Cell, ...]:
        """Return the cells that determine an agent's actors and their footprints."""
        return (code_cell(agent), line_cell(agent), sends_cell(agent), host_cell(agent))

    def of(self, c: Configuration) -> dict[Actor, Acting]:
        """Return the actors of a configuration, with their footprints.

        They depend only on the `local` cells of each agent, on whether it has any provenance, on the existing agents,
        and on the counters of messages from outside.
        """
        found: dict[Actor, Acting] = {}
        for agent in c.alpha.names():
            found.update(self.of_agent(c, agent))
        for number in range(len(c.setting.environment)):
            found.update(self.of_clause(c, number))
        return found

    def of_agent(self, c: Configuration, agent: Name) -> dict[Actor, Acting]:
        """Return the actors of one existing agent; observations that it has not received are irrelevant."""
        code, line, sends, host = (c.read(cell) for cell in self.local(agent))
        asked = tuple(each for each in (*line, *(sends or ())) if not isinstance(each, READY))
        told = self.ordered and any(isinstance(each, READY) for each in line)
        return self._known_agent(agent, code, asked, told, host, self.marks.is_blank(c, agent))

    def of_clause(self, c: Configuration, number: int) -> dict[Actor, Acting]:
        """Return the actor of a clause of the environment, unless the clause is used up."""
        clause = c.setting.environment[number]
        if isinstance(clause, Says) and not c.read(clause.counter):
            return {}
        does = self.clause(clause)
        return {Actor("clause", number): Acting(does, does, does)}

    def actor_of(self, label: Label) -> Actor:
        """Return the actor that takes a transition of an agent, by its label."""
        assert label.agent is not None
        if isinstance(label.about, str | Received):
            return Actor("program", label.agent)
        return self.serving(label.about)

    def serving(self, request: Request) -> Actor:
        """Return the actor that serves a request."""
        in_line = self.ordered and not isinstance(request, SND)
        return Actor("line", request.agent) if in_line else Actor("request", request.agent, request)

    # --- from the values of an agent's cells ------------------------------------------------------------------

    def _agent(
        self, agent: Name, code: Code, asked: Requests, told: bool, host: Name, blank: bool
    ) -> dict[Actor, Acting]:
        rested_on = self.marks.rested_on(agent, code)

        def serving(requests: Sequence[Request]) -> Acting:
            carried = [self.marks.carried(agent, each, rested_on) for each in requests]
            ever = joined([*carried, *(self._of_request(agent, each) for each in requests)])
            now = self._serve(agent, requests[0], {host})
            begins = isinstance(requests[0], OBS)  # it starts provenance
            return Acting(now | carried[0] if begins or not blank else now, ever, ever)

        in_line = [each for each in asked if self.ordered and not isinstance(each, SND)]
        found = {
            Actor("request", agent, request): serving([request])
            for request in asked
            if request not in in_line
        }
        if in_line:
            found[Actor("line", agent)] = serving(in_line)
        if code:
            now = self._next(agent, code[0], told)
            passed = NOTHING if blank else rested_on | self._telling(agent, code[0])
            ever, aside = (
                each | rested_on for each in self._reached_by(agent, reachable(self.program, code))
            )
            found[Actor("program", agent)] = Acting(now | passed, ever, aside)
        return found

    def _next(self, agent: Name, number: int, told: bool) -> SlotFootprint:
        """Bound the rules that take an agent's next step; a ready first observation decides it alone."""
        statement = self.program.statements[number]
        here = self.footprints.slots.footprint([("host", agent)])
        if isinstance(statement, React):
            return here | self.footprints.waiting(agent, number, told)
        return here | self.footprints.spawn() if isinstance(statement, Spawn) else here

    def _telling(self, agent: Name, number: int) -> SlotFootprint:
        """Bound the marks in a statement's message."""
        match self.program.statements[number]:
            case Send(_, to):
                return self.marks.told(agent, self.roles.receivers(agent, to))
            case Spawn(name):
                return self.marks.told(agent, [name])
            case _:
                return NOTHING

    def _reached(self, agent: Name, reach: frozenset[int]) -> tuple[SlotFootprint, SlotFootprint]:
        """Return the footprint of all statements reachable from code, and of those before the agent's line moves."""
        born = self.roles.descendants(reach)
        theirs = joined(map(self._life, born))
        here = self.footprints.slots.footprint([("host", agent)])  # any step may evaluate HOST
        free = (each for each in reach if not isinstance(self.program.statements[each], InLine))
        aside = joined([here, theirs, *(self._of_statement(agent, each) for each in free)])
        return aside | joined(self._of_statement(agent, each) for each in reach), aside

    def _life(self, agent: Name) -> SlotFootprint:
        """Return the footprint of all of an agent's later steps, without its pending requests."""
        statements = self.roles[agent].statements
        rested_on = self.marks.rested_on(agent, tuple(sorted(statements)))
        return rested_on | joined(self._of_statement(agent, each) for each in statements)

    def _request(self, agent: Name, request: Request) -> SlotFootprint:
        return self._serve(agent, request, self._hosts(agent))

    def _serve(self, agent: Name, request: Request, hosts: Iterable[Name]) -> SlotFootprint:
        match request:
            case OBS(_, query):
                return self.footprints.sense(agent, hosts, query) | self.footprints.telling(agent)
            case CTR(_, reaction) | FLY(_, reaction, _):
                does = self._of_reaction(agent, reaction)
                return does | self.marks.made(agent, does)
            case SND(_, to, message):
                there = to in self.roles.agents
                return self.footprints.post(agent, hosts, to, Literal(message)) if there else NOTHING
            case MGR(_, to):
                return self.footprints.migrate(agent, hosts, to)
            case _:
                return NOTHING

    def _statement(self, agent: Name, number: int) -> SlotFootprint:
        """Return the footprint of a statement without its nested statements."""
        return self._asked_by(agent, number) | self._telling(agent, number)

    def _asked_by(self, agent: Name, number: int) -> SlotFootprint:
        statement: Statement = self.program.statements[number]
        hosts = self._hosts(agent)
        match statement:
            case Observe(query):
                asked = self.roles.query(agent, query)
                return self.footprints.sense(agent, hosts, asked) | self.footprints.telling(agent)
            case ControlBy():
                return self._of_control(agent, statement) | self._marking(agent, statement)
            case Send(message, to):
                receivers = self.roles.receivers(agent, to)
                return joined(self.footprints.post(agent, hosts, each, message) for each in receivers)
            case Migrate(host):
                entities = self.roles.named_entities(agent, host)
                return joined(self.footprints.migrate(agent, hosts, each) for each in entities)
            case Spawn():
                return self.footprints.spawn()
            case React():
                return self.footprints.wary(agent, number)
            case _:
                return NOTHING

    def _control(self, agent: Name, statement: ControlBy) -> SlotFootprint:
        """Return the footprint of a control without its marks."""
        found = self.roles.reactions(agent, statement)
        return EVERYTHING if found is None else joined(self._of_reaction(agent, each) for each in found)

    def _marking(self, agent: Name, statement: ControlBy) -> SlotFootprint:
        """Bound the marks of a control."""
        if not self.marks.monitored:
            return NOTHING
        does = (self._of_reaction(agent, each) for each in self.roles.reactions(agent, statement) or ())
        return joined(self.marks.made(agent, each) for each in does)
