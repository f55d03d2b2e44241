"""Worlds from files: GeoJSON, waypoint files, plans, and AIS recordings at a given time."""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass, field, replace
from datetime import UTC, datetime
from pathlib import Path
from typing import Final

from physical import GeoJSONError, Geometry, PhysicalError, PhysicalProperty, circle, contains, open_file
from physical.file_account import Counting, Read
from physical.geojson import MAX_BYTES as MAX_GEOJSON
from physical.mmsi import KINDS
from physical.place_files import PLACES, read_place_file
from physical.wordings import counted
from specs import syntax as s
from specs.codes import Code
from specs.elaboration.geometry import elaborate_geometry
from specs.elaboration.mission_mistakes import shorten
from specs.elaboration.names import Names
from specs.grammar import RESERVED

AIS: Final = (".nmea", ".ais", ".txt", ".log")
MOST_PROBLEMS: Final = 5
"""The number of mistakes of one file that are reported."""

_NAME: Final = re.compile(r"[^\W\d_]\w*")
_CHANNEL: Final = re.compile(r"\w+(?:[:.\-]\w+)*")


_GIVEN_BY_FILES: Final = ("entity", "name", "channel")
"""The sorts of names that a file may declare; the names in an unreadable file are unknown."""


class UnusableFileError(Exception):
    """A file cannot be used; carries the code, message and hint for the user."""

    def __init__(self, code: Code, message: str, hint: str = "") -> None:
        self.code, self.message, self.hint = code, message, hint
        super().__init__(message)


@dataclass(frozen=True, slots=True)
class Library:
    """The location of a world's files: beside the mission, unless they are replaced."""

    directory: Path
    instead: Mapping[str, Path] = field(default_factory=dict)

    def locate(self, name: str) -> Path:
        """Return the path of a file that a mission names; raises UnusableFileError if there is none."""
        if name in self.instead:
            return self.instead[name]
        try:
            if Path(name).is_absolute() or re.match(r"[A-Za-z]:|[\\/~]", name):
                raise UnusableFileError(
                    Code.UNREADABLE_FILE,
                    f"'{shorten(name)}' is an absolute path",
                    "give it relative to the mission",
                )
            path = (self.directory / name).resolve()
            if not path.exists() or path.is_dir():
                raise UnusableFileError(
                    Code.UNREADABLE_FILE,
                    f"there is no file '{shorten(name)}' beside the mission",
                    "check the path",
                )
        except (OSError, ValueError, RuntimeError) as error:
            raise UnusableFileError(
                Code.UNREADABLE_FILE, f"'{shorten(name)}' is no path of a file"
            ) from error
        return path


def read_source(
    entry: s.FromSource, library: Library, names: Names, notes: list[str]
) -> tuple[PhysicalProperty, ...]:
    """Return the entities of a file, with kinds of the signature; reports mistakes, and adds omissions to `notes`."""
    area = None if entry.within is None else elaborate_geometry(entry.within, names.findings)
    for keep in entry.keep:
        names.kind(keep.kind)
    try:
        read = _read(entry, library.locate(entry.file.value), area)
    except UnusableFileError as refused:
        names.findings.add(refused.code, entry.file, refused.message, refused.hint)
        names.findings.unread.update(_GIVEN_BY_FILES)
        return ()
    found = read.properties
    _check_keep(entry, found, names)
    counting = Counting()
    kept = tuple(_kept(found, entry.keep, area, counting))
    if missing := (*read.missing(), *counting.tally(len(found), "entity", "entities").missing()):
        notes.append(f"{entry.file.value}: {'; '.join(missing)}")
    places = _as_places(_prefixed(kept, entry.prefix), entry, names, notes)
    limited = places if entry.limit is None else places[: entry.limit]
    if len(limited) < len(places):
        notes.append(
            f"{len(limited):,} of the {counted(len(places), 'entity', 'entities')} in {entry.file.value} "
            f"{'is' if len(limited) == 1 else 'are'} in the world: the first"
        )
    usable = tuple(item for item in limited if _usable(item, entry, names))
    if len(usable) < len(limited):
        names.findings.unread.update(_GIVEN_BY_FILES)
    return usable


def _read(entry: s.FromSource, path: Path, area: Geometry | None) -> Read:
    suffix = path.suffix.lower()
    if suffix in PLACES:
        if entry.time is not None:
            raise UnusableFileError(Code.BAD_FILE, "a file of places has no times", "leave out 'at'")
        read = _places(suffix, path)
        return replace(read, properties=tuple(sorted(read.properties, key=lambda item: item.entity)))
    if suffix in AIS:
        return _ais(entry, path, area)
    known = ", ".join((*PLACES, *AIS))
    raise UnusableFileError(
        Code.BAD_FILE,
        f"'{shorten(suffix)}' is the ending of no format that is read here",
        f"they are {known}",
    )


def _places(suffix: str, path: Path) -> Read:
    try:
        with open_file(path) as file:
            data = file.read(MAX_GEOJSON + 1)
        return read_place_file(suffix, data)
    except OSError as error:
        raise UnusableFileError(
            Code.UNREADABLE_FILE, f"it cannot be read: {error.strerror or error}"
        ) from error
    except GeoJSONError as error:
        shown, more = error.problems[:MOST_PROBLEMS], len(error.problems) - MOST_PROBLEMS
        told = [f"{each.where}: {each.message}" if each.where else each.message for each in shown]
        told += [f"and {more} more"] if more > 0 else []
        raise UnusableFileError(Code.BAD_FILE, "; ".join(told), error.hint) from error
    except PhysicalError as error:
        where = f"{error.where}: " if error.where else ""
        raise UnusableFileError(Code.BAD_FILE, f"{where}{error.message}", error.hint) from error


