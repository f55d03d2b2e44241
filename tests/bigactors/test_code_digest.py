"""A build is known by its code, wherever it is installed."""

import shutil
import subprocess
import sys
from pathlib import Path

from bigactors.code_digest import ROOMS, build_digest

ROOT = Path(__file__).parents[2]
ASK = "from bigactors.code_digest import build_digest; print(build_digest())"


def asked(folder):
    where = {"cwd": folder, "env": {"PYTHONPATH": str(folder)}}
    told = subprocess.run([sys.executable, "-c", ASK], check=True, capture_output=True, text=True, **where)
    return told.stdout.strip()


def test_a_build_with_one_other_line_is_another(tmp_path):
    for room in (*ROOMS, "bigactors"):
        shutil.copytree(ROOT / room, tmp_path / room, ignore=shutil.ignore_patterns("__pycache__", "page"))
    assert asked(tmp_path) == build_digest()
    with (tmp_path / "semantics" / "rules.py").open("a") as file:
        file.write("# another line\n")
    assert asked(tmp_path) != build_digest()
