"""The setting of a mission: everything that stays constant while configurations change."""

from dataclasses import dataclass, field, replace
from enum import Enum

from semantics.behaviours.program import Program
from semantics.environment import Clause
from semantics.state.signature import Name, Sorting
from semantics.timing.timing import Timing


class Scheduler(Enum):
    """Which pending request may be served next; each refines the one before where no `react` has an `after`.

    A timeout asks that nothing in line fits, and under an order less is in line.
    """

    UNORDERED = "unordered"
    PROGRAM_ORDER = "program_order"
    FCFS = "fcfs"


class Control(Enum):
    """Whether a control is one step (`atomic`, the paper's `actuate`), or `command` and `commit` (`timed`)."""

    ATOMIC = "atomic"
    TIMED = "timed"


@dataclass(frozen=True, eq=False)
class Setting(Sorting):
    """Hold what a mission declares.

    Attributes:
        signature: Its kinds.
        kinds: The kind of each entity that it names, present at first or not.
        program: The statements of all behaviours.
        environment: What `env` and `say` may do.
        scheduler: Which requests are in line.
        control: Whether control takes time.
        arriving: Entities whose flights always end: their `commit` is fair.
        monitored: Whether what observations rest on is remembered, for stale-observation races.
        clause_lines: The line of the mission's text that each clause of the environment stands in, from 1.
        timing: How long everything takes; None where the mission says nothing of time.
    """

    program: Program
    environment: tuple[Clause, ...] = ()
    scheduler: Scheduler = Scheduler.PROGRAM_ORDER
    control: Control = Control.ATOMIC
    arriving: frozenset[Name] = field(default_factory=frozenset)
    monitored: bool = False
    clause_lines: tuple[int, ...] = ()
    timing: Timing | None = None

    def __repr__(self) -> str:
        return (
            f"<Setting kinds={len(self.signature.kinds)} entities={len(self.kinds)} "
            f"scheduler={self.scheduler.value} control={self.control.value}>"
        )

    def with_(self, **changes: object) -> "Setting":
        """Return the setting with some of its attributes changed."""
        return replace(self, **changes)  # type: ignore[arg-type]  # names are checked by replace itself
