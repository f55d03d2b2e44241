"""Zenoh routers on loopback, ROS nodes that are theirs, and messages and bags that `rosbags` writes."""

import asyncio
import json
import socket
from contextlib import contextmanager

import numpy as np
import zenoh
from rosbags.rosbag2 import Writer
from rosbags.typesys import Stores, get_types_from_msg, get_typestore

from adapters.ros.position_messages import FIX, GEOGRAPHIC

STORE = get_typestore(Stores.ROS2_KILTED)
for _name, _definition in GEOGRAPHIC.items():
    STORE.register(get_types_from_msg(_definition, _name))


def session(mode, **endpoints):
    settings = {"mode": mode, "scouting": {"multicast": {"enabled": False}}}
    settings |= {kind: {"endpoints": [where]} for kind, where in endpoints.items()}
    return zenoh.open(zenoh.Config.from_json5(json.dumps(settings)))


@contextmanager
def router():
    with socket.socket() as free:
        free.bind(("127.0.0.1", 0))
        port = free.getsockname()[1]
    with session("router", listen=f"tcp/127.0.0.1:{port}") as opened:
        yield port, opened


def tokens(node, domain):
    return [str(each.ok.key_expr) for each in node.liveliness().get(f"@ros2_lv/{domain}/**")]


async def for_real(condition):
    for _ in range(500):
        if condition():
            return
        await asyncio.sleep(0.02)
    raise AssertionError("it did not happen")


def header(seconds):
    types = STORE.types
    stamp = types["builtin_interfaces/msg/Time"](sec=int(seconds), nanosec=0)
    return types["std_msgs/msg/Header"](stamp=stamp, frame_id="gps")


def fix(latitude=37.0, longitude=-8.7, seconds=0, status=0):
    types = STORE.types
    said = types[FIX](
        header=header(seconds),
        status=types["sensor_msgs/msg/NavSatStatus"](status=status, service=1),
        latitude=latitude,
        longitude=longitude,
        altitude=50.0,
        position_covariance=np.zeros(9),
        position_covariance_type=0,
    )
    return bytes(STORE.serialize_cdr(said, FIX))


def write_bag(path, messages, storage):
    with Writer(path, version=9, storage_plugin=storage) as bag:
        topics = {}
        for seconds, topic, name, raw in messages:
            if topic not in topics:
                topics[topic] = bag.add_connection(topic, name, typestore=STORE)
            bag.write(topics[topic], int(seconds * 1e9), raw)
    return path
