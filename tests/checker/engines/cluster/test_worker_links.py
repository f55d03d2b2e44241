"""Links between workers: what is exchanged, who is let in, and what becomes of all when one is lost."""

import socket
from concurrent.futures import ThreadPoolExecutor

import numpy as np
import pytest

from checker.engines.cluster.crew import LostError
from checker.engines.cluster.worker_links import Sockets

SECRET = b"s" * 32


@pytest.fixture
def linked():
    """Return what links workers, each of which knows some secret."""
    made = []

    def link(secrets):
        made.extend(Sockets("127.0.0.1") for _ in secrets)
        addresses = [each.address for each in made]
        together([lambda me=me: made[me].meet(me, addresses, secrets[me]) for me in range(len(secrets))])
        return made

    yield link
    for each in made:
        each.close()


def together(asked):
    with ThreadPoolExecutor(len(asked)) as threads:
        answers = [threads.submit(each) for each in asked]
    return [each.result() for each in answers]


@pytest.mark.parametrize("workers", [1, 2, 3, 5])
def test_each_gets_what_each_gave_it_more_than_the_system_buffers_too(linked, workers):
    links = linked([SECRET] * workers)
    for size in (0, 1, 1_000_000):
        given = [[np.full(size, 10 * me + to) for to in range(workers)] for me in range(workers)]
        found = together([lambda me=me, given=given: links[me].exchange(given[me]) for me in range(workers)])
        for me, taken in enumerate(found):
            assert [each.tolist() for each in taken] == [given[of][me].tolist() for of in range(workers)]


def test_who_does_not_know_the_secret_is_told_nothing(linked, monkeypatch):
    monkeypatch.setattr("checker.engines.cluster.worker_links.PATIENCE", 1.0)
    with pytest.raises(LostError, match="could not meet the others"):
        linked([SECRET, b"another"])


@pytest.mark.parametrize("says", [b"", b"GET / HTTP/1.1\r\n\r\n", bytes(7) + b"\1" + bytes(64)])
def test_a_stranger_who_calls_first_keeps_nobody_out(says):
    links = [Sockets("127.0.0.1") for _ in range(2)]
    with socket.create_connection(links[0].address) as stranger:
        stranger.sendall(says)
        stranger.shutdown(socket.SHUT_WR)
        addresses = [each.address for each in links]
        together([lambda me=me: links[me].meet(me, addresses, SECRET) for me in range(2)])
    found = together([lambda me=me: links[me].exchange([me, me]) for me in range(2)])
    assert found == [[0, 1], [0, 1]]
    for each in links:
        each.close()


@pytest.mark.parametrize("size", [1, 1_000_000])
def test_all_are_told_when_one_is_lost(linked, size):
    links = linked([SECRET] * 3)

    def exchange(me):
        with pytest.raises(LostError):
            links[me].exchange([bytes(size)] * 3)

    together([lambda: exchange(0), lambda: exchange(1), links[2].close])
