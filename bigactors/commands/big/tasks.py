"""The tasks of `bigactors big`: full, sim, check, validate, show and convert."""

from __future__ import annotations

from argparse import Namespace
from collections import Counter
from collections.abc import Callable, Iterable, Iterator
from pathlib import Path
from typing import TYPE_CHECKING, Any, Final

from bigactors.commands.big.output import (
    check_outputs,
    checkpoint_folder,
    spill_folder,
    state_line,
    state_text,
    write_data,
    write_outputs,
)
from bigactors.exits import Exit, worst
from bigactors.mistakes import Mistake
from bigactors.progress import Watch, watching
from bigactors.terminal import is_terminal, say, tell
from bigraphs import BigraphError, NotationError
from bigraphs.confluence import MOST_REACTIONS, Divergence, compare_orders
from bigraphs.engine.machine import Machine
from bigraphs.examples import example_names, example_text
from bigraphs.exploration import ExplorationLimits, ExplorationProgress, explore, explore_long
from bigraphs.exports.json import bigraph_json
from bigraphs.notation import read_system
from bigraphs.notation.system_files import system_in, text_of
from bigraphs.resources import cores
from bigraphs.system import System, SystemKind
from bigraphs.transitions import TransitionSystem
from physical.wordings import counted

if TYPE_CHECKING:
    from bigraphs.simulation import Stage


def run_task(options: Namespace) -> Exit:
    """Run one of the tasks."""
    try:
        return TASKS[options.task](options)
    except NotationError as error:
        raise Mistake(error.message, error.hint, options.file, error.render(options.file)) from error
    except BigraphError as error:
        raise Mistake(error.message, error.hint, options.file) from error


def read_file(options: Namespace) -> System:
    """Return the system in a file, or in an example that ships."""
    return read_with_text(options)[0]


def read_with_text(options: Namespace) -> tuple[System, str]:
    """Return the system in a file, or in an example that ships, and its text."""
    constants = dict(options.const)
    if options.file in example_names() and not Path(options.file).exists():
        text = example_text(options.file)
        return read_system(text, constants=constants), text
    text = text_of(options.file)
    found = system_in(text, options.file, constants=constants)
    for warning in found.warnings:
        tell(f"warning: {warning.render(options.file)}")
    return found, text


def explored(options: Namespace, system: System, text: str) -> TransitionSystem:
    """Explore a system with this text within the limits of the command line, with progress on a terminal."""
    name, folder, saving = Path(options.file).name, checkpoint_folder(options), None
    limits = ExplorationLimits(
        options.max_states, options.max_time, options.max_memory, spill_folder(options)
    )
    if folder is not None:
        from bigactors.commands.big.states_file import saving_of  # numpy is slow to import

        saving = saving_of(options, folder, text)
    with watching(name) as watch:

        def told(progress: ExplorationProgress) -> None:
            _show_progress(watch, name, progress)

        return explore_long(system, limits, options.threads or cores(), told, saving)


def warn_of_orders(options: Namespace, system: System) -> None:
    """Warn of instantaneous rules whose order matters, with two different outcomes."""
    orders = compare_orders(system)
    if orders.divergence is not None:
        for line in _divergence_lines(options.file, orders.divergence):
            tell(line)
    elif not orders.complete:
        tell(
            f"warning: {options.file}: the order of the instantaneous rules may matter: of all orders "
            f"{MOST_REACTIONS:,} reactions were tried, and none had another outcome"
        )


