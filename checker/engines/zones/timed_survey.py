"""Surveys of the configurations that are reachable in time, by their places in the order of discovery."""

from __future__ import annotations

from collections.abc import Callable, Hashable, Iterator
from typing import Any

import numpy as np
from numpy.typing import NDArray

from checker.engines.fast.survey.row_survey import BLOCK, RowSurvey
from checker.engines.timed.answers import Times, shown_in_time
from checker.engines.zones.timed_automaton_of import Network
from checker.properties.inspections import InTime
from semantics.state.configuration import Configuration
from semantics.successors import Expansion


class TimedSurvey(RowSurvey):
    """Asks questions about all configurations that are reachable in time, or about some of them.

    Attributes:
        times: The answers about time.
        order: The row of each configuration.
        in_time: The view of each configuration that an inspection gets.
        places: The configurations that are asked about.
    """

    def __init__(
        self,
        network: Network,
        times: Times,
        order: NDArray[np.int64],
        in_time: InTime,
        places: NDArray[np.int64] | None = None,
    ) -> None:
        super().__init__(network.model, np.zeros(0, np.int64))
        self.network = network
        self.times = times
        self.order = order
        self.in_time = in_time
        self.places = np.arange(len(order)) if places is None else places
        self.size = len(self.places)

    def among(self, places: NDArray[np.int64]) -> TimedSurvey:
        """Return a survey of some of the configurations."""
        return TimedSurvey(self.network, self.times, self.order, self.in_time, places)

    def configuration(self, number: int) -> Configuration:
        """Return a configuration."""
        return self.model.configuration(int(self.order[number]))

    def classify(self, tree: int, rows: NDArray[np.int64]) -> NDArray[np.int32]:
        """Return each configuration's leaf in a tree."""
        return self.model.classify(tree, self.order[rows])

    def shown(self, number: int) -> Iterator[tuple[Configuration, Expansion]]:
        """Yield the views of a configuration for an inspection."""
        return shown_in_time(self.times, number, self.in_time)

    def blocks(self, size: int | None = None) -> Iterator[NDArray[np.int64]]:
        """Yield the places of the configurations to ask about, or of the first so many, block by block."""
        asked = self.places[:size]
        for begin in range(0, len(asked), BLOCK):
            yield asked[begin : begin + BLOCK]

    def answered(self, question: Callable[[Configuration], Hashable]) -> tuple[NDArray[np.int64], list[Any]]:
        """Return the number of each configuration's answer, and all answers."""
        tree, numbers = self.learner.question(question), dict[Hashable, int]()
        found = [self.numbered(self.classify(tree, rows), numbers) for rows in self.blocks()]
        return np.concatenate([np.zeros(0, np.int64), *found]), list(numbers)
