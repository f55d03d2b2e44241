"""The reductions of an exploration: partial-order reduction, symmetry, or both."""

from collections.abc import Callable, Iterable, Sequence
from itertools import pairwise

from checker.engines.contract import Exploration
from checker.reduction.ample import Ample, Proviso
from checker.reduction.refusals import Reduction, refusal, refuse_partial_order, refuse_symmetry
from checker.reduction.renaming import Renaming
from checker.reduction.symmetry import Symmetry
from semantics.properties.property import Property
from semantics.properties.propositions import Proposition
from semantics.state.configuration import Configuration, Transition
from semantics.successors import Expansion, expand


class Reduced:
    """Applies reductions to one mission.

    Attributes:
        names: Their names, in a fixed order.
    """

    def __init__(
        self,
        initial: Configuration,
        reductions: Iterable[Reduction],
        formulas: Sequence[Proposition] = (),
        proviso: Proviso = Proviso.SOME,
    ) -> None:
        asked = set(reductions)
        self.names = tuple(each for each in Reduction if each in asked)
        if Reduction.POR in asked:
            refuse_partial_order(initial)
        self.ample = Ample(initial, formulas, proviso) if Reduction.POR in asked else None
        self.symmetry: Symmetry | None = None
        if Reduction.SYMMETRY in asked:
            refuse_symmetry(initial)
            self.symmetry = Symmetry(initial, formulas)

    @property
    def putting_off(self) -> bool:
        """Whether steps are postponed: then a trace need not be a shortest one."""
        return self.ample is not None

    def refuses(self, asked: Property) -> str | None:
        """Return why a property is not decided under these reductions, None if it is."""
        return refusal(asked)

    def representative(self, c: Configuration) -> Configuration:
        """Return the representative of a configuration."""
        return c if self.symmetry is None else self.symmetry.representative(c)

    def choose(
        self, c: Configuration, expansion: Expansion, later: Callable[[Transition], bool]
    ) -> tuple[Transition, ...]:
        """Return the transitions to follow."""
        return expansion.transitions if self.ample is None else self.ample.choose(c, expansion, later)

    def hold(self, c: Configuration) -> None:
        """Check the reductions' assumptions on a configuration: footprints, visibility, and symmetry.

        Raises:
            Drift: One does not hold; a bug of ours.
        """
        from checker.reduction.crosscheck import crosscheck, exchange  # noqa: PLC0415  # for --paranoid only

        if self.ample is not None:
            crosscheck(self.ample, c)
        if self.symmetry is not None:
            exchange(self.symmetry, c)

    def run_to(self, found: Exploration, number: int, by: Transition | None = None) -> tuple[Transition, ...]:
        """Return a run of the rules to a configuration that a visited one represents, and then `by`."""
        steps, real, renaming = self._unfold(found, number)
        if by is not None:
            steps.append(self._really(by, real, renaming))
        return tuple(steps)

    def told(self, found: Exploration, number: int, text: str) -> str:
        """Translate a text about a visited configuration to the names at the end of the run."""
        return text if self.symmetry is None else self._unfold(found, number)[2].inverse.text(text)

    def _unfold(self, found: Exploration, number: int) -> tuple[list[Transition], Configuration, Renaming]:
        """Return the run, its end, and the renaming that leads from there to the visited configuration."""
        real = found.configurations[0] if found.start is None else found.start
        renaming = self._sorting(real)
        steps: list[Transition] = []
        for source, target in pairwise(found.path(number)):
            after = found.configurations[target]
            allowed = expand(found.configurations[source]).transitions
            taken = next(t for t in allowed if self.representative(t.target) == after)
            steps.append(self._really(taken, real, renaming))
            real = steps[-1].target
            renaming = self._sorting(taken.target).after(renaming)
        return steps, real, renaming

    def _sorting(self, c: Configuration) -> Renaming:
        return Renaming() if self.symmetry is None else self.symmetry.sorting(c)[0]

    def _really(self, taken: Transition, real: Configuration, renaming: Renaming) -> Transition:
        """Return the step of a real run that corresponds to a step of its end's representative."""
        if self.symmetry is None:
            return taken
        target = renaming.inverse.configuration(taken.target)
        label = renaming.inverse.text(str(taken.label))
        alike = [each for each in candidates(expand(real)) if each.target == target]
        return next((each for each in alike if str(each.label) == label), alike[0])


def candidates(expansion: Expansion) -> tuple[Transition, ...]:
    """Return all transitions, those out of turn last."""
    return expansion.transitions + expansion.out_of_turn


def reducing(
    initial: Configuration, reductions: Iterable[Reduction], formulas: Sequence[Proposition]
) -> Reduced | None:
    """Return the reducer of an exploration, None if no reduction is requested; raises RefusedError."""
    asked = tuple(reductions)
    return Reduced(initial, asked, formulas) if asked else None
