"""`check --watch` in a process of its own: files are saved as editors save them, and it is asked to end."""

import os
import queue
import signal
import subprocess
import sys
import threading
import time
from contextlib import ExitStack, suppress

import pytest
from geojson import collection, feature
from processes import begun

from bigactors.commands.check import file_changes
from bigactors.commands.check.continuous_check import files_of
from bigactors.commands.check.file_changes import changed, look
from specs.elaboration import Variation

WAITING = "waiting for a save of "
PATIENCE = 30


class Watched:
    """What a process prints, line by line."""

    def __init__(self, process):
        self.process = process
        self.lines = queue.Queue()
        threading.Thread(target=self._read, daemon=True).start()

    def _read(self):
        for line in self.process.stdout:
            self.lines.put(line.rstrip("\n"))
        self.lines.put(None)

    def until(self, words):
        """Return the lines up to the one that holds some words."""
        found = []
        with suppress(queue.Empty):
            while (line := self.lines.get(timeout=PATIENCE)) is not None:
                found.append(line)
                if words in line:
                    return found
        raise AssertionError(f"it never printed '{words}':\n" + "\n".join(found))

    def end(self):
        """Press Ctrl-C and return the exit code."""
        self.process.send_signal(signal.SIGINT)
        return self.process.wait(PATIENCE)


@pytest.fixture
def watched(missions):
    """Watch missions, with what goes to the standard error among the lines."""
    streams = {"stdout": subprocess.PIPE, "stderr": subprocess.STDOUT, "text": True, "encoding": "utf-8"}
    command = [sys.executable, "-m", "bigactors", "check", "--no-traces", "--watch"]
    with ExitStack() as started:
        yield lambda *words: Watched(
            started.enter_context(begun([*command, *words], cwd=missions, **streams))
        )


def saved_in_place(path, text):
    path.write_text(text, encoding="utf-8")


def saved_by_renaming(path, text):
    """Save as editors do that keep the old file until the new one is whole."""
    new = path.with_suffix(".new")
    new.write_text(text, encoding="utf-8")
    os.replace(new, path)


def saved_after_deleting(path, text):
    path.unlink()
    time.sleep(0.5)
    path.write_text(text, encoding="utf-8")


def saved_in_two_halves(path, text):
    with path.open("w", encoding="utf-8") as file:
        file.write(text[: len(text) // 2])
        file.flush()
        time.sleep(0.05)
        file.write(text[len(text) // 2 :])


def test_a_mission_is_checked_again_however_it_is_saved(missions, watched):
    path = missions / "holds.mission"
    holds = path.read_text("utf-8")
    run = watched("holds.mission")
    first = run.until(WAITING)
    assert first[0].endswith("] checking holds.mission")
    assert "  ✓ found              holds; examined 1, a witness of 8 steps" in first
    saved_in_place(path, holds.replace("actually uav0 in oilSpill0", "actually uav0 in nowhere0"))
    run.until("LS201: unknown entity 'nowhere0'")
    run.until(WAITING)
    saved_by_renaming(path, holds.replace("actually uav0 in oilSpill0", "oilSpill0 in uav0"))
    assert "  changed: found holds → violated" in run.until("✗ found")
    run.until(WAITING)
    saved_after_deleting(path, holds)
    assert "  changed: found violated → holds" in run.until("✓ found")
    run.until(WAITING)
    saved_in_two_halves(path, f"{holds}// more\n")
    assert "  no verdict changed" in run.until("no verdict changed")
    run.until(WAITING)
    assert run.end() == 0


def test_a_file_of_the_world_is_watched(missions, watched):
    boats = [collection(feature("boat0", "Boat", [-8.7, north])) for north in (37.0, 38.0)]
    (missions / "boats.geojson").write_text(boats[0])
    (missions / "boats.mission").write_text(
        "signature { kind Boat driven kind Area contains Boat }\n"
        'world { area0: Area = box (37.1, -8.6) (36.9, -8.8) from "boats.geojson" }\n'
        "BigActor a hosted_at boat0 with_behavior { skip }\n"
        'check { invariant "within": actually boat0 in area0 }\n'
    )
    run = watched("boats.mission", "holds.mission")
    assert run.until(WAITING)[-1].endswith(
        "waiting for a save of boats.mission, boats.geojson, holds.mission; Ctrl-C ends"
    )
    saved_in_place(missions / "boats.geojson", boats[1])
    lines = run.until(WAITING)
    assert any(line.endswith("] boats.geojson saved, checking again") for line in lines)
    assert "  changed: boats.mission: within holds → violated" in lines
    assert "  holds.mission: no verdict changed" in lines
    assert run.end() == 1


def test_a_running_check_ends_when_its_file_is_saved(missions, watched):
    run = watched("endless.mission")
    run.until("checking endless.mission")
    time.sleep(1.5)  # it explores
    (missions / "endless.mission").write_text((missions / "holds.mission").read_text("utf-8"))
    lines = run.until(WAITING)
    assert not any("INCOMPLETE" in line for line in lines)
    assert "  ✓ found              holds; examined 1, a witness of 8 steps" in lines
    assert run.end() == 0


def test_ctrl_c_ends_a_running_check_with_nothing_decided(watched):
    run = watched("endless.mission")
    run.until("checking endless.mission")
    time.sleep(1.5)
    assert run.end() == 3


def test_the_screen_is_cleared_on_a_terminal_only(missions, watched):
    assert "\033" not in "".join(watched("holds.mission").until(WAITING))
    import pty  # noqa: PLC0415 - not on every system

    leader, follower = pty.openpty()
    command = [sys.executable, "-m", "bigactors", "check", "--watch", "holds.mission"]
    with begun(command, cwd=missions, stdout=follower, env=os.environ | {"TERM": "xterm"}):
        assert os.read(leader, 100).decode().startswith("\033[H\033[2J[")


def test_files_are_compared_by_their_content(tmp_path):
    path = tmp_path / "a"
    assert changed(look([path]), look([path])) == ()
    missing = look([path])
    path.write_text("one")
    first = look([path], missing)
    assert changed(missing, first) == (path,)
    path.write_text("two")  # as long, within one tick of some clocks
    assert changed(first, look([path], first)) == (path,)
    os.replace(path, tmp_path / "b")
    (tmp_path / "a").write_text("one")
    assert changed(first, look([path], first)) == ()


def test_a_file_is_read_again_only_if_it_may_have_changed(tmp_path, monkeypatch):
    path = tmp_path / "a"
    path.write_text("one")
    os.utime(path, (1, 1))
    first = look([path])
    monkeypatch.setattr(file_changes.hashlib, "file_digest", None)  # who reads now fails
    assert look([path], first)[path] is first[path]


def test_a_mission_that_does_not_parse_is_made_of_what_it_was_before(missions):
    first = files_of("holds.mission", Variation())
    assert [path.name for path in first] == ["holds.mission"]
    before = (*first, missions / "a.geojson")
    (missions / "holds.mission").write_text("world {", encoding="utf-8")
    assert files_of("holds.mission", Variation(), before) == before
    (missions / "holds.mission").unlink()
    assert files_of("holds.mission", Variation(), before) == before
