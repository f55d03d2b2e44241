"""The kind of a station, from its MMSI (ITU-R M.585) and from messages of a single kind of station.

>>> kind_of(2442103, 4), kind_of(244660274, 1), kind_of(992446001, 21)
('BaseStation', 'Vessel', 'AidToNavigation')
"""

from typing import Final

VESSEL: Final = "Vessel"
BASE_STATION: Final = "BaseStation"
AID_TO_NAVIGATION: Final = "AidToNavigation"
AIRCRAFT: Final = "SearchAndRescueAircraft"
DISTRESS_BEACON: Final = "DistressBeacon"
ASSOCIATED_CRAFT: Final = "AssociatedCraft"
HANDHELD_RADIO: Final = "HandheldRadio"
UNKNOWN_STATION: Final = "UnknownStation"

KINDS: Final = (
    AID_TO_NAVIGATION,
    ASSOCIATED_CRAFT,
    BASE_STATION,
    DISTRESS_BEACON,
    HANDHELD_RADIO,
    AIRCRAFT,
    UNKNOWN_STATION,
    VESSEL,
)
"""All kinds, sorted."""

HIGHEST: Final = 999_999_999

# Each prefix is followed by the three digits of a country. A group of vessels (`0`) sends nothing.
_BY_PREFIX: Final = (
    ("111", AIRCRAFT),
    ("00", BASE_STATION),
    ("98", ASSOCIATED_CRAFT),
    ("99", AID_TO_NAVIGATION),
    ("8", HANDHELD_RADIO),
    ("", VESSEL),
)
# Followed by the maker's number instead: transmitters for search and rescue, man over board, EPIRB.
_BEACONS: Final = ("970", "972", "974")
_COUNTRIES: Final = range(201, 776)

# Sent by one kind of station only; buoys and shore stations often have a vessel's number.
_BY_MESSAGE: Final = {4: BASE_STATION, 9: AIRCRAFT, 17: BASE_STATION, 21: AID_TO_NAVIGATION}

# Sent by craft of classes A and B, and over long range.
_FROM_CRAFT: Final = frozenset({1, 2, 3, 5, 18, 19, 24, 27})


def digits(mmsi: int) -> str:
    """Return an MMSI with its nine digits, leading zeros included.

    >>> digits(2442103)
    '002442103'
    """
    if not 0 <= mmsi <= HIGHEST:
        raise ValueError(f"an MMSI has at most nine digits, not {mmsi}")
    return f"{mmsi:09d}"


def entity_name(mmsi: int) -> str:
    """Return the name of the entity with an MMSI.

    >>> entity_name(244660274)
    'mmsi244660274'
    """
    return f"mmsi{digits(mmsi)}"


def kind_by_range(mmsi: int) -> str:
    """Return the kind of a station by its number alone; `UnknownStation` for an unassigned number.

    >>> kind_by_range(111232512), kind_by_range(970010119), kind_by_range(123456789)
    ('SearchAndRescueAircraft', 'DistressBeacon', 'UnknownStation')
    """
    text = digits(mmsi)
    if text.startswith(_BEACONS):
        return DISTRESS_BEACON
    for prefix, kind in _BY_PREFIX:
        if text.startswith(prefix) and int(text[len(prefix) : len(prefix) + 3]) in _COUNTRIES:
            return kind
    return UNKNOWN_STATION


def kind_of(mmsi: int, msg_type: int) -> str:
    """Return the kind of a station from its number and from one of its messages.

    A number of a special range decides; else a message that only one kind of station sends; else the number. A craft
    with an unassigned number (an unconfigured transponder) is still a vessel.
    """
    by_range = kind_by_range(mmsi)
    if by_range not in (VESSEL, UNKNOWN_STATION):
        return by_range
    return _BY_MESSAGE.get(msg_type, VESSEL if msg_type in _FROM_CRAFT else by_range)
