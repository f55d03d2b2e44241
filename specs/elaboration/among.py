"""What quantifiers go through: the entities of a kind, bigActors, and what has to be true for one to count."""

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
"""A name that a quantified one stands for, and what has to be true for it to count; None where it always does."""


class Among:
    """What the quantifiers of a mission go through."""

    def __init__(self, names: Names, bodies: Bodies) -> None:
        self.names = names
        self.bodies = bodies
        self.settled = cache(self._settled)

    def instances(self, node: s.Quantified, bound: Mapping[str, str]) -> tuple[Instance, ...]:
        """Return what a quantified name stands for, sorted; reports a range that means nothing."""
        agents = self._agents(node)
        if agents is None:
            return self._entities(node)
        found = [(agent, self._condition(node, agent, bound)) for agent in agents]
        return tuple(
            (agent, None if if_so is True else if_so) for agent, if_so in found if if_so is not False
        )

    def late(self, node: s.Quantified) -> str | None:
        """Return a bigActor that is quantified over and only spawned; None where there is none."""
        return next((agent for agent in self._agents(node) or () if self.names.agents[agent] is None), None)

    def _agents(self, node: s.Quantified) -> list[str] | None:
        """Return the bigActors that may be quantified over, sorted; None where it is entities."""
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
        """Return what has to be true for a bigActor to count: that it is there, and hosted where it should be."""
        if node.host is None:
            return Exists(agent, implied=True) if self.names.agents[agent] is None else True
        hosts = self._hosts(node.host, bound)
        settled = self.settled(agent)
        if settled is not None:
            return settled in hosts
        there = tuple(HostedAt(agent, host) for host in hosts)
        return there[0] if len(there) == 1 else Or(there)

    def _settled(self, agent: str) -> str | None:
        """Return where a bigActor is always hosted; None where that may change."""
        host = self.names.agents[agent]
        moves = any(body.migrations for body in self.bodies.running(agent))
        return None if host is None or moves else host.text

    def _hosts(self, host: s.Name, bound: Mapping[str, str]) -> tuple[str, ...]:
        if host.text in self.names.signature.kinds:
            return tuple(name for name, kind in sorted(self.names.kinds.items()) if kind == host.text)
        if host.text not in bound:
            self.names.entity(host)
        return (bound.get(host.text, host.text),)
