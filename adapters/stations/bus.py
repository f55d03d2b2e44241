"""The transport between stations: broadcast, and requests to one. By Zenoh, which no other file here imports.

Endpoints are explicit: no discovery, no multicast, no gossip. Each station writes under keys of its own. With mutual
TLS the common name of its certificate enforces this.
"""

from __future__ import annotations

import asyncio
import json
from collections.abc import Callable
from contextlib import suppress
from typing import Any, Final

from adapters.stations.peers import Peers
from adapters.stations.station_messages import MOST_BYTES
from physical import PhysicalError
from physical.wordings import install_extra

MOST_WAITING: Final = 1_000
"""The most waiting messages; more are dropped, and requested again."""

Hear = Callable[[str, bytes], None]
"""Takes a station and its message."""

Answer = Callable[[str, bytes], bytes]
"""Takes the asking station's claimed name and its question, and returns the answer."""


class Bus:
    """The session of one station; its callbacks run in the event loop's thread."""

    def __init__(self, peers: Peers, topic: str, hear: Hear, answer: Answer) -> None:
        """Open the session; raises PhysicalError if it can't listen, or Zenoh is not installed."""
        self._peers = peers
        self._topic = topic
        self._loop = asyncio.get_running_loop()
        self._hear, self._answer = hear, answer
        self._waiting = 0
        self._zenoh = _library()
        try:
            self._session = self._zenoh.open(
                self._zenoh.Config.from_json5(json.dumps(settings(peers, topic)))
            )
        except self._zenoh.ZError as error:
            where = ", ".join(peers.own.listen)
            raise PhysicalError(
                "stations", f"{peers.own.name} cannot listen at {where}: {error!s:.300}", "is it in use?"
            ) from error
        self._kept: list[Any] = []
        self._publisher = self._session.declare_publisher(self._key(peers.own.name, "said"))
        for name in peers.others:
            self._subscribe(name)
        self._serve()

    def put(self, said: bytes) -> None:
        """Send a message to all reachable stations."""
        self._publisher.put(said)

    async def ask(self, station: str, question: bytes, patience: float) -> bytes:
        """Send one station a question, and return its answer.

        Raises:
            OSError: It is not reachable, or does not answer in time.
        """
        answered: asyncio.Future[bytes] = self._loop.create_future()

        def reply(found: Any) -> None:
            if found.ok is not None and len(found.ok.payload) <= MOST_BYTES:
                self._call(_set, answered, found.ok.payload.to_bytes())

        def done() -> None:
            self._call(_set, answered, None)

        handler = self._zenoh.handlers.Callback(reply, done)
        key = self._key(station, "log")
        self._session.get(key, handler, payload=question, timeout=patience)
        async with asyncio.timeout(patience + 1.0):
            answer = await answered
        if answer is None:
            raise OSError(f"{station} does not answer")
        return answer

    def close(self) -> None:
        """Close the session."""
        for each in self._kept:
            each.undeclare()
        self._session.close()

    def _key(self, station: str, what: str) -> str:
        return key_of(self._topic, station, what)

    def _subscribe(self, name: str) -> None:
        def heard(sample: Any) -> None:
            if len(sample.payload) <= MOST_BYTES and self._waiting < MOST_WAITING:
                self._waiting += 1
                self._call(self._take, name, sample.payload.to_bytes())

        self._kept.append(self._session.declare_subscriber(self._key(name, "said"), heard))

    def _take(self, name: str, said: bytes) -> None:
        self._waiting -= 1
        self._hear(name, said)

    def _serve(self) -> None:
        key = self._key(self._peers.own.name, "log")

        def asked(query: Any) -> None:
            small = query.payload is None or len(query.payload) <= MOST_BYTES
            if small and self._waiting < MOST_WAITING:
                self._waiting += 1
                self._call(self._reply, key, query)
            else:
                query.drop()

        self._kept.append(self._session.declare_queryable(key, asked, complete=True))

    def _reply(self, key: str, query: Any) -> None:
        self._waiting -= 1
        with query:
            question = b"" if query.payload is None else query.payload.to_bytes()
            query.reply(key, self._answer(key, question))

    def _call(self, function: Callable[..., None], *arguments: Any) -> None:
        with suppress(RuntimeError):  # the loop has ended
            self._loop.call_soon_threadsafe(function, *arguments)


