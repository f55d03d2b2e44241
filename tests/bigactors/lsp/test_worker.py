"""The process that checks an editor's text."""

import json
import subprocess
import sys
from pathlib import Path

MISSION = Path(__file__).parents[2] / "corpus" / "warned" / "LS712_shows_itself.mission"


def test_the_report_has_no_gap_in_a_line_whose_warning_explains_it():
    text = MISSION.read_text(encoding="utf-8")
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
    assert "if empty(o of Station) { skip }" in {lines[gap - 1].strip() for gap in gaps}
    assert "if empty(o) { skip }" not in {lines[gap - 1].strip() for gap in gaps}
