"""The server in a real editor: Neovim, by its own client."""

import json
import os
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[3]
NEOVIM = shutil.which("nvim")
SCRIPT = Path(__file__).with_name("neovim.lua")
OIL_SPILL = (ROOT / "specs/missions/oil_spill.mission").read_text(encoding="utf-8")


@pytest.mark.skipif(NEOVIM is None, reason="Neovim is not installed")
def test_neovim_shows_mistakes_mends_renames_completes_and_lays_out(tmp_path):
    mission, results = tmp_path / "oil_spill.mission", tmp_path / "results.json"
    mission.write_text(OIL_SPILL.replace("TO searchArea0", "TO   serchArea0"), encoding="utf-8")
    server = tmp_path / "bigactors"
    server.write_text(f'#!/bin/sh\nexec "{sys.executable}" -m bigactors "$@"\n')
    server.chmod(0o755)
    line = [NEOVIM, "--clean", "--headless", "-n", "-S", str(SCRIPT)]
    told = {"BIGACTORS_EDITED": "\n".join(map(str, (server, mission, results)))}
    home = {"XDG_STATE_HOME": str(tmp_path), "XDG_CACHE_HOME": str(tmp_path)}
    subprocess.run(
        line, cwd=ROOT, env={**os.environ, **told, **home}, timeout=120, check=True, capture_output=True
    )
    found = json.loads(results.read_text(encoding="utf-8"))
    assert found.get("error") is None
    assert found["mistakes"] == [[20, 26, "unknown name 'serchArea0'\nhint: did you mean 'searchArea0'?"]]
    assert found["definition"] == 14
    assert found["hover"].startswith("**entity** `oilSpill0`")
    assert found["renamed"] == OIL_SPILL.count("oilSpill0") == 6
    assert "searchArea0" in found["completion"]
    assert found["text"] == OIL_SPILL.replace("oilSpill0", "slick")
    assert found["lenses"] == 6
