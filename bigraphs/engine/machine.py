"""A system prepared to run: the possible steps of each state, by priorities and conditions."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import replace
from typing import Final, NamedTuple

from bigraphs.algebra import lean
from bigraphs.bigraph import Bigraph
from bigraphs.canonical import canonical
from bigraphs.engine.contexts import occurs, without_idle
from bigraphs.engine.decoding import history_free
from bigraphs.engine.labelling import Labelling
from bigraphs.engine.occurrences import Spot
from bigraphs.engine.patterns import compile_pattern
from bigraphs.engine.reactions import Reaction
from bigraphs.engine.search import Matcher
from bigraphs.engine.search_state import Occurrence
from bigraphs.engine.state import Key, State, make_state
from bigraphs.engine.world import World, has_sharing
from bigraphs.errors import BigraphError
from bigraphs.system import Rule, System

MOST_INSTANTANEOUS: Final = 100_000
"""How many instantaneous reactions may follow one another."""


class Step(NamedTuple):
    """One thing that can happen: the rule, where, and the state that it leads to.

    `reactions` counts it and the instantaneous reactions that follow, which are counted once where several occurrences
    have equal results.
    """

    reaction: Reaction
    occurrence: Occurrence
    target: Spot
    reactions: int


class Machine:
    """A system compiled for its world.

    Results do not depend on the order in which terms are written: the initial state and both sides of each rule
    are put into canonical form first.
    """

    def __init__(self, system: System, pause: Callable[[], None] = lambda: None) -> None:
        initial = canonical(lean(replace(system.initial, signature=system.signature)))
        if initial.sites or initial.inner_links:
            hint = "fill its sites, and close or rename its inner names"
            raise BigraphError("target", f"the initial state is not ground: it has {initial.inner}", hint)
        rules = [_canonical_rule(rule) for rule in system.rules() if rule.weight != 0]
        sides = [side for rule in rules for side in (rule.redex, rule.reactum)]
        self.system = system
        self.pause = pause
        self.world = World(
            system.signature,
            initial.outer_names,
            initial.regions,
            sharing=any(map(has_sharing, [initial, *sides])),
            edges=any(side.edges for side in [initial, *(rule.reactum for rule in rules)]),
        )
        self.world.pause = pause
        self.labelling = Labelling(self.world)
        self.reactions = [Reaction(self.world, rule, number) for number, rule in enumerate(rules)]
        self.classes = self._classes()
        self.instantaneous = any(instant for _, instant in self.classes)
        self.predicates = [
            Matcher(self.world, compile_pattern(self.world, without_idle(predicate.pattern)))
            for predicate in system.predicates
        ]
        self.initial = initial

    def _classes(self) -> list[tuple[list[Reaction], bool]]:
        waiting = iter(self.reactions)
        return [
            ([next(waiting) for rule in each.rules if rule.weight != 0], each.instantaneous)
            for each in self.system.classes
        ]

    def start(self) -> tuple[Spot, int]:
        """Return the initial state after the instantaneous rules, and how many of their reactions that took."""
        return self.settle(Spot(make_state(self.world, self.initial), len(self.reactions)))

    def holds(self, predicate: int, state: State) -> bool:
        """Say whether a predicate occurs in a state."""
        return occurs(self.predicates[predicate], state)

    def steps(self, spot: Spot) -> Iterator[Step]:
        """Yield all that can happen: every occurrence in the first class of priority that has any."""
        for reactions, instant in self.classes:
            if instant:
                continue
            enabled = [(reaction, found) for reaction in reactions for found in spot.live(reaction)]
            settled: set[Key] = set()
            for reaction, found in enabled:
                result = spot.after(reaction.apply(spot.state, found)[0])
                target, count = self.settle(result)
                yield Step(reaction, found, target, 1 + (count and self._counted(result, count, settled)))
            if enabled:
                return

    def _counted(self, result: Spot, count: int, settled: set[Key]) -> int:
        """Return a number of instantaneous reactions, 0 where those that follow an equal result are counted already."""
        key = self.labelling.canonical(result.state)
        if key in settled:
            return 0
        settled.add(key)
        return count

    def settle(self, spot: Spot) -> tuple[Spot, int]:
        """Apply instantaneous rules until none can be applied, or an ordinary class above them is enabled.

        Each instantaneous class is run to its end before higher ones are asked again. Raises BigraphError if that
        does not end.
        """
        count = 0
        seen: set[Key] = set()
        while self.instantaneous:
            found = self._settle_once(spot, seen, count)
            if found is None:
                break
            spot, count = found
        return spot, count

    def _settle_once(self, spot: Spot, seen: set[Key], count: int) -> tuple[Spot, int] | None:
        """Run the first instantaneous class that is enabled to its end; None if there is none."""
        for reactions, instant in self.classes:
            if not instant:
                if any(spot.live(reaction) for reaction in reactions):
                    return None
                continue
            before = count
            while (target := self._instant(spot, reactions)) is not None:
                spot, count = target, count + 1
                self._check_progress(spot, seen, count)
            if count > before:
                return spot, count
        return None

    def _instant(self, spot: Spot, reactions: list[Reaction]) -> Spot | None:
        """Apply the first rule that can be; of its results the one with the least canonical form."""
        for reaction in reactions:
            live = spot.live(reaction)
            if live:
                results: dict[Key, Spot] = {}
                for found in live:
                    target = spot.after(reaction.apply(spot.state, found)[0])
                    target.lost |= spot.lost
                    results.setdefault(self.labelling.canonical(target.state), target)
                if len(results) == 1:
                    return next(iter(results.values()))
                return min(results.values(), key=lambda target: history_free(target.state))
        return None

    def _check_progress(self, spot: Spot, seen: set[Key], count: int) -> None:
        self.pause()
        key = self.labelling.canonical(spot.state)
        if key in seen or count > MOST_INSTANTANEOUS:
            names = sorted(
                {reaction.rule.label for rules, instant in self.classes if instant for reaction in rules}
            )
            raise BigraphError(
                "instantaneous",
                f"the instantaneous rules {', '.join(names)} never come to rest",
                "let each of them take away what it looks for",
            )
        seen.add(key)


def _canonical_rule(rule: Rule) -> Rule:
    return replace(rule, redex=_tidy(rule.redex), reactum=_tidy(rule.reactum))


def _tidy(side: Bigraph) -> Bigraph:
    return canonical(lean(side))
