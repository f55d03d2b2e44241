"""Wordings shared by several packages: a count with its noun, and the installation of a missing extra."""


def counted(count: int, one: str, many: str = "") -> str:
    """Return a count with its noun.

    >>> counted(1, "step"), counted(1234, "step"), counted(0, "vertex", "vertices")
    ('1 step', '1,234 steps', '0 vertices')
    """
    return f"{count:,} {one if count == 1 else many or one + 's'}"


def install_extra(extra: str) -> str:
    """Return a hint for any installation of bigactors, from a clone or a wheel: no registry has it."""
    return (
        f"install bigactors as you did, with [{extra}] behind its folder or its wheel: "
        f"pip install '.[{extra}]' in a clone (-e as before), pip install 'FILE.whl[{extra}]'"
    )
