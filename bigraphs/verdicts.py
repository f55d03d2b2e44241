"""Decide claims about a transition system: predicates and properties in every state, or in some."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from enum import Enum

from bigraphs.errors import BigraphError
from bigraphs.notation.spelling import did_you_mean
from bigraphs.properties import Property, Situation, holds
from bigraphs.transitions import TransitionSystem


class Quantifier(Enum):
    """In which states a predicate is claimed to occur."""

    ALWAYS = "always"
    NEVER = "never"
    REACHABLE = "reachable"


class Outcome(Enum):
    """What became of a claim; *incomplete* if the states that were explored don't decide it."""

    HOLDS = "holds"
    VIOLATED = "violated"
    INCOMPLETE = "incomplete"


@dataclass(frozen=True, slots=True)
class Verdict:
    """What became of one claim, with the nearest state that shows it, if one does."""

    claim: str
    outcome: Outcome
    state: int | None


def predicate_hint(name: str, labels: Sequence[str]) -> str:
    """Return what may help where a system has no predicate of a name.

    >>> predicate_hint("overr", ["over", "done"]), predicate_hint("x", ["over", "done"])
    ("did you mean 'over'?", 'the predicates are over, done')
    """
    if not labels:
        return "the system has none: write 'preds = { ... };' before its end"
    more = f" and {len(labels) - 8:,} more" if len(labels) > 8 else ""
    return did_you_mean(name, labels) or f"the predicates are {', '.join(labels[:8])}{more}"


def predicate_verdict(system: TransitionSystem, quantifier: Quantifier, label: str) -> Verdict:
    """Decide whether a predicate occurs always, never or ever; raises BigraphError if there is none of that label."""
    labels = [predicate.label for predicate in system.system.predicates]
    if label not in labels:
        raise BigraphError("predicate", f"unknown predicate '{label}'", predicate_hint(label, labels))
    column = system.labels[labels.index(label)]
    found = column.find(0 if quantifier is Quantifier.ALWAYS else 1)
    state = None if found < 0 else found
    claim = f"{quantifier.value} {label}"
    if quantifier is Quantifier.REACHABLE:
        return Verdict(
            claim, Outcome.HOLDS if state is not None else _nothing(system, Outcome.VIOLATED), state
        )
    return Verdict(claim, Outcome.VIOLATED if state is not None else _nothing(system, Outcome.HOLDS), state)


def deadlock_verdict(system: TransitionSystem) -> Verdict:
    """Decide whether something can happen in every state."""
    found = next((state for state in range(system.expanded) if not system.leaving(state)), None)
    outcome = Outcome.VIOLATED if found is not None else _nothing(system, Outcome.HOLDS)
    return Verdict("no deadlock", outcome, found)


def property_verdict(system: TransitionSystem, claim: Property) -> Verdict:
    """Decide whether a property of a `.bgm` file holds in every state; states that were not expanded are left out."""
    found = next(
        (state for state, here in _situations(system) if not holds(claim.formula, here)),
        None,
    )
    outcome = Outcome.VIOLATED if found is not None else _nothing(system, Outcome.HOLDS)
    return Verdict(claim.name, outcome, found)


def _nothing(system: TransitionSystem, outcome: Outcome) -> Outcome:
    """Return what it means that nothing was found: nothing, unless all states were looked at."""
    return outcome if system.complete else Outcome.INCOMPLETE


def _situations(system: TransitionSystem) -> Iterator[tuple[int, Situation]]:
    before: list[list[int]] = [[] for _ in range(len(system))]
    after: list[list[int]] = [[] for _ in range(len(system))]
    for each in system.transitions():
        after[each.source].append(each.target)
        before[each.target].append(each.source)
    bigraphs = [system.state(state) for state in range(len(system))]
    for state in range(system.expanded):
        yield (
            state,
            Situation(
                bigraphs[state],
                tuple(bigraphs[other] for other in before[state]),
                tuple(bigraphs[other] for other in after[state]),
            ),
        )


@dataclass(frozen=True, slots=True)
class Step:
    """A step of a run: the rules that make it, none where nothing can happen, and the number of the state after it.

    `action` is the action that was chosen, and `chance` the probability of the step then, where they are asked about.
    """

    rules: tuple[str, ...]
    state: int
    action: str = ""
    chance: float | None = None


@dataclass(frozen=True, slots=True)
class Run:
    """A run from the initial state; the steps from number `loop` on come again and again, unless it is None."""

    steps: tuple[Step, ...]
    loop: int | None = None


@dataclass(frozen=True, slots=True)
class Value:
    """A number that was asked for: what it is, between which bounds it surely is if they are known.

    `compared` says that a formula claims something of it.
    """

    number: float
    bounds: tuple[float, ...] = ()
    compared: bool = False


@dataclass(frozen=True, slots=True)
class Decided:
    """What became of a claim, with a run that shows it where one run can.

    `what` says of the run what it is, `remarks` what the verdict says less than it seems to. Where a number is asked
    for, `value` is it, and `strategy` what is chosen in the states with a choice to reach it.
    """

    claim: str
    outcome: Outcome
    run: Run | None = None
    what: str = ""
    note: str = ""
    remarks: tuple[str, ...] = ()
    value: Value | None = None
    strategy: Mapping[int, str] = field(default_factory=dict)
