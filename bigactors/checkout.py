"""A checkout's packages under their installed names: `bigactors.semantics` is the module `semantics`.

An installation has the packages inside this one (`hatch_build.py`); a checkout has them beside it, at the top.
Each module is imported once, so a class has one identity under both names.
"""

from __future__ import annotations

import sys
from collections.abc import Sequence
from importlib import import_module
from importlib.machinery import ModuleSpec
from importlib.util import find_spec
from pathlib import Path
from types import CodeType, ModuleType
from typing import Any, Final

ROOMS: Final = ("adapters", "bigraphs", "checker", "physical", "semantics", "specs")
PREFIX: Final = "bigactors."


class RoomFinder:
    """Meta path finder and loader that maps `bigactors.ROOM.x` to `ROOM.x`."""

    @classmethod
    def find_spec(cls, name: str, path: Sequence[str] | None = None, target: Any = None) -> ModuleSpec | None:  # noqa: ARG003 - the protocol
        """Return the specification of a package's module under its installed name; None for other modules."""
        own = name.removeprefix(PREFIX)
        if own == name or own.split(".")[0] not in ROOMS or own.endswith(".__main__"):
            return None  # Python runs a `__main__` by its file
        found = find_spec(own)
        if found is None:
            return None
        loader: Any = cls()  # a base class of importlib.abc would load twenty modules more
        is_package = found.submodule_search_locations is not None
        spec = ModuleSpec(name, loader, origin=found.origin, is_package=is_package)
        spec.submodule_search_locations = found.submodule_search_locations
        return spec

    def create_module(self, spec: ModuleSpec) -> ModuleType:
        """Import and return the module under its checkout name."""
        self.module = import_module(spec.name.removeprefix(PREFIX))
        self.spec = self.module.__spec__
        return self.module

    def exec_module(self, module: ModuleType) -> None:
        """Restore the module's own specification, which the import system has replaced. The module has already run."""
        module.__spec__ = self.spec

    def get_code(self, name: str) -> CodeType | None:
        """Return the code of a module, for `python -m`."""
        spec = find_spec(name.removeprefix(PREFIX))
        loader: Any = None if spec is None else spec.loader
        return loader.get_code(name.removeprefix(PREFIX)) if loader else None


def share_rooms() -> None:
    """Install the finder once, in a checkout only."""
    if not (Path(__file__).parent / ROOMS[0]).is_dir() and RoomFinder not in sys.meta_path:
        sys.meta_path.insert(0, RoomFinder)
