"""All declared names of a mission, by sort; failed look-ups are reported."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Final

from semantics.state.signature import REGION, Signature
from specs import syntax as s
from specs.codes import Code
from specs.elaboration.findings import Findings, a, shorten

SORTS: Final = ("entity", "agent", "kind", "channel", "rule", "behaviour")
WORDS: Final = {
    "agent": "bigActor",
    "entity": "entity",
    "kind": "kind",
    "channel": "channel",
    "rule": "rule",
    "behaviour": "behaviour",
}
EXCLUSIVE: Final = ("entity", "agent", "kind", "channel")
"""Sorts whose names differ from each other."""


@dataclass(slots=True)
class Names:
    """What is declared where.

    Attributes:
        findings: Where mistakes go.
        signature: The kinds.
        spans: Where each name of each sort is declared first.
        kinds: The kind of each entity.
        rules: The named rules.
        behaviours: The parametrised behaviours.
        agents: All bigActors, spawned ones too, with their hosts (None for spawned ones).
        channels: All channels.
        lacking: Kinds that were reported as undeclared.
    """

    findings: Findings
    signature: Signature = field(default_factory=Signature)
    spans: dict[tuple[str, str], s.Span] = field(default_factory=dict)
    kinds: dict[str, str] = field(default_factory=dict)
    rules: dict[str, s.Rule] = field(default_factory=dict)
    behaviours: dict[str, s.Definition] = field(default_factory=dict)
    agents: dict[str, s.Name | None] = field(default_factory=dict)
    channels: set[str] = field(default_factory=set)
    lacking: set[str] = field(default_factory=set)

    def declare(self, sort: str, name: str, where: s.Node | s.Span) -> bool:
        """Give a name its meaning; reports one that has a meaning already, and tells whether all is well."""
        span = where if isinstance(where, s.Span) else where.span
        clashing = EXCLUSIVE if sort in EXCLUSIVE else (sort,)
        taken = next((other for other in clashing if (other, name) in self.spans), None)
        problem = (
            f"is {a(WORDS[taken])} already"
            if taken is not None
            else "is what lies around everything"
            if name == REGION and sort in EXCLUSIVE
            else ""
        )
        if problem:
            line = f", declared in line {self._line(taken, name)}" if taken is not None else ""
            self.findings.add(
                Code.DUPLICATE_NAME,
                span,
                f"'{name}' {problem}{line}",
                "choose another name for one of the two",
            )
            return False
        self.spans[sort, name] = span
        return True

    def _line(self, sort: str, name: str) -> int:
        return self.findings.source.line(self.spans[sort, name].start)

    # --- look-ups

    def is_node(self, name: str) -> bool:
        """Tell whether a name is an entity's."""
        return name in self.kinds

    def entity(self, name: s.Name, otherwise: str = "") -> str | None:
        """Return the kind of the entity of that name; reports a name that is none."""
        kind = self.kinds.get(name.text)
        if kind is None:
            self._missing(name, "entity", self.kinds, otherwise)
        return kind

    def kind(self, name: s.Name) -> bool:
        """Tell whether there is such a kind, and report one that there isn't, once: only rules' bodies name any."""
        if name.text in self.signature.kinds:
            return True
        if name.text not in self.lacking:
            self.lacking.add(name.text)
            kinds = [kind for sort, kind in self.spans if sort == "kind"]
            declare = f"declare it: signature {{ kind {shorten(name.text)} }}"
            self.findings.unknown(name, kinds, sort="kind", code=Code.UNKNOWN_KIND, otherwise=declare)
        return False

    def agent(self, name: s.Name) -> bool:
        """Tell whether there is such a bigActor, and report one that there isn't."""
        if name.text in self.agents:
            return True
        self._missing(name, "agent", self.agents)
        return False

    def channel(self, name: s.Name) -> bool:
        """Tell whether there is such a channel, and report one that there isn't."""
        if name.text in self.channels:
            return True
        otherwise = f"declare it: world {{ channel {name.text} }}"
        self._missing(name, "channel", self.channels, otherwise)
        return False

    def _missing(
        self, name: s.Name, sort: str, among: Mapping[str, object] | set[str], otherwise: str = ""
    ) -> None:
        other = self.sort_of(name.text)
        if other is None:
            self.findings.unknown(name, among, sort=WORDS[sort], otherwise=otherwise)
            return
        hint = self._instead(name.text, other, sort) or self.findings.suggest(name.text, among) or otherwise
        self.findings.add(
            Code.WRONG_SORT, name, f"'{name.text}' is {a(WORDS[other])}, and not {a(WORDS[sort])}", hint
        )

    def _instead(self, name: str, other: str, sort: str) -> str:
        host = self.agents.get(name) if other == "agent" and sort == "entity" else None
        return f"its host is '{host.text}'" if host is not None else ""

    def sort_of(self, name: str) -> str | None:
        """Return the first sort that a name is declared as."""
        return next((sort for sort in SORTS if (sort, name) in self.spans), None)
