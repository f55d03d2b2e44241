"""The reductions of an exploration: partial-order reduction, symmetry, or both."""

from collections.abc import Iterable, Sequence

from checker.reduction.ample import Ample, Followed, Reached
from checker.reduction.cycle_proviso import Paths
from checker.reduction.refusals import Reduction, refusal, refuse_partial_order, refuse_symmetry
from checker.reduction.symmetry import MissionSymmetry
from semantics.properties.property import Property
from semantics.properties.propositions import Proposition
from semantics.state.configuration import Configuration
from semantics.successors import Expansion


class Reduced:
    """Applies reductions to one mission.

    Attributes:
        names: Their names, in a fixed order.
        identity: Their names, and the propositions that they keep: whatever decides which configurations are visited.
    """

    def __init__(
        self,
        initial: Configuration,
        reductions: Iterable[Reduction],
        formulas: Sequence[Proposition] = (),
    ) -> None:
        asked = set(reductions)
        self.names = tuple(each for each in Reduction if each in asked)
        self.identity = f"{', '.join(map(str, self.names))}: {tuple(formulas)!r}"
        if Reduction.POR in asked:
            refuse_partial_order(initial)
        self.ample = Ample(initial, formulas) if Reduction.POR in asked else None
        self.symmetry: MissionSymmetry | None = None
        if Reduction.SYMMETRY in asked:
            refuse_symmetry(initial)
            self.symmetry = MissionSymmetry(initial, formulas)

    @property
    def putting_off(self) -> bool:
        """Whether steps are postponed, so that a trace may not be a shortest one."""
        return self.ample is not None

    def refuses(self, asked: Property) -> str | None:
        """Return why a property is undecided under these reductions, None if it is decided."""
        return refusal(asked)

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
        from checker.reduction.footprint_check import crosscheck, exchange  # noqa: PLC0415  # for --paranoid only

        if self.ample is not None:
            crosscheck(self.ample, c)
        if self.symmetry is not None:
            exchange(self.symmetry, c)
