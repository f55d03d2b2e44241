"""Consoles and what they show as processes of their own: begun, ended, and asked for their links."""

import os
import re
import socket
import subprocess
import sys
from contextlib import contextmanager

LINK = re.compile(r"https?://\S+")


def free_port(kind=socket.SOCK_STREAM):
    with socket.socket(socket.AF_INET, kind) as found:
        found.bind(("127.0.0.1", 0))
        return found.getsockname()[1]


@contextmanager
def begun(*line):
    words = [sys.executable, *map(str, line)]
    environment = {**os.environ, "PYTHONPATH": os.getcwd(), "PYTHONUNBUFFERED": "1"}
    process = subprocess.Popen(
        words, env=environment, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True
    )
    try:
        yield process
    finally:
        process.kill()
        process.wait()
        process.stdout.close()


def link_of(process, role="act"):
    """Return the link that a console prints for a role."""
    said = ""
    for line in process.stdout:
        said += line
        if f"to {role}:" in line:
            return LINK.search(line)[0]
        if "the console has ended" in line:  # the run goes on without it
            break
    raise AssertionError(said)
