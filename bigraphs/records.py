"""Frozen values with a fast class definition: a language has dozens of them, and a small file would wait for them."""

from __future__ import annotations

from operator import attrgetter
from typing import Any, ClassVar, Final, NoReturn, dataclass_transform

WHERE: Final = "span"
"""The field that equality ignores: the position in the source."""


@dataclass_transform(frozen_default=True)
class Record:
    """A frozen value whose fields are the annotations of its class, as in a dataclass.

    Two records are equal if their classes and all fields except `span` are equal.

    >>> class Pair(Record):
    ...     first: int
    ...     second: int = 0
    >>> Pair(1)
    Pair(first=1, second=0)
    """

    __slots__ = ("__dict__",)
    _said: ClassVar[Any]

    def __init_subclass__(cls) -> None:
        names = tuple(vars(cls).get("__annotations__", ()))
        defaults = {f"_{name}": vars(cls)[name] for name in names if name in vars(cls)}
        parameters = [f"{name}=_{name}" if f"_{name}" in defaults else name for name in names]
        lines = [f"def __init__(self, {', '.join(parameters)}):", "    put = object.__setattr__"]
        lines += [f"    put(self, {name!r}, {name})" for name in names]
        made: dict[str, Any] = {}
        exec("\n".join(lines), defaults, made)
        cls.__init__ = made["__init__"]  # type: ignore[method-assign]
        cls.__match_args__ = names  # type: ignore[misc]  # as dataclass does
        said = [name for name in names if name != WHERE]
        cls._said = staticmethod(attrgetter(*said) if said else type)

    __match_args__: ClassVar[tuple[str, ...]] = ()

    def __eq__(self, other: object) -> bool:
        return type(self) is type(other) and self._said(self) == self._said(other)

    def __hash__(self) -> int:
        return hash((type(self), self._said(self)))

    def __repr__(self) -> str:
        shown = ", ".join(f"{name}={getattr(self, name)!r}" for name in self.__match_args__)
        return f"{type(self).__name__}({shown})"

    def __setattr__(self, name: str, value: object) -> NoReturn:
        raise AttributeError(f"cannot assign to field '{name}'")

    def __delattr__(self, name: str) -> NoReturn:
        raise AttributeError(f"cannot delete field '{name}'")
