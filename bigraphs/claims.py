"""Decisions of claims about a transition system: predicates and properties in every state, or in some."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from enum import Enum

from bigraphs.errors import BigraphError
from bigraphs.notation.spelling import did_you_mean
from bigraphs.properties import StateContext, SystemProperty, holds
from bigraphs.transitions import TransitionSystem


class Quantifier(Enum):
    """The claimed occurrence of a predicate: in every state, in none, or in some."""

    ALWAYS = "always"
    NEVER = "never"
    REACHABLE = "reachable"


class ClaimOutcome(Enum):
    """The outcome of a claim; *incomplete* if the explored states do not decide it."""

    HOLDS = "holds"
    VIOLATED = "violated"
    INCOMPLETE = "incomplete"


@dataclass(frozen=True, slots=True)
class ClaimVerdict:
    """The outcome of one claim, with the nearest state that demonstrates it, if one does."""

    claim: str
    outcome: ClaimOutcome
    state: int | None


def predicate_hint(name: str, labels: Sequence[str]) -> str:
    """Return a hint for an unknown predicate name.

    >>> predicate_hint("overr", ["over", "done"]), predicate_hint("x", ["over", "done"])
    ("did you mean 'over'?", 'the predicates are over, done')
    """
    if not labels:
        return "the system has none: write 'preds = { ... };' before its end"
    more = f" and {len(labels) - 8:,} more" if len(labels) > 8 else ""
    return did_you_mean(name, labels) or f"the predicates are {', '.join(labels[:8])}{more}"


def predicate_verdict(system: TransitionSystem, quantifier: Quantifier, label: str) -> ClaimVerdict:
    """Decide whether a predicate holds always, never or in a reachable state.

    Raises:
        BigraphError: If no predicate has that label.
    """
    labels = [predicate.label for predicate in system.system.predicates]
    if label not in labels:
        raise BigraphError("predicate", f"unknown predicate '{label}'", predicate_hint(label, labels))
    column = system.labels[labels.index(label)]
    found = column.find(0 if quantifier is Quantifier.ALWAYS else 1)
    state = None if found < 0 else found
    claim = f"{quantifier.value} {label}"
    if quantifier is Quantifier.REACHABLE:
        return ClaimVerdict(
            claim, ClaimOutcome.HOLDS if state is not None else _nothing(system, ClaimOutcome.VIOLATED), state
        )
    return ClaimVerdict(
        claim, ClaimOutcome.VIOLATED if state is not None else _nothing(system, ClaimOutcome.HOLDS), state
    )


def deadlock_verdict(system: TransitionSystem) -> ClaimVerdict:
    """Decide whether every state has a transition."""
    found = next((state for state in range(system.expanded) if not system.leaving(state)), None)
    outcome = ClaimOutcome.VIOLATED if found is not None else _nothing(system, ClaimOutcome.HOLDS)
    return ClaimVerdict("no deadlock", outcome, found)


def property_verdict(system: TransitionSystem, claim: SystemProperty) -> ClaimVerdict:
    """Decide whether a property of a `.bgm` file holds in every expanded state."""
    found = next(
        (state for state, here in _situations(system) if not holds(claim.formula, here)),
        None,
    )
    outcome = ClaimOutcome.VIOLATED if found is not None else _nothing(system, ClaimOutcome.HOLDS)
    return ClaimVerdict(claim.name, outcome, found)


def _nothing(system: TransitionSystem, outcome: ClaimOutcome) -> ClaimOutcome:
    """Return the outcome of a search without a finding: the given one if the system is complete, else incomplete."""
    return outcome if system.complete else ClaimOutcome.INCOMPLETE


def _situations(system: TransitionSystem) -> Iterator[tuple[int, StateContext]]:
    before: list[list[int]] = [[] for _ in range(len(system))]
    after: list[list[int]] = [[] for _ in range(len(system))]
    for each in system.transitions():
        after[each.source].append(each.target)
        before[each.target].append(each.source)
    bigraphs = [system.state(state) for state in range(len(system))]
    for state in range(system.expanded):
        yield (
            state,
            StateContext(
                bigraphs[state],
                tuple(bigraphs[other] for other in before[state]),
                tuple(bigraphs[other] for other in after[state]),
            ),
        )


@dataclass(frozen=True, slots=True)
class WitnessStep:
    """A step of a run: its rules (none after a deadlock) and the number of the state after it.

    For a probabilistic claim, `action` is the chosen action and `chance` the probability of the step under that choice.
    """

    rules: tuple[str, ...]
    state: int
    action: str = ""
    chance: float | None = None


@dataclass(frozen=True, slots=True)
class WitnessRun:
    """A run from the initial state; the steps from number `loop` on repeat forever, unless it is None."""

    steps: tuple[WitnessStep, ...]
    loop: int | None = None


@dataclass(frozen=True, slots=True)
class Value:
    """A computed number, with its proven bounds if they are known.

    `compared` is whether a formula compares it with a limit.
    """

    number: float
    bounds: tuple[float, ...] = ()
    compared: bool = False


@dataclass(frozen=True, slots=True)
class Decided:
    """The outcome of a claim, with a run as its evidence where one run suffices.

    `what` describes the run; `remarks` explain why the verdict is weaker than it looks. A claim that asks for
    a number has it as `value`; `strategy` is the choice in each state that attains it.
    """

    claim: str
    outcome: ClaimOutcome
    run: WitnessRun | None = None
    what: str = ""
    note: str = ""
    remarks: tuple[str, ...] = ()
    value: Value | None = None
    strategy: Mapping[int, str] = field(default_factory=dict)
