"""Sequences whose elements are made at each access."""

from collections.abc import Callable, Sequence
from typing import Any, TypeVar, overload

from numpy.typing import NDArray

Made = TypeVar("Made")


class MadeOnAccess(Sequence[Made]):
    """Objects made from numbers: `make` of each number of `numbers`, in their order."""

    __slots__ = ("make", "numbers")

    def __init__(self, make: Callable[[int], Made], numbers: range | NDArray[Any]) -> None:
        self.make = make
        self.numbers = numbers

    def __len__(self) -> int:
        return len(self.numbers)

    @overload
    def __getitem__(self, at: int) -> Made: ...

    @overload
    def __getitem__(self, at: slice) -> Sequence[Made]: ...

    def __getitem__(self, at: int | slice) -> Made | Sequence[Made]:
        if isinstance(at, slice):
            return MadeOnAccess(self.make, self.numbers[at])
        return self.make(int(self.numbers[at]))
