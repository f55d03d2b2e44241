"""The findings of inspections, by surveys of all rows instead of single configurations.

A survey says of each finding how often it occurs, and where first; there the inspection itself is asked what to say.
"""

from collections.abc import Callable, Hashable, Iterable, Iterator
from functools import cache, partial
from itertools import chain, combinations_with_replacement

import numpy as np
from numpy.typing import NDArray

from checker.engines.contract import Inspect
from checker.engines.fast.learner import Actor
from checker.engines.fast.leaves import COPIES, COPIES_END, PAIR, PARTS, PARTS_END, STEP, WRITES, WRITES_END
from checker.engines.fast.profiles import Profiles
from checker.engines.fast.survey import Survey, distinct
from checker.limits import look
from checker.properties.findings import Collected, Key
from checker.properties.inspections import Excerpt, Inspection, Invariant, Reachability, Rules
from checker.properties.races import ControlRaces
from checker.properties.vacuity import bindings, truth
from checker.properties.visited import Visited, where_it_stands
from semantics.behaviours.expressions import Fault
from semantics.properties.propositions import Proposition, atoms_of, holds
from semantics.races.monitor import CONTROLS
from semantics.state.configuration import Configuration, Transition
from semantics.state.setting import Scheduler
from semantics.state.signature import Name
from semantics.successors import Expansion, served

Bools = NDArray[np.bool_]
Tally = tuple[Key | None, int, int]
"""What was found (None: nothing wrong), how often, and in which configuration first."""

ALL = 1 << 62
"""More different findings than there are."""


def inspect_fast(survey: Survey, inspections: Iterable[Inspect]) -> None:
    """Let each inspection have found what it would have found by looking at every configuration that was expanded."""
    setting = survey.space.learner.setting
    takes_turns = setting.scheduler is Scheduler.FCFS
    for each in inspections if survey.size else ():
        match each:
            case Inspection() if not each.concerns(setting):
                continue
            case Visited():
                look_at_visited(survey, each)
            case Invariant():
                look_at_invariant(survey, each)
            case Reachability():
                look_at_reachability(survey, each)
            case ControlRaces():
                look_at_races(survey, each)
            case Inspection() if (each.alone or each.together) and not (each.in_turn and takes_turns):
                look_at_agents(survey, each)
            case _:
                look_at_each(survey, each)


def look_at_each(survey: Survey, inspection: Inspect) -> None:
    """Let an inspection look at every configuration."""
    for number in range(survey.size):
        look()
        for c, steps in survey.shown(number):
            inspection(number, c, steps)


def collect(
    survey: Survey, inspection: Inspection, tallies: Iterable[Tally], make: Callable[[], Inspection]
) -> None:
    """Let an inspection have found what there is; a new one looks once more where each was met first."""

    @cache
    def again(number: int) -> Collected:
        fresh = make()
        fresh.collected.apart = True
        for c, steps in survey.shown(number):
            fresh(number, c, steps)
        return fresh.collected

    collected = inspection.collected
    found: dict[Key, tuple[int, int]] = {}
    for key, count, first in sorted(tallies, key=lambda tally: tally[2]):
        if key is None:
            collected.examined += count
            if collected.example is None:
                collected.example, collected.example_by = first, again(first).example_by
            continue
        collected.count += count
        before = found.get(key, (0, first))
        found[key] = (before[0] + count, before[1])
    for key in _by_discovery(found, again):
        collected.count -= 1  # adding it counts it
        collected.add(again(found[key][1]).first[key])


def _by_discovery(found: dict[Key, tuple[int, int]], again: Callable[[int], Collected]) -> Iterator[Key]:
    """Yield findings in the order in which they were met; those of one configuration as the inspection tells them."""
    for first in sorted({first for _, first in found.values()}):
        yield from (key for key in again(first).first if found.get(key, (0, -1))[1] == first)


# --- what is asked of agents ----------------------------------------------------------------------------------


def look_at_agents(survey: Survey, inspection: Inspection) -> None:
    """Collect what an inspection finds of agents, each by itself and all together."""
    tallies = [*_alone(survey, inspection), *together(survey, inspection)]
    collect(survey, inspection, tallies, lambda: type(inspection)(ALL))


def _alone(survey: Survey, inspection: Inspection) -> Iterator[Tally]:
    for a in survey.agents() if inspection.alone else ():
        for answer in survey.answers(partial(_seen, inspection, a)):
            yield from ((key, answer.count, answer.first) for key in answer.value)


def _seen(inspection: Inspection, a: Name, c: Configuration) -> tuple[Key | None, ...]:
    return tuple(each.wrong for each in inspection.seen(excerpt(c, inspection.alone, (a,))))


def as_it_is(c: Configuration) -> Configuration:
    """Return a configuration."""
    return c


