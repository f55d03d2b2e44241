"""The causes of a deadlock: the reason why each request stays pending, and the awaited input of each waiting agent."""

from collections.abc import Iterable, Iterator

from semantics.analysis.possible_messages import may_take
from semantics.analysis.traversal import reachable
from semantics.behaviours.expressions import Literal
from semantics.behaviours.patterns import Anything, Elements, Exactly, Pattern, bind
from semantics.behaviours.process_conversion import next_statement
from semantics.behaviours.statements import React, Send
from semantics.behaviours.values import Value, show
from semantics.bigactor_rules import linked
from semantics.control import obstacle
from semantics.environment import Drops, Leaves
from semantics.state.agents import written
from semantics.state.configuration import Configuration
from semantics.state.eta import PendingRequest
from semantics.state.requests import CTR, FLY, MGR, OBS, READY, SND
from semantics.state.signature import Name


def causes(c: Configuration, waiting: Iterable[Name]) -> Iterator[str]:
    """Yield the known reasons for each pending request, and the awaited input of agents at a react."""
    for a in c.alpha.names():
        for pending in c.eta.of(a):
            why = _why(c, pending)
            if why:
                yield f"{pending.request}: {why}"
    for a in waiting:
        react = next_statement(c, a)
        assert isinstance(react, React)
        yield f"{a} waits for {_awaited(c, a, react)}"


def _why(c: Configuration, pending: PendingRequest) -> str:
    request = pending.request
    match request:
        case READY():
            return ""
        case SND(a, to, _) if to not in c.alpha:
            return f"there is no bigActor '{to}'"
        case SND(a, to, _):
            return _apart(c, c.alpha.host(a), c.alpha.host(to), "their hosts")
        case _ if pending not in (line := c.eta.in_line(request.agent)):
            return f"it waits behind {line[0].request}" if line else ""
        case MGR(a, host):
            return _apart(c, c.alpha.host(a), host, "the two")
        case CTR() | FLY():
            hindered = obstacle(c, request)
            return "" if hindered is None else f"it is {hindered.value}"
    return ""


def _apart(c: Configuration, here: Name, there: Name, who: str) -> str:
    """Return why two hosts are not linked, empty if they are."""
    if linked(c, here, there):
        return ""
    return f"{who}, {here} and {there}, share no link{_missing(c, here, there)}{_promise(c, here, there)}"


def _missing(c: Configuration, here: Name, there: Name) -> str:
    """Return the reason why two hosts share no link: no image in P, a channel that is down, or missing belief."""
    logical, physical = c.structure.logical, c.structure.physical
    absent = [host for host in (here, there) if host not in physical]
    if absent:
        return f": {' and '.join(absent)} {'is' if len(absent) == 1 else 'are'} not there"
    both = sorted(set(physical.channels(here)).intersection(physical.channels(there)))
    down = [channel for channel in both if physical.is_down(channel)]
    if both and down == both:
        return f": {' and '.join(down)} {'is' if len(down) == 1 else 'are'} down"
    believed = set(logical.links(here)).intersection(logical.links(there))
    if both and not believed.intersection(both):
        return f" in belief: both are actually on {' and '.join(each for each in both if each not in down)}"
    return ": both are actually on none" if believed else ""


def _promise(c: Configuration, here: Name, there: Name) -> str:
    """Return advice on a link that the environment may restore; empty if it restores none."""
    physical = c.structure.physical
    for clause in c.setting.environment:
        dropped = isinstance(clause, Drops) and clause.returns and physical.is_down(clause.channel)
        left = isinstance(clause, Leaves) and clause.returns and clause.entity in (here, there)
        if dropped or left:
            return "; it may return: deadlock_freedom under weak fairness of environment counts on that"
    return ""


# --- the awaited input of an agent ----------------------------------------------------------------------------


def _awaited(c: Configuration, a: Name, react: React) -> str:
    if not react.cases:
        return "nothing: it has no case"
    wanted = " or ".join(dict.fromkeys(_shown(case.pattern) for case in react.cases))
    there = ", ".join(map(show, _got(c, a)))
    refused = f"; no case takes {there}" if there else ""
    patterns = [case.pattern for case in react.cases]
    return f"{wanted}{_from(c, a, patterns)}{refused}"


def _from(c: Configuration, a: Name, patterns: Iterable[Pattern]) -> str:
    """Return the possible senders of a message for some patterns, even those that are stuck themselves."""
    senders = _senders(c, a, patterns)
    if senders:
        return f" from {' or '.join(senders)}"
    if any(not isinstance(each, Anything) or each.of != "observation" for each in patterns):
        return ", which no bigActor can send any more"
    asked = any(isinstance(each.request, OBS | READY) for each in c.eta.of(a))
    return "" if asked else ", which it has not asked for"


def _senders(c: Configuration, a: Name, patterns: Iterable[Pattern]) -> list[Name]:
    """Return the agents that have sent, or may still send, a message that a pattern may take."""
    wanted = tuple(patterns)
    return [b for b in c.alpha.names() if _on_its_way(c, a, b, wanted) or _may_send(c, a, b, wanted)]


def _on_its_way(c: Configuration, a: Name, b: Name, patterns: tuple[Pattern, ...]) -> bool:
    sent = (each.request for each in c.eta.of(b))
    said = [each.message for each in sent if isinstance(each, SND) and each.to == a]
    return any(bind(pattern, message) is not None for pattern in patterns for message in said)


def _may_send(c: Configuration, a: Name, b: Name, patterns: tuple[Pattern, ...]) -> bool:
    program = c.setting.program
    found = (program.statements[number] for number in reachable(program, c.alpha.code(b)))
    sends = [each for each in found if isinstance(each, Send) and _may_be_to(each, a)]
    return any(may_take(pattern, each.message) for pattern in patterns for each in sends)


def _may_be_to(send: Send, a: Name) -> bool:
    return not isinstance(send.to, Literal) or send.to.value == a


def _got(c: Configuration, a: Name) -> tuple[Value, ...]:
    ready = (each.request for each in c.eta.ready(a))
    return (*(each.observation for each in ready if isinstance(each, READY)), *c.alpha.mailbox(a))


def _shown(pattern: Pattern) -> str:
    match pattern:
        case Exactly(value):
            return show(value)
        case Elements(items):
            return f"({', '.join(_shown(each) for each in items)})"
        case Anything(_, "observation"):
            return "an observation"
        case Anything(_, "message"):
            return "a message"
        case Anything(variable):
            return written(variable or "_")
