"""The questions of inspections: pure functions of a configuration.

Each is about one agent, or two, so that answers do not multiply.
"""

from typing import Any

from checker.properties.coverage import passed_over
from checker.properties.inspections import is_at_rest, is_unfair, is_waiting
from checker.properties.races import compared, enabled_controls, is_stale
from semantics.control import obstacle
from semantics.races.monitor import CONTROLS
from semantics.state.agents import code_cell
from semantics.state.configuration import Configuration, Transition
from semantics.state.requests import CTR, FLY
from semantics.state.signature import Name
from semantics.successors import moves, served

Key = tuple[str, str]
"""What is wrong: its kind and its subject."""


def controls_in_line(a: Name, c: Configuration) -> tuple[Key | None, ...]:
    """Return what hinders each control that is next in an agent's line."""
    found: list[Key | None] = []
    if a in c.alpha:
        done = {step.served.request for step in served(c, a) if step.served is not None}
        for pending in c.eta.in_line(a):
            if isinstance(pending.request, CTR | FLY):
                hindered = None if pending.request in done else obstacle(c, pending.request)
                found.append(hindered and (hindered.value, str(pending.request)))
    return tuple(found)


def computations(a: Name, c: Configuration) -> tuple[bool, tuple[Key, ...]]:
    """Return whether an agent computes, and how that fails."""
    steps = list(moves(c, a)) if a in c.alpha else []
    faults = [step for step in steps if not isinstance(step, Transition)]
    keys = tuple(("diverges" if f.diverges else "fails", f"{f.agent}: {f}") for f in faults)
    return any(isinstance(step, Transition) and step.label.rule == "fun" for step in steps), keys


def what_is_served(a: Name, c: Configuration) -> tuple[bool, bool, tuple[str, ...]]:
    """Return whether something of an agent must be served, whether a flight may end, and what is pending or may end."""
    if a not in c.alpha:
        return False, False, ()
    steps = list(served(c, a))
    fair = any(not is_unfair(c, step) for step in steps)
    words = (*(str(step.label) for step in steps), *(str(each.request) for each in c.eta.of(a)))
    return fair, any(step.label.rule == "commit" for step in steps), () if fair else words


def what_moves(a: Name, c: Configuration) -> tuple[bool, bool, bool]:
    """Return whether an agent can go on, whether it failed, and whether it waits."""
    if a not in c.alpha:
        return False, False, False
    steps = list(moves(c, a))
    can = any(isinstance(step, Transition) for step in steps)
    return can, bool(steps) and not can, not can and is_waiting(c, a) and not is_at_rest(c, a)


def races_between(a: Name, b: Name, c: Configuration) -> tuple[Key | None, ...]:
    """Return what is wrong with each pair of enabled controls of two agents, or of one."""
    if a not in c.alpha or b not in c.alpha:
        return ()
    steps = [step for each in dict.fromkeys((a, b)) for step in dict.fromkeys(served(c, each))]
    pairs = compared(c, enabled_controls(steps))
    about = [(one, other, problem) for one, other, problem in pairs if _are(one, other, a, b)]
    return tuple(problem and ("control race", problem[1]) for _, _, problem in about)


def _are(one: list[Transition], other: list[Transition], a: Name, b: Name) -> bool:
    return {one[0].label.agent, other[0].label.agent} == {a, b}


def stale_controls(a: Name, c: Configuration) -> tuple[Key | None, ...]:
    """Return which controls of an agent rest on what others have changed."""
    steps = dict.fromkeys(served(c, a) if a in c.alpha else ())
    found = ((step, step.served) for step in steps if step.label.rule in CONTROLS and step.served is not None)
    return tuple(
        ("stale-observation race", str(pending.request)) if is_stale(c, pending) else None
        for _, pending in found
    )


def where_it_stands(a: Name, c: Configuration) -> Any:
    """Return what is left of an agent to run, and what its computation passes over."""
    if a not in c.alpha:
        return None
    return c.read(code_cell(a)), passed_over(c, a)
