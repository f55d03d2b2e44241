"""What is made once for all workers of a run of the tests."""

import fcntl
import os
from shutil import rmtree


def once(tmp_path_factory, name, make):
    """Return a folder that the first worker to ask has had made; the others wait until it is whole."""
    shared = tmp_path_factory.getbasetemp()
    shared = shared.parent if "PYTEST_XDIST_WORKER" in os.environ else shared
    folder, making = shared / name, shared / f"{name}_making"
    with (shared / f"{name}.lock").open("w") as lock:
        fcntl.flock(lock, fcntl.LOCK_EX)
        if not folder.exists():
            rmtree(making, ignore_errors=True)  # what failed before
            making.mkdir()
            make(making)
            making.rename(folder)
    return folder
