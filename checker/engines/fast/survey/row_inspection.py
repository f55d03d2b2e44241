"""The findings of inspections, computed for all rows together.

A survey counts each finding and gives its first configuration. Only there the inspection itself runs, for its report.
"""

from collections.abc import Callable, Hashable, Iterable, Iterator
from functools import cache, partial
from itertools import chain, combinations_with_replacement

import numpy as np
from numpy.typing import NDArray

from checker.engines.contract import Inspect
from checker.engines.fast.model.decision_leaves import (
    COPIES,
    COPIES_END,
    PAIR,
    PARTS,
    PARTS_END,
    STEP,
    WRITES,
    WRITES_END,
)
from checker.engines.fast.model.learner import TransitionGroup
from checker.engines.fast.survey.proposition_table import Profiles
from checker.engines.fast.survey.row_survey import RowSurvey, distinct
from checker.limits import BoundMet, look
from checker.properties.findings import Collected, Key
from checker.properties.inspections import Excerpt, Inspection, Invariant, Reachability, Rules
from checker.properties.invariant_vacuity import bindings, truth
from checker.properties.races import ControlRaces
from checker.properties.stance_questions import StanceQuestions
from checker.properties.visited_statements import Visited, where_it_stands
from semantics.behaviours.expressions import Fault
from semantics.properties.propositions import Proposition, atoms_of, holds
from semantics.races.monitor import CONTROLS
from semantics.state.configuration import Configuration, Transition
from semantics.state.setting import Scheduler
from semantics.state.signature import Name
from semantics.successors import Expansion, served

Bools = NDArray[np.bool_]
Tally = tuple[Key | None, int, int]
"""A finding (None: nothing wrong), its number of occurrences, and its first configuration."""

ALL = 1 << 62
"""An unreachable limit on the number of different findings."""


def inspect_fast(survey: RowSurvey, inspections: Iterable[Inspect]) -> None:
    """Give each inspection the findings that it would have after visiting every expanded configuration."""
    setting = survey.learner.setting
    takes_turns = setting.scheduler is Scheduler.FCFS
    for each in inspections if survey.size else ():
        match each:
            case Inspection() if not each.concerns(setting):
                continue
            case Visited():
                look_at_visited(survey, each)
            case StanceQuestions():
                look_at_stances(survey, each)
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


def look_at_each(survey: RowSurvey, inspection: Inspect) -> None:
    """Run an inspection on every configuration."""
    for number in range(survey.size):
        look()
        for c, steps in survey.shown(number):
            inspection(number, c, steps)


def collect(
    survey: RowSurvey, inspection: Inspection, tallies: Iterable[Tally], make: Callable[[], Inspection]
) -> None:
    """Give an inspection its findings from tallies; a fresh copy inspects the first configuration of each."""

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
        collected.count -= 1  # `add` counts it
        collected.add(again(found[key][1]).first[key])


def _by_discovery(found: dict[Key, tuple[int, int]], again: Callable[[int], Collected]) -> Iterator[Key]:
    """Yield findings in the order of first occurrence; within one configuration, in the inspection's order."""
    for first in sorted({first for _, first in found.values()}):
        yield from (key for key in again(first).first if found.get(key, (0, -1))[1] == first)


# --- agents ---------------------------------------------------------------------------------------------------


def look_at_agents(survey: RowSurvey, inspection: Inspection) -> None:
    """Collect the findings of an inspection about single agents, and about all agents together."""
    tallies = [*_alone(survey, inspection), *together(survey, inspection)]
    collect(survey, inspection, tallies, lambda: type(inspection)(ALL))


def _alone(survey: RowSurvey, inspection: Inspection) -> Iterator[Tally]:
    for a in survey.agents() if inspection.alone else ():
        for answer in survey.answers(partial(_seen, inspection, a)):
            yield from ((key, answer.count, answer.first) for key in answer.value)


def _seen(inspection: Inspection, a: Name, c: Configuration) -> tuple[Key | None, ...]:
    return tuple(each.wrong for each in inspection.seen(excerpt(c, inspection.alone, (a,))))


def as_it_is(c: Configuration) -> Configuration:
    """Return the configuration."""
    return c


def together(
    survey: RowSurvey, inspection: Inspection, view: Callable[[Configuration], Configuration] = as_it_is
) -> Iterator[Tally]:
    """Yield the findings in configurations in which no agent must move.

    Each agent's question is answered only for the rows that all previous agents left. `view` maps a configuration to
    the one inspected.
    """
    agents = survey.agents() if inspection.together else ()
    trees = [survey.learner.question(partial(_still, inspection, a, view)) for a in agents]
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
    """Return an excerpt of a configuration: some of its agents, and the steps that some rules allow them."""
    there = tuple(a for a in dict.fromkeys(agents) if a in c.alpha)
    found = list(dict.fromkeys(step for a in there for rule in rules for step in rule(c, a)))
    faults = tuple(each for each in found if isinstance(each, Fault))
    return Excerpt(c, there, Expansion(tuple(s for s in found if isinstance(s, Transition)), (), (), faults))


