"""Reasons to refuse a parcel: the text of this mission cannot have produced its contents."""

from collections.abc import Iterator, Sequence

from semantics.admission.program_points import is_point, once
from semantics.analysis.abstract_values import Abstract
from semantics.analysis.traversal import reachable
from semantics.analysis.value_flow import PossibleBehaviour, ValueFlow
from semantics.behaviours.expressions import Fault, QueryOf
from semantics.behaviours.observations import All, Nodes, Query
from semantics.behaviours.statements import ControlBy, Migrate, Observe, Send, Statement
from semantics.behaviours.values import Route
from semantics.environment import Says
from semantics.state.agents import Code
from semantics.state.parcels import Asked, Controls, Parcel, Running, requested
from semantics.state.requests import MGR, OBS, READY, SND
from semantics.state.setting import Setting
from semantics.state.signature import Name

MOST_REQUESTS = 1_000
"""The largest number of requests of an admitted agent; each is compared with the statements that may have made it."""


def text_objection(setting: Setting, flow: ValueFlow, parcel: Parcel) -> str:
    """Return the first part of a parcel that the mission's text cannot have produced; empty if there is none."""
    return next(_Reading(setting, flow, parcel.agent).objections(parcel), "")


def may_be_hosted(setting: Setting, flow: ValueFlow, agent: Name, host: Name) -> bool:
    """Whether the text of a mission may host an agent at a node."""
    role = flow.roles.get(agent)
    return role is not None and host in setting.kinds and flow.vocabulary_of(setting).fits(host, role.hosts)


class _Reading:
    """The setting, value flow and role that one parcel is compared with."""

    def __init__(self, setting: Setting, flow: ValueFlow, agent: Name) -> None:
        self.setting = setting
        self.flow = flow
        self.agent = agent
        self.program = setting.program
        self.role = flow.roles.get(agent, PossibleBehaviour())
        self.names = flow.vocabulary_of(setting)

    def objections(self, parcel: Parcel) -> Iterator[str]:
        if self.agent not in self.flow.roles:
            yield f"there is no bigActor {self.agent:.60} in this mission"
            return
        messages = self.flow.messages(self.agent)
        if not all(self.names.fits(message, messages) for message in parcel.mail):
            yield "it carries a message without a sender in this mission"
        if parcel.running is not None:
            yield from self._of_running(parcel.running)

    def _of_running(self, running: Running) -> Iterator[str]:
        if not is_point(self.program, self.role.starts, running.code):
            yield "its remaining program is not in this mission"
            return
        if not self._fits(running.host, self.role.hosts):
            yield f"it never goes to {running.host:.60}"
        yield from self._of_store(running)
        yield from self._of_says(running.says)
        yield from self._of_requests(running.requests, running.code)

    def _fits(self, name: Name, abstract: Abstract) -> bool:
        return name in self.setting.kinds and self.names.fits(name, abstract)

    def _of_store(self, running: Running) -> Iterator[str]:
        live = self.program.live(running.code)
        kept = frozenset[str]().union(*self.program.kept.get(self.agent, {}).values())
        given = [name for name, _ in running.store]
        if given != sorted(set(given)) or not live <= set(given) <= live | kept:
            yield "its variables differ from those of its program there"
            return
        for name, value in running.store:
            if not self.names.fits(value, self.flow.variable(self.agent, name)):
                yield f"its variable {name.partition('#')[0]:.60} never has such a value"

    def _of_says(self, says: tuple[int, ...]) -> Iterator[str]:
        clauses = [
            each for each in self.setting.environment if isinstance(each, Says) and each.agent == self.agent
        ]
        fits = len(says) == len(clauses)
        if not fits or any(not 0 <= n <= each.times for n, each in zip(says, clauses, strict=True)):
            yield "its counts of `says` differ from the clauses of this mission"

    # --- requests -------------------------------------------------------------------------------------------

    def _of_requests(self, requests: Sequence[Asked], code: Code) -> Iterator[str]:
        if len(requests) > MOST_REQUESTS:
            yield f"it has more than {MOST_REQUESTS:,} requests"
            return
        if any(request.agent != self.agent for request in requests):
            yield "it holds requests of another agent"
            return
        single_use = once(self.program, self.role.starts)
        taken = sorted(self.role.statements - (single_use & reachable(self.program, code)))
        single = []
        for request in requests:
            makers = [number for number in taken if self._makes(number, request)]
            if not makers:
                yield f"no statement that it has passed makes this request: {_shown(request):.100}"
                return
            if single_use.issuperset(makers):
                single.append(makers)
        if not _have_each_their_own(single):
            yield "it has more requests than its statements make"

    def _makes(self, number: int, request: Asked) -> bool:
        """Whether a statement can have made a request."""
        statement: Statement = self.program.statements[number]
        match statement, request:
            case Observe(template), OBS(_, query):
                return self._asks(template, query)
            case Observe(template), READY(_, query, seen):
                return self._asks(template, query) and self.names.observes(seen)
            case Send(message, to), SND(_, receiver, said):
                heard = self.names.fits(receiver, self.flow.names(self.agent, to))
                return heard and self.names.fits(said, self.flow.value(self.agent, message))
            case Migrate(host), MGR(_, there):
                return self._fits(there, self.flow.names(self.agent, host))
            case ControlBy(name, arguments), Controls(_, made_by, host, given):
                several = (self.role.hosts, *(self.flow.names(self.agent, each) for each in arguments))
                fits = name == made_by and len(given) == len(arguments)
                return fits and all(map(self._fits, (host, *given), several)) and self._is_made(request)
        return False

    def _is_made(self, request: Asked) -> bool:
        """Whether a command or rule accepts its arguments."""
        try:
            requested(self.program, request)
        except Fault:
            return False
        return True

    def _asks(self, template: QueryOf, query: Query) -> bool:
        argument = template.argument
        if argument is None:
            return isinstance(query, All)
        if template.operator is not None:
            if isinstance(query, All | Nodes) or query.operator != template.operator:
                return False
            query = query.of
        if isinstance(argument, QueryOf):
            return self._asks(argument, query)
        return isinstance(query, Nodes) and self._names(query.names, self.flow.value(self.agent, argument))

    def _names(self, given: tuple[Name, ...], value: Abstract) -> bool:
        """Whether a query has the names that a value denotes: the value itself, or its members in order."""
        if len(given) == 1 and self.names.fits(given[0], value):
            return True
        several = (frozenset(given), Route(given))
        return given == tuple(sorted(set(given))) and any(self.names.fits(each, value) for each in several)


def _have_each_their_own(several: Sequence[Sequence[int]]) -> bool:
    """Whether each sequence can get a number of its own (a bipartite matching by augmenting paths)."""
    holders: dict[int, int] = {}

    def finds(index: int, tried: set[int]) -> bool:
        for number in several[index]:
            if number not in tried:
                tried.add(number)
                if number not in holders or finds(holders[number], tried):
                    holders[number] = index
                    return True
        return False

    return all(finds(index, set()) for index in range(len(several)))


def _shown(request: Asked) -> str:
    if isinstance(request, Controls):
        return f"control({request.name} {', '.join(request.arguments)})"
    return str(request)