def together(
    survey: Survey, inspection: Inspection, view: Callable[[Configuration], Configuration] = as_it_is
) -> Iterator[Tally]:
    """Yield what is found where no agent must move: asked agent by agent, of those that are left each time.

    Asked is what a configuration is seen as.
    """
    agents = survey.agents() if inspection.together else ()
    trees = [survey.space.learner.question(partial(_still, inspection, a, view)) for a in agents]
    numbers: dict[Hashable, int] = {None: 0}
    for block in survey.blocks() if agents else ():
        rows, answers, kinds = block, np.zeros((0, len(block)), np.int64), np.zeros(len(block), np.int64)
        for tree in trees:
            said = survey.numbered(survey.classify(tree, rows), numbers)
            left = said > 0
            rows, answers = rows[left], np.vstack((answers[:, left], said[left]))
            kinds = np.unique(kinds[left] << 32 | said[left], return_inverse=True)[1]
        _, firsts, counts = np.unique(kinds, return_index=True, return_counts=True)
        told = list(numbers)
        for first, count in zip(firsts, counts, strict=True):
            waits = chain.from_iterable(told[number] for number in answers[:, first])
            yield from ((each.wrong, int(count), int(rows[first])) for each in inspection.judged(waits))


def _still(
    inspection: Inspection, a: Name, view: Callable[[Configuration], Configuration], c: Configuration
) -> Hashable:
    return inspection.still(excerpt(view(c), inspection.together, (a,)))


def excerpt(c: Configuration, rules: Iterable[Rules], agents: Iterable[Name]) -> Excerpt:
    """Return some agents of a configuration, as far as they are there, and what some rules allow them."""
    there = tuple(a for a in dict.fromkeys(agents) if a in c.alpha)
    found = list(dict.fromkeys(step for a in there for rule in rules for step in rule(c, a)))
    faults = tuple(each for each in found if isinstance(each, Fault))
    return Excerpt(c, there, Expansion(tuple(s for s in found if isinstance(s, Transition)), (), (), faults))


# --- races ----------------------------------------------------------------------------------------------------


def look_at_races(survey: Survey, inspection: ControlRaces) -> None:
    """Collect control races: of pairs that touch nothing of each other's nothing need be asked."""
    space = survey.space
    tallies: list[Tally] = []
    agents = survey.agents()
    trees = {a: survey.of_actor(Actor(served, a)) for a in agents}
    unordered = space.learner.setting.scheduler is Scheduler.UNORDERED
    pairs = [(a, b) for a, b in combinations_with_replacement(agents, 2) if a != b or unordered]
    asked = {pair: space.learner.question(partial(_between, inspection, pair)) for pair in pairs}
    controlling = cache(partial(has_control, survey))
    independent = cache(partial(are_independent, survey))

    def are_fine(one: int, other: int) -> bool | None:
        if not (controlling(one) and controlling(other)):
            return None
        return not unordered and independent(one, other)

    for rows in survey.blocks():
        leaves = {a: survey.classify(trees[a], rows) for a in agents}
        for a, b in pairs:
            tallies += of_pairs(survey, asked[a, b], rows, (leaves[a], leaves[b]), are_fine)
    collect(survey, inspection, tallies, lambda: ControlRaces(ALL))


def of_pairs(
    survey: Survey,
    tree: int,
    rows: NDArray[np.int64],
    leaves: tuple[NDArray[np.int32], NDArray[np.int32]],
    are_fine: Callable[[int, int], bool | None],
) -> Iterator[Tally]:
    """Yield what a question finds where two leaves say neither that all is fine nor (None) that nothing is there."""
    both = leaves[0].astype(np.int64) << 32 | leaves[1]
    kinds, firsts, which, counts = np.unique(both, return_index=True, return_inverse=True, return_counts=True)
    asked = np.zeros(len(kinds), np.bool_)
    for kind, pair in enumerate(kinds.tolist()):
        fine = are_fine(pair >> 32, pair & 0xFFFFFFFF)
        asked[kind] = fine is False
        if fine:
            yield None, int(counts[kind]), int(rows[firsts[kind]])
    yield from of_rows(survey, tree, rows[asked[which]])


def _between(inspection: ControlRaces, pair: tuple[Name, Name], c: Configuration) -> tuple[Key | None, ...]:
    return tuple(each.wrong for each in inspection.between(excerpt(c, (served,), pair), frozenset(pair)))


def of_rows(survey: Survey, tree: int, rows: NDArray[np.int64]) -> Iterator[Tally]:
    """Yield what a question finds in some rows."""
    if len(rows):
        leaves = survey.classify(tree, rows)
        for leaf, first, count in distinct(leaves):
            for key in survey.space.learner.answers[leaf]:  # type: ignore[attr-defined]  # a tuple of keys
                yield key, count, int(rows[first])


