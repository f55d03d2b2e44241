"""Describe the machine of a measurement: figures of two machines cannot be compared."""

import importlib.metadata
import os
import platform
import shutil
import subprocess
import time
from collections.abc import Iterator
from pathlib import Path

PACKAGES = ("numba", "numpy")


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


def resident(name: str = "VmHWM", process: str = "self") -> float:
    """Return the memory of a process in MB: at its peak (`VmHWM`), or now (`VmRSS`); none where it has just ended."""
    value = _field(f"/proc/{process}/status", name)
    if value is None and process != "self":
        return 0.0
    if value is None:
        raise SystemExit("the benchmarks read memory from /proc: run them on Linux")
    return int(value.split()[0]) / 1024
