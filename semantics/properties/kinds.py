"""The kinds of properties: one table, from which grammar, defaults, reports and refusals are derived."""

from dataclasses import dataclass
from enum import Enum, StrEnum, auto
from typing import Final


class RequestMode(Enum):
    """The way in which a mission asks for a property."""

    BY_DEFAULT = auto()
    """By its name, or by naming no property at all."""
    BY_NAME = auto()
    ALWAYS = auto()
    """Without being asked."""
    OF_CONFIGURATIONS = auto()
    """With a proposition about configurations."""
    OF_RUNS = auto()
    """With a formula about runs."""
    OF_TIMES = auto()
    """With a clause about the time at which a proposition becomes true."""
    OF_TIMED_MISSIONS = auto()
    """By its name, in a mission with a `timing` section."""


@dataclass(frozen=True, slots=True)
class About:
    """The description of a kind of properties.

    Attributes:
        says: The meaning of such a property, in a sentence.
        asked: The way in which a mission asks for it.
        examined: The singular and plural of the items that are examined for it; empty if they are not reported.
        nothing: The meaning of an empty examination, if that is no shortcoming.
        vacuous: The meaning of an empty examination, if a verdict that holds is then vacuous.
        counted: Whether all violations are counted, instead of searching for one.
    """

    says: str
    asked: RequestMode
    examined: tuple[str, str]
    nothing: str = ""
    vacuous: str = ""
    counted: bool = True


CONFIGURATIONS: Final = ("configuration", "configurations")


class PropertyKind(StrEnum):
    """The kinds of properties, by their words in the language and in reports."""

    LOCAL_CONSISTENCY = "local_consistency"
    RACE_FREEDOM = "race_freedom"
    DEADLOCK_FREEDOM = "deadlock_freedom"
    ARRIVAL = "arrival"
    COMPUTATION = "computation"
    INVARIANT = "invariant"
    REACHABLE = "reachable"
    LTL = "ltl"
    CTL = "ctl"
    PROGRESS = "progress"
    WITHIN = "within"
    ENDURANCE = "endurance"
    TIME = "time"

    @property
    def about(self) -> About:
        """The description of the kind."""
        return ABOUT[self]

    @property
    def is_of_runs(self) -> bool:
        """Whether it is about runs, and not about single configurations."""
        return self.about.asked is RequestMode.OF_RUNS

    @property
    def is_of_time(self) -> bool:
        """Whether it is about time: a mission then needs a `timing` section."""
        return self.about.asked in (RequestMode.OF_TIMES, RequestMode.OF_TIMED_MISSIONS)

    @property
    def has_proposition(self) -> bool:
        """Whether a mission asks for it with a proposition about configurations."""
        return self.about.asked is RequestMode.OF_CONFIGURATIONS


ABOUT: Final = {
    PropertyKind.LOCAL_CONSISTENCY: About(
        "Every control next in line can be served in the present world.",
        RequestMode.BY_DEFAULT,
        ("control next in line", "controls next in line"),
        vacuous="no control was ever next in line",
    ),
    PropertyKind.RACE_FREEDOM: About(
        "No bigActor changes anything that another's control depends on.",
        RequestMode.BY_DEFAULT,
        ("control or pair of controls", "controls and pairs of controls"),
        vacuous="no control was ever served",
    ),
    PropertyKind.DEADLOCK_FREEDOM: About(
        "Some bigActor can move as long as one has work left.",
        RequestMode.BY_DEFAULT,
        ("configuration at rest", "configurations at rest"),
        nothing="some bigActor can always move",
    ),
    PropertyKind.ARRIVAL: About(
        "No run waits for ever for the end of a flight.",
        RequestMode.BY_NAME,
        ("end of a flight", "ends of flights"),
        vacuous="no flight ever ends",
    ),
    PropertyKind.COMPUTATION: About(
        "No bigActor's computation fails or diverges.",
        RequestMode.ALWAYS,
        ("internal step", "internal steps"),
        nothing="no bigActor computes anything that could fail",
    ),
    PropertyKind.INVARIANT: About(
        "A proposition is true of every configuration.",
        RequestMode.OF_CONFIGURATIONS,
        CONFIGURATIONS,
    ),
    PropertyKind.REACHABLE: About(
        "A proposition is true of some configuration.",
        RequestMode.OF_CONFIGURATIONS,
        ("", ""),
    ),
    PropertyKind.LTL: About(
        "A formula of linear time is true of every fair run.",
        RequestMode.OF_RUNS,
        CONFIGURATIONS,
        counted=False,
    ),
    PropertyKind.CTL: About(
        "A formula of branching time is true of the tree of fair runs.",
        RequestMode.OF_RUNS,
        CONFIGURATIONS,
        counted=False,
    ),
    PropertyKind.PROGRESS: About(
        "Every pending request is eventually served on every fair run.",
        RequestMode.OF_RUNS,
        ("request", "requests"),
    ),
    PropertyKind.WITHIN: About(
        "A proposition becomes true in time on every run.",
        RequestMode.OF_TIMES,
        CONFIGURATIONS,
        counted=False,
    ),
    PropertyKind.ENDURANCE: About(
        "No vehicle is ever away from its place of restoration for longer than it lasts.",
        RequestMode.OF_TIMED_MISSIONS,
        CONFIGURATIONS,
    ),
    PropertyKind.TIME: About(
        "When a proposition first becomes true: the earliest and the latest moment.",
        RequestMode.OF_TIMES,
        CONFIGURATIONS,
        counted=False,
    ),
}


def asked_by(*ways: RequestMode) -> tuple[PropertyKind, ...]:
    """Return the kinds that a mission asks for in one of these ways, in order."""
    return tuple(kind for kind in PropertyKind if kind.about.asked in ways)
