"""A MAVLink message as a plain value, independent of its encoding."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any, Final, TypeVar

VERSION_2: Final = 0xFD
"""The first byte of a MAVLink 2 frame; its third byte has flags."""

FLAGS: Final = 2
SIGNED: Final = 1


@dataclass(frozen=True, slots=True)
class MavlinkMessage:
    """One message.

    Attributes:
        name: Its name in MAVLink, such as `HEARTBEAT`.
        fields: All of its fields.
        system: The sender's system id; 0 in an outgoing message, whose sender is chosen later.
        component: The sender's component id.
        raw: Its received frame; empty in an outgoing message.
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
        """Whether it has a signature, valid or not."""
        return len(self.raw) > FLAGS and self.raw[0] == VERSION_2 and bool(self.raw[FLAGS] & SIGNED)

    @property
    def target(self) -> int:
        """The target system; 0 means all."""
        return int(self.fields.get("target_system", 0))


def say(name: str, **fields: Any) -> MavlinkMessage:
    """Return an outgoing message."""
    return MavlinkMessage(name, fields)


def is_for(message: MavlinkMessage, system: int) -> bool:
    """Return whether a message is addressed to a system, or to all."""
    return message.target in (0, system)


Value = TypeVar("Value")


def changed(value: Value, **changes: Any) -> Value:
    """Return a frozen value with some attributes changed: `dataclasses.replace`, ten times as fast.

    For dataclasses without slots and without `__post_init__`, with many attributes: a hundred vehicles send a thousand
    messages a second, and each message replaces some values.
    """
    made = object.__new__(type(value))
    attributes = made.__dict__
    attributes.update(value.__dict__)
    attributes.update(changes)
    assert len(attributes) == len(value.__dict__), changes.keys() - value.__dict__.keys()
    return made
