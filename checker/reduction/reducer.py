"""What an exploration is given to visit less: partial-order reduction, symmetry, or both."""

from collections.abc import Callable, Iterable
from itertools import pairwise

from checker.exploration import Exploration
from checker.reduction.ample import Ample, Proviso
from checker.reduction.refusals import Reduction, refusal, refuse_partial_order
from semantics.configuration import Configuration, Transition
from semantics.propositions import Property, Proposition
from semantics.successors import Expansion, expand


class Reduced:
    """Applies reductions to one mission.

    Attributes:
        names: What they are called, in one order.
    """

    def __init__(
        self,
        initial: Configuration,
        reductions: Iterable[Reduction],
        formulas: Iterable[Proposition] = (),
        proviso: Proviso = Proviso.SOME,
    ) -> None:
        asked = set(reductions)
        self.names = tuple(each for each in Reduction if each in asked)
        self.ample: Ample | None = None
        if Reduction.POR in asked:
            refuse_partial_order(initial)
            self.ample = Ample(initial, formulas, proviso)

    @property
    def putting_off(self) -> bool:
        """Whether steps are put off: then a trace need not be a shortest one."""
        return self.ample is not None

    def refuses(self, asked: Property) -> str | None:
        """Return why a property is not decided under these reductions, None where it is."""
        return next(filter(None, (refusal(each, asked) for each in self.names)), None)

    def representative(self, c: Configuration) -> Configuration:
        """Return the configuration that stands for one."""
        return c

    def choose(
        self, c: Configuration, expansion: Expansion, later: Callable[[Transition], bool]
    ) -> tuple[Transition, ...]:
        """Return the transitions to be followed."""
        return expansion.transitions if self.ample is None else self.ample.choose(c, expansion, later)

    def run_to(self, found: Exploration, number: int) -> tuple[Transition, ...]:
        """Return a run of the rules from the initial configuration to what a visited one stands for."""
        steps = []
        path = found.path(number)
        for source, target in pairwise(path):
            label, after = found.labels[target], found.configurations[target]
            allowed = expand(found.configurations[source]).transitions
            steps.append(next(each for each in allowed if (each.label, each.target) == (label, after)))
        return tuple(steps)


def reducing(
    initial: Configuration, reductions: Iterable[Reduction], formulas: Iterable[Proposition]
) -> Reduced | None:
    """Return what reduces an exploration, None where nothing is asked for; raises RefusedError."""
    asked = tuple(reductions)
    return Reduced(initial, asked, formulas) if asked else None
