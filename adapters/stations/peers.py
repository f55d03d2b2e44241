"""The peers file: the stations, their addresses, the hosts that each runs, and their certificates.

[gcs0]
listen = ["tcp/0.0.0.0:7447"]            # where it listens; by default at `connect`, on loopback only
connect = ["tcp/gcs0.example.net:7447"]  # where others reach it
hosts = ["uav0"]                         # it also runs the bigActors of these hosts

[gcs1]
connect = ["tcp/gcs1.example.net:7447"]

[tls]                                    # mutual TLS: endpoints are then tls/HOST:PORT
ca = "ca.pem"
certificate = "{station}.pem"            # its common name is the station's name
key = "{station}.key"
"""

from __future__ import annotations

import re
import tomllib
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Final

from physical import PhysicalError, open_file

MOST_BYTES: Final = 65_536
MOST_STATIONS: Final = 32
MOST_WORDS: Final = 64
LOOPBACK: Final = ("127.0.0.1", "localhost", "[::1]")
TABLES: Final = frozenset({"listen", "connect", "hosts"})


@dataclass(frozen=True, slots=True)
class Peer:
    """One station.

    Attributes:
        name: Its name in the mission.
        listen: Its own addresses, such as `tcp/0.0.0.0:7447`.
        connect: Its addresses for the others.
        hosts: The nodes whose bigActors it runs, beside its own.
    """

    name: str
    listen: tuple[str, ...]
    connect: tuple[str, ...]
    hosts: tuple[str, ...] = ()


@dataclass(frozen=True, slots=True)
class Tls:
    """Mutual TLS: the authority that signed the certificates, and our certificate with its key."""

    authority: Path
    certificate: Path
    key: Path


@dataclass(frozen=True, slots=True)
class Peers:
    """All stations, from the view of one of them.

    Attributes:
        own: This station.
        others: The others, by their names.
        tls: Its certificate, None for a trusted network.
    """

    own: Peer
    others: Mapping[str, Peer]
    tls: Tls | None = None

    @property
    def all(self) -> tuple[Peer, ...]:
        """Every station, ours first."""
        return (self.own, *self.others.values())

    @property
    def hosts(self) -> dict[str, str]:
        """The station that runs each node's bigActors."""
        return {host: peer.name for peer in self.all for host in (peer.name, *peer.hosts)}


def read_peers(path: Path, station: str) -> Peers:
    """Read a peers file for one of its stations.

    Raises:
        PhysicalError: It is not valid; with the place and the remedy.
        OSError: It cannot be read.
    """
    with open_file(path) as file:
        data = file.read(MOST_BYTES + 1)
    if len(data) > MOST_BYTES:
        raise _mistake(f"it has more than {MOST_BYTES:,} bytes", "a station is a few lines of it")
    try:
        said = tomllib.loads(data.decode())
    except (ValueError, RecursionError) as error:
        raise _mistake(f"it is no TOML: {_reason(error):.200}", "see docs/how-to/stations.md") from error
    return peers_of(said, station, path.parent)


def _reason(error: Exception) -> str:
    """Return the fault of a TOML text."""
    match error:
        case tomllib.TOMLDecodeError():
            return str(error)
        case UnicodeDecodeError():
            return f"byte {error.start} is no UTF-8"
        case RecursionError():
            return "it is nested too deeply"
    return "it has a number of thousands of digits"


def peers_of(data: Mapping[str, Any], station: str, folder: Path) -> Peers:
    """Return the content of a peers file; relative file names start in its folder."""
    named = {name: table for name, table in data.items() if name != "tls"}
    if len(named) > MOST_STATIONS:
        raise _mistake(f"it has more than {MOST_STATIONS} stations", "leave out those that share nothing")
    tls = None if "tls" not in data else _tls(data["tls"], station, folder)
    scheme = "tcp" if tls is None else "tls"
    found = {name: _peer(name, table, scheme) for name, table in named.items()}
    if station not in found:
        known = ", ".join(sorted(found)) or "none"
        raise _mistake(f"it has no station '{station:.40}': its stations are {known}", f"add [{station:.40}]")
    _check_each_once(found)
    own = found.pop(station)
    return Peers(own, dict(sorted(found.items())), tls)


