"""User mistakes in physical input, as data."""

from __future__ import annotations


class PhysicalError(ValueError):
    """A mistake in physical input: the finding, the expectation and a remedy.

    Attributes:
        code: A stable word for the kind of mistake, such as ``latitude``.
        message: The problem, in the user's words.
        hint: A remedy; may be empty.
        where: The position in the input: a feature's index and name, a line; may be empty.
    """

    def __init__(self, code: str, message: str, hint: str = "", where: str = "") -> None:
        super().__init__(code, message, hint, where)
        self.code = code
        self.message = message
        self.hint = hint
        self.where = where

    def __str__(self) -> str:
        text = f"{self.where}: {self.message}" if self.where else self.message
        return f"{text}\nhint: {self.hint}" if self.hint else text


class GeometryError(PhysicalError):
    """Coordinates that describe no geometry on the earth."""
