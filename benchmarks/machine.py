"""Describe the machine of a measurement: figures of two machines cannot be compared."""

import importlib.metadata
import json
import os
import platform
import shutil
import subprocess
import sys
import tempfile
import time
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path

PACKAGES = ("numba", "numpy")

LAUNCHER = """
import json, os, resource, sys
told, limit, *command = sys.argv[1:]
child = os.fork()
if not child:
    if limit != "-":
        resource.setrlimit(resource.RLIMIT_CPU, (int(limit), int(limit) + 5))
    try:
        os.execvp(command[0], command)
    except OSError as error:
        os.write(2, f"{command[0]}: {error.strerror}\\n".encode())
        os._exit(127)
_, status, used = os.wait4(child, 0)
with open(told, "w") as file:
    json.dump([os.waitstatus_to_exitcode(status), used.ru_utime + used.ru_stime, used.ru_maxrss], file)
"""
"""Runs a program as a child of a small process.

What a system calls the peak of a process counts that of the one that it was forked from, until it became another
program: of one that a benchmark starts itself it was the benchmark's own, with Python's libraries.
"""


@dataclass(frozen=True, slots=True)
class Ended:
    """A program that was run: what it printed, its exit status, processor seconds and peak memory in MB.

    Less than some 9 MB, the launcher's own, are not told from it.
    """

    printed: str
    status: int
    seconds: float
    memory: float


def run_peer(command: Sequence[str], *, folder: Path | None = None, seconds: int | None = None) -> Ended:
    """Run another program as a process of its own, and measure that alone.

    Args:
        command: The program and its arguments.
        folder: Where it runs.
        seconds: How much processor time it gets; then a signal ends it.
    """
    with tempfile.TemporaryDirectory() as own:
        told = Path(own) / "told"
        limit = "-" if seconds is None else str(seconds)
        launcher = [sys.executable, "-I", "-S", "-c", LAUNCHER, str(told), limit, *command]
        done = subprocess.run(
            launcher, cwd=folder, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, check=True
        )
        status, used, peak = json.loads(told.read_text(encoding="utf-8"))
        unit = 1 << 20 if sys.platform == "darwin" else 1 << 10
        return Ended(done.stdout.decode("utf-8", "replace"), status, used, peak / unit)


def describe() -> dict[str, object]:
    """Return the machine and the versions, as the system says them, and how busy it is now."""
    return {
        "processor": _field("/proc/cpuinfo", "model name") or platform.processor() or "unknown",
        "cores": os.cpu_count(),
        "memory_gb": round(os.sysconf("SC_PAGE_SIZE") * os.sysconf("SC_PHYS_PAGES") / 1e9, 1),
        "system": f"{platform.system()} {platform.machine()}",
        "versions": dict(_versions()),
        "load_average": round(os.getloadavg()[0], 2),
        "day": time.strftime("%Y-%m-%d", time.gmtime()),
    }


def _versions() -> Iterator[tuple[str, str]]:
    yield "python", platform.python_version()
    for package in PACKAGES:
        yield package, importlib.metadata.version(package)
    for tool, option in (("spin", "-V"), ("gcc", "--version")):
        if shutil.which(tool):
            done = subprocess.run([tool, option], capture_output=True, text=True, check=False)
            yield tool, done.stdout.partition("\n")[0].strip()


def _field(path: str, name: str) -> str | None:
    """Return the first value of a name in a file of the system; None where there is none."""
    file = Path(path)
    lines = file.read_text(encoding="utf-8", errors="replace").splitlines() if file.exists() else []
    values = (line.partition(":")[2].strip() for line in lines if line.startswith(name))
    return next(values, None)


def resident() -> float:
    """Return the memory of this process at its peak, in MB."""
    value = _field("/proc/self/status", "VmHWM")
    if value is None:
        raise SystemExit("the benchmarks read memory from /proc: run them on Linux")
    return int(value.split()[0]) / 1024
