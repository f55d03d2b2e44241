"""A simulated flight beside the studio."""

import os
import subprocess
import sys
from pathlib import Path
from time import monotonic, sleep
from urllib.error import URLError
from urllib.request import urlopen

from processes import begun

import specs.missions
from bigactors.studio.child_process import LINK

CORRIDOR = str(Path(specs.missions.__path__[0]) / "corridor.mission")
PATIENCE = 60


def answers(link):
    try:
        with urlopen(link):
            return True
    except URLError:
        return False


def test_a_flight_and_its_console_end_with_a_studio_that_is_killed(tmp_path):
    line = (sys.executable, "-m", "bigactors.studio.simulated_flight", CORRIDOR, str(tmp_path))
    flights_end, studios_end = os.pipe()
    with begun(line, stdin=flights_end, stdout=subprocess.PIPE, text=True) as flight:
        link = next(each for each in flight.stdout if each.startswith(LINK)).removeprefix(LINK).strip()
        assert answers(link)
        os.close(studios_end)  # as the system does when the studio is killed
        flight.wait(PATIENCE)
        end = monotonic() + PATIENCE
        while answers(link) and monotonic() < end:
            sleep(0.2)
        assert not answers(link)
