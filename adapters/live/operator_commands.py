"""Input from operators: messages to agents, orders to vehicles, vehicles given back, findings acknowledged.

An order is no rule of the calculus, and leaves the configuration as it is: the operator *takes over* the vehicle, which
then holds or returns. The mission's requests of it stay pending until it is given back.
"""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator
from ipaddress import ip_address

from adapters.live.batch import Acknowledging, GivingBack, Noting, Ordering, Said, Saying
from adapters.live.command_planning import is_authority, stopping
from adapters.live.fallbacks import answers_for, due_fallback, fall_back
from adapters.live.flying import ask_anew
from adapters.live.overrides import StandingOrder, operator
from adapters.live.step_taking import take
from adapters.live.turn_in_progress import Turning
from adapters.live.turn_result import Answer
from adapters.plugin import Follow, GiveBack, GoTo, HandOver, Hold, Rebind, Return
from semantics.behaviours.values import show, spoken
from semantics.bigactor_rules import say
from semantics.environment import Says
from semantics.live_policy import Fallback
from semantics.state.signature import Name
from semantics.state.station_partition import is_here, station_of

_ADDRESS = re.compile(r"\[?([0-9a-fA-F:.]+)\]?:([0-9]{1,5})")
"""A vehicle's address: numeric, since the loop does not wait for name look-ups."""

MOST_PORT = 65_535


def answer(turning: Turning, said: Said) -> None:
    """Take a message from outside, and answer it."""
    match said:
        case Saying():
            say_to(turning, said)
        case Ordering():
            turning.answer(order(turning, said))
        case GivingBack():
            turning.answer(_take_back(turning, said))
        case Acknowledging(number):
            count = turning.before.reported.count
            refusal = "" if 0 < number <= count else f"there is no finding {number}; there are {count}"
            turning.answer(Answer(said, refusal))
        case Noting(text):
            turning.answer(Answer(said, "" if text.strip() else "the note is empty"))


# --- orders


def order(turning: Turning, said: Ordering) -> Answer:
    """Order a vehicle, several, or all, to hold or to return: from now on the mission does not command them."""
    one = said.vehicle if isinstance(said.vehicle, str) else None
    named = [one] if one else sorted(turning.plan.vehicles if said.vehicle is None else said.vehicle)
    left_out = {entity: why for entity in named if (why := _objection(turning, entity, said))}
    ordered = [entity for entity in named if entity not in left_out]
    if not ordered:
        return Answer(said, "; ".join(left_out.values()) or "there is no vehicle")
    notes = tuple(note for entity in ordered for note in _notes(turning, entity, said.fallback))
    requests = {entity: _order_one(turning, entity, said) for entity in ordered}
    who, are = ", ".join(ordered), "is" if len(ordered) == 1 else "are"
    message = f"{who} {are} ordered to {said.fallback.value} by {operator(said.by)}"
    back = f"until `bigactors give-back {one or 'VEHICLE'}`"
    rest = "; ".join([*notes, *left_out.values(), f"the mission does not command {_it(ordered)} {back}"])
    turning.find("ordered", one or "", f"{message}; {rest}")
    return Answer(said, "", requests, left_out, notes)


def _it(ordered: list[Name]) -> str:
    return "it" if len(ordered) == 1 else "them"


def _objection(turning: Turning, entity: Name, said: Ordering) -> str:
    """Return the reason why a vehicle does not get an order, or an empty text.

    An order to all or to several overrules no pilot and no fail-safe; an order to one overrules only a take-over from
    an earlier turn, which the operator can know.
    """
    if entity not in turning.plan.vehicles:
        return _no_vehicle(turning, entity)
    if not answers_for(turning, entity):
        return f"{entity} is under the authority of {_authority(turning, entity)}: order it there"
    if not turning.overrides.is_foreign(entity):
        return ""
    why = turning.overrides.taken[entity]
    if not isinstance(said.vehicle, str):
        told = "all" if said.vehicle is None else "several"
        return f"{entity} was taken over, and an order to {told} does not overrule that: {why}"
    if turning.before.overrides.taken.get(entity) != why:
        return f"{entity} was taken over just now: {why}; order it again to overrule that"
    return ""


def _authority(turning: Turning, entity: Name) -> str:
    """Return the stations that a vehicle obeys, according to P."""
    channels = turning.before.configuration.structure.physical.channels(entity)
    stations = (channel.partition(":")[2] for channel in channels if is_authority(channel))
    return " and ".join(sorted(stations)) or "another station"


def _notes(turning: Turning, entity: Name, what: Fallback) -> Iterator[str]:
    """Yield remarks to the operator on a vehicle that gets an order."""
    if turning.overrides.is_foreign(entity):
        yield f"this order overrules the take-over of {entity}: {turning.overrides.taken[entity]}"
    if entity in turning.sightings.lost or entity not in turning.sightings.newest:
        yield f"{entity} is silent: it gets the order once it is heard, unless it was taken over by then"
    if what is Fallback.RETURN:
        yield from _of_leaving(turning, entity)


def _of_leaving(turning: Turning, entity: Name) -> Iterator[str]:
    """Yield the consequence if a vehicle flies home although the mission assumes that it stays."""
    physical, then = turning.c.structure.physical, turning.plan.precautions.on_broken
    if turning.overrides.suspended or then is Fallback.CONTINUE:
        return
    if entity not in physical or physical.transit(entity):
        return
    place = physical.abstract_parent(entity)
    if place != turning.plan.first.structure.physical.abstract_parent(entity):
        stays = f"the mission assumes that {entity} stays in {place}"
        yield f"{stays}: when it leaves, all vehicles are commanded to {then.value}"


