"""The process that checks an editor's text."""

import json
import subprocess
import sys
from pathlib import Path

MISSION = Path(__file__).parents[2] / "corpus" / "warned" / "LS704_always_the_same.mission"


def test_the_report_has_no_gap_in_a_line_whose_warning_explains_it():
    told = "if kind(HOST) == uav0 { skip }"
    text = MISSION.read_text(encoding="utf-8").replace(told, told + "\n      if size(obs) > 9 { skip }")
    asked = {"name": "m.mission", "text": text, "directory": ".", "configurations": 10_000, "seconds": 60}
    ended = subprocess.run(
        [sys.executable, "-m", "bigactors.lsp.worker"],
        input=json.dumps(asked),
        capture_output=True,
        text=True,
        check=True,
    )
    gaps = [each["line"] for each in json.loads(ended.stdout)["report"]["coverage"]["gaps"]]
    lines = text.splitlines()
    assert {lines[gap - 1].strip() for gap in gaps} == {"if size(obs) > 9 { skip }"}
