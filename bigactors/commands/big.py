"""`bigactors big`: systems of bigraphs, without missions."""

import sys
from argparse import Namespace
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any, Final

from bigactors.big_output import check_outputs, write_outputs
from bigactors.exits import Exit, worst
from bigactors.files import json_text, write_json
from bigactors.mistakes import Mistake
from bigactors.progress import Watch, watching
from bigactors.terminal import is_terminal, paint, say, say_text, tell
from bigraphs import BigraphError, NotationError, draw_text, save_bigraph
from bigraphs.engine.machine import Machine
from bigraphs.examples import example_names, example_text
from bigraphs.exploration import Progress, explore
from bigraphs.exports.json import bigraph_json
from bigraphs.notation import load_system, read_system, write_big
from bigraphs.simulation import Bounds, Stage, simulate
from bigraphs.system import System, SystemKind
from bigraphs.transitions import TransitionSystem
from bigraphs.verdicts import (
    Outcome,
    Quantifier,
    Verdict,
    deadlock_verdict,
    predicate_verdict,
    property_verdict,
)

MARKS: Final = {
    Outcome.HOLDS: ("✓", "green", Exit.HOLDS),
    Outcome.VIOLATED: ("✗", "red", Exit.VIOLATED),
    Outcome.INCOMPLETE: ("?", "yellow", Exit.INCOMPLETE),
}


def run(options: Namespace) -> Exit:
    """Do one of the tasks."""
    try:
        return TASKS[options.task](options)
    except NotationError as error:
        raise Mistake(error.message, error.hint, options.file, error.render(options.file)) from error
    except BigraphError as error:
        raise Mistake(error.message, error.hint, options.file) from error


def read_file(options: Namespace) -> System:
    """Return the system in a file, or of an example that ships."""
    if options.file in example_names() and not Path(options.file).exists():
        return read_system(example_text(options.file), constants=dict(options.const))
    return load_system(options.file, constants=dict(options.const))


def explored(options: Namespace, system: System) -> TransitionSystem:
    """Explore within the limits of the command line, progress shown on a terminal."""
    name = Path(options.file).name
    with watching(name) as watch:

        def told(progress: Progress) -> None:
            _show_progress(watch, name, progress)

        return explore(system, max_states=options.max_states, max_time=options.max_time, watch=told)


def _show_progress(watch: Watch, name: str, progress: Progress) -> None:
    if watch.interrupted:
        raise KeyboardInterrupt
    if is_terminal(watch.stream):
        rate = progress.states / max(progress.seconds, 1e-6)
        watch.rewrite(f"{name}: {progress.states:,} states, {progress.waiting:,} waiting, {rate:,.0f}/s")


def full(options: Namespace) -> Exit:
    """Explore every state, and write what was asked for."""
    check_outputs(options)
    found = explored(options, read_file(options))
    if options.json != "-":
        say(summary(options.file, found))
        for predicate, holds in zip(found.system.predicates, found.labels, strict=True):
            say(f"  {predicate.label} occurs in {sum(holds):,}")
        if idle := found.rules_never_used():
            say(f"  rules never used: {', '.join(idle)}")
    for path in write_outputs(options, found):
        tell(f"  written: {path}")
    return Exit.HOLDS if found.complete else Exit.INCOMPLETE


def summary(file: str, found: TransitionSystem) -> str:
    """Say in one line how large a system is, and whether that is all of it."""
    end = "complete" if found.complete else f"incomplete: {found.reason}"
    return (
        f"{Path(file).name}: {len(found):,} states, {len(found.starts):,} transitions, "
        f"{found.occurrences:,} occurrences, {end}, {found.seconds:.2f} s"
    )


def sim(options: Namespace) -> Exit:
    """Take one run."""
    system = read_file(options)
    if options.until is not None and system.kind is not SystemKind.SBRS:
        raise Mistake("--until is a time, and only an sbrs has times", "give --steps", options.file)
    stages = []
    for number, stage in enumerate(simulate(system, options.seed, Bounds(options.steps, options.until))):
        stages.append(stage)
        if options.json != "-":
            say(stage_line(system, number, stage))
    if options.json:
        _write_json(
            options.json, {"file": options.file, "seed": options.seed, "run": list(map(stage_json, stages))}
        )
    return Exit.HOLDS


def stage_line(system: System, number: int, stage: Stage) -> str:
    """Return how one state of a run is printed."""
    time = f" {stage.time:.6g}" if system.kind is SystemKind.SBRS else ""
    how = f" --{stage.action + ': ' if stage.action else ''}{stage.rule}-->" if stage.rule else ""
    labels = f"  [{', '.join(stage.labels)}]" if stage.labels else ""
    return f"{number}{time}{how} {write_big(stage.bigraph)}{labels}"


