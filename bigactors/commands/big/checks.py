"""The verdicts of `bigactors big check`, as text and as data."""

import sys
from argparse import Namespace
from collections.abc import Iterator, Mapping
from itertools import islice, pairwise
from math import isfinite
from typing import Any, Final

from bigactors.commands.big.output import state_text
from bigactors.exits import Exit
from bigactors.mistakes import Mistake
from bigactors.terminal import paint
from bigraphs import NotationError
from bigraphs.claims import (
    ClaimOutcome,
    ClaimVerdict,
    Decided,
    Quantifier,
    Value,
    WitnessRun,
    WitnessStep,
    deadlock_verdict,
    predicate_verdict,
    property_verdict,
)
from bigraphs.exports.json import bigraph_json
from bigraphs.system import System
from bigraphs.transitions import TransitionSystem
from physical.wordings import counted

LOGICS: Final = ("ltl", "ctl")
"""The options that take formulas."""

MARKS: Final = {
    ClaimOutcome.HOLDS: ("✓", "green", Exit.HOLDS),
    ClaimOutcome.VIOLATED: ("✗", "red", Exit.VIOLATED),
    ClaimOutcome.INCOMPLETE: ("?", "yellow", Exit.INCOMPLETE),
}


SHOWN_CHOICES: Final = 8
"""The most choices of a strategy that are printed."""


def of_verdict(found: TransitionSystem, verdict: ClaimVerdict) -> Decided:
    """Return a verdict with a shortest run to the state that proves it."""
    if verdict.state is None:
        return Decided(verdict.claim, verdict.outcome)
    path = found.path_to(verdict.state)
    steps = tuple(WitnessStep(found.rules_between(*pair), pair[1]) for pair in pairwise(path))
    what = f"a shortest run to state {verdict.state}, {counted(len(steps), 'step')}"
    return Decided(verdict.claim, verdict.outcome, WitnessRun(steps), what)


def verdicts_on(options: Namespace, found: TransitionSystem) -> Iterator[Decided]:
    """Yield a verdict on each claim."""
    for quantifier in Quantifier:
        for label in getattr(options, quantifier.value):
            yield of_verdict(found, predicate_verdict(found, quantifier, label))
    if options.no_deadlock:
        yield of_verdict(found, deadlock_verdict(found))
    for claim in found.system.properties:
        yield of_verdict(found, property_verdict(found, claim))
    if options.storm:
        from bigactors.commands.big.storm import answers  # Storm is rarely wanted

        yield from answers(found, options.storm)
    if asked := asked_formulas(options):
        from bigactors.commands.big.temporal import decided_formulas  # numpy is slow to import

        yield from decided_formulas(found, asked)


def check_formulas(options: Namespace, system: System) -> None:
    """Refuse an invalid formula before a long exploration, not after it."""
    for logic, text in asked_formulas(options):
        from checker.properties.temporal.claim_text import (  # geometry is slow to load
            claim_words_of,
            parse_claim,
        )

        try:
            parse_claim(text, logic, claim_words_of(system))
        except NotationError as error:
            raise _mistake(error, options, logic) from error
    if options.storm:
        from bigactors.commands.big.storm import check_queries  # Storm is rarely wanted

        try:
            check_queries(options.storm, system)
        except NotationError as error:
            raise _mistake(error, options, "storm") from error


def _mistake(error: NotationError, options: Namespace, option: str) -> Mistake:
    return Mistake(error.message, error.hint, options.file, error.render(f"--{option}"))


def asked_formulas(options: Namespace) -> list[tuple[str, str]]:
    """Return the requested formulas, each with its logic."""
    return [(logic, text) for logic in LOGICS for text in getattr(options, logic)]


def asks_nothing(options: Namespace, system: System) -> bool:
    """Return whether there is nothing to decide."""
    predicates = (getattr(options, quantifier.value) for quantifier in Quantifier)
    asked = (*asked_formulas(options), *options.storm)
    return not (any(predicates) or options.no_deadlock or system.properties or asked)


