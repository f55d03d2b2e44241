"""Race-freedom (semantics.md, check 2): control races in a configuration, stale-observation races at a transition."""

from collections.abc import Iterable, Iterator, Mapping, Set
from itertools import combinations
from typing import Final

from checker.properties.control_sites import common_sites
from checker.properties.findings import Inspected
from checker.properties.inspections import Excerpt, Inspection, InTime
from semantics.control import applicable
from semantics.races.monitor import CONTROLS, slots_used, stale_tests
from semantics.races.provenance import EVERYTHING, Dependency
from semantics.rules import TIMED_RULES, actuate
from semantics.state.cell_values import MONITOR, VOYAGE
from semantics.state.configuration import Configuration, Transition
from semantics.state.eta import PendingRequest
from semantics.state.requests import CTR, FLY, Request
from semantics.state.setting import Scheduler
from semantics.state.signature import Name
from semantics.successors import served

STALE: Final = "stale-observation race"
"""The kind of violation."""


class ControlRaces(Inspection):
    """No two enabled controls where serving one disables the other, or the two orders end differently."""

    in_time = InTime.TOGETHER

    def seen(self, of: Excerpt) -> Iterator[Inspected]:
        """Yield every pair of controls that are enabled, regardless of turns."""
        return self.between(of)

    def between(self, of: Excerpt, pair: Set[Name] | None = None) -> Iterator[Inspected]:
        """Yield every pair of controls, or those of one or two agents."""
        for one, other, problem in compared(of.c, enabled_controls(of.steps.enabled), pair):
            yield Inspected(by=one[0]) if problem is None else _race(of.c, problem, one[0], other[0])


def _race(c: Configuration, problem: tuple[str, str], one: Transition, other: Transition) -> Inspected:
    message, about = problem
    return Inspected(
        ("control race", about),
        None,
        message,
        lambda: (f"enabled here: {one.label} and {other.label}",),
        lambda: common_sites(c, _request(one), _request(other)),
    )


Control = list[Transition]
"""The transitions that serve one pending control."""


def enabled_controls(enabled: Iterable[Transition]) -> list[Control]:
    """Return the enabled controls, each with its transitions."""
    served: dict[tuple[object, int], Control] = {}
    for transition in enabled:
        if transition.label.rule in CONTROLS and transition.served is not None:
            served.setdefault((transition.served.cell, transition.served.position), []).append(transition)
    return list(served.values())


def compared(
    c: Configuration, controls: list[Control], between: Set[Name] | None = None
) -> Iterator[tuple[Control, Control, tuple[str, str] | None]]:
    """Yield each pair of controls, or those between some agents, with its race: a message and a subject; None without.

    Only under `unordered` may both controls belong to one agent; two equal ones are served by the same transitions.
    """
    unordered = c.setting.scheduler is Scheduler.UNORDERED
    twice = [(each, each) for each in controls if unordered and _is_twice(c, _request(each[0]))]
    for one, other in (*combinations(controls, 2), *twice):
        agents = {one[0].label.agent, other[0].label.agent}
        if (len(agents) == 1 and not unordered) or between not in (None, agents):
            continue
        problem = conflict(one, other) or conflict(other, one) or different_ends(c, one, other)
        about = " and ".join(sorted(str(_request(each[0])) for each in (one, other)))
        yield one, other, None if problem is None else (problem, about)


def _is_twice(c: Configuration, request: Request) -> bool:
    return sum(each.request == request for each in c.eta.of(request.agent)) > 1


def conflict(one: Control, other: Control) -> str | None:
    """Return a message if serving one control disables another, None if not."""
    request = _request(other[0])
    for transition in one:
        if not list(serving(transition.target, request)):
            return f"serving {_request(transition)} disables {request}"
    return None


def different_ends(c: Configuration, one: Control, other: Control) -> str | None:
    """Return a message if the two orders end differently, None if not.

    The comparison ignores the order of η, and the memories of the race monitor and of flights.
    """
    ends = [_ends(one, _request(other[0])), _ends(other, _request(one[0]))]
    cells = sorted({cell for end in ends for after in end for cell in after.state.changed(c.state)})
    counted = [cell for cell in cells if cell[0] not in (MONITOR, VOYAGE)]
    if len({frozenset(tuple(map(after.read, counted)) for after in end) for end in ends}) == 1:
        return None
    return f"{_request(one[0])} and {_request(other[0])} end differently in the two orders"


def _ends(first: Control, then: Request) -> list[Configuration]:
    return [after.target for transition in first for after in serving(transition.target, then)]


def serving(c: Configuration, request: Request) -> Iterator[Transition]:
    """Yield the transitions that serve a control, regardless of its turn."""
    for rule in (actuate, *TIMED_RULES):
        for transition in rule(c, request.agent):
            if transition.served is not None and transition.served.request == request:
                yield transition


def _request(transition: Transition) -> CTR | FLY:
    assert transition.served is not None
    assert isinstance(transition.served.request, CTR | FLY)
    return transition.served.request


class StaleObservationRaces(Inspection):
    """No control depends on a test whose answer another agent's control has changed since the observation."""

    alone = (served,)
    in_turn = True
    in_time = InTime.TAKEN

    def seen(self, of: Excerpt) -> Iterator[Inspected]:
        """Yield every control that is served; the configuration must be monitored."""
        for step in of.steps.by_agents:
            if step.label.rule in CONTROLS and step.served is not None:
                stale = is_stale(of.c, step.served)
                yield _resting_on(of.c, stale[0], step) if stale else Inspected(by=step)


def _resting_on(c: Configuration, stale: Dependency, by: Transition) -> Inspected:
    request = _request(by)
    changed = "that answer" if stale.stale else "a relation that it uses"
    message = (
        f"{request} depends on {asked_in_words(stale)}, and another agent has changed {changed} since then"
    )
    return Inspected((STALE, str(request)), by, message, alike=lambda: common_sites(c, request))


_QUESTIONS: Final[Mapping[str, str]] = {
    "all": "the whole of {seen}, of which no test takes a part",
    "members": "which names {seen} shows",
    "size": "how many names {seen} shows",
    "in": "whether {seen} shows {name}",
    "parent": "where {seen} shows {name}",
    "children": "the content of {name} in {seen}",
    "links": "the links on which {seen} shows {name}",
}
"""The questions to an observation in words, by the first word of the key."""


def asked_in_words(stale: Dependency) -> str:
    """Return a question to an observation in words.

    >>> from semantics.behaviours.observations import Nodes, Of, QueryOperator
    >>> asked_in_words(Dependency(Of(QueryOperator.CHILDREN, Nodes(("gate0",))), (), asked=("in", "uav0")))
    'whether observe(CHILDREN(gate0)) shows uav0'
    """
    question, *names = stale.asked or EVERYTHING
    return _QUESTIONS[question].format(seen=f"observe({stale.query})", name=" ".join(names))


def is_stale(c: Configuration, pending: PendingRequest) -> tuple[Dependency, ...]:
    """Return the dependencies of a control that other agents have changed since they were observed."""
    return stale_tests(pending.request, pending.rests_on, used_slots(c, pending))


def used_slots(c: Configuration, pending: PendingRequest) -> frozenset[tuple[str, ...]]:
    """Return the slots that the redex of a pending control uses, in any match."""
    request = pending.request
    assert isinstance(request, CTR | FLY)
    redex = request.reaction.redex
    found = [request.match] if isinstance(request, FLY) else applicable(c, request.agent, request.reaction)
    used = (slots_used(m.relations(redex), tuple(node for node, _ in m.closed(redex))) for m in found)
    return frozenset[tuple[str, ...]]().union(*used)
