"""Check a mission and fly it with simulated vehicles, with the operator's console beside it: a process of its own.

`python -m bigactors.studio.simulated_flight FILE FOLDER`. It prints what `bigactors run --console` prints, the links of
the console among it. Only the vehicles are simulated, and time passes ten times as fast. It ends at the end of its
input: a studio that is killed cannot end it otherwise.
"""

from __future__ import annotations

import json
import os
import signal
import sys
from contextlib import redirect_stderr, redirect_stdout
from io import StringIO
from pathlib import Path
from threading import Thread
from typing import Any, Final

from bigactors.cli import main as command
from bigactors.cli import reported
from bigactors.commands.run.station_flight import driven
from bigactors.ending_signals import as_process
from bigactors.exits import Exit
from bigactors.mission_lookup import open_mission
from bigactors.mistakes import Mistake
from bigactors.studio.child_process import RECORDING
from specs.elaboration import ElaboratedMission, Variation

SPEED: Final = 10
COPTER: Final = "simulated:copter"


def main() -> int:
    """Fly a mission's file with recording, verdict and socket in a folder; return the exit code."""
    file, folder = sys.argv[1:]
    Thread(target=_end_with_input, daemon=True).start()
    return reported(lambda: _flown(file, Path(folder)))


def _end_with_input() -> None:
    given = sys.stdin.fileno()  # unbuffered: at its exit, Python waits for the lock of a buffer
    while os.read(given, 1 << 10):
        pass
    os.kill(os.getpid(), signal.SIGTERM)


def _flown(file: str, folder: Path) -> int:
    verdict, report = str(folder / "verdict.json"), folder / "report.json"
    asked = ["check", "--no-traces", "--control", "timed", "--verdict", verdict, "--json", str(report), file]
    with redirect_stdout(StringIO()) as said, redirect_stderr(said):
        code = command(asked)
    if code == Exit.VIOLATED:
        raise _unflyable(json.loads(report.read_text("utf-8")))
    if code:
        sys.stdout.write(said.getvalue())
        return code
    vehicles = [f"--vehicle={name}={COPTER}" for name in _driven(open_mission(file, Variation()))]
    files = [f"--verdict={verdict}", f"--record={folder / RECORDING}", f"--socket={folder / 'run.sock'}"]
    return command(["run", file, "--console", f"--speed={SPEED}", *vehicles, *files])


def _unflyable(report: dict[str, Any]) -> Mistake:
    """Return what does not hold of flights that take time, though it may hold of those that take none."""
    found = (each for each in report["properties"] if each["verdict"] == "violated")
    words = "; ".join(f"{each['name']}: {each['violations'][0]['message']}" for each in found)
    hint = "write the line control timed into the text: Show how then shows the run"
    return Mistake(f"not all holds where a flight takes time: {words}", hint)


def _driven(mission: ElaboratedMission) -> list[str]:
    """Return the entities that a bigActor can drive, where the mission has them; raises Mistake."""
    physical = mission.initial.structure.physical
    found = [name for name in sorted(driven(mission)) if physical.position(name) is not None]
    if not found:
        hint = "place an entity of a driven kind in the world"
        raise Mistake("the mission drives nothing that could fly", hint)
    return found


if __name__ == "__main__":
    sys.exit(as_process(main))
