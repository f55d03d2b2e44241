import io
import signal
import threading

import pytest

from bigactors.progress import Watch, describe, watching
from checker import Progress

PROGRESS = Progress(configurations=12_000, transitions=30_000, depth=7, frontier=450, rate=5_300.2)


class Terminal(io.StringIO):
    def isatty(self):
        return True


def test_a_line_is_rewritten_on_a_terminal(monkeypatch):
    monkeypatch.setenv("COLUMNS", "200")
    monkeypatch.setenv("NO_COLOR", "1")
    stream = Terminal()
    watch = Watch("long", stream)
    watch(PROGRESS)
    watch.name = "m"
    watch(PROGRESS)
    watch.clear()
    first, second, blank, end = stream.getvalue().split("\r")[1:]
    assert first == f"{describe('long', PROGRESS)}"
    assert second == f"{describe('m', PROGRESS)}   "
    assert (blank.strip(), end) == ("", "")


def test_a_line_is_no_wider_than_the_terminal(monkeypatch):
    monkeypatch.setenv("NO_COLOR", "1")
    monkeypatch.setenv("COLUMNS", "20")
    stream = Terminal()
    Watch("mission", stream)(PROGRESS)
    assert stream.getvalue() == "\rmission: 12,000"


def test_nothing_is_shown_in_a_pipe():
    stream = io.StringIO()
    watch = Watch("m", stream)
    watch(PROGRESS)
    watch.clear()
    assert stream.getvalue() == ""


def test_ctrl_c_is_a_wish_that_is_asked_for_where_it_can_be_fulfilled():
    with watching("m") as watch:
        assert not watch.interrupted
        signal.raise_signal(signal.SIGINT)  # does not raise here
        watch(PROGRESS)
    assert watch.interrupted
    assert watch.interruption.is_due()
    assert not watch.interruption.is_due(3600.0)


def test_a_second_ctrl_c_ends_it_at_once():
    def twice():
        signal.raise_signal(signal.SIGINT)
        signal.raise_signal(signal.SIGINT)

    with watching("m"), pytest.raises(KeyboardInterrupt):
        twice()


def test_the_handler_of_before_is_put_back():
    before = signal.getsignal(signal.SIGINT)
    with watching("m"):
        assert signal.getsignal(signal.SIGINT) != before
    assert signal.getsignal(signal.SIGINT) == before


def test_a_check_in_another_thread_is_watched_without_signals():
    watched = []

    def check():
        with watching("m") as watch:
            watched.append(watch)

    thread = threading.Thread(target=check)
    thread.start()
    thread.join()
    assert not watched[0].interrupted