def _order_one(turning: Turning, entity: Name, said: Ordering) -> str:
    """Take a vehicle over and order it, in place of this turn's other commands; return the request."""
    flies = (GoTo, Follow, HandOver, Hold, Return)
    commands = turning.results.commands
    turning.results.commands = [c for c in commands if c.entity != entity or not isinstance(c, flies)]
    if turning.overrides.is_foreign(entity):
        turning.command(GiveBack(turning.request_of("operator"), entity))
    command = stopping(said.fallback, turning.request_of("operator"), entity)
    turning.overrides = turning.overrides.ordered(entity, StandingOrder(command, said.by))
    turning.command(command)
    return command.request


# --- vehicles given back


def _take_back(turning: Turning, said: GivingBack) -> Answer:
    """Take back a vehicle, or accept its messages from another address."""
    if said.vehicle not in turning.plan.vehicles:
        return Answer(said, _no_vehicle(turning, said.vehicle))
    return Answer(said, _rebind(turning, said.vehicle, said.at)) if said.at else _give_back(turning, said)


def _no_vehicle(turning: Turning, name: str) -> str:
    vehicles = ", ".join(sorted(turning.plan.vehicles))
    return f"there is no vehicle '{name:.60}'; there are {vehicles or 'none'}"


def _give_back(turning: Turning, said: GivingBack) -> Answer:
    """Command a vehicle again that was taken over or has refused."""
    entity = said.vehicle
    fallback = turning.overrides.fallbacks.get(entity)
    owed = fallback is not None and fallback.owed
    refused = owed or any(given.refused for given in turning.commanded.of(entity))
    turning.overrides = turning.overrides.without_fallback(entity)
    if entity not in turning.overrides.taken and not refused:
        return Answer(said, f"{entity} was not taken over here, and has refused nothing")
    turning.overrides = turning.overrides.given_back(entity)
    turning.agents = turning.agents.looking_again()
    turning.command(GiveBack(turning.request_of("give-back"), entity))
    ask_anew(turning, entity)
    given = f"{entity} was given back{f' by {said.by}' if said.by else ''}"
    then = due_fallback(turning, entity)
    if then is Fallback.CONTINUE:
        turning.find("given back", entity, f"{given}, and is commanded again")
        return Answer(said)
    note = f"its task was given up: it is commanded to {then.value}"  # no one else flies it
    turning.find("given back", entity, f"{given}; {note}")
    fall_back(turning, then, (entity,))
    return Answer(said, notes=(note,))


def say_to(turning: Turning, saying: Saying) -> None:
    """Put a message into a mailbox, if the environment section allows it, and not too often."""
    agents = turning.c.alpha
    if saying.agent in agents and not is_here(turning.c, saying.agent):
        there = station_of(turning.c, saying.agent)
        turning.answer(
            Answer(saying, f"{saying.agent} runs at {there or 'no station'}: send the message there")
        )
        return
    clauses = [each for each in turning.c.setting.environment if isinstance(each, Says)]
    for clause in _meant(saying, clauses):
        found = tuple(say(turning.c, clause))
        if found:
            take(turning, found[0], found)
            turning.agents = turning.agents.woken([clause.agent])
            turning.answer(Answer(saying))
            return
    left = [f"{typed(each, clauses)} to {each.agent}" for each in clauses if turning.c.read(each.counter)]
    is_vehicle = saying.agent in turning.plan.vehicles
    nobody = f"there is no bigActor '{saying.agent:.60}'{', which is a vehicle' if is_vehicle else ''}; "
    who = "" if saying.agent in agents else nobody
    what = f"permitted now: {', '.join(left)}" if left else "no message is permitted any more"
    turning.answer(Answer(saying, f"{who}the mission does not permit this message; {what}"))


def _meant(saying: Saying, clauses: Iterable[Says]) -> Iterator[Says]:
    """Yield the clauses that a message may be: first those printed so, then those printed so but for quotes."""
    mine = [each for each in clauses if each.agent == saying.agent]
    yield from (each for each in mine if saying.message == show(each.message))
    plain = saying.message.replace('"', "")
    yield from (each for each in mine if plain in (show(each.message).replace('"', ""), spoken(each.message)))


def typed(clause: Says, clauses: Iterable[Says]) -> str:
    """Return an operator's input for a message; a text has quotes only if a name with the same letters may be sent."""
    others = (each for each in clauses if each.agent == clause.agent and each.message != clause.message)
    short = spoken(clause.message)
    return show(clause.message) if any(short == show(each.message) for each in others) else short


def _rebind(turning: Turning, entity: Name, at: str) -> str:
    """Accept a vehicle's messages from another address; return the reason of a refusal, or an empty text."""
    found = _ADDRESS.fullmatch(at)
    if found is None or not _is_number(found[1]) or int(found[2]) > MOST_PORT:
        return (
            f"'{at:.60}' is no HOST:PORT with HOST as a number, such as 192.168.1.7:14555 or [fd00::7]:14555"
        )
    if entity not in turning.sightings.lost:
        return f"the link to {entity} is not lost; another address is accepted once the known one is silent"
    turning.command(Rebind(turning.request_of("operator"), entity, at))
    return ""


def _is_number(host: str) -> bool:
    try:
        ip_address(host)
    except ValueError:
        return False
    return True
