"""The ranges of quantifiers: the entities of a kind, or bigActors, with the conditions under which they count."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from functools import cache

from bigraphs.notation.spelling import listed
from semantics.properties.propositions import Exists, HostedAt, Or, Proposition
from specs import syntax as s
from specs.codes import Code
from specs.elaboration.bodies import Bodies
from specs.elaboration.names import AGENTS, Names

Instance = tuple[str, Proposition | None]
"""A name in the range of a quantifier, and the condition under which it counts; None if it always does."""


class Among:
    """The ranges of a mission's quantifiers."""

    def __init__(self, names: Names, bodies: Bodies) -> None:
        self.names = names
        self.bodies = bodies
        self.settled = cache(self._settled)

    def instances(self, node: s.Quantified, bound: Mapping[str, str]) -> tuple[Instance, ...]:
        """Return the instances of a quantifier, sorted by name; reports an invalid range."""
        agents = self._agents(node)
        if agents is None:
            return self._entities(node)
        found = [(agent, self._condition(node, agent, bound)) for agent in agents]
        return tuple(
            (agent, None if if_so is True else if_so) for agent, if_so in found if if_so is not False
        )

    def late(self, node: s.Quantified) -> str | None:
        """Return a bigActor in the range that is only spawned; None if there is none."""
        return next((agent for agent in self._agents(node) or () if self.names.agents[agent] is None), None)

    def _agents(self, node: s.Quantified) -> list[str] | None:
        """Return the bigActors in the range, sorted; None if the range has entities."""
        word = node.range.text
        if word in self.names.families:
            agents: Iterable[str] = self.names.families[word].values()
        elif word == AGENTS and word not in self.names.signature.kinds:
            agents = self.names.agents
        else:
            return None
        running = None if node.behaviour is None else self._running(node.behaviour)
        return sorted(agent for agent in agents if running is None or agent in running)

    def _entities(self, node: s.Quantified) -> tuple[Instance, ...]:
        kinds, restricted = self.names.kinds, node.behaviour or node.host
        if restricted is not None:
            message = "only bigActors run a behaviour and have a host"
            self.names.findings.add(Code.WRONG_SORT, restricted, message, "quantify over agents, or a family")
        if not self.names.kind(node.range):
            return ()
        return tuple((name, None) for name, kind in sorted(kinds.items()) if kind == node.range.text)

    def _running(self, behaviour: s.Name) -> frozenset[str]:
        """Return the bigActors that are declared or spawned with a behaviour."""
        name = behaviour.text
        if name not in self.names.behaviours:
            known = self.names.behaviours
            otherwise = listed(known, "behaviours")
            self.names.findings.unknown(behaviour, known, sort="behaviour", otherwise=otherwise)
            return frozenset(self.names.agents)
        spawned = {
            each for each, sites in self.bodies.spawned.items() if any(s.behaviour == name for s in sites)
        }
        return frozenset({each for each, body in self.bodies.agents.items() if body.runs == name} | spawned)

    def _condition(self, node: s.Quantified, agent: str, bound: Mapping[str, str]) -> Proposition | bool:
        """Return the condition under which a bigActor counts: it exists, and has a host of the range."""
        if node.host is None:
            return Exists(agent, implied=True) if self.names.agents[agent] is None else True
        hosts = self._hosts(node.host, bound)
        settled = self.settled(agent)
        if settled is not None:
            return settled in hosts
        there = tuple(HostedAt(agent, host) for host in hosts)
        return there[0] if len(there) == 1 else Or(there)

    def _settled(self, agent: str) -> str | None:
        """Return the constant host of a bigActor; None if its host may change."""
        host = self.names.agents[agent]
        moves = any(body.migrations for body in self.bodies.running(agent))
        return None if host is None or moves else host.text

    def _hosts(self, host: s.Name, bound: Mapping[str, str]) -> tuple[str, ...]:
        if host.text in self.names.signature.kinds:
            return tuple(name for name, kind in sorted(self.names.kinds.items()) if kind == host.text)
        if host.text not in bound:
            self.names.entity(host)
        return (bound.get(host.text, host.text),)
