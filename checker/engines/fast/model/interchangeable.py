"""Interchangeability: the names that a mission does not distinguish, so that their lessons are shared."""

from collections import Counter
from collections.abc import Hashable, Iterator, Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property
from typing import Any

from checker.engines.fast.model.rule_cache import Exchange, NoImage, names_in
from checker.recording.access_recording import QuestionScope
from checker.reduction.alpha_equivalence import Pairing, Unlike
from checker.reduction.mission_automorphisms import Automorphisms
from semantics.behaviours.observations import AGENT
from semantics.state.cell_values import Cell, Row
from semantics.state.configuration import Configuration
from semantics.state.setting import Scheduler, Setting
from semantics.state.signature import Name


@dataclass
class Likeness:
    """The names that a mission does not distinguish.

    Attributes:
        setting: The mission.
        still: Its initial configuration.
        mobile: The names with columns for their facts in observations.
        apart: The names that may have parts.
    """

    setting: Setting
    still: Row
    mobile: frozenset[Name]
    apart: frozenset[Name]
    firsts: dict[Name, Name] = field(default_factory=dict)
    mentioning: dict[Cell, bool] = field(default_factory=dict)
    held: dict[Cell, tuple[tuple[Name, Hashable], ...]] = field(default_factory=dict)

    @cached_property
    def _automorphisms(self) -> Automorphisms:
        return Automorphisms(Configuration(self.setting, self.still))

    @cached_property
    def nobody(self) -> Exchange:
        """The identity exchange."""
        return Exchange(self.mobile, self.setting.scheduler is Scheduler.UNORDERED)

    @cached_property
    def _firsts(self) -> dict[Name, tuple[Name, Exchange]]:
        """For each agent, the first interchangeable one, with the exchange of both and of their hosts."""
        found: dict[Name, tuple[Name, Exchange]] = {}
        for agent in self._automorphisms.c.alpha.names():
            firsts = dict.fromkeys(first for first, _ in found.values())
            alike = ((first, self._exchange(first, agent)) for first in firsts)
            found[agent] = next(
                ((first, exchange) for first, exchange in alike if exchange is not None), (agent, self.nobody)
            )
        return found

    @cached_property
    def agents(self) -> dict[Name, tuple[Name, Exchange]]:
        """For each agent that is interchangeable with another, the first one and the exchange to it."""
        many = Counter(first for first, _ in self._firsts.values())
        return {agent: found for agent, found in self._firsts.items() if many[found[0]] > 1}

    @cached_property
    def _movable(self) -> frozenset[Any]:
        """The names that may be exchanged."""
        return self.apart.union(*(exchange.moved for _, exchange in self.agents.values()))

    def mentions_any(self, cell: Cell) -> bool:
        """Return whether a constant cell, or its value, mentions an exchangeable name."""
        if cell not in self.mentioning:
            names = names_in(self.still.read(cell)).union(cell[1:])
            self.mentioning[cell] = cell in self._movable or not names.isdisjoint(self._movable)
        return self.mentioning[cell]

    def alike(self, cell: Cell) -> Iterator[Cell]:
        """Yield the cells that correspond to a cell under exchanges of agents and their hosts."""
        alpha = self._automorphisms.c.alpha
        for one, (first, exchange) in self.agents.items():
            if one in cell or alpha.host(one) in cell:
                of_first = exchange.cell(cell)
                yield from (
                    other.inverse.cell(of_first) for its, other in self.agents.values() if its == first
                )

    def _exchange(self, one: Name, other: Name) -> Exchange | None:
        pairing = Pairing(self._automorphisms.c)
        try:
            pairing.agents(one, other)
            return replace(self.nobody, renaming=self._automorphisms.of_setting(pairing))
        except Unlike:
            return None

    def models(self, names: Sequence[Name], scope: QuestionScope) -> dict[Name, Name]:
        """Return the first interchangeable name for each name with a part, unless it is the name itself.

        A name that the transition's own questions in `scope` mention is interchangeable with none.
        """
        try:
            mentioned, taken = _mentioned(scope), self._taken(scope)
        except NoImage:
            return {}
        there: dict[Hashable, Name] = {}
        models = {
            name: there.setdefault((self._first(name), frozenset(taken.get(name, ()))), name)
            for name in names
            if name not in mentioned and not name.startswith(AGENT)
        }
        return {name: model for name, model in models.items() if name != model}

    def _taken(self, scope: QuestionScope) -> dict[Name, list[Hashable]]:
        """Return, for each name, the contents of constant cells that mention it, with the name removed."""
        found: dict[Name, list[Hashable]] = {}
        for cell in scope.taken:
            if cell not in self.held:
                self.held[cell] = self._held(cell)
            for name, what in self.held[cell]:
                found.setdefault(name, []).append(what)
        return found

    def _held(self, cell: Cell) -> tuple[tuple[Name, Hashable], ...]:
        """Return the names with parts that a cell mentions, each with the cell and its value without the name."""
        value = self.still.read(cell)
        return tuple(
            (name, (tuple(None if each == name else each for each in cell), value if name in cell else None))
            for name in names_in(value).union(cell[1:]).intersection(self.apart)
        )

    def _first(self, name: Name) -> Name:
        """Return the first name seen that is interchangeable with a name."""
        if name not in self.firsts:
            others = dict.fromkeys(self.firsts.values())
            self.firsts[name] = next((each for each in others if self._are_like(each, name)), name)
        return self.firsts[name]

    def _are_like(self, one: Name, other: Name) -> bool:
        pairing = Pairing(self._automorphisms.c)
        try:
            pairing.pair(pairing.names, one, other)
            self._automorphisms.of_setting(pairing)
        except Unlike:
            return False
        return True


def _mentioned(scope: QuestionScope) -> frozenset[Any]:
    """Return the names that questions and answers mention."""
    found: set[Any] = set()
    for ask, answer in scope.asked.items():
        found.update(ask.cell[1:], names_in(ask.constants), names_in(answer))
        if ask.hole is not None:
            found.add(ask.hole[1].removeprefix(AGENT))
    return frozenset(found)