def _divergence_lines(file: str, found: Divergence) -> Iterator[str]:
    """Yield the warning on an instantaneous class that is not confluent."""
    place = f"{file}:{found.rules.position}" if found.rules.position else file
    names = _instances(rule.name for rule in found.rules.rules)
    yield f"warning: {place}: the instantaneous class ({names}) is not confluent: the order of its rules matters"
    yield f"  of {state_line(found.state)}"
    yield f"  {found.taken.rule} makes in the end {state_line(found.taken.outcome)}"
    where = f"{found.other.rule} elsewhere" if found.other.rule == found.taken.rule else found.other.rule
    yield f"  {where} makes in the end {state_line(found.other.outcome)}"
    hint = f"a run takes the first rule of the class that applies, again and again, here {found.taken.rule}"
    if found.other.rule == found.taken.rule:
        hint += ", at the place with the least result in a canonical order"
    yield f"hint: {hint}; let the rules exclude each other where that is not meant"


def _show_progress(watch: Watch, name: str, progress: ExplorationProgress) -> None:
    if watch.interrupted:
        raise KeyboardInterrupt
    if is_terminal(watch.stream):
        rate = progress.states / max(progress.seconds, 1e-6)
        watch.rewrite(f"{name}: {progress.states:,} states, {progress.waiting:,} waiting, {rate:,.0f}/s")


def full(options: Namespace) -> Exit:
    """Explore every state, and write the requested files."""
    check_outputs(options)
    system, text = read_with_text(options)
    warn_of_orders(options, system)
    found = explored(options, system, text)
    if options.json != "-":
        say(summary(options.file, found))
        for line in _occurrence_lines(found):
            say(line)
        if idle := found.rules_never_used():
            when = "never used" if found.complete else "not used so far"
            say(f"  rules {when}: {_instances(rule.name for rule in idle)}")
    for path in write_outputs(options, found):
        tell(f"  written: {path}")
    return Exit.HOLDS if found.complete else Exit.INCOMPLETE


def _occurrence_lines(found: TransitionSystem) -> Iterator[str]:
    """Yield the number of states in which each predicate occurs; instances that occur nowhere share a line."""
    counts = Counter(predicate for numbers in found.holding for predicate in numbers)
    nowhere = Counter(each.name for number, each in enumerate(found.system.predicates) if not counts[number])
    for number, predicate in enumerate(found.system.predicates):
        if counts[number]:
            yield f"  {predicate.label} occurs in {counts[number]:,}"
        elif (instances := nowhere.pop(predicate.name, 0)) > 1:
            yield f"  {predicate.name} ({instances:,}) occurs in 0"
        elif instances:
            yield f"  {predicate.label} occurs in 0"


def summary(file: str, found: TransitionSystem) -> str:
    """Return the size of a system and the completeness of its exploration in one line."""
    end = "complete" if found.complete else f"incomplete: {found.reason}"
    return (
        f"{Path(file).name}: {counted(len(found), 'state')}, {counted(len(found.targets), 'transition')}, "
        f"{counted(found.occurrences, 'occurrence')}, {end}, {found.seconds:.2f} s"
    )


def sim(options: Namespace) -> Exit:
    """Take one run, or many."""
    system = read_file(options)
    if options.until is not None and system.kind is not SystemKind.SBRS:
        raise Mistake("--until is a time, and only an sbrs has times", "give --steps", options.file)
    warn_of_orders(options, system)
    if options.runs is not None and options.run is not None:
        raise Mistake("--runs takes many runs, --run one of them", "leave one of the two out", options.file)
    if options.runs is not None:
        from bigactors.commands.big.many_runs import many_runs  # only many runs need statistics

        return Exit.HOLDS if many_runs(options, system) else Exit.INCOMPLETE
    if options.plot:
        raise Mistake(
            "--plot draws statistics of many runs", "give --runs, such as --runs 1000", options.file
        )
    from bigraphs.simulation import Bounds, simulate  # only this task simulates

    stages = []
    bounds = Bounds(options.steps, options.until)
    for number, stage in enumerate(simulate(system, options.seed, bounds, run=options.run)):
        stages.append(stage)
        if options.json != "-":
            say(stage_line(system, number, stage))
    if options.json:
        write_data(
            options.json,
            {
                "file": options.file,
                "seed": options.seed,
                "number": options.run,
                "run": list(map(stage_json, stages)),
            },
        )
    return Exit.HOLDS


