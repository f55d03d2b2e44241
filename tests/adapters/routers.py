"""Zenoh routers on loopback, and ROS nodes that are theirs."""

import asyncio
import json
import socket
from contextlib import contextmanager

import zenoh


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
