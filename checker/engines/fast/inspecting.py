"""The findings of inspections, by surveys of all rows instead of single configurations.

A survey says of each finding how often it occurs, and where first; there the inspection itself is asked what to say.
"""

from collections.abc import Callable, Iterable, Iterator
from functools import cache, partial, reduce
from itertools import combinations_with_replacement
from operator import and_, or_
from typing import Any

import numpy as np
from numpy.typing import NDArray

from checker.bounding import look
from checker.engines.contract import Inspect
from checker.engines.fast.learner import Actor
from checker.engines.fast.leaves import COPIES, COPIES_END, PAIR, PARTS, PARTS_END, STEP, WRITES, WRITES_END
from checker.engines.fast.survey import Survey, distinct
from checker.properties.findings import Collected
from checker.properties.inspections import (
    Computation,
    DeadlockFreedom,
    Invariant,
    LocalConsistency,
    Reachability,
)
from checker.properties.questions import (
    Key,
    computations,
    controls_in_line,
    races_between,
    stale_controls,
    what_is_served,
    what_moves,
    where_it_stands,
)
from checker.properties.races import ControlRaces, StaleObservationRaces
from checker.properties.vacuity import atoms_of, truth
from checker.properties.visited import Visited
from semantics.properties.propositions import Always, And, Not, Or, Proposition, holds
from semantics.races.monitor import CONTROLS
from semantics.state.setting import Scheduler
from semantics.successors import expand, served

Bools = NDArray[np.bool_]
Tally = tuple[Key | None, int, int]
"""What was found (None: nothing wrong), how often, and in which configuration first."""

ALL = 1 << 62
"""More different findings than there are."""


def inspect_fast(survey: Survey, inspections: Iterable[Inspect]) -> None:
    """Let each inspection have found what it would have found by looking at every configuration that was expanded."""
    for each in inspections:
        how = SURVEYS.get(type(each))
        if how is None or (isinstance(each, StaleObservationRaces) and _takes_turns(survey)):
            look_at_each(survey, each)
        elif survey.size:
            how(survey, each)


def look_at_each(survey: Survey, inspection: Inspect) -> None:
    """Let an inspection look at every configuration."""
    for number in range(survey.size):
        look()
        c = survey.space.configuration(number)
        inspection(number, c, expand(c))


def _takes_turns(survey: Survey) -> bool:
    return survey.space.learner.setting.scheduler is Scheduler.FCFS


def _collect(collected: Collected, tallies: Iterable[Tally], again: Callable[[int], Collected]) -> None:
    """Add what was found to what is collected; `again` looks at one configuration once more."""
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


def _again(survey: Survey, make: Callable[[], Any], number: int) -> Any:
    c = survey.space.configuration(number)
    inspection = make()
    inspection(number, c, expand(c))
    return inspection


# --- what is asked of one agent -------------------------------------------------------------------------------


def look_at_consistency(survey: Survey, inspection: LocalConsistency) -> None:
    """Collect what local consistency finds."""
    tallies = [
        (key, answer.count, answer.first)
        for a in survey.agents()
        for answer in survey.answers(partial(controls_in_line, a))
        for key in answer.value
    ]

    def again(number: int) -> Collected:
        found: Collected = _again(survey, lambda: LocalConsistency(ALL), number).collected
        return found

    _collect(inspection.collected, tallies, again)


def look_at_computation(survey: Survey, inspection: Computation) -> None:
    """Collect what fails or diverges."""
    answers = [each for a in survey.agents() for each in survey.answers(partial(computations, a))]
    tallies: list[Tally] = [(key, each.count, each.first) for each in answers for key in each.value[1]]
    firsts = [each.first for each in answers if each.value[0]]
    if firsts:
        tallies.append((None, survey.space.rules(followed=False)["fun"], min(firsts)))

    def again(number: int) -> Collected:
        found: Collected = _again(survey, lambda: Computation(ALL), number).collected
        return found

    _collect(inspection.collected, tallies, again)


# --- deadlock -------------------------------------------------------------------------------------------------


def look_at_deadlocks(survey: Survey, inspection: DeadlockFreedom) -> None:
    """Collect deadlocks, and flights that need never end."""
    learner, agents = survey.space.learner, survey.agents()
    asked = [partial(question, a) for question in (what_is_served, what_moves) for a in agents]
    trees = [learner.question(question) for question in asked]
    deadlocks: list[Tally] = []
    late: list[Tally] = []
    commits: list[int] = []

    def again(number: int) -> DeadlockFreedom:
        found: DeadlockFreedom = _again(survey, lambda: DeadlockFreedom(ALL), number)
        return found

    for rows in survey.blocks():
        leaves = np.stack([survey.space.classify(tree, rows) for tree in trees], axis=1)
        fair, ends = _first_two(learner.answers, leaves, len(agents))
        commits += [int(row) for row in rows[ends][:1]]
        still = np.flatnonzero(~fair)
        kinds, firsts, counts = np.unique(leaves[still], axis=0, return_index=True, return_counts=True)
        for first, count in zip(firsts if len(kinds) else (), counts, strict=bool(len(kinds))):
            number = int(rows[still[first]])
            seen = again(number)
            deadlocks += [(key, int(count), number) for key in seen.collected.first]
            deadlocks += [(None, int(count), number)] * seen.collected.examined
            late += [(key, int(count), number) for key in seen.arrival.first]
    if commits:
        late.append((None, survey.space.rules(followed=False)["commit"], min(commits)))
    _collect(inspection.collected, deadlocks, lambda number: again(number).collected)
    _collect(inspection.arrival, late, lambda number: again(number).arrival)


