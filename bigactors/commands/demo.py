"""`bigactors demo`: the missions of the README, checked and drawn; a verified one in flight with --console."""

from argparse import Namespace
from pathlib import Path
from typing import Final

from bigactors.exits import Exit, worst
from bigactors.terminal import say

DESCRIPTION: Final = """\
Check the oil spill of the paper and the watch over a harbour, print their verdicts, and write their
pictures and traces. With --console, check the watch over a spill, fly it with a simulated plane, and serve the
operator's console: open the link that it prints."""

EXAMPLES: Final = ("bigactors demo --out demo", "bigactors demo --console")

ARGUMENTS: Final = """\
  --out DIR = demo  the folder for pictures and traces
  --console  fly a mission with a simulated plane instead, ten times as fast as the clock, with the console"""


MISSIONS = ("oil_spill", "harbour_watch")


def run(options: Namespace) -> Exit:
    """Check both missions, and write a picture and the traces of each; or fly one with the console."""
    from bigactors.files import make_folder

    out = make_folder(options.out)
    if options.console:
        from bigactors.live_demo import demonstrate

        return Exit(demonstrate(out, console=True))
    return worst([_show(name, out) for name in MISSIONS])


def _show(name: str, out: Path) -> Exit:
    from bigactors.checking import Checked, check_mission
    from bigactors.commands.check.check_report import coloured, report_lines
    from bigactors.picture_files import draw
    from bigactors.trace_files import write_evidence
    from checker import Limits
    from specs.elaboration import Variation

    result = check_mission(name, Limits(seconds=60), Variation())
    for line in report_lines(result, traces=True):
        say(coloured(line))
    if isinstance(result, Checked):
        folder = out / name
        picture = f"{folder}.svg"
        draw(result.mission.initial, picture, title=name)
        say(f"  picture: {picture}")
        for written in write_evidence(result, folder):
            say(f"  trace: {written}/trace.html, .txt, .json and .svg")
    say()
    return result.exit
