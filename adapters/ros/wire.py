"""The wire format of `rmw_zenoh`: key expressions of topics, and tokens of nodes."""

from __future__ import annotations

import struct
import time
from dataclasses import dataclass
from typing import Any, Final

from physical import PhysicalError

LIVELINESS: Final = "@ros2_lv"
NODE: Final = "bigactors"
UNHASHED: Final = "TypeHashNotSupported"
"""ROS 2 Humble's placeholder for a type's hash."""


@dataclass(frozen=True, slots=True)
class Topic:
    """A topic with its type and the type's hash."""

    name: str
    type_name: str
    type_hash: str


def key_of(domain: int, topic: Topic) -> str:
    """Return the key of a topic's messages.

    >>> key_of(0, Topic("/uav0/fix", "sensor_msgs/msg/NavSatFix", "RIHS01_62"))
    '0/uav0/fix/sensor_msgs::msg::dds_::NavSatFix_/RIHS01_62'
    """
    return f"{domain}/{topic.name.strip('/')}/{_dds(topic.type_name)}/{topic.type_hash}"


def topic_of(key: str) -> Topic:
    """Read a topic's key; raises PhysicalError for any other key.

    >>> topic_of("0/uav0/fix/sensor_msgs::msg::dds_::NavSatFix_/RIHS01_62")
    Topic(name='/uav0/fix', type_name='sensor_msgs/msg/NavSatFix', type_hash='RIHS01_62')
    """
    parts = key.split("/")
    if len(parts) < 4:
        raise PhysicalError("key unreadable", f"{key!r:.100} is no DOMAIN/TOPIC/TYPE/HASH")
    *name, dds, type_hash = parts[1:]
    return Topic(
        f"/{'/'.join(name)}", dds.replace("::dds_::", "::").removesuffix("_").replace("::", "/"), type_hash
    )


def all_of(domain: int, type_name: str) -> str:
    """Return the key expression of all topics of a type, with any hash.

    >>> all_of(0, "sensor_msgs/msg/NavSatFix")
    '0/*/**/sensor_msgs::msg::dds_::NavSatFix_/*'
    """
    return key_of(domain, Topic("*/**", type_name, "*"))


def node_token(domain: int, session: str) -> str:
    """Return the token by which ROS lists this node; a session has one.

    >>> node_token(0, "a1")
    '@ros2_lv/0/a1/0/0/NN/%/%/bigactors'
    """
    return f"{LIVELINESS}/{domain}/{session}/0/0/NN/%/%/{NODE}"


def publisher_token(domain: int, session: str, number: int, topic: Topic, *, lasts: bool) -> str:
    """Return the token by which ROS lists a reliable publisher; one that `lasts` keeps a message for late subscribers.

    >>> publisher_token(0, "a1", 2, Topic("/uav0/fix", "sensor_msgs/msg/NavSatFix", "RIHS01_62"), lasts=False)
    '@ros2_lv/0/a1/0/2/MP/%/%/bigactors/%uav0%fix/sensor_msgs::msg::dds_::NavSatFix_/RIHS01_62/1:2:1,1:,:,:,,'
    """
    about = f"{topic.name.replace('/', '%')}/{_dds(topic.type_name)}/{topic.type_hash}"
    return (
        f"{LIVELINESS}/{domain}/{session}/0/{number}/MP/%/%/{NODE}/{about}/1:{1 if lasts else 2}:1,1:,:,:,,"
    )


def subscriptions_of(domain: int, topic: str, type_name: str) -> str:
    """Return the key expression of the tokens of all subscriptions to a topic by a type, with any hash.

    >>> subscriptions_of(0, "/uav0/goal", "sensor_msgs/msg/NavSatFix")
    '@ros2_lv/0/*/*/*/MS/*/*/*/%uav0%goal/sensor_msgs::msg::dds_::NavSatFix_/*/*'
    """
    return f"{LIVELINESS}/{domain}/*/*/*/MS/*/*/*/{topic.replace('/', '%')}/{_dds(type_name)}/*/*"


def gid_of(token: str) -> bytes:
    """Return the identity of a publisher, which is the XXH3 hash of its token: its low half, then its high half."""
    import xxhash  # noqa: PLC0415 - an extra

    return xxhash.xxh3_128_intdigest(token.encode()).to_bytes(16, "little")


def attachment(number: int, nanoseconds: int, gid: bytes) -> bytes:
    """Return the attachment of a message: its number, its time, and its publisher."""
    return struct.pack("<qqB16s", number, nanoseconds, len(gid), gid)


def _dds(type_name: str) -> str:
    package, kind, name = type_name.split("/")
    return f"{package}::{kind}::dds_::{name}_"


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
