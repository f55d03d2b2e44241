"""All declared names of a mission, by sort; failed look-ups are reported."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from itertools import islice
from typing import Final

from bigraphs.notation.spelling import listed
from semantics.behaviours.expressions import Expression
from semantics.behaviours.values import Value, show
from semantics.state.signature import NO_ENTITIES, REGION, Signature
from specs import syntax as s
from specs.codes import Code
from specs.elaboration.mission_mistakes import Findings, a, shorten
from specs.elaboration.type_constraints import Demand, Need, Use, unquoted

SORTS: Final = ("entity", "agent", "family", "kind", "channel", "rule", "behaviour")
AGENTS: Final = "agents"
"""The word for all bigActors in properties, unless a kind or a family has this name."""

WORDS: Final = {
    "agent": "bigActor",
    "family": "family of bigActors",
    "entity": "entity",
    "kind": "kind",
    "channel": "channel",
    "rule": "rule",
    "behaviour": "behaviour",
}
MANY: Final = {
    "agent": "bigActors",
    "family": "families of bigActors",
    "entity": "entities",
    "channel": "channels",
    "rule": "rules",
    "behaviour": "behaviours",
}
EXCLUSIVE: Final = ("entity", "agent", "family", "kind", "channel")
"""Sorts that may not share a name."""


@dataclass(slots=True)
class Names:
    """The declarations of a mission.

    Attributes:
        findings: The collector of mistakes.
        signature: The kinds.
        spans: The first declaration of each name of each sort.
        kinds: The kind of each entity.
        rules: The named rules.
        behaviours: The parametrised behaviours.
        agents: All bigActors, with their initial hosts (None for spawned ones).
        channels: All channels.
        lacking: Kinds that were reported as undeclared.
        families: For each family, its members by their entities, in order.
        hiding: The spans of pattern variables that hide an entity or a bigActor, by its name.
        demands: The required types of expressions, checked when all types are known.
    """

    findings: Findings
    signature: Signature = field(default_factory=Signature)
    spans: dict[tuple[str, str], s.Span] = field(default_factory=dict)
    kinds: dict[str, str] = field(default_factory=dict)
    rules: dict[str, s.Rule] = field(default_factory=dict)
    behaviours: dict[str, s.Definition] = field(default_factory=dict)
    agents: dict[str, s.Name | None] = field(default_factory=dict)
    families: dict[str, dict[str, str]] = field(default_factory=dict)
    channels: set[str] = field(default_factory=set)
    lacking: set[str] = field(default_factory=set)
    hiding: dict[str, list[s.Span]] = field(default_factory=dict)
    demands: list[Demand] = field(default_factory=list)

    def is_taken(self, sort: str, name: str) -> bool:
        """Whether a name is already declared with a sort that it can't share with this one."""
        return any((other, name) in self.spans for other in (EXCLUSIVE if sort in EXCLUSIVE else (sort,)))

    def declare(
        self,
        sort: str,
        name: str,
        where: s.Node | s.Span,
        hint: str = "choose another name for one of the two",
    ) -> bool:
        """Declare a name and return whether it was free; reports one that is declared already."""
        span = where if isinstance(where, s.Span) else where.span
        clashing = EXCLUSIVE if sort in EXCLUSIVE else (sort,)
        taken = next((other for other in clashing if (other, name) in self.spans), None)
        problem = (
            f"is {a(WORDS[taken])} already"
            if taken is not None
            else "is reserved for the space around all places"
            if name == REGION and sort in EXCLUSIVE
            else "is reserved for the place of an unseen node"
            if name in NO_ENTITIES and sort in EXCLUSIVE
            else ""
        )
        if problem:
            line = f", declared in line {self._line(taken, name)}" if taken is not None else ""
            self.findings.add(
                Code.DUPLICATE_NAME,
                span,
                f"'{name}' {problem}{line}",
                hint,
            )
            return False
        self.spans[sort, name] = span
        return True

    def _line(self, sort: str, name: str) -> int:
        return self.findings.source.line(self.spans[sort, name].start)

    def need(self, node: s.Node, value: Expression, need: Need, by: str) -> Expression:
        """Record the required type of an expression, and return the expression."""
        self.demands.append(Use(node, value, need, by))
        return value

    # --- look-ups

    def is_node(self, name: str) -> bool:
        """Whether a name is an entity's."""
        return name in self.kinds

    def entity(self, name: s.Name, otherwise: str = "") -> str | None:
        """Return the kind of an entity; reports an unknown name."""
        kind = self.kinds.get(name.text)
        if kind is None:
            self._missing(name, "entity", self.kinds, otherwise)
        return kind

    def holding(self, kind: str) -> tuple[str, ...]:
        """Return the first five entities that may contain an entity of a kind."""
        found = (name for name, of in sorted(self.kinds.items()) if self.signature[of].may_contain(kind))
        return tuple(islice(found, 5))

    def kind(self, name: s.Name) -> bool:
        """Whether a kind is declared; reports an undeclared one, once. Only rule bodies can name undeclared kinds."""
        if name.text in self.signature.kinds:
            return True
        if name.text not in self.lacking:
            self.lacking.add(name.text)
            kinds = [kind for sort, kind in self.spans if sort == "kind"]
            declare = f"declare it: signature {{ kind {shorten(name.text)} }}"
            self.findings.unknown(name, kinds, sort="kind", code=Code.UNKNOWN_KIND, otherwise=declare)
        return False

    def agent(self, node: s.Agent, bound: Mapping[str, str] | None = None) -> str | None:
        """Return the name of a bigActor; reports an unknown one. `bound` are quantified names."""
        match node:
            case s.Member(family, s.Name(index)):
                return self.member(family, (bound or {}).get(index, index), node.index)
            case s.Member(family, s.IntegerLiteral(number)):
                return self.member(family, number, node.index)
            case s.Name(name):
                if name in self.agents:
                    return name
                self._missing(node, "agent", self.agents)
        return None

    def member(self, family: s.Name, index: Value, where: s.Node) -> str | None:
        """Return the member of a family by its entity or its number; reports an unknown one."""
        members = self.family(family)
        if members is None:
            return None
        called = tuple(members.values())
        if isinstance(index, int) and index < len(called):
            return called[index]
        if isinstance(index, str) and index in members:
            return members[index]
        if isinstance(index, str) and self.kinds.get(index) in self.lacking:
            return None  # its kind is the mistake
        hint = f"its members are {', '.join(called[:5])}{', ...' if len(called) > 5 else ''}"
        message = f"'{family.text}' has no member for {show(index)}"
        hint = unquoted(where, members) or (hint if called else "")
        self.findings.add(Code.UNKNOWN_NAME, where, message, hint)
        return None

    def family(self, name: s.Name) -> Mapping[str, str] | None:
        """Return the members of a family by their entities; reports an unknown family."""
        found = self.families.get(name.text)
        if found is None:
            self._missing(name, "family", self.families)
        return found

    def channel(self, name: s.Name) -> bool:
        """Whether a channel is declared; reports an undeclared one."""
        if name.text in self.channels:
            return True
        otherwise = f"{listed(self.channels, 'channels')}; or declare it: world {{ channel {name.text} }}"
        self._missing(name, "channel", self.channels, otherwise)
        return False

    def _missing(
        self, name: s.Name, sort: str, among: Mapping[str, object] | set[str], otherwise: str = ""
    ) -> None:
        other = self.sort_of(name.text)
        otherwise = otherwise or listed(among, MANY[sort])
        if other is None:
            self.findings.unknown(name, among, sort=WORDS[sort], otherwise=otherwise)
            return
        hint = self._instead(name.text, other, sort) or self.findings.suggest(name.text, among) or otherwise
        self.findings.add(
            Code.WRONG_SORT, name, f"'{name.text}' is {a(WORDS[other])}, and not {a(WORDS[sort])}", hint
        )

    def _instead(self, name: str, other: str, sort: str) -> str:
        if other == "family" and sort == "agent":
            return f"name a member: {next(iter(self.families[name].values()), f'{name}[...]')}"
        if other == "entity" and sort == "agent":
            hosted = [agent for agent, host in self.agents.items() if host is not None and host.text == name]
            return f"name the bigActor that it hosts: {hosted[0]}" if hosted else ""
        host = self.agents.get(name) if other == "agent" and sort == "entity" else None
        return f"its host is '{host.text}'" if host is not None and host.text != name else ""

    def sort_of(self, name: str) -> str | None:
        """Return the first sort of a declared name."""
        return next((sort for sort in SORTS if (sort, name) in self.spans), None)
