"""Reports of AIS stations: positions and static data as plain values, in the units of AIS.

Units are degrees, knots and seconds since 1970; None is *not available*. `time` is the time of reception, from the
recording or the receiver: AIS messages themselves carry at most the second of the minute.
"""

from dataclasses import dataclass

from physical.errors import PhysicalError

HIGHEST_ALTITUDE = 4094.0
"""The altitude in message 9 that means 4,094 metres *or more*."""

_TENTH_OF_A_MINUTE = (17, 27)


class AisError(PhysicalError):
    """Unreadable AIS input; single bad lines are counted instead."""


@dataclass(frozen=True, slots=True)
class PositionReport:
    """The position of one station: WGS 84 degrees; speed over ground in knots; course and heading in degrees true.

    `altitude` is in metres, for aircraft only; `HIGHEST_ALTITUDE` also stands for all higher ones.
    """

    time: float | None
    msg_type: int
    mmsi: int
    lat: float
    lon: float
    sog_kn: float | None = None
    cog_deg: float | None = None
    heading_deg: float | None = None
    altitude: float | None = None

    @property
    def coarse(self) -> bool:
        """Whether the resolution of the position is only a tenth of a minute (185 m): messages 17 and 27."""
        return self.msg_type in _TENTH_OF_A_MINUTE


@dataclass(frozen=True, slots=True)
class StaticReport:
    """The name and the ship type of one station, as far as the message contains them.

    `ship_type` is the code of ITU-R M.1371 (52 is a tug, 70-79 are cargo ships).
    """

    time: float | None
    msg_type: int
    mmsi: int
    name: str | None = None
    ship_type: int | None = None


Report = PositionReport | StaticReport
