"""Programs that tests start: runs of missions and a simulated vehicle, each a process of its own."""

import os
import socket
import subprocess
import sys
import time
from contextlib import contextmanager, suppress
from random import SystemRandom

from adapters.recording.mcap_files import RecordingError
from adapters.recording.recording_reader import read_recording

SIMULATOR = """
import sys
from adapters.simulated import Kind, Simulator, Vehicle, run
address, speed, *loose = sys.argv[1:]
vehicle = Vehicle(Kind.COPTER, (37.01, -8.65, 20.0), enforce=not loose)
run(Simulator(address, [vehicle]).run(), float(speed))
"""


GIVEN = set()


def free_port():
    """Return a free port, each only once, below those that the system gives to outgoing connections."""
    while True:
        port = SystemRandom().randrange(20_000, 32_000)
        if port in GIVEN:
            continue
        with socket.socket() as tcp, socket.socket(type=socket.SOCK_DGRAM) as udp, suppress(OSError):
            tcp.bind(("127.0.0.1", port))
            udp.bind(("127.0.0.1", port))
            GIVEN.add(port)
            return port


def until(what, seconds=180.0):
    """Look until something is so; looks that take long are taken less often, so that the stations can go on."""
    end = time.monotonic() + seconds
    while True:
        began = time.monotonic()
        if found := what():
            return found
        ended = time.monotonic()
        assert ended < end, "it did not come to pass in time"
        time.sleep(max(0.1, 2 * (ended - began)))


@contextmanager
def started(*line, stderr=None):
    process = subprocess.Popen(
        [sys.executable, *line],
        env={**os.environ, "PYTHONPATH": os.getcwd()},
        stdout=subprocess.PIPE,
        stderr=stderr,
        text=True,
    )
    try:
        yield process
    finally:
        process.kill()
        process.wait()
        process.stdout.close()


def rules(path):
    """Return the rules of the steps that are recorded so far."""
    with suppress(RecordingError, FileNotFoundError):  # it has only just begun
        return [message.data["label"][1:].partition(" ")[0] for message in read_recording(path).of("steps")]
    return []
