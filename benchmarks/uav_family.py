"""The UAV family: vehicles that move between neighbouring locations and are handed from station to station.

A case is written in BigraphER's language, and its states and transitions are counted without any bigraphs: a state
is where each vehicle is and which station it is linked to, up to what cannot be told apart.
"""

from collections.abc import Iterator
from dataclasses import dataclass
from itertools import permutations, product

Vehicles = tuple[tuple[int, int], ...]
"""For each vehicle its location and its station."""


@dataclass(frozen=True, slots=True)
class Case:
    """One of the family.

    Attributes:
        shape: `row`, `ring`, or a grid such as `3x3`.
        vehicles: How many there are; all start in the first location, linked to the first station.
        locations: How many there are.
        distinct: Whether vehicles can be told apart.
        open: Whether links have names, so that locations and stations can be told apart.
        stations: How many there are.
    """

    shape: str
    vehicles: int
    locations: int
    distinct: bool
    open: bool
    stations: int = 2

    def __str__(self) -> str:
        kind = "distinct" if self.distinct else "alike"
        links = "open" if self.open else "closed"
        return f"{self.shape}, {self.vehicles} {kind}, {self.locations} locations, {links} links"

    def borders(self) -> list[tuple[int, int]]:
        """Return the pairs of neighbouring locations."""
        if self.shape in ("row", "ring"):
            row = [(place, place + 1) for place in range(self.locations - 1)]
            return [*row, (self.locations - 1, 0)] if self.shape == "ring" else row
        rows, columns = map(int, self.shape.split("x"))
        cells = list(product(range(rows), range(columns)))
        right = [(r * columns + c, r * columns + c + 1) for r, c in cells if c + 1 < columns]
        down = [(r * columns + c, (r + 1) * columns + c) for r, c in cells if r + 1 < rows]
        return sorted([*right, *down])


def text(case: Case) -> str:
    """Write a case in BigraphER's language."""
    which, each = ("(i)", "fun ") if case.distinct else ("", "")
    borders = case.borders()
    places = []
    for place in range(case.locations):
        inside = [f"N{{e{number}}}" for number, pair in enumerate(borders) if place in pair]
        if place == 0:
            inside += [
                f"UAV({number}){{g0}}" if case.distinct else "UAV{g0}" for number in range(case.vehicles)
            ]
        places.append(f"Loc.({' | '.join(inside)})")
    stations = [f"GCS{{g{number}}}" for number in range(case.stations)]
    names = [f"e{number}" for number in range(len(borders))] + [
        f"g{number}" for number in range(case.stations)
    ]
    closures = "" if case.open else "".join(f"/{name} " for name in names)
    values = f"  int i = [0:1:{case.vehicles - 1}];\n" if case.distinct else ""
    return f"""\
ctrl Loc = 0;
atomic ctrl N = 1;
atomic ctrl GCS = 1;
atomic {each}ctrl UAV{which} = 1;
{each}react move{which} =
  Loc.(UAV{which}{{g}} | N{{e}} | id) || Loc.(N{{e}} | id) --> Loc.(N{{e}} | id) || Loc.(UAV{which}{{g}} | N{{e}} | id);
{each}react hand{which} =
  UAV{which}{{g}} || GCS{{g}} || GCS{{h}} --> UAV{which}{{h}} || GCS{{g}} || GCS{{h}};
big start = {closures}({" | ".join([*stations, *places])});
begin brs
{values}  init start;
  rules = [ {{move{which}, hand{which}}} ];
end
"""


def counts(case: Case) -> tuple[int, int]:
    """Return the states that can be reached and the pairs of a state and a successor, loops included."""
    symmetries = [] if case.open else list(product(_symmetries(case), permutations(range(case.stations))))

    def one(state: Vehicles) -> Vehicles:
        seen = [tuple((turn[at], swap[by]) for at, by in state) for turn, swap in symmetries] or [state]
        return min(each if case.distinct else tuple(sorted(each)) for each in seen)

    first = one(((0, 0),) * case.vehicles)
    known, waiting, pairs = {first}, [first], 0
    for state in waiting:  # grows while it is walked
        after = {one(each) for each in _steps(case, state)}
        pairs += len(after)
        waiting += sorted(after - known)
        known |= after
    return len(known), pairs


def _steps(case: Case, state: Vehicles) -> Iterator[Vehicles]:
    borders = case.borders()
    for number, (at, by) in enumerate(state):
        for pair in borders:
            if at in pair:
                yield (*state[:number], (pair[pair[0] == at], by), *state[number + 1 :])
        for other in range(case.stations):
            if other != by:
                yield (*state[:number], (at, other), *state[number + 1 :])


def _symmetries(case: Case) -> Iterator[tuple[int, ...]]:
    """Yield the permutations of locations that keep neighbours, built up place by place."""
    near = {frozenset(pair) for pair in case.borders()}
    partial: list[tuple[int, ...]] = [()]
    for place in range(case.locations):
        partial = [
            (*found, image)
            for found in partial
            for image in range(case.locations)
            if image not in found
            and all(
                (frozenset((old, place)) in near) == (frozenset((found[old], image)) in near)
                for old in range(place)
            )
        ]
    yield from partial
