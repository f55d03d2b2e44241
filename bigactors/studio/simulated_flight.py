"""Check a mission and fly it with simulated vehicles, with the operator's console beside it: a process of its own.

`python -m bigactors.studio.simulated_flight FILE FOLDER`. It prints what `bigactors run --console` prints, the links of
the console among it. Only the vehicles are simulated, and time passes ten times as fast.
"""

from __future__ import annotations

import sys
from pathlib import Path
from typing import Final

from bigactors.cli import main as command
from bigactors.cli import reported
from bigactors.commands.run.station_flight import driven
from bigactors.mission_lookup import open_mission
from bigactors.mistakes import Mistake
from specs.elaboration import ElaboratedMission, Variation

SPEED: Final = 10
COPTER: Final = "simulated:copter"


def main() -> int:
    """Fly a mission's file with recording, verdict and socket in a folder; return the exit code."""
    file, folder = sys.argv[1:]
    return reported(lambda: _flown(file, Path(folder)))


def _flown(file: str, folder: Path) -> int:
    verdict = str(folder / "verdict.json")
    if code := command(["check", "--no-traces", "--control", "timed", "--verdict", verdict, file]):
        return code
    vehicles = [f"--vehicle={name}={COPTER}" for name in _driven(open_mission(file, Variation()))]
    files = [f"--verdict={verdict}", f"--record={folder / 'run.mcap'}", f"--socket={folder / 'run.sock'}"]
    return command(["run", file, "--console", f"--speed={SPEED}", *vehicles, *files])


def _driven(mission: ElaboratedMission) -> list[str]:
    """Return the entities that a bigActor can drive, where the mission has them; raises Mistake."""
    physical = mission.initial.structure.physical
    found = [name for name in sorted(driven(mission)) if physical.position(name) is not None]
    if not found:
        hint = "place an entity of a driven kind in the world"
        raise Mistake("the mission drives nothing that could fly", hint)
    return found


if __name__ == "__main__":
    sys.exit(main())
