"""A system prepared to run: the possible steps of each state, by priorities and conditions."""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Iterator
from dataclasses import replace
from typing import Final, NamedTuple

from bigraphs.algebra import lean
from bigraphs.bigraph import Bigraph
from bigraphs.canonical_form import canonical
from bigraphs.engine.contexts import occurs, without_idle
from bigraphs.engine.intern_tables import InternTables, has_edges, has_sharing
from bigraphs.engine.labelling import Labelling
from bigraphs.engine.occurrence_search import Matcher
from bigraphs.engine.occurrences import Spot
from bigraphs.engine.patterns import check_size, compile_pattern
from bigraphs.engine.reactions import CompiledReaction
from bigraphs.engine.rule_forms import Forms
from bigraphs.engine.rule_index import ReactionIndex, RuleIndex, numbers_in
from bigraphs.engine.search_state import PatternOccurrence
from bigraphs.engine.state_arrays import GroundState, Key, make_state
from bigraphs.engine.state_digests import Outlines
from bigraphs.errors import BigraphError
from bigraphs.system import System

MOST_INSTANTANEOUS: Final = 100_000
"""The largest number of consecutive instantaneous reactions."""
MANY_INSTANTANEOUS: Final = 100
"""The number of reactions after which states are compared: a sequence that revisits a state never ends."""


class RewritingStep(NamedTuple):
    """A possible step: the rule, its occurrence, and the target state.

    `reactions` counts the step and the instantaneous reactions after it. If several occurrences have equal results,
    only the first one counts these reactions.
    """

    reaction: CompiledReaction
    occurrence: PatternOccurrence
    target: Spot
    reactions: int