def stage_line(system: System, number: int, stage: Stage) -> str:
    """Return one state of a run as a line."""
    time = f" {stage.time:.6g}" if system.kind is SystemKind.SBRS else ""
    how = f" --{stage.action + ': ' if stage.action else ''}{stage.rule}-->" if stage.rule else ""
    labels = f"  [{', '.join(stage.labels)}]" if stage.labels else ""
    return f"{number}{time}{how} {state_text(stage.bigraph)}{labels}"


def stage_json(stage: Stage) -> dict[str, Any]:
    """Return one state of a run as data; `kept` pairs each node's number before the step with its number after it."""
    return {
        "time": stage.time,
        "rule": stage.rule,
        "action": stage.action,
        "labels": list(stage.labels),
        "kept": [list(pair) for pair in stage.kept],
        "state": bigraph_json(stage.bigraph),
    }


def check(options: Namespace) -> Exit:
    """Decide the claims."""
    from bigactors.commands.big import checks  # only this task decides claims

    system, text = read_with_text(options)
    if checks.asks_nothing(options, system):
        raise Mistake(
            "there is nothing to check",
            "give --always, --never or --reachable with a predicate, --ltl, --ctl or --storm with a formula, "
            "or --no-deadlock",
            options.file,
        )
    checks.check_formulas(options, system)
    warn_of_orders(options, system)
    found = explored(options, system, text)
    decided = list(checks.verdicts_on(options, found))
    if options.json != "-":
        say(summary(options.file, found))
        for each in decided:
            for line in checks.decided_lines(found, each):
                say(line)
    if options.json:
        write_data(options.json, checks.decided_json(found, decided))
    return worst(checks.MARKS[each.outcome][2] for each in decided)


def validate(options: Namespace) -> Exit:
    """Print the contents of a valid file."""
    system = read_file(options)
    machine = Machine(system)
    kind = f"{'a' if system.kind in (SystemKind.BRS, SystemKind.PBRS) else 'an'} {system.kind.value}"
    say(f"{Path(options.file).name}: {kind} of {counted(len(machine.reactions), 'rule')}")
    say(f"  initial state: {state_line(system.initial)}")
    for each in system.classes:
        how = "at once" if each.instantaneous else "one at a time"
        say(f"  a class, {how}: {_instances(rule.name for rule in each.rules) or 'no rule'}")
    warn_of_orders(options, system)
    for what, named in (
        ("actions", system.actions),
        ("predicates", system.predicates),
        ("properties", system.properties),
    ):
        if named:
            say(f"  {what}: {_instances(each.name for each in named)}")
    return Exit.HOLDS


def _instances(names: Iterable[str]) -> str:
    """Return distinct names in a list, each with its number of instances."""
    return ", ".join(name if times == 1 else f"{name} ({times:,})" for name, times in Counter(names).items())


def show(options: Namespace) -> Exit:
    """Print a state, and draw it."""
    from bigraphs import draw_text, save_bigraph  # only this task draws

    found = explore(read_file(options), max_states=max(1, options.state + 1))
    if options.state >= len(found):
        raise Mistake(f"there is no state {options.state}: there are {len(found)}", "", options.file)
    bigraph = found.state(options.state)
    say(f"state {options.state} = {state_text(bigraph)}")
    say(draw_text(bigraph))
    if options.output:
        save_bigraph(bigraph, options.output, title=f"{Path(options.file).name}, state {options.state}")
        tell(f"picture written to {options.output}")
    return Exit.HOLDS


def convert(options: Namespace) -> Exit:
    """Write the model in the file format of another tool."""
    from bigactors.commands.big.convert import convert_file  # only this task writes models

    return convert_file(options)


TASKS: Final[dict[str, Callable[[Namespace], Exit]]] = {
    "full": full,
    "sim": sim,
    "check": check,
    "validate": validate,
    "show": show,
    "convert": convert,
}
