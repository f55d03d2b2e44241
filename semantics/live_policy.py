"""The responses of a mission's `live` section: to a broken assumption or property, and to a late request."""

from dataclasses import dataclass
from enum import Enum

from semantics.state.signature import Name


class Fallback(Enum):
    """The command that a response gives the vehicles; `continue` only notifies the operator."""

    HOLD = "hold"
    RETURN = "return"
    CONTINUE = "continue"


@dataclass(frozen=True, slots=True)
class TimeLimit:
    """The longest time that a request may stay at the head of its agent's line.

    Attributes:
        request: The kind of request (`OBS`, `CTR`, `FLY`, `SND`, `MGR`), None for any.
        agent: The agent, None for any.
        seconds: The limit in seconds.
        fallback: The response when the limit is exceeded.
    """

    request: str | None
    agent: Name | None
    seconds: float
    fallback: Fallback

    def covers(self, request: str, agent: Name) -> bool:
        """Whether the limit applies to such a request of an agent."""
        return self.request in (None, request) and self.agent in (None, agent)


@dataclass(frozen=True, slots=True)
class LivePolicy:
    """The `live` section of a mission.

    Attributes:
        on_broken: The response to a broken assumption.
        limits: The time limits of requests.
        on_broken_property: The response to an invariant about ways that is false of what is seen.
    """

    on_broken: Fallback = Fallback.HOLD
    limits: tuple[TimeLimit, ...] = ()
    on_broken_property: Fallback = Fallback.CONTINUE
