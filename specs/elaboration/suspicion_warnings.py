"""Warnings about ways that the text suggests: they stand unless an exploration refutes them."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field

from semantics.regions.suspicions import SuspectedWay, Suspicion
from specs.diagnostics import Diagnostic


@dataclass(frozen=True, slots=True)
class SuspicionWarning:
    """A warning that stands for one of several suspicions.

    Attributes:
        suspicions: The suspicions.
        warning: The warning as the text alone suggests it.
        confirmed: The function from a suspicion, and a way that confirms it, to the warning.
    """

    suspicions: tuple[Suspicion, ...]
    warning: Diagnostic
    confirmed: Callable[[Suspicion, SuspectedWay], Diagnostic] = field(repr=False)

    def after(self, decided: Mapping[Suspicion, SuspectedWay | None]) -> Diagnostic | None:
        """Return the warning after an exploration; None if it refutes all suspicions."""
        for suspicion in self.suspicions:
            way = decided.get(suspicion)
            if way is not None:
                return self.confirmed(suspicion, way)
        return None if self.suspicions and decided.keys() >= set(self.suspicions) else self.warning