class Machine:
    """A system compiled for its world.

    The initial state and both sides of each rule are first put into canonical form, so results do not depend on the
    order of terms in the source.
    """

    def __init__(self, system: System, pause: Callable[[], None] = lambda: None) -> None:
        initial = canonical(lean(replace(system.initial, signature=system.signature)))
        if initial.sites or initial.inner_links:
            hint = "fill its sites, and close or rename its inner names"
            raise BigraphError("target", f"the initial state is not ground: it has {initial.inner}", hint)
        rules = [rule for rule in system.rules() if rule.weight != 0]
        sides = [side for rule in rules for side in (rule.redex, rule.reactum)]
        self.system = system
        self.pause = pause
        self.world = InternTables(
            system.signature,
            initial.outer_names,
            initial.regions,
            sharing=any(map(has_sharing, [initial, *sides])),
            edges=any(has_edges(side) for side in [initial, *(rule.reactum for rule in rules)]),
        )
        self.world.pause = pause
        self.labelling = Labelling(self.world)
        self.outlines = Outlines(self.labelling)
        forms = Forms()
        self.reactions = [
            CompiledReaction(self.world, rule, number, forms) for number, rule in enumerate(rules)
        ]
        self.index = ReactionIndex(self.reactions)
        self.classes = self._classes()
        self.instantaneous = any(instant for _, instant in self.classes)
        self.predicate_index = RuleIndex([self._needs(predicate.pattern) for predicate in system.predicates])
        self.predicates: dict[int, Matcher] = {}
        self.initial = initial

    def _classes(self) -> list[tuple[int, bool]]:
        """Return for each priority class the mask of its rules, and whether it is instantaneous."""
        waiting = iter(range(len(self.reactions)))
        return [
            (sum(1 << next(waiting) for rule in each.rules if rule.weight != 0), each.instantaneous)
            for each in self.system.classes
        ]

    def start(self) -> tuple[Spot, int]:
        """Return the initial state after the instantaneous rules, and the number of their reactions."""
        return self.settle(self.first())

    def first(self) -> Spot:
        """Return the initial state before the instantaneous rules."""
        return Spot(make_state(self.world, self.initial), self.index)

    def holding(self, state: GroundState) -> set[int]:
        """Return the numbers of the predicates that hold in a state."""
        possible = numbers_in(self.predicate_index.possible(state))
        return {number for number in possible if occurs(self._predicate(number), state)}

    def _needs(self, pattern: Bigraph) -> Counter[int]:
        check_size(pattern)
        self.world.know(pattern)
        return Counter(self.world.controls[node.control] for node in pattern.nodes)

    def _predicate(self, number: int) -> Matcher:
        """Return the matcher of a predicate; it is compiled when a state first has enough nodes for it."""
        if number not in self.predicates:
            pattern = without_idle(self.system.predicates[number].pattern)
            self.predicates[number] = Matcher(self.world, compile_pattern(self.world, pattern))
        return self.predicates[number]

    def steps(self, spot: Spot) -> Iterator[RewritingStep]:
        """Yield all possible steps: every occurrence in the highest ordinary priority class that has any."""
        enabled = self.enabled(spot)
        settled: set[Key] = set()
        for reaction, found in enabled:
            result = spot.after(reaction.apply(spot.state, found)[0])
            target, count = self.settle(result)
            if count and len(enabled) > 1:
                count = self._counted(result, count, settled)
            yield RewritingStep(reaction, found, target, 1 + count)

    def enabled(self, spot: Spot) -> list[tuple[CompiledReaction, PatternOccurrence]]:
        """Return every occurrence in the highest ordinary priority class that has any."""
        askable = spot.askable()
        for rules, instant in self.classes:
            if instant or not rules & askable:
                continue
            found = [(reaction, one) for reaction, live in spot.enabled(rules) for one in live]
            if found:
                return found
        return []

    def _counted(self, result: Spot, count: int, settled: set[Key]) -> int:
        """Return the number of instantaneous reactions to count: 0 if an equal result was counted already."""
        key = self.labelling.canonical(result.state)
        if key in settled:
            return 0
        settled.add(key)
        return count

    def settle(self, spot: Spot) -> tuple[Spot, int]:
        """Apply instantaneous rules until none applies or a higher ordinary class is enabled.

        The first applicable rule of a class fires, repeatedly. Each class runs to its end before higher classes are
        tried again.

        Raises:
            BigraphError: If the reactions do not end.
        """
        count = 0
        seen: set[Key] = set()
        while self.instantaneous and (urgent := self.urgent(spot)) is not None:
            rules = self.classes[urgent][0]
            while (target := self.instant(spot, rules)) is not None:
                spot, count = target, count + 1
                self._check_progress(spot, seen, count)
        return spot, count

    def urgent(self, spot: Spot) -> int | None:
        """Return the instantaneous class that acts now; None if an ordinary class precedes it, or none can act."""
        askable = spot.askable()
        for number, (rules, instant) in enumerate(self.classes):
            if rules & askable and any(True for _ in spot.enabled(rules)):
                return number if instant else None
        return None

    def instant(self, spot: Spot, rules: int) -> Spot | None:
        """Apply the first applicable rule; of its results choose the one with the least canonical form."""
        for reaction, live in spot.enabled(rules):
            targets = self.results(spot, reaction, live)
            return targets[self.outlines.least([target.state for target in targets])]
        return None

    def results(self, spot: Spot, reaction: CompiledReaction, live: list[PatternOccurrence]) -> list[Spot]:
        """Return the result of a rule at each of these occurrences."""
        targets = [spot.after(reaction.apply(spot.state, found)[0]) for found in live]
        for target in targets:
            target.lost |= spot.lost
        return targets

    def _check_progress(self, spot: Spot, seen: set[Key], count: int) -> None:
        self.pause()
        if count < MANY_INSTANTANEOUS:
            return
        key = self.labelling.canonical(spot.state)
        if key in seen or count > MOST_INSTANTANEOUS:
            names = sorted(
                {
                    self.reactions[number].label
                    for rules, instant in self.classes
                    if instant
                    for number in numbers_in(rules)
                }
            )
            raise BigraphError(
                "instantaneous",
                f"the instantaneous rules {', '.join(names)} never come to rest",
                "let each of them remove its own redex",
            )
        seen.add(key)
