"""numba's cache of compiled loops, made safe for a change of our own code.

numba compares a cached loop with the loop's own file only. But loops are compiled together with the loops and the
constants of other files. After an update of one such file, numba alone would run a mixture of old and new code.
"""

import pickle
import re
from collections.abc import Callable, Iterator
from contextlib import contextmanager, suppress
from functools import cache
from hashlib import sha256
from pathlib import Path
from typing import IO, Any, Final

from numba.core.caching import FunctionCache, IndexDataCacheFile
from numba.core.compiler_lock import global_compiler_lock
from numba.core.event import trigger_event

try:
    import fcntl
except ImportError:  # Windows: there, processes that begin together compile a loop more than once
    fcntl = None  # type: ignore[assignment]

ENGINES: Final = Path(__file__).parents[2]
IMPORT: Final = re.compile(r"^from (?:bigactors\.)?(\w[\w.]*) import (\([^)]*\)|.*)", re.MULTILINE)


class _Index(IndexDataCacheFile):
    """The index of the compiled forms of one loop."""

    def _load_index(self) -> dict[Any, str]:
        """Return the index; an unreadable one, as of a version whose modules had other names, is empty."""
        try:
            found: dict[Any, str] = super()._load_index()  # type: ignore[no-untyped-call]  # numba ships no types
        except (
            pickle.UnpicklingError,
            AttributeError,
            EOFError,
            ImportError,
            IndexError,
            TypeError,
            ValueError,
        ):
            return {}
        return found


class LoopCache(FunctionCache):
    """The cache of one loop, void as soon as any code that is compiled with loops has changed."""

    def __init__(self, loop: Callable[..., Any]) -> None:
        super().__init__(loop)  # type: ignore[no-untyped-call]
        self._cache_file = _Index(self._cache_path, self._impl.filename_base, stamp(ENGINES))  # type: ignore[no-untyped-call]

    @contextmanager
    def compiling_alone(self) -> Iterator[None]:
        """Let no other process compile this loop meanwhile, so that those that begin together share the work.

        Waiting for another process counts as compiling. Where there can be no lock file, nothing is waited for.
        """
        with global_compiler_lock:  # first: threads of one process would wait for each other's locks
            with suppress(OSError):
                self._impl.locator.ensure_cache_path()
            try:
                opened = open(f"{self._cache_path}/{self._impl.filename_base}.lock", "w")  # noqa: SIM115
            except OSError:
                yield
                return
            with opened:
                _lock(opened)
                try:
                    yield
                finally:
                    _unlock(opened)


def _lock(opened: IO[str]) -> None:
    """Wait until no other process has locked a file; where files can't be locked, don't wait."""
    if fcntl is not None:
        with suppress(OSError):
            try:
                fcntl.flock(opened, fcntl.LOCK_EX | fcntl.LOCK_NB)
            except BlockingIOError:
                with trigger_event("numba:compile"):
                    fcntl.flock(opened, fcntl.LOCK_EX)


def _unlock(opened: IO[str]) -> None:
    """Release a lock at once, also where a forked process has the file open."""
    if fcntl is not None:
        with suppress(OSError):
            fcntl.flock(opened, fcntl.LOCK_UN)


@cache
def stamp(engines: Path) -> str:
    """Return a digest of all code that is compiled with loops, independent of the files' place and dates."""
    found = sha256()
    for path in sorted(_compiled(engines)):
        found.update(
            f"{path.relative_to(engines.parents[1]).as_posix()}\0{sha256(path.read_bytes()).hexdigest()}\n".encode()
        )
    return found.hexdigest()


def _compiled(engines: Path) -> set[Path]:
    """Return the modules with loops, the modules that they import, and the engines' modules that these import."""
    texts = {path: path.read_text(encoding="utf-8") for path in engines.rglob("*.py")}
    loops = {path for path, text in texts.items() if ".jit_decorators import " in text}
    found, left = set[Path](), list(loops)
    while left:
        path = left.pop()
        found.add(path)
        new = set(_imported(engines.parents[1], texts.get(path, ""))) - found
        left += (other for other in new if other in texts or (path in loops and other.is_file()))
    return found


def _imported(root: Path, text: str) -> Iterator[Path]:
    """Yield the possible files of the modules that a module imports at its top."""
    for module, names in IMPORT.findall(text):
        home = root.joinpath(*module.split("."))
        yield home.with_suffix(".py")
        yield from (home / f"{name}.py" for name in re.findall(r"\w+", names))


def is_compiled(loop: Any) -> bool:
    """Return whether the cache of a loop has a compiled form of it."""
    return bool(loop._cache._cache_file._load_index())  # noqa: SLF001 - numba compiles where it finds none
