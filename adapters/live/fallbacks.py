"""Broken assumptions, and the mission's fallback: it commands its vehicles to hold or to return."""

from __future__ import annotations

from adapters.live.command_planning import is_authority, stopping
from adapters.live.overrides import StandingOrder
from adapters.live.turn_in_progress import Turning
from semantics.live_policy import Fallback
from semantics.state.signature import Name
from semantics.state.station_partition import HERE, is_parted


def breaks(
    turning: Turning,
    assumption: str,
    about: Name,
    kind: str = "broken assumption",
    response: Fallback | None = None,
) -> None:
    """Report a broken assumption, or another end of a flight, and respond with a fallback: by default the mission's."""
    if not answers_for(turning, about):
        return
    fallback = turning.plan.precautions.on_broken if response is None else response
    found = turning.find(kind, about, assumption, fallback.value, once=True)
    if found and not turning.overrides.suspended:
        fall_back(turning, fallback, tuple(sorted(turning.plan.vehicles)))
        if fallback is not Fallback.CONTINUE:
            turning.overrides = turning.overrides.suspending()


def fall_back(turning: Turning, fallback: Fallback, entities: tuple[Name, ...]) -> None:
    """Command the mission's fallback to vehicles; a vehicle on its way home does not stop."""
    if fallback is Fallback.CONTINUE:
        return
    for entity in entities:
        if not answers_for(turning, entity):
            continue
        if fallback is Fallback.HOLD and flies_home(turning, entity):
            message = f"{entity} is not commanded to hold: it was commanded to return before"
            turning.find("trouble", entity, message, once=True)
        elif entity in turning.overrides.taken:
            message = f"{entity} is not commanded to {fallback.value}: {_override(turning, entity)}"
            turning.find("taken over", entity, message, once=True)
        else:
            _command(turning, fallback, entity)


def _override(turning: Turning, entity: Name) -> str:
    """Return the reason why the mission does not command a vehicle."""
    order = turning.overrides.orders.get(entity)
    return "it was taken over" if order is None else f"{order.orderer} ordered it to {order.action}"


def _command(turning: Turning, fallback: Fallback, entity: Name) -> None:
    """Command a fallback; it ends a hand-over, which the vehicle's agent may order again."""
    command = stopping(fallback, turning.request_of("fallback"), entity)
    turning.overrides = turning.overrides.ordered(entity, StandingOrder(command, by=None))
    turning.command(command)
    if entity in turning.commanded.hand_overs:
        turning.commanded = turning.commanded.handed_over(entity)
        turning.agents = turning.agents.looking_again()


def due_fallback(turning: Turning, entity: Name) -> Fallback:
    """Return the mission's standing fallback for a vehicle; `CONTINUE` if the mission commands its flight."""
    due = {turning.plan.precautions.on_broken} if turning.overrides.suspended else set()
    agents = [agent for agent in turning.overrides.grounded if entity in vehicles_of(turning, agent)]
    if agents:
        limits = turning.plan.precautions.limits
        due |= {limit.fallback for limit in limits if limit.agent in (None, *agents)}
    return next((each for each in (Fallback.RETURN, Fallback.HOLD) if each in due), Fallback.CONTINUE)


def flies_home(turning: Turning, entity: Name) -> bool:
    """Return whether the mission's fallback sends a vehicle home."""
    return entity in turning.plan.vehicles and due_fallback(turning, entity) is Fallback.RETURN


def vehicles_of(turning: Turning, agent: Name) -> tuple[Name, ...]:
    """Return the vehicles of an agent's request: those that it has sent, else its host."""
    sent = turning.commanded.serving(agent)
    host = {turning.c.alpha.host(agent)} if agent in turning.c.alpha else set()
    return tuple(sorted(sent or host & turning.plan.vehicles.keys()))


def answers_for(turning: Turning, entity: Name) -> bool:
    """Return whether this station alone commands a vehicle and reports on it."""
    if not is_parted(turning.c) or entity not in turning.plan.vehicles:
        return True
    if turning.plan.vehicles[entity] == turning.plan.peers:
        return False
    physical = turning.before.configuration.structure.physical
    authority = set(filter(is_authority, physical.channels(entity)))
    return not authority or not authority.isdisjoint(physical.channels(turning.c.read(HERE)))
