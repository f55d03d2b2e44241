"""Fast copies of frozen values that change with every packet."""

from __future__ import annotations

from typing import Any, TypeVar

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
