"""The reductions of an exploration: partial-order reduction, symmetry, or both."""

from collections.abc import Iterable, Sequence
from dataclasses import replace
from typing import Self

from checker.reduction.ample import Ample, Followed, Reached
from checker.reduction.conjunct_orbits import one_of_each
from checker.reduction.cycle_proviso import Paths
from checker.reduction.preserved_runs import (
    distinguished,
    distinguished_by,
    follows_names,
    named_in_fairness,
    refused_by_por,
    refused_by_symmetry,
    refused_formula,
    told_apart,
)
from checker.reduction.refusals import Reduction, RefusedError, refuse_partial_order, refuse_symmetry
from checker.reduction.symmetry import MissionSymmetry
from semantics.properties.property import Property
from semantics.properties.propositions import Proposition
from semantics.properties.temporal import Temporal
from semantics.state.configuration import Configuration
from semantics.successors import Expansion


class Reduced:
    """Applies reductions to one mission.

    Args:
        initial: The initial configuration.
        reductions: The reductions.
        formulas: The propositions of invariants and of reachability.
        runs: The properties of runs.

    Attributes:
        names: Their names, in a fixed order.
        runs: The properties of runs that the reductions preserve.
        identity: Whatever decides which configurations are visited, as text.
    """

    def __init__(
        self,
        initial: Configuration,
        reductions: Iterable[Reduction],
        formulas: Sequence[Proposition] = (),
        runs: Iterable[Property] = (),
    ) -> None:
        runs = tuple(runs)
        self.made_of = (initial, tuple(reductions), tuple(formulas), runs)
        self.reductions = frozenset(self.made_of[1])
        self.names = tuple(each for each in Reduction if each in self.reductions)
        self.symmetry: MissionSymmetry | None = None
        if Reduction.POR in self.reductions:
            refuse_partial_order(initial)
        self.standing: dict[Property, Property] = {}
        asked = [each for each in runs if self.refuses(each) is None]
        if Reduction.SYMMETRY in self.reductions:
            refuse_symmetry(initial)
            every = MissionSymmetry(initial, formulas)
            self.standing = {each: _standing(each, every) for each in asked}
            self.symmetry = _narrowed(every, formulas, self.standing.values())
        self.runs = tuple(self.decided_for(each) for each in asked if self.refuses(each) is None)
        self.ample = Ample(initial, formulas, self.runs) if Reduction.POR in self.reductions else None
        self.identity = repr((tuple(map(str, self.names)), tuple(formulas), self.runs))

    def __reduce__(self) -> tuple[type[Self], tuple[object, ...]]:
        """Return how another process makes the same."""
        return type(self), self.made_of

    @property
    def putting_off(self) -> bool:
        """Whether steps are postponed, so that a trace may not be a shortest one."""
        return self.ample is not None

    def refuses(self, asked: Property) -> str | None:
        """Return why a property is undecided under these reductions, None if it is decided."""
        if not asked.is_of_runs:
            return None
        reason = refused_by_por(asked) if Reduction.POR in self.reductions else None
        if reason is None and self.symmetry is not None:
            reason = refused_by_symmetry(self.decided_for(asked), self.symmetry)
        return reason

    def decided_for(self, asked: Property) -> Property:
        """Return the property that is decided for a property of runs: with one of the conjuncts that are exchanged."""
        return self.standing.get(asked, asked)

    def keeps(self, formula: Temporal) -> bool:
        """Return whether the runs of a reduced search decide a formula whose propositions it was told of."""
        if self.ample is not None and refused_formula(formula) is not None:
            return False
        return self.symmetry is None or told_apart(distinguished_by(formula), self.symmetry) is None

    def representative(self, c: Configuration) -> Configuration:
        """Return the representative of a configuration."""
        return c if self.symmetry is None else self.symmetry.representative(c)

    def paths(self) -> Paths:
        """Return the paths of a new exploration; symmetry renames actors along them."""
        return Paths(named=self.symmetry is None)

    def choose(
        self, c: Configuration, expansion: Expansion, number: int, reached: Reached, paths: Paths
    ) -> Followed:
        """Return the transitions to follow from a configuration, given its number."""
        if self.ample is None:
            return Followed(expansion.transitions)
        return self.ample.choose(c, expansion, number, reached, paths)

    def hold(self, c: Configuration) -> None:
        """Check the reductions' assumptions on a configuration: footprints, visibility, and symmetry.

        Raises:
            Drift: An assumption fails; a bug of ours.
        """
        from checker.reduction.exchange_check import exchange  # noqa: PLC0415  # for --paranoid only
        from checker.reduction.footprint_check import crosscheck  # noqa: PLC0415  # the same

        if self.ample is not None:
            crosscheck(self.ample, c)
        if self.symmetry is not None:
            exchange(self.symmetry, c)


def _standing(asked: Property, symmetry: MissionSymmetry) -> Property:
    """Return a property with one of the conjuncts that exchanges map to one another, if these preserve its fairness."""
    if asked.temporal is None or refused_by_symmetry(asked, symmetry) is None:
        return asked
    if told_apart(named_in_fairness(asked), symmetry) is not None:
        return asked
    return replace(asked, temporal=one_of_each(asked.temporal, symmetry.exchanges))


def _narrowed(
    every: MissionSymmetry, formulas: Sequence[Proposition], runs: Iterable[Property]
) -> MissionSymmetry:
    """Return the exchanges that preserve properties of runs, too, unless none is left."""
    asked = [each for each in runs if follows_names(each, every) is None]
    if all(refused_by_symmetry(each, every) is None for each in asked):
        return every
    try:
        told = (part for each in asked for part in distinguished(each))
        return MissionSymmetry(every.initial, [*formulas, *told])
    except RefusedError:
        return every
