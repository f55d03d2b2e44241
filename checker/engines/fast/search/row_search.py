"""The search: breadth-first over the rows of a store, by the successors of a model.

A row's way is one loop: list its steps, choose some of them, make their successors, map these to representatives, add
the new ones to the store. `FrontierChunks` does it in any number of threads, for `AllSteps` or, with partial-order
reduction, for `ChosenSteps`. Rows get the same numbers whoever expands them. The search visits the same configurations
in the same order as the reference explorer, and stops at the same bounds.
"""

from collections import Counter
from pathlib import Path
from typing import TYPE_CHECKING

from checker.engines.fast.model.learner import Learner
from checker.engines.fast.search.expander import Expander
from checker.engines.fast.search.frontier_chunks import AllSteps, FrontierChunks
from checker.engines.fast.search.rule_model import RuleModel
from checker.engines.fast.store.row_store import RowStore

if TYPE_CHECKING:
    from checker.engines.fast.reduce.partial_order import Choosing
    from checker.engines.fast.reduce.symmetry_tables import Exchanging
    from checker.engines.fast.search.chosen_steps import ChosenSteps
    from checker.reduction.reducer import Reduced


def choosing(learner: Learner, reduce: "Reduced | None") -> "Choosing | None":
    """Return the chooser of ample sets; None without partial-order reduction."""
    if reduce is None or reduce.ample is None:
        return None
    from checker.engines.fast.reduce.partial_order import Choosing  # noqa: PLC0415  # compiled only for a reduction

    return Choosing(learner, reduce.ample)


def exchanging(learner: Learner, reduce: "Reduced | None", *, ahead: bool = True) -> "Exchanging | None":
    """Return the symmetry tables, which learn `ahead` or not; None without symmetry reduction."""
    if reduce is None or reduce.symmetry is None:
        return None
    from checker.engines.fast.reduce.symmetry_tables import Exchanging  # noqa: PLC0415  # compiled only for symmetry

    return Exchanging(learner, reduce.symmetry.items, ahead=ahead)


def chosen_steps(expander: Expander, choosing: "Choosing | None", threads: int = 1) -> "ChosenSteps | None":
    """Return the steps of ample sets; None without partial-order reduction."""
    if choosing is None:
        return None
    from checker.engines.fast.search.chosen_steps import ChosenSteps  # noqa: PLC0415  # compiled only for a reduction

    return ChosenSteps(expander, choosing, threads)


class RowSearch:
    """The progress of an exploration.

    Attributes:
        store: The configurations reached so far, as rows.
        model: The learned rules.
        expander: Makes the successors of rows.
        choosing: What chooses ample sets; None without partial-order reduction.
    """

    def __init__(
        self,
        learner: Learner,
        limit: int | None,
        choosing: "Choosing | None" = None,
        exchanging: "Exchanging | None" = None,
        threads: int = 1,
    ) -> None:
        self.choosing = choosing
        self.store = RowStore(limit)
        self.model = RuleModel(learner, self.store, exchanging)
        self.expander = Expander(self.model, choosing)
        steps = chosen_steps(self.expander, choosing, threads) or AllSteps(self.expander)
        self._chunks = FrontierChunks(self.expander, steps, threads)
        self.model.see()
        self.store.make_room(self.expander.successors)

    @property
    def size(self) -> int:
        """The number of configurations."""
        return self.store.size

    @property
    def expanded(self) -> int:
        """The number of expanded configurations."""
        return self.store.expanded

    @property
    def bytes_used(self) -> int:
        """The bytes of rows, origins, visited set and paths; unwritten capacity takes none."""
        paths = 0 if self.choosing is None else self.choosing.paths.held(self.size)
        return self.store.bytes_used + paths

    def rules(self) -> Counter[str]:
        """Return the number of followed transitions of each rule."""
        return self.model.rules(self.expander.counts.used)

    def advance(self, until: int, end: int) -> None:
        """Expand rows to row `until` or somewhat beyond, but never beyond `end`, learning on the way."""
        while self.expanded < until:
            if self.store.compress():
                self.model.see()
            self._chunks.advance(end)

    def spill(self, folder: Path) -> None:
        """Move rows, origins and paths to files in a folder.

        Raises:
            OSError: There is no such folder, or no room in it.
        """
        self.store.spill(folder)
        if self.choosing is not None:
            self.choosing.paths.spill(folder, self.size)