def stage_json(stage: Stage) -> dict[str, Any]:
    """Return one state of a run as data; `kept` are pairs of a node's number before the step and after it."""
    return {
        "time": stage.time,
        "rule": stage.rule,
        "action": stage.action,
        "labels": list(stage.labels),
        "kept": [list(pair) for pair in stage.kept],
        "state": bigraph_json(stage.bigraph),
    }


def check(options: Namespace) -> Exit:
    """Decide what is claimed."""
    system = read_file(options)
    found = explored(options, system)
    verdicts = list(verdicts_on(options, found))
    if not verdicts:
        raise Mistake(
            "there is nothing to check",
            "give --always, --never or --reachable with a predicate, or --no-deadlock",
            options.file,
        )
    if options.json != "-":
        say(summary(options.file, found))
        for verdict in verdicts:
            for line in verdict_lines(found, verdict):
                say(line)
    if options.json:
        _write_json(options.json, verdicts_json(found, verdicts))
    return worst(MARKS[verdict.outcome][2] for verdict in verdicts)


def verdicts_on(options: Namespace, found: TransitionSystem) -> Iterator[Verdict]:
    """Yield a verdict on each thing that is claimed."""
    for quantifier in Quantifier:
        for label in getattr(options, quantifier.value):
            yield predicate_verdict(found, quantifier, label)
    if options.no_deadlock:
        yield deadlock_verdict(found)
    yield from (property_verdict(found, claim) for claim in found.system.properties)


def verdict_lines(found: TransitionSystem, verdict: Verdict) -> Iterator[str]:
    """Yield what is printed of a verdict: with a state that shows it, a shortest run to that state."""
    mark, colour, _ = MARKS[verdict.outcome]
    yield f"  {paint(mark, colour, sys.stdout)} {verdict.claim}: {verdict.outcome.value}"
    if verdict.state is not None:
        path = found.path_to(verdict.state)
        yield f"      a shortest run to state {verdict.state}, {len(path) - 1} steps:"
        for before, state in zip([None, *path], path, strict=False):
            rules = "" if before is None else f"--{', '.join(found.rules_between(before, state))}--> "
            yield f"        {state}: {rules}{write_big(found.state(state))}"


def verdicts_json(found: TransitionSystem, verdicts: list[Verdict]) -> dict[str, Any]:
    """Return verdicts as data."""
    return {
        "states": len(found),
        "transitions": len(found.starts),
        "complete": found.complete,
        "reason": found.reason,
        "verdicts": [
            {
                "claim": verdict.claim,
                "outcome": verdict.outcome.value,
                "run": None
                if verdict.state is None
                else [_step_json(found, pair) for pair in _pairs(found, verdict)],
            }
            for verdict in verdicts
        ],
    }


def _pairs(found: TransitionSystem, verdict: Verdict) -> list[tuple[int | None, int]]:
    path = found.path_to(verdict.state or 0)
    return list(zip([None, *path], path, strict=False))


def _step_json(found: TransitionSystem, pair: tuple[int | None, int]) -> dict[str, Any]:
    before, state = pair
    rules = [] if before is None else list(found.rules_between(before, state))
    return {"number": state, "rules": rules, "state": bigraph_json(found.state(state))}


def validate(options: Namespace) -> Exit:
    """Say what is in a file, if it makes sense."""
    system = read_file(options)
    machine = Machine(system)
    say(f"{Path(options.file).name}: a {system.kind.value} of {len(machine.reactions)} rules")
    say(f"  initial state: {write_big(system.initial)}")
    for each in system.classes:
        how = "at once" if each.instantaneous else "one at a time"
        say(f"  a class, {how}: {', '.join(rule.label for rule in each.rules) or 'no rule'}")
    if system.predicates:
        say(f"  predicates: {', '.join(predicate.label for predicate in system.predicates)}")
    return Exit.HOLDS


def show(options: Namespace) -> Exit:
    """Print a state, and draw it."""
    found = explore(read_file(options), max_states=max(1, options.state + 1))
    if options.state >= len(found):
        raise Mistake(f"there is no state {options.state}: there are {len(found)}", "", options.file)
    bigraph = found.state(options.state)
    say(f"state {options.state} = {write_big(bigraph)}")
    say(draw_text(bigraph))
    if options.output:
        save_bigraph(bigraph, options.output, title=f"{Path(options.file).name}, state {options.state}")
        tell(f"picture written to {options.output}")
    return Exit.HOLDS


def _write_json(path: str, value: Any) -> None:
    if path == "-":
        say_text(json_text(value))
    else:
        write_json(path, value)


TASKS: Final[dict[str, Callable[[Namespace], Exit]]] = {
    "full": full,
    "sim": sim,
    "check": check,
    "validate": validate,
    "show": show,
}
