"""The properties of runs that reductions preserve, and the reasons for refusing others.

docs/explanation/reduction.md has the proofs.
"""

from collections.abc import Iterable, Iterator
from typing import Protocol

from checker.reduction.configuration_renaming import Renaming
from checker.reduction.mission_automorphisms import changing
from checker.reduction.stutter_invariance import is_stutter_invariant
from semantics.fixpoints import closure
from semantics.properties.kinds import PropertyKind
from semantics.properties.property import Property
from semantics.properties.propositions import And, Exists, Not, Or, Proposition
from semantics.properties.temporal import (
    Both,
    Denied,
    Either,
    Enabled,
    Fairness,
    Next,
    Now,
    State,
    Steps,
    Taken,
    Temporal,
    atoms,
    chain,
    parts,
)


class ExchangeGroup(Protocol):
    """A group of exchanges of names."""

    @property
    def exchanges(self) -> tuple[Renaming, ...]:
        """Exchanges that generate the group."""

    @property
    def moves_agents(self) -> bool:
        """Whether some exchange changes the name of a bigActor."""


# --- partial-order reduction ----------------------------------------------------------------------------------


def refused_by_por(asked: Property) -> str | None:
    """Return why partial-order reduction leaves a property of runs undecided, None if it preserves it.

    Where only the environment moves, nothing is left out. So deadlocks under fairness are preserved.
    """
    if asked.kind is PropertyKind.DEADLOCK_FREEDOM:
        return None
    if asked.fairness or asked.kind is PropertyKind.PROGRESS:
        return "fairness asks which steps stay enabled, and this depends on the order of independent steps"
    assert asked.temporal is not None
    return refused_formula(asked.temporal)


def refused_formula(formula: Temporal) -> str | None:
    """Return why partial-order reduction does not preserve a formula, None if it does."""
    if any(isinstance(each, Next) for each in closure([formula], parts)):
        return "'X' counts steps, and independent steps of others are left out"
    if any(isinstance(each, Enabled) for each in atoms(formula)):
        return "'enabled' asks which steps are possible, and some of these are left out"
    if not is_stutter_invariant(formula):
        return (
            "'taken' asks here for the very next step, and independent steps of others are left out before it"
        )
    return None


def propositions_of(runs: Iterable[Property]) -> Iterator[Proposition]:
    """Yield the propositions in the formulas of properties."""
    for atom in _atoms(runs):
        if isinstance(atom, Now):
            yield atom.proposition


def steps_of(runs: Iterable[Property]) -> Iterator[Steps]:
    """Yield the steps that the formulas of properties name."""
    for atom in _atoms(runs):
        if isinstance(atom, Taken | Enabled):
            yield atom.steps


def _atoms(runs: Iterable[Property]) -> Iterator[State]:
    return (atom for each in runs if each.temporal is not None for atom in atoms(each.temporal))


# --- symmetry -------------------------------------------------------------------------------------------------


def refused_by_symmetry(asked: Property, symmetry: ExchangeGroup) -> str | None:
    """Return why symmetry leaves a property of runs undecided, None if it preserves it."""
    reason = follows_names(asked, symmetry)
    if reason is not None:
        return reason
    apart = told_apart(distinguished(asked), symmetry)
    if apart is None:
        return None
    one, other = apart
    return f"it asks of '{one}' at some moment what it does not ask of '{other}', and they are exchanged"


def told_apart(propositions: Iterable[Proposition], symmetry: ExchangeGroup) -> tuple[str, str] | None:
    """Return two exchanged names that some proposition distinguishes, None if each exchange preserves all."""
    for each in propositions:
        renaming = changing(each, symmetry.exchanges)
        if renaming is not None:
            return min(renaming.names.items())
    return None


def follows_names(asked: Property, symmetry: ExchangeGroup) -> str | None:
    """Return why a property follows names along a run, None if it doesn't: an exchange changes them on the way."""
    if asked.kind is PropertyKind.PROGRESS:
        return "progress follows each request by its name, and an exchange changes names along a run"
    by_name = next((each for each in asked.fairness if _is_by_name(each, symmetry)), None)
    if by_name is None:
        return None
    return f"{by_name} is owed to each by its name, and an exchange changes names along a run"


def distinguished(asked: Property) -> Iterator[Proposition]:
    """Yield propositions: an exchange that preserves each of them preserves the property."""
    if asked.temporal is not None:
        yield from distinguished_by(asked.temporal)
    yield from named_in_fairness(asked)


def named_in_fairness(asked: Property) -> Iterator[Proposition]:
    """Yield the presence of each bigActor that a fairness condition names."""
    for each in asked.fairness:
        yield from _named(each.steps)


def _is_by_name(fairness: Fairness, symmetry: ExchangeGroup) -> bool:
    """Return whether an exchange mixes steps that a fairness condition promises separately.

    The label of a step has the names of agents and entities.
    """
    by_agent = "agent" in fairness.per and fairness.steps.agent is None
    return "label" in fairness.per or (by_agent and symmetry.moves_agents)


def distinguished_by(formula: Temporal) -> Iterator[Proposition]:
    """Yield propositions: an exchange that preserves each of them preserves the truth of the formula.

    These are the maximal parts about single configurations, and the presence of each bigActor whose steps are named.
    The formula as a whole is not enough: `<> p(a) and <> p(b)` is invariant, and neither part is.
    """
    whole = _proposition(formula)
    if whole is not None:
        yield whole
    elif isinstance(formula, Taken | Enabled):
        yield from _named(formula.steps)
    elif isinstance(formula, Both | Either):
        operands = list(chain(formula, type(formula)))
        about = [each for each in map(_proposition, operands) if each is not None]
        if about:
            yield _joined(type(formula), about)
        for each in operands:
            if _proposition(each) is None:
                yield from distinguished_by(each)
    else:
        for each in parts(formula):
            yield from distinguished_by(each)


def _proposition(formula: Temporal) -> Proposition | None:
    """Return a formula as a proposition, None if it is about more than a single configuration."""
    match formula:
        case Now(proposition):
            return proposition
        case Denied(inner):
            known = _proposition(inner)
            return None if known is None else Not(known)
        case Both() | Either():
            operands = [_proposition(each) for each in chain(formula, type(formula))]
            about = [each for each in operands if each is not None]
            return _joined(type(formula), about) if len(about) == len(operands) else None
    return None


def _joined(connective: type[Both | Either], operands: list[Proposition]) -> Proposition:
    return And(tuple(operands)) if connective is Both else Or(tuple(operands))


def _named(steps: Steps) -> Iterator[Proposition]:
    if steps.agent is not None:
        yield Exists(steps.agent)