def _check_each_once(found: Mapping[str, Peer]) -> None:
    seen: dict[str, str] = {}
    for peer in found.values():
        for word in (peer.name, *peer.hosts, *peer.connect):
            if seen.setdefault(word, peer.name) != peer.name:
                raise _mistake(
                    f"{word} belongs to {seen[word]} and to {peer.name}", "leave it to one of them"
                )


def _peer(name: str, table: Any, scheme: str) -> Peer:
    if not re.fullmatch(r"\w{1,64}", name):
        raise _mistake(f"{name!r:.60} is no name of a station", "write letters, digits and _")
    if not isinstance(table, dict):
        raise _mistake(f"{name} is no table", f"write [{name}], then connect = [...]")
    strange = sorted(set(table) - TABLES)
    if strange:
        raise _mistake(f"[{name}] has {strange[0]!r:.60}", f"it may have {', '.join(sorted(TABLES))}")
    connect = _endpoints(name, table, "connect", scheme)
    if not connect:
        raise _mistake(f"[{name}] has no address to connect to", f'write connect = ["{scheme}/HOST:PORT"]')
    listen = _endpoints(name, table, "listen", scheme)
    if not listen and any(_host(each) not in LOOPBACK for each in connect):
        raise _mistake(
            f"[{name}] is reached over a network, but has no address to listen at",
            f'write listen = ["{scheme}/0.0.0.0:PORT"], or one address of it',
        )
    return Peer(name, listen or connect, connect, _words(name, table, "hosts"))


def _endpoints(name: str, table: Mapping[str, Any], key: str, scheme: str) -> tuple[str, ...]:
    found = _words(name, table, key)
    for endpoint in found:
        match = re.fullmatch(r"(tcp|tls)/(\[[0-9a-fA-F:]+\]|[\w.-]+):([0-9]{1,5})", endpoint)
        if not match or not 0 < int(match[3]) < 65_536:
            raise _mistake(f"[{name}] {key}: {endpoint!r:.80} is no endpoint", f"write {scheme}/HOST:PORT")
        if match[1] != scheme:
            why = "has no [tls]" if scheme == "tcp" else "has [tls]"
            raise _mistake(
                f"[{name}] {key}: '{endpoint:.80}', but the file {why}", f"write {scheme}/HOST:PORT"
            )
    return found


def _host(endpoint: str) -> str:
    return endpoint.partition("/")[2].rpartition(":")[0]


def _words(name: str, table: Mapping[str, Any], key: str) -> tuple[str, ...]:
    words = table.get(key, [])
    good = isinstance(words, list) and len(words) <= MOST_WORDS
    if not good or not all(isinstance(word, str) and 0 < len(word) <= 200 for word in words):
        raise _mistake(f"[{name}] {key} is no list of at most {MOST_WORDS} words", f'write {key} = ["..."]')
    return tuple(words)


def _tls(table: Any, station: str, folder: Path) -> Tls:
    names = ("ca", "certificate", "key")
    if not isinstance(table, dict) or set(table) != set(names):
        raise _mistake("[tls] should have ca, certificate and key, and nothing else", 'such as ca = "ca.pem"')
    if not all(isinstance(table[name], str) for name in names):
        raise _mistake("[tls] should name files", 'such as ca = "ca.pem"')
    paths = [(folder / table[name].replace("{station}", station)).absolute() for name in names]
    for name, path in zip(names, paths, strict=True):
        if not path.is_file():
            raise _mistake(f"[tls] {name}: there is no file {path}", "{station} in it stands for the station")
    return Tls(*paths)


def _mistake(message: str, hint: str) -> PhysicalError:
    return PhysicalError("peers", message, hint)
