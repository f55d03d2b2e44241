"""Findings: messages to the operator."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True, slots=True)
class Finding:
    """A message to the operator.

    Attributes:
        kind: `broken assumption`, `refused`, `taken over`, `given back`, `ordered`, `confirmed` (an order), `lost
            link`, `link restored`, `late`, `blocked`, `failed` (a computation, the recording, a plugin), `trouble`.
        about: The entity or agent.
        message: One line.
        time: Its time.
        fallback: The response: `hold`, `return`, or nothing.
        elsewhere: Whether another station found it.
    """

    kind: str
    about: str
    message: str
    time: float
    fallback: str = ""
    elsewhere: bool = False


def is_breach(finding: Finding) -> bool:
    """Return whether it breaches an assumption of the mission, or causes a fallback."""
    return finding.kind == "broken assumption" or bool(finding.fallback)
