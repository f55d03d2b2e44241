"""The scripts that measure the explorer keep figures of the documented shape, and their missions are what they say."""

import json
import subprocess
import sys
from pathlib import Path

import pytest
from scripts import BENCHMARKS, script

from checker import explore
from specs import parse_bytes
from specs.elaboration import elaborate, load_mission

oil_spill = script("oil_spill")
patrol = script("patrol")
spin = script("spin")
growth = script("growth")
tables = script("tables")

needs_spin = pytest.mark.skipif(bool(spin.missing()), reason=f"not installed: {', '.join(spin.missing())}")

MACHINE = {"processor", "cores", "memory_gb", "system", "versions", "load_average", "day"}


def oil(uavs, spills=1):
    source, tree = parse_bytes("oil_spill.mission", oil_spill.mission_text(uavs, spills).encode())
    return elaborate(tree, source, Path()).initial


def kept(name, folder, *arguments):
    path = folder / f"{name}.json"
    command = [sys.executable, str(BENCHMARKS / f"{name}.py"), "--output", str(path), *arguments]
    done = subprocess.run(command, capture_output=True, text=True, check=False, cwd=BENCHMARKS.parent)
    assert done.returncode == 0, done.stderr
    return json.loads(path.read_text()), done.stdout


def test_one_uav_and_one_spill_have_the_counts_of_the_mission_that_ships():
    shipped = explore(load_mission(BENCHMARKS.parent / "specs/missions/oil_spill.mission").initial)
    found = explore(oil(1))
    assert (len(found.configurations), found.transitions) == (
        len(shipped.configurations),
        shipped.transitions,
    )


@pytest.mark.parametrize(("uavs", "spills", "counts"), [(2, 1, (510, 1_438)), (2, 2, (1_530, 6_354))])
def test_several_uavs_and_spills_have_their_counts(uavs, spills, counts):
    found = explore(oil(uavs, spills))
    assert found.complete
    assert (len(found.configurations), found.transitions) == counts


def test_eight_uavs_and_four_spills_are_a_mission():
    assert len(oil(8, 4).alpha.names()) == 8


@pytest.mark.parametrize("write", [oil_spill.mission_text, oil_spill.promela_text])
@pytest.mark.parametrize("size", [(0, 1), (10, 1), (1, 0), (1, 5)])
def test_an_oil_spill_without_room_is_refused(size, write):
    with pytest.raises(ValueError, match="have room, not"):
        write(*size)


@needs_spin
@pytest.mark.parametrize(("uavs", "spills", "counts"), [(2, 1, (510, 1_438)), (2, 2, (1_530, 6_354))])
def test_spin_counts_as_many_for_several_uavs_and_spills(uavs, spills, counts, tmp_path):
    found = spin.bounded(oil_spill.promela_text(uavs, spills), tmp_path, spin.Bounds())
    assert not found.bounds
    assert (found.configurations, found.transitions) == counts


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


@pytest.mark.long
def test_growth_is_kept_mark_by_mark_and_plotted(tmp_path):
    plot = tmp_path / "growth.svg"
    sizes = ("--first", "2000", "--most", "10000", "2x3")
    data, _ = kept("growth", tmp_path, "--no-peer", "--plot", str(plot), *sizes)
    sizes = [mark["configurations"] for mark in data["marks"]]
    assert sizes == sorted(sizes)
    assert data["bounds"] == [f"stopped at {sizes[-1]:,} configurations"]
    assert data["rate_kept"].keys() == {"configurations", "transitions"}
    assert data["peer"] is data["ratio_to_spin"] is None
    assert plot.read_text().startswith("<?xml")


@pytest.mark.long
@needs_spin
def test_spin_grows_until_its_bound_and_tells_what_it_had_on_its_way(tmp_path):
    found = spin.bounded(patrol.promela_text(3, 3), tmp_path, spin.Bounds(minutes=0), breadth_first=True)
    assert found.bounds == ("the time limit of 0 s",)
    assert 0 < found.configurations < patrol.COUNTS[3, 3, False][0]
    told = [mark["configurations"] for mark in found.marks]
    assert told == sorted(told)
    assert told[-1] <= found.configurations


def test_spins_marks_stand_beside_ours_where_they_are_near():
    def mark(configurations, transitions, seconds):
        figures = {"configurations": configurations, "transitions": transitions, "seconds": seconds}
        return figures | {"memory": configurations / 2**20}

    ours = [mark(1_050, 5_000, 1.0), mark(2_060, 9_000, 2.0), mark(10_000, 60_000, 4.0)]
    first, second, third = growth.beside(ours, [mark(1_000, 4_000, 2.0), mark(2_000, 8_000, 6.0)])
    assert (first["transitions_per_second"], second["transitions_per_second"], third) == (2_000, 1_000, None)
    assert second["bytes_per_configuration"] == 1


@pytest.mark.long
@needs_spin
def test_the_largest_are_kept_with_spins_figures_beside_them(tmp_path):
    data, printed = kept("largest", tmp_path, "--uavs", "2", "--spills", "0", "--robots", "3")
    (row,) = data["searches"]
    assert (row["peer"]["configurations"], row["peer"]["transitions"]) == (167, 341)
    assert row["peer"]["ended"] == "complete"
    assert row["ratio_to_spin"].keys() == {"configurations_per_second", "configurations", "memory_each"}
    assert "| rendezvous, 3 robots | in full | 167 | 341 |" in printed


def test_without_spin_it_is_said_that_the_peer_is_left_out(tmp_path, monkeypatch, capsys):
    monkeypatch.setenv("PATH", str(tmp_path))
    assert not spin.has_peer(wanted=True)
    assert "without SPIN, not installed: spin, gcc" in capsys.readouterr().err
    assert not spin.has_peer(wanted=False)
    assert not capsys.readouterr().err


def test_a_family_that_there_is_not_is_refused(capsys):
    with pytest.raises(SystemExit):
        script("largest").main(["--family", "oil_spill"])
    assert "no such family: oil_spill; there are oil_spill, spills: 1," in capsys.readouterr().err


@pytest.mark.long
def test_what_meets_a_limit_is_cut_and_goes_on_reduced(tmp_path):
    sizes = ("--uavs", "2", "--spills", "1", "--robots", "2")
    data, _ = kept("largest", tmp_path, "--no-peer", "--minutes", "0", *sizes)
    assert [row["reduced"] for row in data["searches"]] == [False, True]
    assert not any(row["complete"] for row in data["searches"])
    assert data["largest"] == {}


def test_growth_looks_at_all_sizes_between_its_ends():
    assert growth.marks(100, 10) == [2, 10, 20, 50, 100]


def test_a_table_is_written_between_its_markers_only():
    page = "before\n<!-- begin it -->\nold\n<!-- end it -->\nafter\n"
    assert (
        tables.filled(page, "it", "new\n") == "before\n<!-- begin it -->\n\nnew\n\n<!-- end it -->\nafter\n"
    )
    with pytest.raises(ValueError, match="no markers"):
        tables.filled("nothing", "it", "new\n")
