"""The ways of a mission's flights as a table and as plain data."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from typing import TYPE_CHECKING, Any, Final

if TYPE_CHECKING:
    from checker.properties.corridors import Corridors, FlightWay, PairDistance, PlaceDistance, WayLeg

MOST_PLACES: Final = 4
"""The most places with a column."""

MOST_ROWS: Final = 60
"""The most flights, and the most pairs, of the table; the JSON report has all."""

Row = tuple[str, ...]


def corridors_text(found: Corridors) -> Iterator[str]:
    """Yield the ways line by line: each flight with its legs, then each pair of vehicles."""
    if not found.flights:
        yield "  ways: none; the mission makes no flight" if found.complete else "  ways: none was measured"
    else:
        yield from aligned(flight_rows(found))
    if found.pairs:
        yield from aligned(pair_rows(found))
    yield from (f"  note: {note}" for note in found.notes)


def aligned(rows: Iterator[Row]) -> Iterator[str]:
    """Yield the rows of a table with its columns aligned; the last one is not padded."""
    table = list(rows)
    widths = [max(map(len, column)) for column in zip(*table, strict=True)]
    for row in table:
        cells = (cell.ljust(width) for cell, width in zip(row, widths, strict=True))
        yield f"  {'   '.join(cells)}".rstrip()


# --- flights --------------------------------------------------------------------------------------


def flight_rows(found: Corridors) -> Iterator[Row]:
    """Yield the table of flights row by row, its head first."""
    shown = shown_places(found)
    yield (f"ways{_so_far(found)}", "length", *(f"from {found.places[rank]}" for rank in shown))
    for flight in found.flights[:MOST_ROWS]:
        yield _row(f"  {name_of(flight)}", flight.whole, shown)
        for leg in flight.legs:
            yield _row(f"    {leg.origin} to {leg.to}", leg, shown)
    left = len(found.flights) - MOST_ROWS, len(found.places) - len(shown)
    for count, what in zip(
        left, ("on the list of flights", "on the list of places, farther from all flights"), strict=True
    ):
        if count > 0:
            yield (f"  {count:,} more {what}: see --json", *[""] * (1 + len(shown)))


def _so_far(found: Corridors) -> str:
    return "" if found.complete else " so far"


def shown_places(found: Corridors) -> tuple[int, ...]:
    """Return the ranks of the places with a column: those that some flight comes nearest to, in their order."""

    def least(rank: int) -> float:
        clearances = (flight.whole.places[rank].clearance for flight in found.flights)
        return min((each.metres for each in clearances if each is not None), default=math.inf)

    ranks = sorted(range(len(found.places)), key=lambda rank: (least(rank), rank))
    return tuple(sorted(ranks[:MOST_PLACES]))


def name_of(flight: FlightWay) -> str:
    """Return the words for a flight."""
    by = f" by {', '.join(flight.via)}" if flight.via else ""
    return f"{flight.vehicle} from {flight.whole.origin}{by} to {flight.whole.to}"


def _row(name: str, leg: WayLeg, shown: Sequence[int]) -> Row:
    return (name, length_text(leg), *(_distance_text(leg.places[rank]) for rank in shown))


def length_text(leg: WayLeg) -> str:
    """Return the length of a leg as text: from the least to the most."""
    least = math.floor(leg.least)
    if leg.most is None:
        return f"{least:,} m or more"
    if leg.most - leg.least < 1.0:
        return f"{round(leg.least):,} m"
    return f"{least:,} to {math.ceil(leg.most):,} m"


def _distance_text(distance: PlaceDistance) -> str:
    far = "" if distance.reach is None else f", at most {distance.reach:,.0f} m"
    found = distance.clearance
    if found is None:
        return "-"
    if found.side.value == "across":
        return f"may cross its border{far}"
    gap = f", {found.gap:g} m above or below" if found.gap else ""
    inside = "inside by " if found.side.value == "inside" else ""
    return f"{inside}{math.floor(found.metres):,} m{gap}{far}"


# --- pairs ----------------------------------------------------------------------------------------


def pair_rows(found: Corridors) -> Iterator[Row]:
    """Yield the table of pairs row by row, its head first."""
    yield (f"vehicles under way together{_so_far(found)}", "least distance", "where")
    for pair in found.pairs[:MOST_ROWS]:
        rest = "" if pair.both_fly else ", one at rest"
        yield (f"  {', '.join(pair.vehicles)}{rest}", _metres_text(pair), ", ".join(pair.where))
    if len(found.pairs) > MOST_ROWS:
        yield (f"  and {len(found.pairs) - MOST_ROWS:,} more: see --json", "", "")


def _metres_text(pair: PairDistance) -> str:
    metres = f"{math.floor(pair.metres):,} m" if pair.metres >= 1.0 else "may meet"
    if not pair.gap:
        return metres
    return f"{math.floor(pair.metres):,} m, {pair.gap:g} m above or below"


# --- plain data -----------------------------------------------------------------------------------


def corridors_json(found: Corridors) -> dict[str, Any]:
    """Return the ways as plain data, in metres."""
    return {
        "complete": found.complete,
        "flights": [_flight_json(flight) for flight in found.flights],
        "pairs": [_pair_json(pair) for pair in found.pairs],
        "notes": list(found.notes),
    }


def _flight_json(flight: FlightWay) -> dict[str, Any]:
    altitude = None if flight.low is None or flight.high is None else {"low": flight.low, "high": flight.high}
    return {
        "vehicle": flight.vehicle,
        "via": list(flight.via),
        **_leg_json(flight.whole),
        "margin": flight.margin,
        "altitude": altitude,
        "legs": [_leg_json(leg) for leg in flight.legs or (flight.whole,)],
    }


def _leg_json(leg: WayLeg) -> dict[str, Any]:
    return {
        "from": leg.origin,
        "to": leg.to,
        "length": {
            "at_least": _rounded(leg.least),
            "at_most": None if leg.most is None else _rounded(leg.most),
        },
        "places": [_place_json(each) for each in leg.places],
    }


def _place_json(distance: PlaceDistance) -> dict[str, Any]:
    found = distance.clearance
    return {
        "place": distance.place,
        "side": None if found is None else found.side.value,
        "at_least": None if found is None else _rounded(found.metres),
        "up": None if found is None else found.gap,
        "at_most": distance.reach,
    }


def _pair_json(pair: PairDistance) -> dict[str, Any]:
    return {
        "vehicles": list(pair.vehicles),
        "both_fly": pair.both_fly,
        "at_least": _rounded(pair.metres),
        "up": pair.gap,
        "where": list(pair.where),
        "points": [list(point.vertices[0]) for point in pair.points],
    }


def _rounded(metres: float) -> float:
    return round(metres, 2)
