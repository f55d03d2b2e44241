"""MAVLink 2 signing: the checks of packets, and the state on disk between runs.

A pure state machine. A signature's time stamp counts units of 10 µs since 2015. It must grow in each stream (link,
system, component), and a new stream may be at most a minute behind. A stream is remembered only after its signature has
been checked, so an attacker can neither silence a vehicle nor fill the memory.
"""

from __future__ import annotations

import hashlib
import hmac
import json
import re
from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from enum import StrEnum
from pathlib import Path
from typing import Final

from adapters.mavlink.message import MavlinkMessage, say
from adapters.private_files import open_private, others_may_read
from physical import PhysicalError, open_file, read_json

EPOCH: Final = 1_420_070_400
"""2015-01-01 in seconds since 1970: the origin of time stamps."""

UNITS: Final = 100_000
"""Units of a time stamp in a second."""

NEW_STREAM: Final = 60 * UNITS
RESERVE: Final = 10 * UNITS
"""Lead of the time stamps on disk during a run: even after a crash none is sent, or accepted, a second time.

After a crash a vehicle's packets are ignored for at most this time, until its own time stamps have caught up.
"""

KEY_BYTES: Final = 32
MOST_BYTES: Final = 1_000_000
_STREAM: Final = re.compile(r"[0-9]{1,3}\.[0-9]{1,3}\.[0-9]{1,3}")
_BLOCK: Final = 13  # link id, time stamp, signature


class Verdict(StrEnum):
    """The verdict on a packet's signature."""

    GOOD = "signed"
    UNSIGNED = "unsigned packet"
    FORGED = "forged signature"
    REPLAYED = "replayed packet"


Stream = tuple[int, int, int]


@dataclass(frozen=True, slots=True)
class Signing:
    """A key, the newest time stamp sent or received, and the newest of every stream."""

    key: bytes
    timestamp: int = 0
    streams: Mapping[Stream, int] = field(default_factory=dict)


def new_key(passphrase: str) -> bytes:
    """Make a key from a passphrase as ground stations do: its SHA-256."""
    return hashlib.sha256(passphrase.encode()).digest()


def check(signing: Signing, message: MavlinkMessage) -> tuple[Signing, Verdict]:
    """Check the signature of one packet."""
    raw = message.raw
    if len(raw) < _BLOCK + 12 or not message.signed:
        return signing, Verdict.UNSIGNED
    expected = hashlib.sha256(signing.key + raw[:-6]).digest()[:6]
    if not hmac.compare_digest(expected, raw[-6:]):
        return signing, Verdict.FORGED
    stream = (raw[-_BLOCK], message.system, message.component)
    time = int.from_bytes(raw[-12:-6], "little")
    if time <= signing.streams.get(stream, signing.timestamp - NEW_STREAM):
        return signing, Verdict.REPLAYED
    streams = {**signing.streams, stream: time}
    return replace(signing, timestamp=max(signing.timestamp, time), streams=streams), Verdict.GOOD


def stamp(signing: Signing, now: float) -> Signing:
    """Take the next time stamp to send: the clock's, and larger than any before."""
    return replace(signing, timestamp=max(signing.timestamp + 1, int((now - EPOCH) * UNITS)))


def ahead(signing: Signing) -> Signing:
    """Return the state to store during a run: every time stamp is advanced by the reserve."""
    streams = {stream: time + RESERVE for stream, time in signing.streams.items()}
    return replace(signing, timestamp=signing.timestamp + RESERVE, streams=streams)


def covers(reserved: Signing, signing: Signing) -> bool:
    """Return whether a state on disk is at least as far as another in every time stamp."""
    known = reserved.streams
    return reserved.timestamp >= signing.timestamp and all(
        known.get(stream, -1) >= time for stream, time in signing.streams.items()
    )


def setup_signing(key: bytes, now: float, system: int, component: int = 1) -> MavlinkMessage:
    """Return the message that gives a vehicle its key, in clear text: send it by cable only."""
    return say(
        "SETUP_SIGNING",
        target_system=system,
        target_component=component,
        secret_key=list(key),
        initial_timestamp=max(0, int((now - EPOCH) * UNITS)),
    )


def load(path: Path) -> Signing:
    """Read the state of an earlier run.

    Raises PhysicalError if the file is not such a state, or others may read it.
    """
    hint = "make one: python -m bigactors.adapters.mavlink.new_key FILE"
    try:
        exposed = others_may_read(path)
        with open_file(path) as file:
            found = _signing(read_json(file.read(MOST_BYTES + 1), MOST_BYTES))
    except (OSError, PhysicalError) as problem:
        reason = problem.strerror if isinstance(problem, OSError) else problem.message
        message = f"cannot read the signing key: {reason}"
        raise PhysicalError("signing-file", message, hint, str(path)) from None
    if exposed:
        told = f"others may read the signing key: its mode is {exposed}"
        raise PhysicalError("signing-file", told, f"chmod 600 {path}; if others did, {hint}", str(path))
    return found


def _signing(data: object) -> Signing:
    """Return the state in the data of a file; raises PhysicalError."""
    match data:
        case {"key": str(key), "timestamp": int(timestamp), "streams": dict(streams)}:
            pass
        case _:
            raise _bad("it is no object with 'key', 'timestamp' and 'streams'")
    if not re.fullmatch(rf"[0-9a-fA-F]{{{2 * KEY_BYTES}}}", key):
        raise _bad(f"its key is not {2 * KEY_BYTES} hexadecimal digits")
    if not all(_STREAM.fullmatch(name) and type(time) is int for name, time in streams.items()):
        raise _bad("its streams are not LINK.SYSTEM.COMPONENT with the time of each")
    return Signing(bytes.fromhex(key), timestamp, {_stream(name): time for name, time in streams.items()})


def _bad(message: str) -> PhysicalError:
    return PhysicalError("signing-file", message)


def save(signing: Signing, path: Path) -> None:
    """Write the state for a later run atomically, readable by its owner only."""
    data = {
        "key": signing.key.hex(),
        "timestamp": signing.timestamp,
        "streams": {".".join(map(str, stream)): time for stream, time in sorted(signing.streams.items())},
    }
    beside = path.with_name(f"{path.name}.new")
    with open_private(beside, "wb") as file:
        file.write(json.dumps(data).encode("ascii"))
    beside.replace(path)


def _stream(name: str) -> Stream:
    link, system, component = map(int, name.split("."))
    return link, system, component