def decided_lines(found: TransitionSystem, decided: Decided) -> Iterator[str]:
    """Yield the printed lines of a verdict, with its run."""
    mark, colour, _ = MARKS[decided.outcome]
    value, said = decided.value, decided.outcome.value
    if value is not None and value.compared:
        said += f", it is {value.number:.6g}"
    elif value is not None:
        mark, said = "=" if decided.outcome is ClaimOutcome.HOLDS else mark, f"{value.number:.6g}"
    yield f"  {paint(mark, colour, sys.stdout)} {decided.claim}: {said}"
    if decided.note:
        yield f"      {decided.note}"
    yield from (f"      warning: {remark}" for remark in decided.remarks)
    if decided.strategy:
        yield f"      an optimal strategy chooses {_strategy(decided.strategy)}"
    if decided.run is not None and decided.what:
        yield f"      {decided.what}:"
        yield from _run_lines(found, decided.run)


def _run_lines(found: TransitionSystem, run: WitnessRun) -> Iterator[str]:
    yield f"        0: {state_text(found.state(0))}"
    ends = len(run.steps) if run.loop is None else len(run.steps) - 1
    for step in run.steps[:ends]:
        yield f"        {step.state}: --{_rules(step)}--> {state_text(found.state(step.state))}"
    for step in run.steps[ends:]:
        if step.rules:
            yield f"        and again from state {step.state}, by --{_rules(step)}-->"
        else:
            yield f"        and stays in state {step.state}, where no rule applies"


def _strategy(chosen: Mapping[int, str]) -> str:
    shown = [f"{choice} in state {state}" for state, choice in islice(chosen.items(), SHOWN_CHOICES)]
    more = (
        f", and in {counted(len(chosen) - len(shown), 'more state')}: see --json"
        if len(chosen) > len(shown)
        else ""
    )
    return ", ".join(shown) + more


def _rules(step: WitnessStep) -> str:
    rules = ", ".join(step.rules) or "no rule applies"
    chance = "" if step.chance is None else f", {step.chance:.6g}"
    return f"{step.action + ': ' if step.action else ''}{rules}{chance}"


def decided_json(found: TransitionSystem, decided: list[Decided]) -> dict[str, Any]:
    """Return verdicts as data; `loop` is the index in `run` to which the last state returns, and the rules for that."""
    return {
        "states": len(found),
        "transitions": len(found.targets),
        "complete": found.complete,
        "reason": found.reason,
        "verdicts": [
            {
                "claim": each.claim,
                "outcome": each.outcome.value,
                "value": None if each.value is None else _value_json(each.value),
                "strategy": {str(state): choice for state, choice in each.strategy.items()} or None,
                "note": each.note,
                "remarks": list(each.remarks),
                "run": None if each.run is None else _run_json(found, each.run),
                "loop": None if each.run is None else _loop_json(each.run),
            }
            for each in decided
        ],
    }


def _run_json(found: TransitionSystem, run: WitnessRun) -> list[dict[str, Any]]:
    shown = run.steps if run.loop is None else run.steps[:-1]
    return [
        {
            "number": step.state,
            "rules": list(step.rules),
            "action": step.action or None,
            "chance": step.chance,
            "state": bigraph_json(found.state(step.state)),
        }
        for step in (WitnessStep((), 0), *shown)
    ]


def _value_json(value: Value) -> dict[str, Any]:
    """Return a number as data; an infinite one becomes a word, since JSON has no number for it."""
    number, *bounds = (each if isfinite(each) else str(each) for each in (value.number, *value.bounds))
    return {"number": number, "bounds": bounds or None}


def _loop_json(run: WitnessRun) -> dict[str, Any] | None:
    return None if run.loop is None else {"to": run.loop, "rules": list(run.steps[-1].rules)}
