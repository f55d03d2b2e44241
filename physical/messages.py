"""Wordings that messages of several rooms share: a count with its noun, and how a missing extra is installed."""


def counted(count: int, one: str, many: str = "") -> str:
    """Return a count with its noun.

    >>> counted(1, "step"), counted(1234, "step"), counted(0, "vertex", "vertices")
    ('1 step', '1,234 steps', '0 vertices')
    """
    return f"{count:,} {one if count == 1 else many or one + 's'}"


def install_extra(extra: str) -> str:
    """Return a hint that fits however bigactors was installed, in a clone or from a wheel: no registry has it."""
    return (
        f"install bigactors as you did, with [{extra}] behind its folder or its wheel: "
        f"pip install '.[{extra}]' in a clone (-e as before), pip install 'FILE.whl[{extra}]'"
    )
