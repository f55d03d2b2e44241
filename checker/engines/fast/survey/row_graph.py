"""The graph, propositions and pending requests of a fast exploration, for temporal properties."""

from collections.abc import Hashable, Iterable
from functools import partial

import numpy as np

from checker.engines.fast.model.learner import Learner
from checker.engines.fast.search.row_search import RowSearch
from checker.engines.fast.survey.row_inspection import is_still, truths
from checker.engines.fast.survey.row_survey import RowSurvey
from checker.engines.graph import Graph
from semantics.properties.propositions import Proposition
from semantics.state.configuration import Configuration, Label
from semantics.state.requests import Request
from semantics.state.signature import Name


class GraphSurvey(RowSurvey):
    """A survey that also builds the graph."""

    def __init__(self, search: RowSearch) -> None:
        super().__init__(search.model, search.expander.met.used.copy())
        self.search = search

    def graph(self) -> Graph:
        """Return every transition of the expanded configurations."""
        return graph_of_search(self.search)

    def valuation(self, asked: Iterable[Proposition]) -> dict[Proposition, np.ndarray]:
        """Return the configurations in which each proposition is true."""
        return {each: truths(self, each, self.search.size) for each in dict.fromkeys(asked)}

    def is_still(self, asked: Iterable[Proposition]) -> bool:
        """Return whether everything that the atoms read is constant."""
        return is_still(self, asked)

    def pending(self) -> dict[Request, np.ndarray]:
        """Return, for each request, the configurations in which it is pending, in ascending order."""
        return pending_in_rows(self)


def graph_of_search(search: RowSearch) -> Graph:
    """Return every followed transition of the expanded configurations, in the order of the rules.

    The label of a `rcv_obs` omits the received observation, which only a decoded configuration has.
    """
    size, expanded, learner = search.size, search.expanded, search.model.learner
    found = [(np.zeros(0, np.int64), np.zeros(0, np.int32), np.zeros(0, np.int64))]
    if search.choosing is not None and search.choosing.paths.has_transitions:
        found.append(search.choosing.paths.transitions(expanded))
    else:
        found += search.expander.edges(range(expanded))
    origins, steps, targets = (np.concatenate(each) for each in zip(*found, strict=True))
    action_of, labels = actions_of(learner)
    there = targets >= 0
    partial_rows = np.arange(size) >= expanded
    partial_rows[origins[~there]] = True
    if search.expander.is_crowded:
        partial_rows |= _without_steps(origins, size)
    starts = np.concatenate(([0], np.cumsum(np.bincount(origins[there], minlength=size))))
    return Graph(
        starts.astype(np.int64),
        targets[there].astype(np.int32),
        action_of[steps[there]],
        labels,
        partial_rows if partial_rows.any() else None,
    )


def actions_of(learner: Learner) -> tuple[np.ndarray, tuple[Label, ...]]:
    """Return the number of each transition's label, and the labels."""
    numbers: dict[Label, int] = {}
    found = np.zeros(len(learner.leaves.rule), np.int32)
    for step, label in learner.steps.items():
        found[step] = numbers.setdefault(label, len(numbers))
    return found, tuple(numbers)


def _without_steps(origins: np.ndarray, size: int) -> np.ndarray:
    """Return the configurations without a transition; among these, crowded ones and deadlocks are not distinguished."""
    return np.asarray(np.bincount(origins, minlength=size) == 0)


def pending_in_rows(survey: RowSurvey) -> dict[Request, np.ndarray]:
    """Return, for each request, the configurations in which it is pending, in ascending order."""
    found: dict[Request, list[np.ndarray]] = {}
    for a in survey.agents():
        tree = survey.learner.question(partial(_requests, a))
        for rows in survey.blocks(survey.model.store.size):
            leaves = survey.classify(tree, rows)
            for leaf in np.unique(leaves):
                for request in survey.learner.answers[int(leaf)]:  # type: ignore[attr-defined]  # a tuple
                    found.setdefault(request, []).append(rows[leaves == leaf])
    return {request: np.unique(np.concatenate(rows)) for request, rows in found.items()}


def _requests(a: Name, c: Configuration) -> Hashable:
    return tuple(dict.fromkeys(each.request for each in c.eta.of(a))) if a in c.alpha else ()
