"""The live section's responses: to a broken assumption, and to a request that takes too long."""

from dataclasses import dataclass
from enum import Enum

from semantics.state.signature import Name


class Fallback(Enum):
    """What vehicles are told then; `continue` tells the operator only."""

    HOLD = "hold"
    RETURN = "return"
    CONTINUE = "continue"


@dataclass(frozen=True, slots=True)
class TimeLimit:
    """How long a request may stand at the head of its agent's line.

    Attributes:
        request: Its kind (`OBS`, `CTR`, `FLY`, `SND`, `MGR`), None for any.
        agent: Whose, None for anyone's.
        seconds: How long.
        fallback: What happens then.
    """

    request: str | None
    agent: Name | None
    seconds: float
    fallback: Fallback

    def covers(self, request: str, agent: Name) -> bool:
        """Tell whether the limit is about such a request of an agent."""
        return self.request in (None, request) and self.agent in (None, agent)


@dataclass(frozen=True, slots=True)
class LivePolicy:
    """The `live` section of a mission; without one, vehicles hold when an assumption breaks."""

    on_broken: Fallback = Fallback.HOLD
    limits: tuple[TimeLimit, ...] = ()
