"""The setting of a mission: everything that stays constant while configurations change."""

from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from enum import Enum
from typing import TYPE_CHECKING

from semantics.behaviours.program import Program
from semantics.environment import Clause
from semantics.state.signature import EntityKinds, Name
from semantics.timing.timing import Timing

if TYPE_CHECKING:
    from semantics.regions.region_facts import RegionFacts


class Scheduler(Enum):
    """The order in which pending requests are served; without `after` branches, each member refines the one before.

    A timeout requires that no case takes anything in line, and an order leaves less in line.
    """

    UNORDERED = "unordered"
    PROGRAM_ORDER = "program_order"
    FCFS = "fcfs"


class Control(Enum):
    """Whether a control is one step (`atomic`, the paper's `actuate`), or `command` and `commit` (`timed`)."""

    ATOMIC = "atomic"
    TIMED = "timed"


@dataclass(frozen=True, eq=False)
class Setting(EntityKinds):
    """The declarations of a mission.

    Attributes:
        signature: Its kinds.
        kinds: The kind of each entity that it names, whether present at first or not.
        program: The statements of all behaviours.
        environment: The clauses of `env` and `say`.
        scheduler: The order of service.
        control: Whether control takes time.
        arriving: Entities whose flights always end: their `commit` is fair.
        monitored: Whether the race monitor tracks the provenance of observations.
        clause_lines: The line in the mission's text of each clause of the environment, from 1.
        timing: The durations of steps; None if the mission has no `timing` section.
        strays: The greatest distance in metres of a vehicle from its way, for each that has a bound; sorted.
        missable: Entities that an observation may miss; sorted.
        regions: The facts that regions need; None if no property is about regions. No rule reads them.
    """

    program: Program
    environment: tuple[Clause, ...] = ()
    scheduler: Scheduler = Scheduler.PROGRAM_ORDER
    control: Control = Control.ATOMIC
    arriving: frozenset[Name] = field(default_factory=frozenset)
    monitored: bool = False
    clause_lines: tuple[int, ...] = ()
    timing: Timing | None = None
    strays: Mapping[Name, float] = field(default_factory=dict)
    missable: tuple[Name, ...] = ()
    regions: "RegionFacts | None" = field(default=None, repr=False)

    def __repr__(self) -> str:
        return (
            f"<Setting kinds={len(self.signature.kinds)} entities={len(self.kinds)} "
            f"scheduler={self.scheduler.value} control={self.control.value}>"
        )

    def with_(self, **changes: object) -> "Setting":
        """Return the setting with some of its attributes changed."""
        return replace(self, **changes)  # type: ignore[arg-type]  # names are checked by replace itself
