"""A MAVLink message as a plain value, independent of its encoding."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any, Final

VERSION_2: Final = 0xFD
"""The first byte of a frame of MAVLink 2; its third has flags."""

FLAGS: Final = 2
SIGNED: Final = 1


@dataclass(frozen=True, slots=True)
class Message:
    """One message.

    Attributes:
        name: As MAVLink calls it, such as `HEARTBEAT`.
        fields: All of its fields.
        system: Who says it; 0 in what is to be sent: the sender is chosen then.
        component: Which part of that system.
        raw: The frame that it came in; empty in what is to be sent.
    """

    name: str
    fields: Mapping[str, Any]
    system: int = 0
    component: int = 0
    raw: bytes = field(default=b"", compare=False, repr=False)

    def __getitem__(self, name: str) -> Any:
        return self.fields[name]

    @property
    def signed(self) -> bool:
        """Whether it came with a signature, of whatever worth."""
        return len(self.raw) > FLAGS and self.raw[0] == VERSION_2 and bool(self.raw[FLAGS] & SIGNED)

    @property
    def target(self) -> int:
        """The system that it is meant for; 0 is everybody."""
        return int(self.fields.get("target_system", 0))


def say(name: str, **fields: Any) -> Message:
    """Return a message to be sent."""
    return Message(name, fields)


def is_for(message: Message, system: int) -> bool:
    """Whether a message is meant for a system: its own, or everybody's."""
    return message.target in (0, system)
