"""The `live` section: what vehicles do when an assumption breaks or a request takes too long."""

from __future__ import annotations

from typing import TypeAlias

from specs.syntax.expressions import Agent
from specs.syntax.nodes import Node, node
from specs.syntax.statements import Duration


@node
class OnBroken(Node):
    """`on broken assumption: return`: hold (the default), return or continue.

    What vehicles do when the world does what the environment section does not allow.
    """

    fallback: str


@node
class TimeLimit(Node):
    """`FLY a within 10 min: return`, `anyone within 1 min: continue`.

    How long a request of an agent may be first in its line, and what is done then. `OBS`, `CTR`, `FLY`, `SND` or `MGR`
    restricts the limit to one sort of request.
    """

    request: str | None
    agent: Agent | None
    limit: Duration
    fallback: str


Precaution: TypeAlias = OnBroken | TimeLimit


@node
class Live(Node):
    """`live { ... }`: precautions for live runs. They do not change what is checked."""

    precautions: tuple[Precaution, ...]
