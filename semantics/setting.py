"""The setting of a mission: all that stays the same while its configurations change."""

from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from enum import Enum
from functools import cached_property
from typing import TYPE_CHECKING

from semantics.signature import Name, Signature

if TYPE_CHECKING:
    from semantics.environment import Clause
    from semantics.program import Program


class Scheduler(Enum):
    """Which pending request may be served next; each refines the one before."""

    UNORDERED = "unordered"
    PROGRAM_ORDER = "program_order"
    FCFS = "fcfs"


class Control(Enum):
    """Whether a control is one step (`atomic`, the paper's `actuate`), or `command` and `commit` (`timed`)."""

    ATOMIC = "atomic"
    TIMED = "timed"


@dataclass(frozen=True, eq=False)
class Setting:
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
    """

    signature: Signature
    kinds: Mapping[Name, str]
    program: "Program"
    environment: tuple["Clause", ...] = ()
    scheduler: Scheduler = Scheduler.PROGRAM_ORDER
    control: Control = Control.ATOMIC
    arriving: frozenset[Name] = field(default_factory=frozenset)
    monitored: bool = False
    clause_lines: tuple[int, ...] = ()

    def kind(self, name: Name) -> str:
        """Return the kind of an entity."""
        return self.kinds[name]

    @cached_property
    def _containers(self) -> dict[str, tuple[Name, ...]]:
        kinds = sorted(set(self.kinds.values()))
        holders = {kind: [k for k in kinds if kind in self.signature[k].contains] for kind in kinds}
        return {
            kind: tuple(sorted(name for name, of in self.kinds.items() if of in holding))
            for kind, holding in holders.items()
        }

    def containers(self, kind: str) -> tuple[Name, ...]:
        """Return the names of all that may contain an entity of a kind, sorted."""
        return self._containers.get(kind, ())

    def carries(self, carrier: Name, name: Name) -> bool:
        """Tell whether a kind carries another: what is put into it goes along."""
        return self.kind(name) in self.signature[self.kind(carrier)].carries

    def with_(self, **changes: object) -> "Setting":
        """Return the setting with some of its attributes changed."""
        return replace(self, **changes)  # type: ignore[arg-type]  # names are checked by replace itself
