"""Reports of AIS stations: positions and static data as plain values, in the units of AIS.

Degrees, knots and seconds since 1970; None is *not available*. `time` is when the message was received, as
told by the recording or by the receiver: AIS messages themselves carry at most the second of the minute.
"""

from dataclasses import dataclass

from physical.errors import PhysicalError

HIGHEST_ALTITUDE = 4094.0
"""How message 9 says 4,094 metres *or more*."""

_TENTH_OF_A_MINUTE = (17, 27)


class AisError(PhysicalError):
    """AIS input that cannot be read at all; single bad lines are counted instead."""


@dataclass(frozen=True, slots=True)
class PositionReport:
    """Where one station was: WGS 84 degrees; speed over ground in knots; course, heading in degrees true.

    `altitude` is in metres, of aircraft only; `HIGHEST_ALTITUDE` stands for all above it, too.
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
        """Whether the position is given to a tenth of a minute (185 m) only: messages 17 and 27."""
        return self.msg_type in _TENTH_OF_A_MINUTE


@dataclass(frozen=True, slots=True)
class StaticReport:
    """What one station is: its name and its type of ship, as far as the message tells them.

    `ship_type` is the code of ITU-R M.1371 (52 is a tug, 70-79 are cargo ships).
    """

    time: float | None
    msg_type: int
    mmsi: int
    name: str | None = None
    ship_type: int | None = None


Report = PositionReport | StaticReport