def has_control(survey: Survey, leaf: int) -> bool:
    """Tell whether a leaf serves a control."""
    learner = survey.space.learner
    return any(learner.steps[step].rule in CONTROLS for step in learner.leaves.steps_of(leaf))


def are_independent(survey: Survey, one: int, other: int) -> bool:
    """Tell whether neither of two leaves writes what the other writes, or what changes an answer it was found by."""
    writes = [written(survey, leaf) for leaf in (one, other)]
    if writes[0] is None or writes[1] is None or not writes[0].keys().isdisjoint(writes[1]):
        return False
    return leaves_alone(survey, writes[0], other) and leaves_alone(survey, writes[1], one)


def leaves_alone(survey: Survey, writes: dict[int, list[int]], leaf: int) -> bool:
    """Tell whether some writes change no answer that a leaf was found by."""
    columns = survey.space.learner.columns.all
    for column, ask, said in survey.space.learner.reads[leaf]:
        for code in writes.get(column, ()):
            if ask.question is None or ask.question(columns[column].value(code), *ask.constants) != said:
                return False
    return True


def written(survey: Survey, leaf: int) -> dict[int, list[int]] | None:
    """Return the columns that a leaf's transitions write, with the codes; None where that is worked out elsewhere."""
    leaves = survey.space.learner.leaves
    found: dict[int, list[int]] = {}
    for step in leaves.steps_of(leaf):
        record = leaves.steps.room[STEP * step : STEP * (step + 1)]
        if record[COPIES] != record[COPIES_END] or record[PARTS] != record[PARTS_END]:
            return None
        for write in range(int(record[WRITES]), int(record[WRITES_END])):
            column, code = leaves.writes.room[PAIR * write : PAIR * (write + 1)]
            found.setdefault(int(column), []).append(int(code))
    return found


# --- propositions ---------------------------------------------------------------------------------------------


def truths(survey: Survey, formula: Proposition, size: int) -> Bools:
    """Return for each of the first configurations whether a proposition is true of it."""
    return Profiles(survey, formula).truths(size)


def is_still(survey: Survey, atoms: Iterable[Proposition]) -> bool:
    """Tell whether nothing that atoms ask of configurations ever changes."""
    asked = tuple(dict.fromkeys(atoms))
    return not any(survey.where_with_change(partial(holds, each))[1] for each in (*asked, *bindings(asked)))


def look_at_invariant(survey: Survey, inspection: Invariant) -> None:
    """Collect where an invariant is violated, and which valuations of its atoms there are."""
    valuations, size = inspection.valuations, survey.size
    found = np.zeros(size, np.uint64)
    changing = False
    for rank, atom in enumerate(valuations.atoms):
        values, varies = survey.where_with_change(partial(holds, atom))
        changing = changing or varies
        found |= values.astype(np.uint64) << np.uint64(rank)
    if valuations.atoms:
        values, firsts, counts = np.unique(found, return_index=True, return_counts=True)
        valuations.met.update(map(int, values))
        columns = [{atom: int(value) >> k & 1 for k, atom in enumerate(valuations.atoms)} for value in values]
        good = [truth(inspection.formula, column, 1) == 1 for column in columns]
    else:
        profiles = Profiles(survey, inspection.formula)
        true, changing = profiles.truths(size), profiles.changing
        values, firsts, counts = np.unique(true, return_index=True, return_counts=True)
        good = list(map(bool, values))
    changing = changing or not is_still(survey, bindings(atoms_of(inspection.formula)))
    valuations.begun, valuations.still = True, None if changing else {}
    tallies = [
        (None if fine else inspection.WRONG, int(count), int(first))
        for fine, first, count in zip(good, firsts, counts, strict=True)
    ]
    collect(survey, inspection, tallies, lambda: Invariant(inspection.formula, inspection.shown))


def look_at_reachability(survey: Survey, inspection: Reachability) -> None:
    """Collect where a proposition is true."""
    true = np.flatnonzero(truths(survey, inspection.formula, survey.size))
    if len(true):
        inspection.collected.examined, inspection.collected.example = len(true), int(true[0])


# --- what was visited -----------------------------------------------------------------------------------------


def look_at_visited(survey: Survey, inspection: Visited) -> None:
    """Collect where agents stood, what they passed over, and what the environment did."""
    for a in survey.agents():
        for answer in survey.answers(partial(where_it_stands, a)):
            if answer.value is not None:
                code, passed = answer.value
                inspection.codes.setdefault(a, set()).add(code)
                inspection.passed |= passed
    space = survey.space
    for step in np.flatnonzero(space.met.used):
        label = space.learner.steps.get(int(step))
        if label is not None and label.agent is None:
            inspection.happened.add(str(label.about))
