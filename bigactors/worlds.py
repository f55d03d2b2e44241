"""Worlds without a mission: files as a configuration without agents."""

from collections import Counter
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

from bigactors.files import read_bytes
from bigactors.mistakes import Mistake
from physical import GeoJSONError, Geometry, PhysicalError, PhysicalProperty, box, check_places, contains
from physical.ais_recording import read_recording, without_sentences
from physical.ais_reports import AisError
from physical.ais_world import check_time, seen_at
from physical.file_account import FileAccount, Read
from physical.geojson import MAX_BYTES
from physical.long_edges import check_width
from physical.place_files import PLACES, read_place_file
from physical.wordings import counted
from semantics.behaviours.program import Program
from semantics.state.configuration import Configuration
from semantics.state.initial import initial
from semantics.state.physical_model import Carried, Placed, Placement
from semantics.state.setting import Setting
from semantics.state.signature import NO_ENTITIES, Kind, Signature


@dataclass(frozen=True, slots=True)
class World:
    """The entities in files, with their positions.

    Attributes:
        properties: The property of each entity, sorted by name.
        accounts: For each file, a tally of its contents, taken and left out.
        left_out: The number of entities read and not kept.
        doubts: Probable mistakes of the user, in words.
    """

    properties: tuple[PhysicalProperty, ...]
    accounts: tuple[tuple[str, FileAccount], ...] = ()
    left_out: int = 0
    doubts: tuple[str, ...] = ()

    @property
    def conflicts(self) -> tuple[str, ...]:
        """Places that overlap without nesting: A(P) puts entities in both into the smaller one."""
        areas = {each.entity: each.geometry for each in self.properties if not each.geometry.is_point}
        return tuple(map(str, check_places(areas)))


def read_world(
    paths: Sequence[str],
    time: float | None = None,
    within: tuple[float, float, float, float] | None = None,
    kinds: Iterable[str] = (),
) -> World:
    """Read files of places and AIS recordings; raises Mistake.

    Args:
        paths: The files.
        time: The moment of interest, in seconds since 1970; the end of a recording if None.
        within: The south, west, north and east of the kept area.
        kinds: The kinds to keep; all if there are none.
    """
    origins: dict[str, str] = {}
    found: dict[str, PhysicalProperty] = {}
    accounts: list[tuple[str, FileAccount]] = []
    doubts: list[str] = []
    for path in paths:
        for each in _read(path, time, accounts, doubts):
            if each.entity in found:
                raise Mistake(f"{each.entity} is in {origins[each.entity]} too", "names are unique", path)
            found[each.entity], origins[each.entity] = each, path
    if time is not None and all(Path(path).suffix.lower() in PLACES for path in paths):
        raise Mistake("--at is a time of a recording", "files of places have no times: leave it out")
    kept = tuple(_kept(found, within, frozenset(kinds)))
    listed = tuple(sorted(kept, key=lambda each: each.entity))
    return World(listed, tuple(accounts), len(found) - len(kept), tuple(doubts))


def _read(
    path: str, time: float | None, accounts: list[tuple[str, FileAccount]], doubts: list[str]
) -> tuple[PhysicalProperty, ...]:
    try:
        found = _found(path, time, doubts)
        accounts += ((path, tally) for tally in found.tallies)
        return found.properties
    except GeoJSONError as error:
        said = "\n".join(_said(problem) for problem in error.problems)
        raise Mistake(
            error.message, place=path, rendered="\n".join(f"{path}: {line}" for line in said.split("\n"))
        ) from error
    except PhysicalError as error:
        where = f"{path}: {error.where}" if error.where else path
        raise Mistake(error.message, error.hint, where) from error


def _found(path: str, time: float | None, doubts: list[str]) -> Read:
    suffix = Path(path).suffix.lower()
    if suffix in PLACES:
        return read_place_file(suffix, read_bytes(path, MAX_BYTES))
    recording = read_recording(path)
    if found := without_sentences(recording.tally):
        raise Mistake(found, f"give an AIS recording, or places in a file called {', '.join(PLACES)}", path)
    try:
        check_time(recording, time)
    except AisError as doubt:
        doubts.append(f"{path}: {doubt.message}")
    return seen_at(recording, time)


def _said(problem: PhysicalError) -> str:
    where = f"{problem.where}: " if problem.where else ""
    return f"{where}{problem.message}" + (f" (hint: {problem.hint})" if problem.hint else "")


def _kept(
    found: Mapping[str, PhysicalProperty],
    within: tuple[float, float, float, float] | None,
    kinds: frozenset[str],
) -> Iterator[PhysicalProperty]:
    known = sorted({each.kind for each in found.values()})
    unknown = sorted(kinds.difference(known))
    if unknown:
        raise Mistake(f"nothing is of kind '{unknown[0]:.60}'", f"the kinds are {', '.join(known)}")
    try:
        area = area_within(within) if within else None
    except PhysicalError as error:
        raise Mistake(f"--within: {error.message}", error.hint) from error
    for each in found.values():
        if (not kinds or each.kind in kinds) and (area is None or contains(area, each.geometry)):
            yield each


def area_within(within: Sequence[float]) -> Geometry:
    """Return the box from the south and the west to the north and the east; raises PhysicalError."""
    south, west, north, east = within
    area = box((south, west), (north, east))
    check_width(west, east)
    return area


def configuration_of(world: World) -> Configuration:
    """Return ⟨∅ | (A(P), P, β, γ) | ∅⟩ of a world. A kind with an area may contain every kind."""
    known = {each.entity: each for each in world.properties}
    for name in sorted(NO_ENTITIES & known.keys()):
        raise Mistake(f"an entity is called '{name}'", "the language has that name for a place: rename it")
    kinds = {name: each.kind for name, each in known.items()}
    placements = {name: _placement(each, known) for name, each in known.items()}
    setting = Setting(_signature(world), kinds, Program((), {}, {}))
    return initial(setting, placements, {name: each.channels for name, each in known.items()}, {})


def _placement(entity: PhysicalProperty, known: Mapping[str, PhysicalProperty]) -> Placement:
    placed = Placed(entity.geometry, entity.altitude)
    if entity.carried_by is None:
        return placed
    seen, by = {entity.entity}, entity.carried_by
    while by:
        if by not in known:
            raise Mistake(
                f"{entity.entity} is carried by '{by:.60}', which is not there", "add it, or leave both out"
            )
        if by in seen:
            raise Mistake(f"{entity.entity} is carried by itself", "carrying goes one way")
        seen.add(by)
        by = known[by].carried_by or ""
    return Carried(entity.carried_by, placed)


def _signature(world: World) -> Signature:
    known = {each.entity: each.kind for each in world.properties}
    every = frozenset(known.values())
    wide = {each.kind for each in world.properties if not each.geometry.is_point}
    loads: dict[str, set[str]] = {}
    for each in world.properties:
        if each.carried_by in known:
            loads.setdefault(known[each.carried_by], set()).add(each.kind)
    return Signature.of(
        Kind(kind, contains=every if kind in wide else frozenset(), carries=frozenset(loads.get(kind, ())))
        for kind in every
    )


def census(world: World) -> str:
    """Return the number of entities of each kind, in words."""
    counts = Counter(each.kind for each in world.properties)
    listed = ", ".join(f"{count} {kind}" for kind, count in sorted(counts.items()))
    left_out = (
        f" ({counted(world.left_out, 'other')} not of these kinds or not within)" if world.left_out else ""
    )
    return counted(len(world.properties), "entity", "entities") + (f": {listed}" if listed else "") + left_out
