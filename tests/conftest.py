"""Hypothesis profiles: `default` finds the same examples in every run, `thorough` looks further."""

import gc
import os
import signal
import sys
from pathlib import Path

import pytest
from _pytest.doctest import DoctestModule
from hypothesis import HealthCheck, settings

sys.path.insert(0, str(Path(__file__).parent))  # for scale

from scale import examples

# What is begun in a shell's background ignores Ctrl-C, and so would the processes that tests interrupt.
if signal.getsignal(signal.SIGINT) is signal.SIG_IGN:
    signal.signal(signal.SIGINT, signal.default_int_handler)

# Thousands of tests stay: to look through them again and again took a tenth of the time.
gc.set_threshold(100_000, 20, 50)


def pytest_addoption(parser):
    """Add `--update`, the one way to renew expected outputs: look at the difference before it is committed."""
    parser.addoption(
        "--update", action="store_true", help="rewrite expected outputs: tests/corpus, and docs' consoles"
    )


@pytest.fixture
def expect(request):
    """Return a function that compares a text with an expected file, or rewrites the file with `--update`."""

    def compare(text, path):
        if request.config.getoption("--update"):
            path.write_text(text, encoding="utf-8")
        assert text == path.read_text(encoding="utf-8")

    return compare


@pytest.hookimpl(wrapper=True)
def pytest_collect_file():
    """Look for no doctests in tests: they have none."""
    return [each for each in (yield) if not isinstance(each, DoctestModule)]


def pytest_collection_finish() -> None:
    """Let what was collected be looked through no more."""
    gc.freeze()


_SLOW = [HealthCheck.too_slow, HealthCheck.data_too_large]  # whole configurations are large values

_DEFAULT = examples(60, deadline=None, derandomize=True, suppress_health_check=_SLOW)
settings.register_profile("default", _DEFAULT)
settings.register_profile("thorough", max_examples=2000, deadline=None, suppress_health_check=_SLOW)
settings.load_profile(os.environ.get("HYPOTHESIS_PROFILE", "default"))