# --- races ----------------------------------------------------------------------------------------------------


def look_at_races(survey: RowSurvey, inspection: ControlRaces) -> None:
    """Collect control races; a pair of agents with independent steps has none and is not examined."""
    tallies: list[Tally] = []
    agents = survey.agents()
    trees = {a: survey.of_actor(TransitionGroup(served, a)) for a in agents}
    unordered = survey.learner.setting.scheduler is Scheduler.UNORDERED
    pairs = [(a, b) for a, b in combinations_with_replacement(agents, 2) if a != b or unordered]
    asked = {pair: survey.learner.question(partial(_between, inspection, pair)) for pair in pairs}
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
    survey: RowSurvey,
    tree: int,
    rows: NDArray[np.int64],
    leaves: tuple[NDArray[np.int32], NDArray[np.int32]],
    are_fine: Callable[[int, int], bool | None],
) -> Iterator[Tally]:
    """Yield the findings for a pair of agents.

    `are_fine` classifies a pair of leaves: True (no race), None (nothing to examine) or False (ask the question).
    """
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


def of_rows(survey: RowSurvey, tree: int, rows: NDArray[np.int64]) -> Iterator[Tally]:
    """Yield the findings of a question in some rows."""
    if len(rows):
        leaves = survey.classify(tree, rows)
        for leaf, first, count in distinct(leaves):
            for key in survey.learner.answers[leaf]:  # type: ignore[attr-defined]  # a tuple of keys
                yield key, count, int(rows[first])


def has_control(survey: RowSurvey, leaf: int) -> bool:
    """Return whether a leaf has a transition that serves a control."""
    learner = survey.learner
    return any(learner.steps[step].rule in CONTROLS for step in learner.leaves.steps_of(leaf))


def are_independent(survey: RowSurvey, one: int, other: int) -> bool:
    """Return whether two leaves write disjoint columns, and neither changes an answer on the path to the other."""
    writes = [written(survey, leaf) for leaf in (one, other)]
    if writes[0] is None or writes[1] is None or not writes[0].keys().isdisjoint(writes[1]):
        return False
    return leaves_alone(survey, writes[0], other) and leaves_alone(survey, writes[1], one)


def leaves_alone(survey: RowSurvey, writes: dict[int, list[int]], leaf: int) -> bool:
    """Return whether writes change no answer on the path to a leaf."""
    columns = survey.learner.columns.all
    for column, ask, said in survey.learner.reads[leaf]:
        for code in writes.get(column, ()):
            if ask.question is None or ask.question(columns[column].value(code), *ask.constants) != said:
                return False
    return True


def written(survey: RowSurvey, leaf: int) -> dict[int, list[int]] | None:
    """Return the columns that a leaf's transitions write, with the codes; None if copies or parts write others."""
    leaves = survey.learner.leaves
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


def truths(survey: RowSurvey, formula: Proposition, size: int) -> Bools:
    """Return whether a proposition is true, for each of the first `size` configurations."""
    return Profiles(survey, formula).truths(size)


def is_still(survey: RowSurvey, atoms: Iterable[Proposition]) -> bool:
    """Return whether everything that the atoms read is constant."""
    asked = tuple(dict.fromkeys(atoms))
    return not any(survey.where_with_change(partial(holds, each))[1] for each in (*asked, *bindings(asked)))


def look_at_invariant(survey: RowSurvey, inspection: Invariant) -> None:
    """Collect the violations of an invariant, and the valuations of its atoms that occur."""
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


def look_at_reachability(survey: RowSurvey, inspection: Reachability) -> None:
    """Collect the configurations in which a proposition is true."""
    true = np.flatnonzero(truths(survey, inspection.formula, survey.size))
    if len(true):
        inspection.collected.examined, inspection.collected.example = len(true), int(true[0])


# --- stances -----------------------------------------------------------------------------------------------------


def look_at_stances(survey: RowSurvey, inspection: StanceQuestions) -> None:
    """Collect the stances of entities, alone and in pairs; a bound that is met leaves some out."""
    try:
        for question in inspection.questions():
            for answer in survey.answers(question):
                inspection.note(answer.value)
    except BoundMet as met:
        inspection.bounds.append(met.bound)


# --- visited places and events --------------------------------------------------------------------------------


def look_at_visited(survey: RowSurvey, inspection: Visited) -> None:
    """Collect the places where agents stood or passed, and the events of the environment."""
    for a in survey.agents():
        for answer in survey.answers(partial(where_it_stands, a)):
            if answer.value is not None:
                code, passed = answer.value
                inspection.codes.setdefault(a, set()).add(code)
                inspection.passed |= passed
    for step in np.flatnonzero(survey.taken):
        label = survey.learner.steps.get(int(step))
        if label is not None and label.agent is None:
            inspection.happened.add(str(label.about))
