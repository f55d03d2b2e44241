"""How much of a generated test is run: `make test` runs a part, `make test-long` more, `make fuzz` the whole."""

import os

import pytest
from hypothesis import settings

IS_WHOLE = "BIGACTORS_FUZZ" in os.environ
IS_LONG = "BIGACTORS_LONG" in os.environ
PART = 3
SHORTER = 2


def examples(most, part=PART, **more):
    """Return the settings of a property that is tried with so many examples.

    `make test-long` divides them by `part`, and `make test` by two more.
    """
    share = most // part if IS_LONG else most // (part * SHORTER)
    return settings(max_examples=most if IS_WHOLE else max(1, share), **more)


def crossed(names, variations):
    """Decorate a test of every `name` under every `variation`.

    Without `make fuzz`, each name is taken once, with the next variation; of these, two thirds are long.
    """
    numbered = [
        (place, name, at, key) for place, name in enumerate(names) for at, key in enumerate(variations)
    ]
    pairs = [
        pytest.param(name, variations[key], id=f"{name}-{key}", marks=_long(place, *LINES))
        for place, name, at, key in numbered
        if IS_WHOLE or at == place % len(variations)
    ]
    return lambda test: pytest.mark.fuzz(pytest.mark.parametrize(("name", "variation"), pairs)(test))


LINES = (9, {0, 5, 7})
"""A third of the places, with remainders of all kinds, so that no variation is left out by its number."""


def some_long(cases, every=3):
    """Return the cases of a test; each `every`-th is run by `make test`, the others are long."""
    return [pytest.param(case, marks=_long(place, every, {0})) for place, case in enumerate(cases)]


def long_ones(*cases):
    """Return cases of a test that `make test-long` alone runs: larger ones, or more of what another case tries."""
    return [pytest.param(case, marks=pytest.mark.long) for case in cases]


def _long(place, period, short):
    return () if IS_WHOLE or place % period in short else pytest.mark.long


def seeds(most, part):
    """Decorate a test of generated cases by their number: `make fuzz` takes all, else a part, half of which is long."""
    numbers = some_long(range(most if IS_WHOLE else part), every=SHORTER)
    return lambda test: pytest.mark.fuzz(pytest.mark.parametrize("seed", numbers)(test))


def soak(test):
    """Mark a test that only `make fuzz` runs: of what a shorter one tells, over a long time."""
    return pytest.mark.fuzz(pytest.mark.skipif(not IS_WHOLE, reason="a long run: `make fuzz`")(test))
