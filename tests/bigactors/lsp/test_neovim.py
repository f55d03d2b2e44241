"""The configuration of Neovim in docs/how-to/editors.md, followed to the letter: a mistake is shown."""

import os
import re
import shutil
import subprocess
import sys

import pytest
from repository import ROOT

PAGE = ROOT / "docs" / "how-to" / "editors.md"
MISSION = """\
signature standard
world {
  bay0: Location = circle (37.01, -8.65) radius 900 m
  uav0: UAV = point (37.01, -8.65)
}
BigActor a hosted_at uav0 with_behavior { control(MOVE_HOST_TO byy0) }
"""
SHOWS = """\
vim.wait(100000, function() return #vim.diagnostic.get(0) > 0 end, 200)
for _, each in ipairs(vim.diagnostic.get(0)) do print(each.lnum + 1, each.code, each.message) end
vim.cmd("qa!")
"""


def test_neovim_shows_a_mistake_with_its_remedy(tmp_path):
    neovim = shutil.which("nvim")
    if neovim is None:
        pytest.skip("there is no nvim")
    version = subprocess.run([neovim, "--version"], capture_output=True, text=True, check=True).stdout
    is_new = tuple(map(int, re.findall(r"v(\d+)\.(\d+)", version)[0])) >= (0, 11)
    since, before = re.findall(r"```lua\n(.*?)```", PAGE.read_text("utf-8"), re.DOTALL)
    for name, text in (
        ("init.lua", since if is_new else before),
        ("m.mission", MISSION),
        ("shows.lua", SHOWS),
    ):
        (tmp_path / name).write_text(text, encoding="utf-8")
    command = tmp_path / "bigactors"
    command.write_text(f'#!/bin/sh\nexec "{sys.executable}" -m bigactors "$@"\n', encoding="utf-8")
    command.chmod(0o700)
    shown = subprocess.run(
        [neovim, "--headless", "-u", "init.lua", "m.mission", "-c", "luafile shows.lua"],
        cwd=tmp_path,
        env=os.environ | {"PATH": f"{tmp_path}:{os.environ['PATH']}", "PYTHONPATH": str(ROOT)},
        capture_output=True,
        text=True,
        timeout=150,
        check=True,
    )
    assert "6 LS201 unknown name 'byy0'\nhint: did you mean 'bay0'?" in shown.stderr + shown.stdout
