"""Steps of runs: one transition with its choice, and the steps that a label, an observation or a target may mean."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from semantics.observed_steps import Sight, steps_seen
from semantics.state.brief import cut
from semantics.state.configuration import Configuration, Label, Transition
from semantics.state.requests import Received
from semantics.state.signature import Name
from semantics.state.station_partition import Elsewhere
from semantics.successors import expand_by, served, turn_of


@dataclass(frozen=True, slots=True)
class Step:
    """One transition of a trace.

    Attributes:
        label: Its label.
        choice: The index of the chosen successor among those with that label.
        target: The configuration after it.
        sight: The observation, for a step that the world decided (live).
    """

    label: Label
    choice: int
    target: Configuration
    sight: Sight | Elsewhere | None = None

    def __repr__(self) -> str:
        return f"<Step {cut(self.label)}>"


def step_of(source: Configuration, label: Label, target: Configuration) -> Step:
    """Return the step between two configurations; labels with the same text count as equal, since `replay` has no more.

    For a received observation, the label with the missing parts of the observation is looked up.
    """
    if isinstance(label.about, Received):
        received = (t for t in candidates(source, label=str(label)) if isinstance(t.label.about, Received))
        label = next(t.label for t in received if t.target == target and t.label.agent == label.agent)
    targets = [transition.target for transition in alike(source, str(label))]
    return Step(label, targets.index(target), target)


def step_between(source: Configuration, target: Configuration) -> Step:
    """Return the first step from one configuration to another."""
    changed = target.state.changed(source.state)
    agents = source.alpha.names()
    if changed and all(
        len(cell) > 1 for cell in changed
    ):  # a step changes cells of its agent or the queue, which has no owner
        named = {name for cell in changed for name in cell[1:]}
        agents = tuple(name for name in agents if name in named)
    steps = _in_turn(source, agents)
    return step_of(source, next(step.label for step in steps if step.target == target), target)


def candidates(
    source: Configuration,
    sight: Sight | Elsewhere | None = None,
    label: str | None = None,
    *,
    in_turn: bool = True,
) -> tuple[Transition, ...]:
    """Return the possible next steps, or those that a sight may mean.

    Args:
        source: The configuration before.
        sight: An observation of a live run.
        label: The label of the step. Agents that it does not name are skipped: the label of an agent's step always has
            its name.
        in_turn: Whether requests are served in the turn of `fcfs`.
    """
    agents = [name for name in source.alpha.names() if label is None or name in label]
    if sight is not None:
        return tuple(steps_seen(source, sight, agents))
    if in_turn:
        return _in_turn(source, agents)
    found = expand_by(source, agents)
    return found.enabled + found.by_environment


def _in_turn(source: Configuration, agents: Sequence[Name]) -> tuple[Transition, ...]:
    """Return the possible steps of some agents and the environment, restricted to the turn of all agents."""
    found = expand_by(source, agents).transitions
    turn = next((turn_of(each) for each in found if turn_of(each) is not None), None)
    if turn is None:
        return found
    others = (name for name in source.alpha.names() if name not in agents)
    turns = (turn_of(each) for other in others for each in served(source, other))
    is_first = all(other is None or turn <= other for other in turns)
    return found if is_first else tuple(each for each in found if turn_of(each) is None)


def alike(
    source: Configuration, label: str, sight: Sight | Elsewhere | None = None, *, in_turn: bool = True
) -> list[Transition]:
    """Return the steps with a label."""
    return [each for each in candidates(source, sight, label, in_turn=in_turn) if str(each.label) == label]
