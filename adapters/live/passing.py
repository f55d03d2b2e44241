"""Parcels from other stations: what is in them enters, each once and in order."""

from __future__ import annotations

from adapters.live.turning import Turning
from adapters.plugin import Delivered
from semantics.parting import Passage, enter, objection, took_cell
from semantics.plain_parcels import parcel_of


def take_in(turning: Turning, delivered: Delivered) -> None:
    """Let a parcel enter if it is the next of its station; what has entered already is passed over."""
    station, number = delivered.station, delivered.number
    if turning.c.read(took_cell(station)) != number - 1:
        return
    try:
        parcel = parcel_of(delivered.parcel)
    except ValueError as error:
        _refuse(turning, station, number, str(error))
        return
    found = tuple(enter(turning.c, station, number, parcel))
    if found:
        turning.idle.discard(parcel.agent)
        turning.take(found[0], found, Passage(parcel.agent, station, number, parcel))
    else:
        _refuse(turning, station, number, objection(turning.c, parcel))


def _refuse(turning: Turning, station: str, number: int, why: str) -> None:
    message = f"parcel {number} of {station} cannot enter, nor what comes after it: {why}"
    turning.find("trouble", station, message, once=True)
