"""Unfolding: the run of the unreduced mission behind a path of a reduced exploration."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from itertools import pairwise
from typing import TYPE_CHECKING

from checker.engines.contract import Exploration
from checker.limits import look
from semantics.state.configuration import Configuration, Label, Transition
from semantics.successors import expand

if TYPE_CHECKING:
    from checker.reduction.configuration_renaming import Renaming
    from checker.reduction.reducer import Reduced

Edge = tuple[int, Label, int]
"""An edge between visited configurations: its source, its label and its target."""


def run_to(found: Exploration, number: int, by: Transition | None = None) -> tuple[Transition, ...]:
    """Return an unreduced run to the configuration that a visited one represents, and then through `by`."""
    run = _run_to(found, number)
    if by is not None:
        run.take(by)
    return tuple(run.steps)


def original_step(taken: Transition, renaming: Renaming, allowed: Iterable[Transition]) -> Transition:
    """Return the step, among those allowed in a configuration, that corresponds to a step of its representative.

    Args:
        taken: The step of the representative.
        renaming: The renaming from the configuration to its representative.
        allowed: The steps of the configuration.
    """
    back = renaming.inverse
    target, label = back.configuration(taken.target), back.text(str(taken.label))
    agent = None if taken.label.agent is None else back.name(taken.label.agent)
    alike = [
        each
        for each in allowed
        if each.target == target and (each.label.rule, each.label.agent) == (taken.label.rule, agent)
    ]
    return next((each for each in alike if str(each.label) == label), alike[0])


def in_original_names(found: Exploration, number: int, text: str, by: Transition | None = None) -> str:
    """Return a text about a visited configuration in the names of the unreduced run to it.

    With times, `by` is the last step of the run that is shown, if it is taken.
    """
    if found.reducer is None or found.reducer.symmetry is None:
        return text
    if found.times is not None:
        return found.times.in_original_names(number, by, text)
    return _run_to(found, number).renaming.inverse.text(text)


def lasso_of(
    found: Exploration, stem: Iterable[Edge], loop: Sequence[Edge]
) -> tuple[tuple[Transition, ...], int]:
    """Return an unreduced run behind a stem and a loop of visited configurations, and the length of its stem.

    One round of the loop may exchange names. The rounds are powers of one permutation, so after finitely many of them
    the run is where the first one began.
    """
    run = _Run(found)
    run.follow(stem)
    begin, entry = len(run.steps), run.real
    while loop:
        look()
        run.follow(loop)
        if run.real == entry:
            break
    return tuple(run.steps), begin


class _Run:
    """An unreduced run beside a path of representatives.

    Attributes:
        steps: Its steps.
        real: Its last configuration.
        renaming: The renaming from there to the visited configuration.
    """

    def __init__(self, found: Exploration) -> None:
        assert found.reducer is not None
        self.found = found
        self.reducer: Reduced = found.reducer
        self.real: Configuration = found.configurations[0] if found.start is None else found.start
        self.renaming = self.sorting(self.real)
        self.steps: list[Transition] = []

    def take(self, taken: Transition) -> None:
        """Go on by the step that corresponds to a step of the representative."""
        self.steps.append(self.really(taken))
        self.real = self.steps[-1].target
        self.renaming = self.sorting(taken.target).after(self.renaming)

    def follow(self, edges: Iterable[Edge]) -> None:
        """Go on along edges."""
        for source, label, target in edges:
            after = self.found.configurations[target]
            self.take(
                next(
                    t
                    for t in expand(self.found.configurations[source]).transitions
                    if (t.label.rule, t.label.agent) == (label.rule, label.agent)
                    and self.reducer.representative(t.target) == after
                )
            )

    def sorting(self, c: Configuration) -> Renaming:
        from checker.reduction.configuration_renaming import Renaming  # noqa: PLC0415 - only reduced explorations are unfolded

        return Renaming() if self.reducer.symmetry is None else self.reducer.symmetry.sorting(c)[0]

    def really(self, taken: Transition) -> Transition:
        """Return the step of the unreduced run that corresponds to a step of the representative."""
        if self.reducer.symmetry is None:
            return taken
        return original_step(taken, self.renaming, expand(self.real).transitions)


def _run_to(found: Exploration, number: int) -> _Run:
    """Return the unreduced run to a visited configuration."""
    run = _Run(found)
    for source, target in pairwise(found.path(number)):
        after = found.configurations[target]
        allowed = expand(found.configurations[source]).transitions
        run.take(next(t for t in allowed if run.reducer.representative(t.target) == after))
    return run
