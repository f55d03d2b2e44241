"""A publisher in the form of `rmw_zenoh`."""

from __future__ import annotations

import time
from typing import Any

from adapters.ros.wire import Topic, attachment, gid_of, key_of, publisher_token


class Publisher:
    """A ROS publisher: reliable; keeps its last message, for late subscribers too if it lasts."""

    def __init__(self, session: Any, domain: int, topic: Topic, number: int, *, lasts: bool) -> None:
        import zenoh.ext  # noqa: PLC0415 - an extra

        token = publisher_token(domain, str(session.zid()), number, topic, lasts=lasts)
        self._puts = zenoh.ext.declare_advanced_publisher(
            session,
            key_of(domain, topic),
            cache=zenoh.ext.CacheConfig(1) if lasts else None,
            publisher_detection=lasts,
        )
        self._token = session.liveliness().declare_token(token)
        self._gid = gid_of(token)
        self._number = 0

    def put(self, raw: bytes) -> None:
        """Publish a message."""
        self._number += 1
        self._puts.put(raw, attachment=attachment(self._number, time.time_ns(), self._gid))
