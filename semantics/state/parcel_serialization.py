"""Parcels as plain data: written, and read back within bounds by the types of their parts.

A value of the mission language is encoded by its form; every other part is read by its declared type. Reactions are not
encoded: a control's reaction is rebuilt from the text of the receiving mission.
"""

from collections.abc import Mapping
from dataclasses import fields, is_dataclass
from functools import cache
from types import UnionType
from typing import Any, Union, get_args, get_origin, get_type_hints

from semantics.behaviours.observations import All, Fact, Nodes, Observation, Of, Query, QueryOperator, Swept
from semantics.behaviours.values import LARGEST_NUMBER, MOST_PARTS, Route, Text, Truth, Value, in_order, parts
from semantics.state.parcels import Controls, Parcel, Running
from semantics.state.requests import MGR, OBS, READY, SND
from semantics.state.station_partition import Belief, Elsewhere, HostReport, Passage

MOST_ITEMS = 10_000
"""The greatest length of one list."""

MOST_MAIL = 10_000
DEEPEST = 40

TYPES: Mapping[str, type] = {
    each.__name__: each
    for each in (OBS, READY, SND, MGR, Controls, All, Nodes, Of, Fact, Swept, Running, Parcel)
}
NAMES: Mapping[str, Any] = {**TYPES, "Query": Query, "Observation": Observation}


def elsewhere_json(seen: Elsewhere) -> dict[str, Any]:
    """Return an event between stations as plain data."""
    if isinstance(seen, HostReport):
        data: dict[str, Any] = {"words": f"{seen.agent} is at {seen.host}", "writes": []}
        return {**data, "agent": seen.agent, "host": seen.host}
    if isinstance(seen, Belief):
        data = {"words": f"{seen.slot} of {seen.node}: {', '.join(seen.names)}", "writes": []}
        return {**data, "node": seen.node, "slot": seen.slot, "names": list(seen.names)}
    verb = "leaves for" if seen.parcel is None else "enters from"
    data = {"words": f"{seen.agent} {verb} {seen.station}", "writes": []}
    data |= {"agent": seen.agent, "station": seen.station, "number": seen.number}
    return data if seen.parcel is None else {**data, "parcel": parcel_json(seen.parcel)}


def elsewhere_of(data: Any) -> Elsewhere:
    """Return the event between stations of plain data; raises ValueError."""
    match data:
        case {"node": str(node), "slot": "parent" | "links" as slot, "names": [*names]}:
            return Belief(node, slot, _tuple((str, ...), names, 0))
        case {"agent": str(agent), "host": str(host)}:
            return HostReport(agent, host)
        case {"agent": str(agent), "station": str(station), "number": int(number)} if number > 0:
            parcel = parcel_of(data["parcel"]) if "parcel" in data else None
            return Passage(agent, station, number, parcel)
    raise ValueError("a parcel between stations has an agent, a station and a number, or a host")


def parcel_json(parcel: Parcel) -> Any:
    """Return a parcel as plain data."""
    return _plain(parcel)


def parcel_of(data: Any) -> Parcel:
    """Return the parcel of plain data.

    Raises:
        ValueError: The data are malformed.
    """
    parcel: Parcel = _read(Parcel, data, 0)
    if len(parcel.mail) > MOST_MAIL:
        raise ValueError(f"a parcel has at most {MOST_MAIL:,} messages")
    return parcel


# --- written --------------------------------------------------------------------------------------------


def _plain(value: Any) -> Any:
    match value:
        case None | str() | int():
            return value
        case Text(characters):
            return {"text": characters}
        case Truth():
            return {"truth": value.value}
        case tuple():
            return [_plain(each) for each in value]
        case frozenset():
            return {"set": [_plain(each) for each in in_order(value)]}
        case Route(stops):
            return {"route": [_plain(each) for each in stops]}
        case Observation():
            facts = [[name, _plain(fact)] for name, fact in value.facts]
            return {"seen": facts, "swept": _plain(value.swept)}
        case _ if is_dataclass(value):
            return {type(value).__name__: [_plain(getattr(value, each.name)) for each in fields(value)]}
    raise TypeError(f"{value!r:.60} is in no parcel")


