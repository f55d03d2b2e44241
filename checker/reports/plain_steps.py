"""Steps in plain words: who did what, and what came of it, for readers who do not know the rules."""

from collections.abc import Callable
from typing import Final

from semantics.behaviours.observations import Nodes, Observation, Of, Query, QueryOperator
from semantics.behaviours.values import show
from semantics.state.configuration import Configuration, Label
from semantics.state.differences import Difference, differences
from semantics.state.requests import CTR, FLY, MGR, OBS, READY, SND, Received
from semantics.state.signature import Name

LOOKS: Final = {
    QueryOperator.PARENT: "looks where {} is",
    QueryOperator.CHILDREN: "looks into {}",
    QueryOperator.LINKED_TO: "looks who is linked to {}",
    QueryOperator.HOSTED_AT: "looks which bigActors are at {}",
}

NOUNS: Final = {
    QueryOperator.PARENT: "the place of {}",
    QueryOperator.CHILDREN: "what is in {}",
    QueryOperator.LINKED_TO: "what is linked to {}",
    QueryOperator.HOSTED_AT: "the bigActors at {}",
}

CONTROLS: Final = frozenset({"actuate", "command", "commit"})


def step_words(before: Configuration, label: Label, after: Configuration) -> str:
    """Return a step in words: "b on uav1 looks into gate0, and sees nobody"."""
    if label.agent is None:
        return str(label.about)
    changes = differences(before, after)
    words = _DEEDS.get(label.rule, _other)(label, after, changes)
    return words if label.rule in CONTROLS else f"{agent_words(before, label.agent)} {words}"


def agent_words(c: Configuration, agent: Name) -> str:
    """Return an agent with its host."""
    host = c.alpha.host(agent) if agent in c.alpha.names() else None
    return agent if host in (None, agent) else f"{agent} on {host}"


def look_words(query: Query) -> str:
    """Return an observation in words.

    >>> look_words(Of(QueryOperator.CHILDREN, Of(QueryOperator.PARENT, Nodes(("uav0",)))))
    'looks into the place of uav0'
    """
    if isinstance(query, Of):
        return LOOKS[query.operator].format(_noun(query.of))
    return f"looks at {_noun(query)}"


def _noun(query: Query) -> str:
    if isinstance(query, Of):
        return NOUNS[query.operator].format(_noun(query.of))
    return str(query) if isinstance(query, Nodes) else "everything"


def seen_words(query: Query, seen: Observation) -> str:
    """Return the answer to an observation in words."""
    if isinstance(query, Of) and query.operator is QueryOperator.HOSTED_AT:
        return ", ".join(seen.agents) or "no bigActor"
    return ", ".join(seen.members) or "nobody"


def _sense(label: Label, after: Configuration, _: tuple[Difference, ...]) -> str:
    assert isinstance(label.about, OBS)
    query = label.about.query
    ready = (each.request for each in after.eta.all() if each.request.agent == label.agent)
    seen = next(each.observation for each in ready if isinstance(each, READY) and each.query == query)
    missed = f": it misses {', '.join(label.missed)}" if label.missed else ""
    return f"{look_words(query)}, and sees {seen_words(query, seen)}{missed}"


def _control(label: Label, _: Configuration, changes: tuple[Difference, ...]) -> str:
    assert isinstance(label.about, CTR | FLY)
    moved = [_effect(each) for each in changes if each.part == "P"]
    return f"{', '.join(moved) or label.about.reaction}, as {label.agent} wants"


def _effect(change: Difference) -> str:
    """Return a change of P in words: "uav0 moves from north0 to gate0"."""
    name, _, where = change.text.partition(" : ")
    origin, moves, target = where.partition(" ↦ ")
    if not moves:
        sign, _, channel = where.partition(" ")
        return f"{name} {'joins' if sign == '+' else 'leaves'} {channel}" if channel else change.text
    if target.startswith("on the way to "):
        return f"{name} sets off for {target.removeprefix('on the way to ')}"
    if origin.startswith("on the way to "):
        return f"{name} arrives {target.replace('carried by', 'aboard')}"
    if origin.startswith("in ") and target.startswith("in "):
        return f"{name} moves from {origin[3:]} to {target[3:]}"
    return f"{name} is {target}"


def _received(label: Label, _: Configuration, __: tuple[Difference, ...]) -> str:
    seen = label.about.observation if isinstance(label.about, Received) else None
    return (
        f"takes in what it saw: {', '.join((*seen.members, *seen.agents)) or 'nobody'}"
        if seen
        else "takes it in"
    )


def _asks_to_look(label: Label, after: Configuration, _: tuple[Difference, ...]) -> str:
    asked = (each.request for each in after.eta.all() if each.request.agent == label.agent)
    query = next(
        each.query for each in asked if isinstance(each, OBS) and str(each.query) in str(label.about)
    )
    return look_words(query).replace("looks", "asks to look", 1)


def _sends(label: Label, _: Configuration, __: tuple[Difference, ...]) -> str:
    message, _comma, to = str(label.about).removeprefix("send(").removesuffix(")").rpartition(", ")
    return f"sends {message} to {to}"


def _sent(label: Label, _: Configuration, __: tuple[Difference, ...]) -> str:
    assert isinstance(label.about, SND)
    return f"delivers {show(label.about.message)} to {label.about.to}"


def _migrates(label: Label, _: Configuration, __: tuple[Difference, ...]) -> str:
    assert isinstance(label.about, MGR)
    return f"moves to {label.about.host}"


def _other(label: Label, _: Configuration, __: tuple[Difference, ...]) -> str:
    about = str(label.about)
    inner = about[about.find("(") + 1 : -1] if about.endswith(")") else about
    verb = _VERBS.get(label.rule, label.rule)
    return f"{verb} {inner}".rstrip()


_VERBS: Final = {
    "fun": "thinks",
    "req_ctr": "asks for",
    "rcv_msg": "reads",
    "timeout": "waits no longer:",
    "req_mgr": "asks to move to",
    "spawn": "starts",
}

_DEEDS: Final[dict[str, Callable[[Label, Configuration, tuple[Difference, ...]], str]]] = {
    "req_obs": _asks_to_look,
    "req_snd": _sends,
    "sense": _sense,
    "actuate": _control,
    "command": _control,
    "commit": _control,
    "rcv_obs": _received,
    "snd": _sent,
    "migrate": _migrates,
}
