"""Observations as plain data for files: written, and read back within bounds."""

from typing import Any

from physical import Band, Geometry, point
from physical.frame import E7
from physical.shape import MAX_VERTICES, canonical
from semantics.observed_steps import WRITABLE, Sight
from semantics.state.cell_values import Cell
from semantics.state.parcel_serialization import elsewhere_json, elsewhere_of
from semantics.state.physical_model import Carried, InTransit, Placed, Placement
from semantics.state.station_partition import Elsewhere

MOST_WRITES = 10_000
"""The most cells that one observation may write."""


def sight_json(sight: Sight | Elsewhere) -> dict[str, Any]:
    """Return an observation, or a passage between stations, as plain data."""
    if not isinstance(sight, Sight):
        return elsewhere_json(sight)
    data: dict[str, Any] = {"words": sight.words}
    data["writes"] = [[list(cell), value_json(value)] for cell, value in sorted(sight.writes.items())]
    return {**data, "admits": dict(sorted(sight.admits.items()))} if sight.admits else data


def value_json(value: Any) -> Any:
    """Return the value of a cell of P as plain data."""
    match value:
        case Placed(geometry, altitude):
            return {"at": geometry_json(geometry)} | (
                {} if altitude is None else {"altitude": [altitude.low, altitude.high]}
            )
        case Carried(by, shape):
            return {"by": by, "shape": value_json(shape)}
        case InTransit(origin, to):
            return {"from": value_json(origin), "to": to}
        case tuple():
            return list(value)
        case _:
            return value


def geometry_json(geometry: Geometry) -> dict[str, Any]:
    """Return a geometry as plain data: its ring in whole numbers of 1e-7 degree, its template and its anchor."""
    data: dict[str, Any] = {"ring": [list(vertex) for vertex in geometry.ring]}
    if geometry.template is not None and geometry.anchor is not None:
        data |= {"of": [list(vertex) for vertex in geometry.template.ring], "anchor": list(geometry.anchor)}
    return data


def sight_of(data: Any) -> Sight | Elsewhere:
    """Return the observation, or the passage between stations, of plain data.

    Raises:
        ValueError: The data are malformed; its subclass GeometryError for a malformed geometry.
    """
    if not isinstance(data, dict) or not isinstance(data.get("words"), str):
        raise ValueError("an observation should have 'words' and 'writes'")
    if "agent" in data or "node" in data:
        return elsewhere_of(data)
    writes, admits = data.get("writes", []), data.get("admits", {})
    if not isinstance(writes, list) or len(writes) > MOST_WRITES or not isinstance(admits, dict):
        raise ValueError(f"an observation has at most {MOST_WRITES:,} writes")
    if not all(isinstance(word, str) for pair in admits.items() for word in pair):
        raise ValueError("'admits' should give a kind to each name")
    return Sight(data["words"], dict(map(_write, writes)), admits)


def _write(item: Any) -> tuple[Cell, Any]:
    match item:
        case [[str(what), *whose], value] if (
            what in WRITABLE and whose and all(isinstance(w, str) for w in whose)
        ):
            return (what, *whose), _value(what, value)
    raise ValueError(f"{item!r:.80} is no observable relation")


def _value(what: str, value: Any) -> Any:
    if what in ("left", "down") and isinstance(value, bool):
        return value
    if what == "channels" and isinstance(value, list) and all(isinstance(each, str) for each in value):
        return tuple(value)
    if what == "placement":
        return None if value is None else placement_of(value)
    raise ValueError(f"{value!r:.80} is no value of '{what}'")


def placement_of(data: Any) -> Placement:
    """Return the placement of plain data; raises ValueError."""
    match data:
        case {"from": origin, "to": str(to)}:
            start = placement_of(origin)
            if isinstance(start, Placed):
                return InTransit(start, to)
        case {"by": str(by), "shape": shape}:
            inner = placement_of(shape)
            if isinstance(inner, Placed):
                return Carried(by, inner)
        case {"at": geometry, **rest}:
            return Placed(geometry_of(geometry), band_of(rest.get("altitude")))
    raise ValueError(f"{data!r:.80} is no placement")


def band_of(data: Any) -> Band | None:
    """Return the band of altitudes of plain data; raises ValueError."""
    match data:
        case None:
            return None
        case [int() | float() as low, int() | float() as high]:
            return Band(low, high)
    raise ValueError(f"{data!r:.80} is no band of altitudes")


def geometry_of(data: Any) -> Geometry:
    """Return the geometry of plain data; raises ValueError."""
    ring = _ring(data.get("ring") if isinstance(data, dict) else None)
    if len(ring) == 1:
        return point(ring[0][0] / E7, ring[0][1] / E7)
    if "of" not in data:
        return canonical(ring)
    return canonical(ring, canonical(_ring(data["of"])), _ring([data.get("anchor")])[0])


def _ring(data: Any) -> list[tuple[int, int]]:
    if not isinstance(data, list) or not 1 <= len(data) <= MAX_VERTICES:
        raise ValueError(f"{data!r:.80} is no ring of positions")
    return [_position(each) for each in data]


def _position(data: Any) -> tuple[int, int]:
    match data:
        case [int(north), int(east)] if abs(north) <= 90 * E7 and abs(east) <= 180 * E7:
            return north, east
    raise ValueError(f"{data!r:.80} is no position in 1e-7 degree")
