"""The scripts that measure the explorer keep figures of the documented shape, and their missions are what they say."""

import json
import subprocess
import sys

import pytest
from scripts import BENCHMARKS, script

spin = script("spin")
tables = script("tables")

needs_spin = pytest.mark.skipif(bool(spin.missing()), reason=f"not installed: {', '.join(spin.missing())}")

MACHINE = {"processor", "cores", "memory_gb", "system", "versions", "load_average", "day"}


def kept(name, folder, *arguments):
    path = folder / f"{name}.json"
    command = [sys.executable, str(BENCHMARKS / f"{name}.py"), "--output", str(path), *arguments]
    done = subprocess.run(command, capture_output=True, text=True, check=False, cwd=BENCHMARKS.parent)
    assert done.returncode == 0, done.stderr
    return json.loads(path.read_text()), done.stdout


@pytest.mark.long
@needs_spin
def test_the_patrol_is_kept_with_its_ratios_to_spin(tmp_path):
    data, printed = kept("run", tmp_path, "--turns", "1", "1x3+handover")
    assert data["machine"].keys() == MACHINE
    assert data["ratio_to_spin"].keys() == set(tables.RATIOS.values())
    (size,) = data["sizes"]
    assert (size["configurations"], size["transitions"]) == (1_434, 4_788)
    assert size["median"].keys() == {
        "bigactors, fast, two cores",
        "bigactors, fast, one core",
        "bigactors, reference",
        "SPIN, no reduction",
        "SPIN, no reduction, two cores",
    }
    fast = size["median"]["bigactors, fast, two cores"]
    assert 0 < fast["rule_runs"] < size["transitions"]
    assert fast["memory"] > 0
    assert data["start"]["cold"]["phases"]["compiling"] > data["start"]["warm"]["phases"]["compiling"] == 0
    assert "| 1, 3×3, hand-over | SPIN, no reduction | 1,434 | 4,788 |" in printed


def test_a_table_is_written_between_its_markers_only():
    page = "before\n<!-- begin it -->\nold\n<!-- end it -->\nafter\n"
    assert (
        tables.filled(page, "it", "new\n") == "before\n<!-- begin it -->\n\nnew\n\n<!-- end it -->\nafter\n"
    )
    with pytest.raises(ValueError, match="no markers"):
        tables.filled("nothing", "it", "new\n")
