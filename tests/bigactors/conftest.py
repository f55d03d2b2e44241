import sys
from collections.abc import Callable
from pathlib import Path

import pytest

from bigactors.cli import main
from bigactors.progress import COMPILING

sys.path.insert(0, str(Path(__file__).parent))  # for small_missions and other helpers

from written_missions import TEXTS


@pytest.fixture
def missions(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """Go to a folder with four missions: one holds, one races, one never ends, one has a mistake."""
    for name, text in TEXTS.items():
        (tmp_path / f"{name}.mission").write_text(text, encoding="utf-8")
    monkeypatch.chdir(tmp_path)
    return tmp_path


Ran = tuple[int, str, str]


@pytest.fixture
def bigactors(capsys: pytest.CaptureFixture[str]) -> Callable[..., Ran]:
    """Run a command line in this process; returns the exit code, the standard output and the standard error."""

    def run(*words: str) -> Ran:
        code = main(list(words))
        captured = capsys.readouterr()
        told = captured.err.splitlines(keepends=True)  # of loops that this process compiles first, nothing
        return code, captured.out, "".join(line for line in told if not line.endswith(f": {COMPILING}\n"))

    return run


@pytest.fixture
def done(bigactors: Callable[..., Ran]) -> Callable[..., str]:
    """Run a command line that succeeds and tells nothing beside its output; returns that."""

    def run(*words: str) -> str:
        code, out, err = bigactors(*words)
        assert (code, err) == (0, "")
        return out

    return run


@pytest.fixture
def refused(bigactors: Callable[..., Ran]) -> Callable[..., str]:
    """Run a command line that is refused; returns why."""

    def run(*words: str) -> str:
        code, out, err = bigactors(*words)
        assert (code, out) == (2, "")
        assert "Traceback" not in err
        return err

    return run