def _set(future: asyncio.Future[Any], value: bytes | None) -> None:
    if not future.done():
        future.set_result(value)


def key_of(topic: str, station: str, what: str) -> str:
    """Return the key for a station's messages or answers."""
    return f"bigactors/{topic}/{station}/{what}"


# --- settings -------------------------------------------------------------------------------------------


def settings(peers: Peers, topic: str) -> dict[str, Any]:
    """Return Zenoh's configuration for a station."""
    connect = sorted(endpoint for peer in peers.others.values() for endpoint in peer.connect)
    found: dict[str, Any] = {
        "mode": "peer",
        "listen": {"endpoints": list(peers.own.listen), "exit_on_failure": True},
        "connect": {
            "endpoints": connect,
            "timeout_ms": -1,
            "exit_on_failure": False,
            "retry": {"period_init_ms": 250, "period_max_ms": 2_000, "period_increase_factor": 2},
        },
        "scouting": {"multicast": {"enabled": False}, "gossip": {"enabled": False}},
        "timestamping": {"enabled": False},
        "adminspace": {"enabled": False},
        "open": {"return_conditions": {"connect_scouted": False, "declares": False}},
        "transport": {
            "unicast": {"open_timeout": 5_000, "accept_timeout": 5_000},
            "link": {"tx": {"lease": 5_000}},
        },
    }
    if peers.tls is not None:
        found["transport"]["link"]["tls"] = {
            "root_ca_certificate": str(peers.tls.authority),
            "listen_certificate": str(peers.tls.certificate),
            "listen_private_key": str(peers.tls.key),
            "connect_certificate": str(peers.tls.certificate),
            "connect_private_key": str(peers.tls.key),
            "enable_mtls": True,
            "verify_name_on_connect": False,
            "close_link_on_expiration": True,
        }
        found["access_control"] = access(peers, topic)
    return found


def access(peers: Peers, topic: str) -> dict[str, Any]:
    """Return the access rules: a station may write under its own keys and ask the others; others may do nothing."""
    own = peers.own.name
    rules, policies, subjects = [], [], []
    ours = [key_of(topic, own, "*")]
    for name in peers.others:
        theirs = [key_of(topic, name, "*")]
        rules.append(_rule(f"says {name}", theirs, ("put", "reply", "declare_queryable"), ("ingress",)))
        rules.append(_rule(f"asks {name}", ours, ("query", "declare_subscriber"), ("ingress",)))
        rules.append(_rule(f"told {name}", ours, ("put", "reply", "declare_queryable"), ("egress",)))
        rules.append(_rule(f"asked {name}", theirs, ("query", "declare_subscriber"), ("egress",)))
        subjects.append({"id": name, "cert_common_names": [name]})
        policies.append(
            {"rules": [f"{verb} {name}" for verb in ("says", "asks", "told", "asked")], "subjects": [name]}
        )
    return {
        "enabled": True,
        "default_permission": "deny",
        "rules": rules,
        "subjects": subjects,
        "policies": policies,
    }


def _rule(name: str, keys: list[str], messages: tuple[str, ...], flows: tuple[str, ...]) -> dict[str, Any]:
    return {
        "id": name,
        "permission": "allow",
        "messages": list(messages),
        "flows": list(flows),
        "key_exprs": keys,
    }


def _library() -> Any:
    try:
        import zenoh  # noqa: PLC0415 - an extra
    except ImportError as missing:
        hint = install_extra("stations")
        raise PhysicalError(
            "stations-extra", "stations need Zenoh, which is not installed", hint
        ) from missing
    return zenoh
