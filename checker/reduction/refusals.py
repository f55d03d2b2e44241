"""The names of reductions, and the reasons for refusing them."""

from enum import Enum

from semantics.state.configuration import Configuration
from semantics.state.setting import Scheduler


class Reduction(Enum):
    """A reduction of the exploration."""

    POR = "por"
    SYMMETRY = "symmetry"

    def __str__(self) -> str:
        return self.value


class RefusedError(ValueError):
    """A reduction that would be unsound for a mission, or useless; with the reason.

    Attributes:
        reduction: The refused reduction.
        reason: The reason.
    """

    def __init__(self, reduction: Reduction, reason: str) -> None:
        super().__init__(f"the reduction '{reduction}' is refused: {reason}")
        self.reduction = reduction
        self.reason = reason


def refuse_symmetry(c: Configuration) -> None:
    """Refuse symmetry for missions with the race monitor's provenance.

    Raises:
        RefusedError: Symmetry would be unsound.
    """
    if c.setting.monitored:
        reason = (
            "the sources of observations are recorded by name; stale observations are searched for in full"
        )
        raise RefusedError(Reduction.SYMMETRY, reason)


def refuse_partial_order(c: Configuration) -> None:
    """Refuse partial-order reduction for missions in which the order of all requests is relevant.

    Raises:
        RefusedError: Partial-order reduction would be unsound.
    """
    if c.setting.scheduler is Scheduler.FCFS:
        reason = (
            "under 'scheduler fcfs' all requests stand in one queue, so no two of them are independent; "
            "check it under program_order: a property of all runs there holds under fcfs too, if no react has "
            "an `after`"
        )
        raise RefusedError(Reduction.POR, reason)
