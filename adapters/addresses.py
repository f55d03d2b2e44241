"""Addresses of links as text: `udp:127.0.0.1:14550`, `tcp:host:port`, `serial:/dev/ttyUSB0:57600`.

A listening address without a host is on this machine only.
"""

from __future__ import annotations

import re
from dataclasses import dataclass
from typing import Final

from physical import PhysicalError

LOOPBACK: Final = "127.0.0.1"
HINT: Final = (
    "write udp:[HOST:]PORT or tcpin:[HOST:]PORT to listen, udpout:HOST:PORT or tcp:HOST:PORT to connect, "
    "serial:DEVICE[:BAUD], or file:PATH"
)

LISTENING: Final = ("udp", "tcpin")
CONNECTING: Final = ("udpout", "tcp")
SCHEMES: Final = (*LISTENING, *CONNECTING, "serial", "file")
DEFAULT_BAUD: Final = 57_600


@dataclass(frozen=True, slots=True)
class Address:
    """A parsed address; the used fields depend on `scheme`."""

    scheme: str
    host: str = ""
    port: int = 0
    path: str = ""
    baud: int = DEFAULT_BAUD

    def __str__(self) -> str:
        match self.scheme:
            case "file":
                return f"file:{self.path}"
            case "serial":
                return f"serial:{self.path}:{self.baud}"
        return f"{self.scheme}:{f'[{self.host}]' if ':' in self.host else self.host}:{self.port}"


def parse_address(text: str) -> Address:
    """Read an address.

    >>> str(parse_address("udp:14550")), str(parse_address("serial:/dev/ttyACM0"))
    ('udp:127.0.0.1:14550', 'serial:/dev/ttyACM0:57600')

    Raises PhysicalError with the known forms.
    """
    scheme, _, rest = text.strip().partition(":")
    match scheme:
        case "udp" | "tcpin":
            host, port = _host_and_port(text, rest)
            return Address(scheme, host or LOOPBACK, port)
        case "udpout" | "tcp":
            host, port = _host_and_port(text, rest)
            return Address(scheme, host, port) if host else _fail(text, "it has no host")
        case "file":
            return Address(scheme, path=rest) if rest else _fail(text, "it has no path")
        case "serial":
            return _serial(text, rest)
    return _fail(text, f"{scheme!r:.40} is no way to connect")


def _host_and_port(text: str, rest: str) -> tuple[str, int]:
    host, _, port = rest.removeprefix("//").rpartition(":")
    if not (re.fullmatch(r"[0-9]{1,5}", port) and int(port) <= 65_535):
        _fail(text, f"{port!r:.40} is no port")
    return host.removeprefix("[").removesuffix("]"), int(port)


def _serial(text: str, rest: str) -> Address:
    path, _, baud = rest.rpartition(":")
    if path and re.fullmatch(r"[0-9]{1,9}", baud):
        return Address("serial", path=path, baud=int(baud))
    return Address("serial", path=rest) if rest else _fail(text, "it has no device")


def _fail(text: str, message: str) -> Address:
    raise PhysicalError("address", f"{text!r:.100}: {message}", HINT)
