"""Controls: the kinds of node, and their properties."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass, field
from functools import lru_cache
from itertools import pairwise
from typing import Literal, TypeAlias

from bigraphs.errors import BigraphError

Status: TypeAlias = Literal["active", "passive", "atomic"]


@dataclass(frozen=True, slots=True)
class Control:
    """A kind of node.

    `arity` is the number of its ports; None allows any number. Rules apply only inside *active* nodes; an *atomic* node
    contains nothing. Ports that are not `ordered` are interchangeable, as in BigraphER.
    """

    name: str
    arity: int | None = None
    status: Status = "active"
    ordered: bool = True

    def __post_init__(self) -> None:
        if not self.name:
            raise BigraphError("control", "a control without a name")
        if self.arity is not None and self.arity < 0:
            raise BigraphError(
                "arity", f"control '{self.name}' has the arity {self.arity}", "count ports from 0"
            )


@dataclass(frozen=True, slots=True, eq=False)
class Signature:
    """A set of controls, sorted by name; it caches its hash and an index because every node uses it."""

    controls: tuple[Control, ...] = ()
    _by_name: dict[str, Control] = field(init=False, repr=False)
    _hash: int = field(init=False, repr=False)

    def __post_init__(self) -> None:
        ordered = tuple(sorted(self.controls, key=lambda control: control.name))
        for one, other in pairwise(ordered):
            if one.name == other.name:
                raise BigraphError("control", f"control '{one.name}' is declared twice")
        object.__setattr__(self, "controls", ordered)
        object.__setattr__(self, "_by_name", {control.name: control for control in ordered})
        object.__setattr__(self, "_hash", hash(ordered))

    def __eq__(self, other: object) -> bool:
        if not isinstance(other, Signature):
            return NotImplemented
        return self is other or (self._hash == other._hash and self.controls == other.controls)

    def __hash__(self) -> int:
        return self._hash

    def __reduce__(self) -> tuple[type[Signature], tuple[tuple[Control, ...]]]:
        return Signature, (self.controls,)  # string hashes differ between processes

    def __getitem__(self, name: str) -> Control:
        found = self._by_name.get(name)
        if found is None:
            known = ", ".join(control.name for control in self.controls) or "none"
            raise BigraphError("control", f"unknown control '{name}'", f"the signature has {known}")
        return found

    def __contains__(self, name: str) -> bool:
        return name in self._by_name

    def __or__(self, other: Signature) -> Signature:
        """Return the union; raises BigraphError if the two declare a shared control differently."""
        if self is other or not other.controls:
            return self
        return _union(self, other) if self.controls else other


def open_signature(names: Iterable[str]) -> Signature:
    """Return a signature of active controls with any arity and interchangeable ports."""
    return Signature(tuple(Control(name, ordered=False) for name in sorted(set(names))))


@lru_cache(maxsize=256)
def _union(one: Signature, other: Signature) -> Signature:
    merged = {control.name: control for control in (*one.controls, *other.controls)}
    for control in one.controls:
        if merged[control.name] != control:
            hint = "give both bigraphs one signature"
            raise BigraphError("control", f"control '{control.name}' is declared in two different ways", hint)
    return one if len(merged) == len(one.controls) else Signature(tuple(merged.values()))
