"""The table of real files says of each what was read and found, or why not."""

import json
import shutil

import pytest
from scripts import BENCHMARKS, script

real_bigraphs = script("real_bigraphs")
EXAMPLE = BENCHMARKS.parent / "bigraphs/examples/sensor_network.big"


def test_a_folder_without_a_name_is_asked_for(monkeypatch, capsys):
    monkeypatch.delenv("BIGRAPHS", raising=False)
    assert real_bigraphs.main([]) == 0
    assert "set BIGRAPHS" in capsys.readouterr().out


def test_every_file_in_a_folder_has_its_counts_or_a_reason(tmp_path, monkeypatch, capsys):
    (tmp_path / "in").mkdir()
    shutil.copy(EXAMPLE, tmp_path / "in")
    (tmp_path / "in/named.bgm").write_text("u:UAV.nil;")
    monkeypatch.setenv("BIGRAPHS", str(tmp_path))
    output = tmp_path / "found.json"
    program = shutil.which("bigrapher")
    assert real_bigraphs.main(["--output", str(output)]) == 0
    refused, counted = json.loads(output.read_text())["rows"]
    assert (counted["ours"]["states"], counted["ours"]["transitions"], counted["ours"]["why"]) == (24, 40, "")
    assert 0 < counted["ours"]["seconds"] < 60
    assert counted["ours"]["megabytes"] > 10
    if program:
        assert (counted["bigrapher"]["states"], counted["bigrapher"]["transitions"]) == (24, 40)
    assert refused["ours"]["why"].startswith("not read: 1:1: 'u:UAV' names a node")
    assert "| in/sensor_network.big | 24 / 40 |" in capsys.readouterr().out


@pytest.mark.parametrize(
    ("states", "why", "differs"),
    [(24, "", False), (25, "", True), (25, "the limit of 25 states was reached", False)],
)
def test_only_what_both_tools_ended_is_compared(states, why, differs):
    left = real_bigraphs.Run(24, 40, "", 0.1, 30)
    right = real_bigraphs.Run(states, 40, why, 0.1, 30)
    assert real_bigraphs.differ(left, right) is differs
    assert ("differs" in real_bigraphs.row("a.big", left, right)) is differs