# --- read -----------------------------------------------------------------------------------------------


def _read(hint: Any, data: Any, depth: int) -> Any:
    """Return the value of a type that the data encode."""
    if depth > DEEPEST:
        raise ValueError("a parcel is nested too deep")
    if Truth in get_args(hint):  # a `Value`, whose parts are values again
        return _value(data, depth)
    if hint is Observation:
        return _observation(data, depth)
    origin = get_origin(hint)
    if origin is tuple:
        return _tuple(get_args(hint), data, depth)
    if origin in (Union, UnionType):
        return _one_of(get_args(hint), data, depth)
    if hint in (str, int, bool, type(None)):
        if type(data) is hint and (hint is not int or abs(data) <= LARGEST_NUMBER):
            return data
        raise ValueError(f"{data!r:.60} should be a {hint.__name__}")
    if hint is QueryOperator:
        if data in list(QueryOperator):
            return QueryOperator(data)
        raise ValueError(f"{data!r:.60} is no operator of queries")
    return _object(hint, data, depth)


def _object(kind: type, data: Any, depth: int) -> Any:
    hints = _hints(kind)
    match data:
        case {kind.__name__: list(values)} if len(data) == 1 and len(values) == len(hints):
            return kind(*(_read(hint, each, depth + 1) for hint, each in zip(hints, values, strict=True)))
    raise ValueError(f"{data!r:.60} should be {kind.__name__}")


@cache
def _hints(kind: type) -> tuple[Any, ...]:
    hints = get_type_hints(kind, None, dict(NAMES))
    return tuple(hints[each.name] for each in fields(kind))


def _one_of(kinds: tuple[Any, ...], data: Any, depth: int) -> Any:
    for kind in kinds:
        named = isinstance(data, dict) and kind in TYPES.values() and kind.__name__ in data
        if named or type(data) is kind:
            return _read(kind, data, depth)
    raise ValueError(f"{data!r:.60} is not allowed there")


def _tuple(kinds: tuple[Any, ...], data: Any, depth: int) -> tuple[Any, ...]:
    if not isinstance(data, list) or len(data) > MOST_ITEMS:
        raise ValueError(f"{data!r:.60} should be a list of at most {MOST_ITEMS:,}")
    if kinds[1:] == (...,):
        kinds = kinds[:1] * len(data)
    if len(kinds) != len(data):
        raise ValueError(f"{data!r:.60} should have {len(kinds)} parts")
    return tuple(_read(kind, each, depth + 1) for kind, each in zip(kinds, data, strict=True))


def _value(data: Any, depth: int) -> Value:
    value = _any_value(data, depth)
    if parts(value) > MOST_PARTS:
        raise ValueError(f"a value has at most {MOST_PARTS:,} parts")
    return value


def _any_value(data: Any, depth: int) -> Value:
    if depth > DEEPEST:
        raise ValueError("a value is nested too deep")
    match data:
        case bool():
            pass
        case str():
            return data
        case int() if abs(data) <= LARGEST_NUMBER:
            return data
        case list():
            return tuple(_any_value(each, depth + 1) for each in data)
        case {"set": list(members)}:
            return frozenset(_any_value(each, depth + 1) for each in members)
        case {"route": list(stops)}:
            return Route(tuple(_any_value(each, depth + 1) for each in stops))
        case {"text": str(characters)}:
            return Text(characters)
        case {"truth": "true" | "false" as truth}:
            return Truth(truth)
        case {"seen": _}:
            return _observation(data, depth)
    raise ValueError(f"{data!r:.60} is no value")


def _observation(data: Any, depth: int) -> Observation:
    match data:
        case {"seen": seen, "swept": swept}:
            facts = _tuple((tuple[str, Fact], ...), seen, depth + 1)
            return Observation(dict(facts), _read(Swept, swept, depth + 1))
    raise ValueError(f"{data!r:.60} is no observation")