def _first_two(answers: Any, leaves: NDArray[np.int32], agents: int) -> tuple[Bools, Bools]:
    """Return for each row whether something must happen, and whether a flight may end."""
    known = np.unique(leaves)
    fair = np.zeros(int(known.max()) + 1, np.bool_)
    ends = np.zeros_like(fair)
    for leaf in known:
        value = answers[int(leaf)]
        fair[leaf] = value[0]
        ends[leaf] = value[1]
    return np.any(fair[leaves], axis=1), np.any(ends[leaves[:, :agents]], axis=1)


# --- races ----------------------------------------------------------------------------------------------------


def look_at_races(survey: Survey, inspection: ControlRaces) -> None:
    """Collect control races: of pairs that touch nothing of each other's nothing need be asked."""
    space = survey.space
    tallies: list[Tally] = []

    def again(number: int) -> Collected:
        found: Collected = _again(survey, lambda: ControlRaces(ALL), number).collected
        return found

    agents = survey.agents()
    trees = {a: survey.of_actor(Actor(served, a)) for a in agents}
    unordered = space.learner.setting.scheduler is Scheduler.UNORDERED
    pairs = [(a, b) for a, b in combinations_with_replacement(agents, 2) if a != b or unordered]
    asked = {pair: space.learner.question(partial(races_between, *pair)) for pair in pairs}
    controlling = cache(partial(has_control, survey))
    independent = cache(partial(are_independent, survey))
    for rows in survey.blocks():
        leaves = {a: space.classify(trees[a], rows) for a in agents}
        for a, b in pairs:
            both = leaves[a].astype(np.int64) << 32 | leaves[b]
            kinds, firsts, which, counts = np.unique(
                both, return_index=True, return_inverse=True, return_counts=True
            )
            together = np.zeros(len(kinds), np.bool_)
            for kind, pair in enumerate(kinds):
                one, other = int(pair) >> 32, int(pair) & 0xFFFFFFFF
                if not (controlling(one) and controlling(other)):
                    continue
                if not unordered and independent(one, other):
                    tallies.append((None, int(counts[kind]), int(rows[firsts[kind]])))
                else:
                    together[kind] = True
            tallies += _of_rows(survey, asked[a, b], rows[together[which]])
    _collect(inspection.collected, tallies, again)


def _of_rows(survey: Survey, tree: int, rows: NDArray[np.int64]) -> Iterator[Tally]:
    if len(rows):
        leaves = survey.space.classify(tree, rows)
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


def look_at_staleness(survey: Survey, inspection: StaleObservationRaces) -> None:
    """Collect controls that rest on stale observations."""
    tallies = [
        (key, answer.count, answer.first)
        for a in survey.agents()
        for answer in survey.answers(partial(stale_controls, a))
        for key in answer.value
    ]

    def again(number: int) -> Collected:
        found: Collected = _again(survey, lambda: StaleObservationRaces(ALL), number).collected
        return found

    _collect(inspection.collected, tallies, again)


# --- propositions ---------------------------------------------------------------------------------------------


def truths(survey: Survey, formula: Proposition, size: int) -> Bools:
    """Return for each of the first configurations whether a proposition is true of it, atom by atom."""
    match formula:
        case Not(inner):
            return ~truths(survey, inner, size)
        case And(parts):
            return reduce(and_, (truths(survey, part, size) for part in parts), np.ones(size, np.bool_))
        case Or(parts):
            return reduce(or_, (truths(survey, part, size) for part in parts), np.zeros(size, np.bool_))
        case Always(value):
            return np.full(size, value)
        case _:
            return survey.where(partial(holds, formula), size)


def is_still(survey: Survey, atoms: Iterable[Proposition]) -> bool:
    """Tell whether nothing that atoms ask of configurations ever changes."""
    return not any(survey.where_with_change(partial(holds, atom))[1] for atom in dict.fromkeys(atoms))


def look_at_invariant(survey: Survey, inspection: Invariant) -> None:
    """Collect where an invariant is violated, and which valuations of its atoms there are."""
    valuations, size = inspection.valuations, survey.size
    found = np.zeros(size, np.uint64)
    changing = False
    for rank, atom in enumerate(valuations.atoms or tuple(atoms_of(inspection.formula))):
        values, varies = survey.where_with_change(partial(holds, atom))
        changing = changing or varies
        if valuations.atoms:
            found |= values.astype(np.uint64) << np.uint64(rank)
    valuations.begun, valuations.still = True, None if changing else {}
    if valuations.atoms:
        values, firsts, counts = np.unique(found, return_index=True, return_counts=True)
        valuations.met.update(map(int, values))
        columns = [{atom: int(value) >> k & 1 for k, atom in enumerate(valuations.atoms)} for value in values]
        good = [truth(inspection.formula, column, 1) == 1 for column in columns]
    else:
        true = truths(survey, inspection.formula, size)
        values, firsts, counts = np.unique(true, return_index=True, return_counts=True)
        good = list(map(bool, values))
    bad: Key = ("invariant", "")
    tallies = [
        (None if fine else bad, int(count), int(first))
        for fine, first, count in zip(good, firsts, counts, strict=True)
    ]

    def again(number: int) -> Collected:
        seen: Collected = _again(survey, lambda: Invariant(inspection.formula), number).collected
        return seen

    _collect(inspection.collected, tallies, again)


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


SURVEYS: dict[type, Callable[[Survey, Any], None]] = {
    Computation: look_at_computation,
    ControlRaces: look_at_races,
    DeadlockFreedom: look_at_deadlocks,
    Invariant: look_at_invariant,
    LocalConsistency: look_at_consistency,
    Reachability: look_at_reachability,
    StaleObservationRaces: look_at_staleness,
    Visited: look_at_visited,
}
"""How each inspection surveys; those without one look at every configuration."""
