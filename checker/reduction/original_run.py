"""Unfolding: the run of the unreduced mission behind a configuration of a reduced exploration."""

from __future__ import annotations

from itertools import pairwise
from typing import TYPE_CHECKING

from checker.engines.contract import Exploration
from semantics.state.configuration import Configuration, Transition
from semantics.successors import expand

if TYPE_CHECKING:
    from checker.reduction.configuration_renaming import Renaming
    from checker.reduction.reducer import Reduced


def run_to(found: Exploration, number: int, by: Transition | None = None) -> tuple[Transition, ...]:
    """Return an unreduced run to the configuration that a visited one represents, and then through `by`."""
    assert found.reducer is not None
    steps, real, renaming = _unfold(found, found.reducer, number)
    if by is not None:
        steps.append(_really(found.reducer, by, real, renaming))
    return tuple(steps)


def in_original_names(found: Exploration, number: int, text: str) -> str:
    """Return a text about a visited configuration in the names of the unreduced run to it."""
    if found.reducer is None or found.reducer.symmetry is None:
        return text
    return _unfold(found, found.reducer, number)[2].inverse.text(text)


def _unfold(
    found: Exploration, reducer: Reduced, number: int
) -> tuple[list[Transition], Configuration, Renaming]:
    """Return the unreduced run, its end, and the renaming from there to the visited configuration."""
    real = found.configurations[0] if found.start is None else found.start
    renaming = _sorting(reducer, real)
    steps: list[Transition] = []
    for source, target in pairwise(found.path(number)):
        after = found.configurations[target]
        allowed = expand(found.configurations[source]).transitions
        taken = next(t for t in allowed if reducer.representative(t.target) == after)
        steps.append(_really(reducer, taken, real, renaming))
        real = steps[-1].target
        renaming = _sorting(reducer, taken.target).after(renaming)
    return steps, real, renaming


def _sorting(reducer: Reduced, c: Configuration) -> Renaming:
    from checker.reduction.configuration_renaming import Renaming  # noqa: PLC0415 - only reduced explorations are unfolded

    return Renaming() if reducer.symmetry is None else reducer.symmetry.sorting(c)[0]


def _really(reducer: Reduced, taken: Transition, real: Configuration, renaming: Renaming) -> Transition:
    """Return the step of the unreduced run that corresponds to a step of the representative."""
    if reducer.symmetry is None:
        return taken
    target = renaming.inverse.configuration(taken.target)
    label = renaming.inverse.text(str(taken.label))
    alike = [each for each in expand(real).transitions if each.target == target]
    return next((each for each in alike if str(each.label) == label), alike[0])
