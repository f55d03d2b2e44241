"""Findings: messages to the operator."""

from __future__ import annotations

from dataclasses import dataclass, replace


@dataclass(frozen=True, slots=True)
class Finding:
    """A message to the operator.

    Attributes:
        kind: `broken assumption`, `broken property`, `refused`, `taken over`, `given back`, `ordered`, `confirmed` (an
            order), `lost link`, `link restored`, `late`, `blocked`, `failed` (a computation, the recording, a plugin),
            `trouble`.
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
    """Return whether it breaches an assumption or a property of the mission, or causes a fallback."""
    return finding.kind in ("broken assumption", "broken property") or bool(finding.fallback)


MOST_REPORTED = 1_000
"""The number of remembered reports; beyond it no more troubles are reported, since any sender can cause any number."""


@dataclass(frozen=True, slots=True)
class Reported:
    """The findings that a run has reported.

    Attributes:
        messages: Messages that are not reported again.
        count: The number of findings: also the number of the last one.
    """

    messages: frozenset[str] = frozenset()
    count: int = 0

    def admits(self, kind: str, message: str) -> bool:
        """Return whether a finding that is reported once is new, and there is room to remember it."""
        full = kind == "trouble" and len(self.messages) >= MOST_REPORTED
        return not full and message not in self.messages

    def remembering(self, message: str) -> Reported:
        """Return the value in which a message is not reported again."""
        return replace(self, messages=self.messages | {message})

    def counted(self, more: int) -> Reported:
        """Return the value after some more findings."""
        return replace(self, count=self.count + more) if more else self
