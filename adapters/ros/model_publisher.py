"""P and L, published into a ROS 2 graph in the form of `rmw_zenoh`. A watcher, which never slows the run."""

from __future__ import annotations

import asyncio
import json
import re
import threading
from collections.abc import Iterator
from typing import Final

from adapters.live.fresh_placements import Sighting
from adapters.live.live_state import LiveState
from adapters.live.run_watchers import Watcher
from adapters.live.turn_result import Turn
from adapters.ros.position_messages import FIX, STRING, WHERE, hash_of, write_fix, write_string, write_where
from adapters.ros.ros_node import open_session, read_address
from adapters.ros.wire import Publisher, Topic, node_token
from physical import PhysicalError, centroid
from semantics.state.logical_model import LogicalModel

PERIOD: Final = 0.5
"""The least seconds between two messages of a topic."""

OURS: Final = "bigactors"
SPACE: Final = f"/{OURS}/logical_space"
NAME: Final = re.compile(r"[A-Za-z][A-Za-z0-9_]*")
"""The names that ROS allows in a topic."""

TopicMessage = tuple[Topic, bytes]


class RosSending(Watcher):
    """A watcher that publishes the positions of entities, and L when it changes.

    The run only leaves its newest state here; a thread sends the messages, and only the newest of each topic waits.

    Arguments:
        address: The Zenoh router's, `tcp:HOST:PORT[?domain=N]`.
    """

    name = "the publication for ROS"

    def __init__(self, address: str) -> None:
        where, self._domain = read_address(address)
        if where.scheme != "tcp":
            raise PhysicalError(
                "address", f"{address!r:.100}: nothing is published there", "write tcp:HOST:PORT"
            )
        self._session = open_session(where)
        self._publishers: dict[Topic, Publisher] = {}
        self._state: LiveState | None = None
        self._seen: dict[str, Sighting] = {}
        self._space = ""
        self._waiting: dict[Topic, bytes] = {}
        self._changed = threading.Condition()
        self._ended = False
        self._failure: Exception | None = None
        self._thread = threading.Thread(target=self._send, daemon=True)
        self._thread.start()

    def turned(self, turn: Turn, now: float) -> None:  # noqa: ARG002 - as watchers are called
        """Keep the newest state, which is published soon; raises PhysicalError if sending has failed."""
        if self._failure is not None:
            raise PhysicalError("ros", f"{self._failure!s:.200}", "nothing is published from now on")
        if self._state is None:
            asyncio.get_running_loop().call_later(PERIOD, self._publish)
        self._state = turn.state

    def close(self) -> None:
        """Publish the rest, and leave the graph."""
        self._publish()
        with self._changed:
            self._ended = True
            self._changed.notify()
        self._thread.join(PERIOD)
        self._session.close()

    def _publish(self) -> None:
        """Pass new messages to the thread."""
        state, self._state = self._state, None
        if state is not None and not self._ended:
            said = dict(self._news(state))
            with self._changed:
                self._waiting.update(said)
                self._changed.notify()

    def _news(self, state: LiveState) -> Iterator[TopicMessage]:
        for entity, sighting in state.sightings.newest.items():
            if self._seen.get(entity) is not sighting and NAME.fullmatch(entity):
                yield _whereabouts(entity, sighting)
        self._seen = dict(state.sightings.newest)
        space = space_json(state.configuration.structure.logical)
        if space != self._space:
            self._space = space
            yield _topic(SPACE, STRING), write_string(space)

    def _send(self) -> None:
        try:
            with self._session.liveliness().declare_token(node_token(self._domain, str(self._session.zid()))):
                while self._wait():
                    with self._changed:
                        waiting, self._waiting = self._waiting, {}
                    for topic, raw in waiting.items():
                        self._publisher(topic).put(raw)
        except Exception as failure:  # Zenoh's; the next turn reports it
            self._failure = failure

    def _wait(self) -> bool:
        """Wait for messages to send; return whether there are any."""
        with self._changed:
            self._changed.wait_for(lambda: self._waiting or self._ended)
            return bool(self._waiting)

    def _publisher(self, topic: Topic) -> Publisher:
        if topic not in self._publishers:
            number = len(self._publishers) + 1  # the node is number 0
            self._publishers[topic] = Publisher(
                self._session, self._domain, topic, number, lasts=topic.name == SPACE
            )
        return self._publishers[topic]


def space_json(logical: LogicalModel) -> str:
    """Return L: the parent and the links of each node."""
    nodes = {
        node: {"parent": logical.parent(node), "links": list(logical.links(node))} for node in logical.nodes()
    }
    return json.dumps({"nodes": nodes}, ensure_ascii=False, sort_keys=True)


def _whereabouts(entity: str, sighting: Sighting) -> TopicMessage:
    """Return the position of an entity: a point as a fix; for an area, the centre."""
    geometry = sighting.property.geometry
    stamp = sighting.time if sighting.property.time is None else sighting.property.time
    ((latitude, longitude),) = centroid(geometry).vertices
    if geometry.is_point:
        return _topic(f"/{OURS}/{entity}/fix", FIX), write_fix(latitude, longitude, stamp, entity)
    return _topic(f"/{OURS}/{entity}/position", WHERE), write_where(latitude, longitude, stamp, entity)


def _topic(name: str, type_name: str) -> Topic:
    return Topic(name, type_name, hash_of(type_name))
