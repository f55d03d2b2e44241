"""A terminal that is stopped, or a pipe that nobody reads, stops no flight."""

import asyncio
import os
import signal
import subprocess
import sys
import threading
import time
from contextlib import closing, contextmanager

import pytest

from adapters.live.operator_socket import say, status
from bigactors import asynchronous_printing
from bigactors.asynchronous_printing import MOST_WAITING, Printer
from bigactors.terminal import flying_output, write

TEXT = """
signature { kind Location contains Station
            kind Station }
world { shore0: Location = box (37.1, -8.5) (37.0, -8.6)
        gcs0: Station = point (37.05, -8.53) }
BigActor op0 hosted_at gcs0 with_behavior { loop { react { case word: Message => display(word) } } }
environment { says "hello" to op0 at most 200 times }
"""


@contextmanager
def full_pipe():
    """Yield the end of a pipe that takes nothing more."""
    reading, writing = os.pipe()
    os.set_blocking(writing, False)
    try:
        while True:
            os.write(writing, b"." * 4096)
    except BlockingIOError:
        os.set_blocking(writing, True)
    try:
        yield writing
    finally:
        os.close(reading)
        os.close(writing)


@contextmanager
def stopped_terminal():
    """Yield a terminal on which somebody has typed Ctrl-S."""
    master, slave = os.openpty()
    os.write(master, b"\x13")
    time.sleep(0.2)
    try:
        yield slave
    finally:
        os.close(master)
        os.close(slave)


@pytest.mark.parametrize(
    ("output", "number"), [(full_pipe, signal.SIGTERM), (stopped_terminal, signal.SIGINT)]
)
def test_a_run_whose_output_is_stopped_answers_and_ends(tmp_path, output, number):
    mission, socket = tmp_path / "said.mission", tmp_path / "said.sock"
    mission.write_text(TEXT)
    line = [sys.executable, "-m", "bigactors", "run", str(mission), "--unverified", "--socket", str(socket)]
    with output() as end:
        recording = tmp_path / "run.mcap"
        run = subprocess.Popen([*line, "--record", str(recording)], stdout=end, stderr=end)
        try:
            until(lambda: socket.exists() and asked(socket))
            for _ in range(50):
                assert asyncio.run(say(socket, "op0", "hello")) == ""
            assert "op0" in asyncio.run(status(socket))
            run.send_signal(number)
            assert run.wait(30) in (3, 130, -number, 128 + number)
        finally:
            run.kill()
            run.wait()
    assert recording.exists()


def lines_of(descriptor):
    with open(descriptor) as file:
        return list(file)


def asked(socket):
    return asyncio.run(status(socket))


def until(what, seconds=60):
    end = time.monotonic() + seconds
    while not what():
        assert time.monotonic() < end
        time.sleep(0.1)


def test_lines_come_in_their_order_and_all_of_them(tmp_path):
    path = tmp_path / "out"
    with path.open("w") as file, pytest.MonkeyPatch.context() as patch:
        patch.setattr(sys, "stdout", file)
        with flying_output():
            for number in range(500):
                write(file, f"{number}\n")
        write(file, "end\n", flush=True)
    assert path.read_text().split() == [*map(str, range(500)), "end"]


def test_of_more_lines_than_wait_the_oldest_are_left_out_and_counted():
    reading, writing = os.pipe()
    with closing(os.fdopen(writing, "w")) as stream:
        gate = threading.Event()
        printer = Printer(lambda *_: None)
        wait, asynchronous_printing._write = (
            asynchronous_printing._write,
            lambda *given: (gate.wait(), wait(*given)),
        )
        try:
            for number in range(MOST_WAITING + 11):
                printer.put(stream, f"{number}\n")
                if not number:
                    until(lambda: printer._writing)
            gate.set()
            found = []
            reader = threading.Thread(target=lambda: found.extend(lines_of(reading)))
            reader.start()
            assert printer.is_done(20.0)
        finally:
            asynchronous_printing._write = wait
    reader.join()
    assert found[:2] == ["0\n", "... 10 lines left out: the output was stopped\n"]
    assert found[2:] == [f"{number}\n" for number in range(11, MOST_WAITING + 11)]


def test_an_output_that_has_gone_is_discarded_and_one_that_fails_is_told():
    failed = []
    reading, writing = os.pipe()
    os.close(reading)
    with closing(os.fdopen(writing, "w")) as stream:
        printer = Printer(lambda *given: failed.append(given))
        printer.put(stream, "gone\n")
        assert printer.is_done(20.0)
    assert [(each, type(error)) for each, error in failed] == [(stream, BrokenPipeError)]
