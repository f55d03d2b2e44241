"""Overrides of the mission's commands: vehicles taken over, operators' orders, fallbacks, agents without control."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field, replace
from enum import StrEnum
from typing import TypeVar

from adapters.plugin import Hold, Return
from semantics.state.signature import Name


class Fate(StrEnum):
    """The progress of an order to hold or to return."""

    ASKED = "asked"
    SENT = "sent"
    CONFIRMED = "confirmed"
    REFUSED = "refused"


@dataclass(frozen=True, slots=True)
class StandingOrder:
    """An order to hold or to return, of an operator or as the mission's fallback.

    A vehicle owes it until its state shows it. It stands until the vehicle is given back or taken over.

    Attributes:
        command: The command to the vehicle.
        by: The operator who gave it, empty if unknown; None for the mission, which falls back.
        fate: Its progress.
        refusal: The last reason of refusal; empty if there was none.
        again: Time of its repetition after a refusal.
    """

    command: Hold | Return
    by: str | None = ""
    fate: Fate = Fate.ASKED
    refusal: str = ""
    again: float = math.inf

    @property
    def owed(self) -> bool:
        """Whether the vehicle has not confirmed it yet."""
        return self.fate is not Fate.CONFIRMED

    @property
    def reported_fate(self) -> Fate:
        """Its fate in reports to people: a refused order stays refused while it is repeated."""
        return Fate.REFUSED if self.owed and self.refusal else self.fate

    @property
    def orderer(self) -> str:
        """The orderer's name for people."""
        return "the mission" if self.by is None else operator(self.by)

    @property
    def action(self) -> str:
        """The ordered action."""
        return "hold" if isinstance(self.command, Hold) else "return"

    @property
    def reason(self) -> str:
        """The reason why the mission does not command the vehicle, with the order's progress."""
        if not self.owed:
            return f"{'held' if self.action == 'hold' else 'sent home'} by {self.orderer}"
        if self.refusal:  # also while it is repeated
            return f"refuses to {self.action}, as {self.orderer} ordered: {self.refusal}"
        return f"ordered to {self.action} by {self.orderer}, not confirmed yet"


def operator(by: str) -> str:
    """Name an operator for people.

    >>> operator("Ana"), operator("")
    ('the operator (Ana)', 'the operator')
    """
    return f"the operator ({by})" if by else "the operator"


T = TypeVar("T")

Orders = Mapping[Name, StandingOrder]
"""A standing order for each of some vehicles."""


@dataclass(frozen=True, slots=True)
class Overrides:
    """Reasons why the mission does not command a vehicle, or does not serve an agent's controls.

    Attributes:
        taken: Vehicles that were taken over, also by an operator's order, with the reason: they get no commands until
            an operator gives them back.
        orders: The operator's standing order for each vehicle; all of them are taken.
        fallbacks: The fallback that the mission has ordered of each vehicle.
        suspended: Whether a broken assumption has stopped all controls.
        grounded: Agents whose controls are no longer served, since a request of theirs took too long.
    """

    taken: Mapping[Name, str] = field(default_factory=dict)
    orders: Orders = field(default_factory=dict)
    fallbacks: Orders = field(default_factory=dict)
    suspended: bool = False
    grounded: frozenset[Name] = frozenset()

    @property
    def owing(self) -> Orders:
        """The orders to hold or to return that vehicles have not confirmed."""
        return {name: each for name, each in (*self.fallbacks.items(), *self.orders.items()) if each.owed}

    @property
    def fates(self) -> Mapping[Name, tuple[str, str]]:
        """The fate of each operator's order, also in words."""
        return {name: (each.reported_fate.value, each.reason) for name, each in self.orders.items()}

    def of(self, entity: Name) -> Iterator[StandingOrder]:
        """Yield the standing orders for a vehicle."""
        return (orders[entity] for orders in (self.fallbacks, self.orders) if entity in orders)

    def all_orders(self) -> Iterator[tuple[Name, StandingOrder]]:
        """Yield the vehicles with their standing orders, first the fallbacks."""
        yield from sorted(self.fallbacks.items())
        yield from sorted(self.orders.items())

    def is_overridden(self, entity: Name) -> bool:
        """Return whether the mission does not command a vehicle: others do, or its fallback was ordered."""
        return entity in self.taken or entity in self.fallbacks or entity in self.orders

    def stops(self, agent: Name) -> bool:
        """Return whether an agent's controls are no longer served."""
        return self.suspended or agent in self.grounded

    def is_foreign(self, entity: Name) -> bool:
        """Return whether a pilot, another station or a fail-safe has taken a vehicle over."""
        return entity in self.taken and entity not in self.orders

    def taken_over(self, entity: Name, reason: str) -> Overrides:
        """Return the value after a take-over, which ends all orders for the vehicle."""
        return replace(self.given_back(entity), taken={**self.taken, entity: reason})

    def ordered(self, entity: Name, order: StandingOrder) -> Overrides:
        """Return the value after a new order for a vehicle; an operator's order replaces the fallback."""
        if order.by is None:
            return self.with_progress(entity, order)
        return self.with_progress(entity, order).without_fallback(entity)

    def with_progress(self, entity: Name, order: StandingOrder) -> Overrides:
        """Return the value after progress of a vehicle's standing order."""
        if order.by is None:
            return replace(self, fallbacks={**self.fallbacks, entity: order})
        taken = {**self.taken, entity: order.reason}
        return replace(self, orders={**self.orders, entity: order}, taken=taken)

    def without_fallback(self, entity: Name) -> Overrides:
        """Return the value without a vehicle's fallback."""
        return replace(self, fallbacks=_without(self.fallbacks, entity))

    def given_back(self, entity: Name) -> Overrides:
        """Return the value in which the mission commands a vehicle again."""
        taken, orders = _without(self.taken, entity), _without(self.orders, entity)
        return replace(self, taken=taken, orders=orders, fallbacks=_without(self.fallbacks, entity))

    def suspending(self) -> Overrides:
        """Return the value in which no controls are served."""
        return replace(self, suspended=True)

    def lifted(self) -> Overrides:
        """Return the value without fallbacks and their suspension: an unverified run goes on."""
        return replace(self, suspended=False, fallbacks={})

    def grounding(self, agent: Name) -> Overrides:
        """Return the value in which an agent's controls are no longer served."""
        return replace(self, grounded=self.grounded | {agent})


def _without(known: Mapping[Name, T], entity: Name) -> Mapping[Name, T]:
    return {name: each for name, each in known.items() if name != entity} if entity in known else known
