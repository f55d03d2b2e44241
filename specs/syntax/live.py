"""The `live` section: the reactions of vehicles to a broken assumption or property, or a slow request."""

from __future__ import annotations

from typing import TypeAlias

from specs.syntax.expressions import Agent
from specs.syntax.nodes import Node, node
from specs.syntax.statements import Duration


@node
class OnBroken(Node):
    """`on broken assumption: return`, `on broken property: hold`: hold, return or continue.

    The reaction of vehicles to a change of the world that the environment section does not allow (by default they
    hold), or to a broken invariant about ways (by default they go on).
    """

    what: str
    fallback: str


@node
class TimeLimit(Node):
    """`FLY a within 10 min: return`, `anyone within 1 min: continue`.

    The longest time for which a request of an agent may be first in its queue, and the reaction after that. `OBS`,
    `CTR`, `FLY`, `SND` or `MGR` restricts the limit to one sort of request.
    """

    request: str | None
    agent: Agent | None
    limit: Duration
    fallback: str


Precaution: TypeAlias = OnBroken | TimeLimit


@node
class Live(Node):
    """`live { ... }`: precautions for live runs. They have no effect on checks."""

    precautions: tuple[Precaution, ...]