def _ais(entry: s.FromSource, path: Path, area: Geometry | None) -> Read:
    from physical.ais_recording import read_recording, without_sentences  # noqa: PLC0415 - few are recordings
    from physical.ais_reports import AisError  # noqa: PLC0415
    from physical.ais_world import check_time, seen_at  # noqa: PLC0415

    kinds = {keep.recorded.text for keep in entry.keep} or None
    time = None if entry.time is None else _seconds(entry.time.value)
    try:
        recording = read_recording(path)
        if found := without_sentences(recording.tally):
            raise UnusableFileError(Code.BAD_FILE, found, "give a recording of AIS")
        check_time(recording, time)
        return seen_at(recording, time, area, kinds)
    except AisError as error:
        code = Code.MISSING_EXTRA if error.code == "ais-extra" else Code.BAD_FILE
        unread = Code.UNREADABLE_FILE if error.code == "ais-unreadable" else code
        raise UnusableFileError(unread, error.message, error.hint) from error


def _seconds(text: str) -> float:
    try:
        time = datetime.fromisoformat(text)
        return (time if time.tzinfo else time.replace(tzinfo=UTC)).timestamp()
    except (ValueError, OverflowError) as error:
        hint = "write it as 2020-04-07T21:42:00Z; without a zone it is UTC"
        raise UnusableFileError(Code.BAD_FILE, f"'{shorten(text)}' is no time", hint) from error


def _check_keep(entry: s.FromSource, found: tuple[PhysicalProperty, ...], names: Names) -> None:
    kinds = {item.kind for item in found} | (
        set(KINDS) if Path(entry.file.value).suffix.lower() in AIS else set()
    )
    for keep in entry.keep:
        if keep.recorded.text not in kinds:
            otherwise = (
                f"its kinds are {', '.join(map(shorten, sorted(kinds)[:10]))}" if kinds else "it is empty"
            )
            names.findings.unknown(
                keep.recorded, kinds, sort="kind of the file", code=Code.UNKNOWN_KIND, otherwise=otherwise
            )


def _kept(
    found: tuple[PhysicalProperty, ...], keep: tuple[s.Keep, ...], area: Geometry | None, counting: Counting
) -> Iterator[tuple[PhysicalProperty, s.Keep | None]]:
    """Yield the entities that are kept, with the mission's kind and their `keep` clause; count the others."""
    kinds = {each.recorded.text: each for each in keep}
    for item in found:
        as_kind = kinds.get(item.kind)
        if keep and as_kind is None:
            counting.leave(f"{shorten(item.kind)} not asked for")
        elif area is not None and not contains(area, item.geometry):
            counting.leave(f"{shorten(item.kind)} outside the area")
        else:
            yield (item if as_kind is None else replace(item, kind=as_kind.kind.text)), as_kind


Kept = Iterable[tuple[PhysicalProperty, s.Keep | None]]


def _prefixed(found: Kept, prefix: s.Name | None) -> Kept:
    """Put the mission's prefix for a file before the names in it."""
    if prefix is None:
        return found
    begin = f"{prefix.text}_"
    return (
        (
            replace(
                item,
                entity=begin + item.entity,
                carried_by=None if item.carried_by is None else begin + item.carried_by,
            ),
            keep,
        )
        for item, keep in found
    )


def _as_places(
    found: Kept, entry: s.FromSource, names: Names, notes: list[str]
) -> tuple[PhysicalProperty, ...]:
    """Replace points by circles if a radius is given; of several at one position only the first is kept."""
    made: dict[Geometry, str] = {}
    places = []
    for item, keep in found:
        if keep is None or keep.radius is None or not item.geometry.is_point:
            places.append(item)
            continue
        try:
            round_it = circle(item.geometry.vertices[0], keep.radius.metres)
        except PhysicalError as error:
            names.findings.add(Code.BAD_GEOMETRY, keep.radius, error.message, error.hint)
            continue
        if round_it in made:
            notes.append(
                f"{entry.file.value}: {item.entity} lies where {made[round_it]} does: it is left out"
            )
            continue
        made[round_it] = item.entity
        places.append(replace(item, geometry=round_it))
    return tuple(places)


def _usable(item: PhysicalProperty, entry: s.FromSource, names: Names) -> bool:
    if not _NAME.fullmatch(item.entity) or item.entity in RESERVED:
        message = f"the file names an entity '{shorten(item.entity)}', which cannot be written in a mission"
        hint = "rename it there: letters, digits and _, a letter first"
        names.findings.add(Code.UNUSABLE_NAME, entry.file, message, hint)
        return False
    odd = next((channel for channel in item.channels if not _CHANNEL.fullmatch(channel)), None)
    if odd is not None:
        message = f"the file names a channel '{shorten(odd)}', which cannot be written in a mission"
        names.findings.add(
            Code.UNUSABLE_NAME, entry.file, message, "rename it there: such as wifi or control:gcs0"
        )
        return False
    if item.kind not in names.signature.kinds and not entry.keep:
        message = f"the file has entities of a kind '{shorten(item.kind)}' that the signature does not have"
        hint = names.findings.suggest(item.kind, names.signature.kinds)
        hint = f"declare it, or choose: keep {item.kind} as {_example(hint, names)}"
        names.findings.add(Code.UNKNOWN_KIND, entry.file, message, hint)
        return False
    return True


def _example(hint: str, names: Names) -> str:
    meant = re.search(r"'(.+)'", hint)
    return meant[1] if meant else min(names.signature.kinds, default="Place")
