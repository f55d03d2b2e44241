"""How much of a long test `make test` runs; `make fuzz` runs the whole of it."""

import os

import pytest
from hypothesis import settings

IS_WHOLE = "BIGACTORS_FUZZ" in os.environ
PART = 3


def examples(most, part=PART, **more):
    """Return the settings of a property that is tried with so many examples; `make test` divides them by `part`."""
    return settings(max_examples=most if IS_WHOLE else most // part, **more)


def crossed(names, variations):
    """Decorate a test of every `name` under every `variation`: `make test` takes each name once, with the next."""
    numbered = [(at, name, key) for name in names for at, key in enumerate(variations)]
    pairs = [
        pytest.param(name, variations[key], id=f"{name}-{key}")
        for at, name, key in numbered
        if IS_WHOLE or at == names.index(name) % len(variations)
    ]
    return lambda test: pytest.mark.fuzz(pytest.mark.parametrize(("name", "variation"), pairs)(test))


def seeds(most, part):
    """Decorate a test of generated cases by their number: `make fuzz` takes all, `make test` the first few."""
    numbers = range(most if IS_WHOLE else part)
    return lambda test: pytest.mark.fuzz(pytest.mark.parametrize("seed", numbers)(test))


def soak(test):
    """Mark a test that only `make fuzz` runs: of what a shorter one tells, over a long time."""
    return pytest.mark.fuzz(pytest.mark.skipif(not IS_WHOLE, reason="a long run: `make fuzz`")(test))
