"""Compiled loops are cached, but never those of other code than the present."""

import fcntl
import pickle
import subprocess
import sys
from contextlib import ExitStack
from importlib import import_module
from pathlib import Path

import pytest

from checker.engines.fast.compiled import loop_cache
from checker.engines.fast.compiled.loop_cache import ENGINES, LoopCache, stamp

LOOPS = "from checker.engines.fast.compiled.jit_decorators import"
KERNEL = f"""\
{LOOPS} njit
from checker.engines.fast import sizes
from semantics.times import LATE
"""
CALLER = """\
from checker.engines.fast.compiled.jit_decorators import njit
from {home} import step

@njit(cache=True)
def walk(x):
    return step(x)
"""

CALLEE = """\
from checker.engines.fast.compiled.jit_decorators import inner

@inner(cache=True)
def step(x):
    return x + {more}
"""


@pytest.fixture
def engines(tmp_path):
    """Return a package of three engines' modules: a loop, a constant that it imports, and code that is not compiled."""
    folder = tmp_path / "checker" / "engines"
    (folder / "fast" / "store").mkdir(parents=True)
    texts = {
        "fast/store/kernel.py": KERNEL,
        "fast/sizes.py": "WORD = 64\n",
        "fast/explorer.py": "from checker.engines.fast.store.kernel import walk\n",
    }
    for name, text in texts.items():
        (folder / name).write_text(text, encoding="utf-8")
    (tmp_path / "semantics").mkdir()
    (tmp_path / "semantics" / "times.py").write_text("LATE = 1\n", encoding="utf-8")
    stamp.cache_clear()
    yield folder
    stamp.cache_clear()


@pytest.mark.parametrize(
    ("name", "voids"),
    [
        ("checker/engines/fast/store/kernel", True),
        ("checker/engines/fast/sizes", True),
        ("checker/engines/fast/explorer", False),
        ("semantics/times", True),
    ],
)
def test_the_cache_is_void_when_what_is_compiled_with_loops_changes(engines, name, voids):
    before = stamp(engines)
    with (engines.parents[1] / f"{name}.py").open("a", encoding="utf-8") as opened:
        opened.write("# changed\n")
    stamp.cache_clear()
    assert (stamp(engines) != before) == voids


def test_every_module_with_loops_is_in_the_stamp():
    compiled = {path.relative_to(ENGINES.parents[1]).as_posix() for path in loop_cache._compiled(ENGINES)}
    engines = (
        "fast/store/kernel",
        "fast/compiled/table",
        "fast/model/columns",
        "zones/make_zones",
        "cluster/kernel",
    )
    assert {f"checker/engines/{name}.py" for name in engines} <= compiled
    assert "semantics/timing/actor_clocks.py" in compiled
    assert "checker/engines/fast/search/rule_model.py" not in compiled


def test_a_changed_inner_loop_of_another_file_is_compiled_anew(tmp_path, monkeypatch):
    """numba alone would go on with the old inner loop, since the file of the outer one is the same."""
    monkeypatch.setenv("NUMBA_CACHE_DIR", str(tmp_path / "cache"))
    folder = tmp_path / "checker" / "engines"
    folder.mkdir(parents=True)
    (folder / "loop_cache_caller.py").write_text(CALLER.format(home="loop_cache_callee"), encoding="utf-8")
    program = (
        "import sys; from pathlib import Path; from checker.engines.fast.compiled import loop_cache; "
        "loop_cache.ENGINES = Path(sys.argv[1]); sys.path.insert(0, sys.argv[1]); "
        "import loop_cache_caller; print(loop_cache_caller.walk(1))"
    )
    found = []
    for more in (1, 2):
        (folder / "loop_cache_callee.py").write_text(CALLEE.format(more=more), encoding="utf-8")
        line = [sys.executable, "-B", "-c", program, str(folder)]
        ran = subprocess.run(line, check=True, capture_output=True, text=True)
        found.append(int(ran.stdout))
    assert found == [2, 3]


def test_an_index_of_modules_that_are_gone_is_empty(tmp_path, monkeypatch):
    """As after an update that renamed a module: the index of the old version is still in the same place."""
    monkeypatch.setattr("numba.core.config.CACHE_DIR", str(tmp_path))
    loop = import_module("checker.engines.fast.compiled.bits").__dict__
    function = next(each.py_func for each in loop.values() if hasattr(each, "py_func"))
    found = LoopCache(function)._cache_file
    found.save("key", b"data")
    assert found.load("key") == b"data"
    with open(found._index_path, "wb") as opened:
        pickle.dump(found._version, opened)
        opened.write(b"\x80\x04cchecker.engines.fast.long_gone\nModel\n.")
    assert found.load("key") is None
    found.save("key", b"new")
    assert found.load("key") == b"new"


TOGETHER = """\
import sys
from pathlib import Path
from numba.core.event import Listener, register
from checker.engines.fast.compiled import loop_cache
loop_cache.ENGINES = Path(sys.argv[1])
sys.path.insert(0, sys.argv[1])
from loop_cache_shared import step

class Compiling(Listener):
    def on_start(self, event):
        print("compiling", flush=True)

    def on_end(self, event):
        pass

register("numba:compile", Compiling())
print(step._cache._cache_path, step._cache._impl.filename_base, flush=True)
sys.stdin.readline()
print(step(1), sum(step.stats.cache_misses.values()))
"""


def test_processes_that_begin_together_compile_a_loop_once(tmp_path, monkeypatch):
    monkeypatch.setenv("NUMBA_CACHE_DIR", str(tmp_path / "cache"))
    folder = tmp_path / "checker" / "engines"
    folder.mkdir(parents=True)
    text = CALLEE.format(more=1).replace("inner", "njit")
    (folder / "loop_cache_shared.py").write_text(text, encoding="utf-8")
    line = [sys.executable, "-B", "-c", TOGETHER, str(folder)]
    pipes = {"stdin": subprocess.PIPE, "stdout": subprocess.PIPE, "text": True}
    with ExitStack() as ended:
        both = [ended.enter_context(subprocess.Popen(line, **pipes)) for _ in range(2)]
        for each in both:
            ended.callback(each.kill)
        (where,) = {tuple(each.stdout.readline().split()) for each in both}
        Path(where[0]).mkdir(parents=True, exist_ok=True)
        with open("{}/{}.lock".format(*where), "w") as held:
            fcntl.flock(held, fcntl.LOCK_EX)
            for each in both:
                print(file=each.stdin, flush=True)
            assert [each.stdout.readline() for each in both] == ["compiling\n"] * 2  # or waiting
        found = [each.stdout.read().split() for each in both]
    assert sorted(found) == [["2", "0"], ["compiling", "2", "1"]]
