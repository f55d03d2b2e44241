"""Processes that tests start and send signals to."""

import signal
import subprocess
from contextlib import contextmanager


@contextmanager
def begun(words, **streams):
    """Start a process that hears hang-ups, whoever ignores them here, and that does not outlive a failed test."""
    before = signal.signal(signal.SIGHUP, signal.SIG_DFL)
    try:
        process = subprocess.Popen(words, **streams)
    finally:
        signal.signal(signal.SIGHUP, before)
    try:
        yield process
    finally:
        process.kill()
        process.communicate()
