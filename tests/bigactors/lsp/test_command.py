"""`bigactors lsp` as a command."""

import subprocess
import sys
from pathlib import Path

ROOT = Path(__file__).parents[3]


def test_without_the_extra_the_way_to_install_it_is_told():
    program = "import sys; sys.modules['lsprotocol'] = None; from bigactors.cli import main; sys.exit(main(['lsp']))"
    ended = subprocess.run(
        [sys.executable, "-c", program], cwd=ROOT, capture_output=True, text=True, check=False
    )
    assert ended.returncode == 2
    assert "pip install '.[lsp]'" in ended.stderr
