"""Small `.big` files, and what is read of them."""

import pytest

from bigraphs.errors import NotationError
from bigraphs.notation import read_system


def system(declarations, block="", *, kind="brs", init="s", rules="", preds=""):
    """Return a file with a small signature, a first state s and a rule r."""
    listed = f"preds = {{{preds}}};" if preds else ""
    return (
        "ctrl A = 0; atomic ctrl Z = 1; ctrl B = 2; big s = A.Z{x};\n"
        f"{declarations}\nbegin {kind} {block} init {init}; rules = [{rules}]; {listed} end\n"
    )


def read(*arguments, **options):
    return read_system(system(*arguments, **options))


def rules(*arguments, **options):
    return [rule for each in read(*arguments, **options).classes for rule in each.rules]


def mistakes(text):
    """Return the mistakes in a text that must have some."""
    with pytest.raises(NotationError) as found:
        read_system(text)
    return found.value.mistakes
