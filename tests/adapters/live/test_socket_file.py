"""The operator's socket: nobody else takes it, and it answers where the process has no descriptor left."""

import asyncio
import os
import resource
import signal
import socket
import subprocess
import sys
from contextlib import ExitStack, suppress

import pytest
from flown_processes import free_port, started, until

from adapters.live.operator_socket import NobodyListens, listening, status
from adapters.live.socket_file import bound, is_taken

WAITING = """
import asyncio, sys
from pathlib import Path
from adapters.live.operator_socket import listening
async def main():
    async with listening(Path(sys.argv[1]), None, lambda: "the first"):
        print("ready", flush=True)
        await asyncio.sleep(60)
asyncio.run(main())
"""


def listens(port):
    with socket.socket() as asking:
        return not asking.connect_ex(("127.0.0.1", port))


def asked(path):
    return asyncio.run(status(path))


def test_a_run_that_is_stopped_keeps_its_socket(tmp_path):
    path = tmp_path / "a.sock"
    with started("-c", WAITING, str(path)) as first:
        assert first.stdout.readline() == "ready\n"
        first.send_signal(signal.SIGSTOP)
        with pytest.raises(FileExistsError, match="another run listens there"), bound(path):
            pass
        first.send_signal(signal.SIGCONT)
        assert asked(path) == "the first"
    assert not is_taken(path)
    with bound(path):
        assert is_taken(path)
    assert not path.exists()


def test_a_socket_at_which_nobody_is_served_any_more_is_taken_all_the_same(tmp_path):
    path = tmp_path / "a.sock"
    with socket.socket(socket.AF_UNIX) as server, ExitStack() as stack:
        server.bind(str(path))
        server.listen(0)
        for _ in range(3):
            waiting = stack.enter_context(socket.socket(socket.AF_UNIX))
            waiting.setblocking(False)
            with suppress(BlockingIOError):
                waiting.connect(str(path))
        assert is_taken(path)


def test_who_ends_removes_no_socket_of_another(tmp_path):
    path = tmp_path / "a.sock"
    with bound(path):
        path.unlink()
        with bound(path):
            pass
        with socket.socket(socket.AF_UNIX) as other:
            other.bind(str(path))
            inode = path.stat().st_ino
    assert path.stat().st_ino == inode


def test_what_is_no_socket_is_left_alone(tmp_path):
    path = tmp_path / "a.sock"
    path.write_text("mine")
    with pytest.raises(OSError, match=r"."), bound(path):
        pass
    assert path.read_text() == "mine"


async def test_the_operator_is_answered_where_no_descriptor_is_left(tmp_path):
    path = tmp_path / "a.sock"
    async with listening(path, None, lambda: "flying"):
        taken = []
        soft, hard = resource.getrlimit(resource.RLIMIT_NOFILE)
        resource.setrlimit(resource.RLIMIT_NOFILE, (min(soft, 256), hard))
        try:
            with suppress(OSError):
                while True:
                    taken.append(os.open(os.devnull, os.O_RDONLY))
            for _ in range(20):
                os.close(taken.pop())  # the one that asks, in the same process, needs one itself
                assert await status(path) == "flying"
                taken.append(os.open(os.devnull, os.O_RDONLY))
        finally:
            resource.setrlimit(resource.RLIMIT_NOFILE, (soft, hard))
            for each in taken:
                os.close(each)


async def test_who_says_nothing_is_not_waited_for(tmp_path):
    path = tmp_path / "a.sock"
    async with listening(path, None, lambda: "flying"):
        idle = [await asyncio.open_unix_connection(path) for _ in range(40)]
        with pytest.raises(NobodyListens):
            await status(path)
        await asyncio.sleep(5.5)
        assert await status(path) == "flying"
        for _, writer in idle:
            writer.close()


def test_a_flood_of_half_requests_leaves_a_run_that_answers_its_operator(tmp_path):
    mission, path = tmp_path / "m.mission", tmp_path / "m.sock"
    mission.write_text(MISSION)
    port = free_port()
    run = ["run", str(mission), "--unverified", "--socket", str(path), "--feed", f"detections=http:{port}"]
    line = ["bash", "-c", 'ulimit -n 128; exec "$@"', "-", sys.executable, "-m", "bigactors", *run]
    with (tmp_path / "said").open("wb") as said, subprocess.Popen(line, stdout=said, stderr=said) as flying:
        try:
            until(lambda: is_taken(path) and listens(port), 60.0)
            with ExitStack() as stack:
                for number in range(260):
                    half = stack.enter_context(socket.create_connection(("127.0.0.1", port), 5.0))
                    half.sendall(b"POST /detections HTTP/1.1\r\nHost: localhost\r\nContent-Le")
                    if not number % 50:
                        assert "op0" in asked(path)
            assert "op0" in asked(path)
        finally:
            flying.kill()
    assert "Traceback" not in (tmp_path / "said").read_text()


MISSION = """
signature { kind Location contains Station
            kind Station }
world { shore0: Location = box (37.1, -8.5) (37.0, -8.6)
        gcs0: Station = point (37.05, -8.53) }
BigActor op0 hosted_at gcs0 with_behavior { loop { react { case word: Message => display(word) } } }
environment { says "hello" to op0 at most 200 times }
"""
