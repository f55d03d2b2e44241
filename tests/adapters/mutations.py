"""Packets and sentences that are almost right: mutated bytes, and MAVLink whose checksum is right all the same."""

from random import Random

from pymavlink.dialects.v20 import ardupilotmega
from pymavlink.generator.mavcrc import x25crc

from adapters.mavlink.codec import Encoder
from adapters.mavlink.command import long, reposition
from adapters.mavlink.constants import Cmd, MavFrame
from adapters.mavlink.items import OnboardItem, item_message
from adapters.mavlink.message import say
from adapters.simulated import Kind, Vehicle
from adapters.simulated.reporting import Reporter

SENTENCES = (
    b"!AIVDM,1,1,,B,35VwAv0300QcEQ`EGcpN40jD0PUQ,0*61",
    b"!AIVDM,2,1,9,B,55R3Vn82=ILTQ3KKS>1<D60Dq@E918U<F222221J1`?164vc03S1CCAD,0*2A",
    b"!AIVDM,2,2,9,B,`88888888888880,2*76",
    rb"\g:1-2-1234,s:r3669961,c:1120959341*0D\!AIVDM,1,1,,B,35VwAv0300QcEQ`EGcpN40jD0PUQ,0*61",
    b"$GPRMC,213950.00,A,5250.53669,N,00542.34920,E,0.020,,070420,,,A*7D",
    b"$PGHP,1,2010,6,11,11,46,11,874,276,0,,1,09*17",
)


PARAMETER = {"param_id": b"SYSID_MYGCS", "param_type": 9}


def frames():
    """Frames that a vehicle says, and that a ground station does."""
    vehicle = Vehicle(Kind.PLANE, (37.0, -8.6, 20.0), time=100.0)
    reporter = Reporter()
    for name in ("GLOBAL_POSITION_INT", "POSITION_TARGET_GLOBAL_INT", "HOME_POSITION"):
        reporter.every(name, 1.0)
    reporter.text("PreArm: not ready")
    theirs = Encoder(1, 1)
    whom = {"target_system": 255, "target_component": 190, "mission_type": 0}
    answers = (
        say("MISSION_REQUEST", seq=0, **whom),
        say("MISSION_REQUEST_INT", seq=1, **whom),
        say("MISSION_ACK", type=0, **whom),
        say("MISSION_COUNT", count=3, **whom),
        say("COMMAND_ACK", command=400, result=0, target_system=255, target_component=190),
        item_message(OnboardItem(Cmd.WAYPOINT, 370_000_000, -86_000_000, 100.0), 1, 0, 255, 190),
        say("PARAM_VALUE", param_value=255.0, param_count=1, param_index=0, **PARAMETER),
    )
    ours = Encoder(255, 190)
    questions = (
        long(Cmd.ARM_DISARM, 1, 1),
        reposition(1, 370_000_000, -86_000_000, (100.0, MavFrame.HOME), 80.0, enters=True),
        say("MISSION_COUNT", target_system=1, target_component=1, count=3, mission_type=0),
        say("PARAM_SET", target_system=1, target_component=1, param_value=9.0, **PARAMETER),
        item_message(OnboardItem(Cmd.WAYPOINT, 370_000_000, -86_000_000, 100.0), 1, 0, 1),
    )
    said = [theirs.pack(message) for message in (*reporter.due(vehicle), *answers)]
    return said, [ours.pack(message) for message in questions]


def mutated(raw: bytes, random: Random) -> bytes:
    """Change a few bytes: other values, some left out, put in, doubled, cut off."""
    changed = bytearray(raw)
    for _ in range(random.randint(1, 4)):
        at = random.randrange(len(changed) + 1)
        match random.randrange(5):
            case 0 if changed:
                changed[at % len(changed)] = random.randrange(256)
            case 1:
                del changed[at : at + random.randint(1, 8)]
            case 2:
                changed[at:at] = random.randbytes(random.randint(1, 8))
            case 3:
                changed += changed[at:]
            case _:
                del changed[at:]
    return bytes(changed)


def with_right_checksum(raw: bytes, random: Random) -> bytes:
    """Change the payload, and make the checksum right again."""
    changed = bytearray(raw)
    for _ in range(random.randint(1, 6)):
        changed[random.randrange(10, len(changed) - 2)] = random.choice(
            (0, 1, 127, 128, 255, random.randrange(256))
        )
    number = int.from_bytes(changed[7:10], "little")
    crc = x25crc(changed[1:-2] + bytes([ardupilotmega.mavlink_map[number].crc_extra])).crc
    return bytes(changed[:-2]) + crc.to_bytes(2, "little")
