"""Plugins of other packages, found by their entry points and loaded when a command line names them.

`importlib.metadata` reads the declarations of packages and imports none of them.
"""

from __future__ import annotations

from collections.abc import Callable, Collection
from importlib.metadata import EntryPoint, entry_points
from typing import Any, Final

from adapters.assigned import Assigned
from adapters.camera.region_detection import load_detector
from adapters.camera.slick import Detector
from adapters.plugin import Plugin
from bigactors.mistakes import Mistake, suggestion
from physical import PhysicalError

VEHICLES: Final = "bigactors.plugins.vehicles"
"""The group of vehicle plugins. An entry point names a scheme, and a function of a name, an address and vehicles."""

FEEDS: Final = "bigactors.plugins.feeds"
"""The group of feed plugins. An entry point names a kind of feed, and a function of a name and an address."""


DETECTORS: Final = "bigactors.plugins.detectors"
"""The group of detectors. An entry point names a function from a `Frame` to `Patch`es."""


def installed(group: str) -> tuple[EntryPoint, ...]:
    """Return the entry points of a group in the order of their names, without duplicates."""
    return tuple(sorted(set(entry_points(group=group)), key=lambda each: (each.name, each.value)))


def package_of(entry: EntryPoint) -> str:
    """Return the name and the version of the package that declares an entry point."""
    return "an unknown package" if entry.dist is None else f"{entry.dist.name} {entry.dist.version}"


def make_vehicles(scheme: str, name: str, address: str, vehicles: tuple[Assigned, ...]) -> Plugin:
    """Return the plugin that an installed package makes to drive the vehicles; raises Mistake."""
    plugin, blame = _made(VEHICLES, scheme, (name, address, vehicles))
    missing = [each.entity for each in vehicles if not plugin.owns(each.entity)]
    if missing:
        raise blame(f"does not own {', '.join(missing)}, which it should drive")
    return plugin


def make_feed(kind: str, name: str, address: str) -> Plugin:
    """Return the feed that an installed package makes; raises Mistake."""
    return _made(FEEDS, kind, (name, address))[0]


def find_detector(word: str) -> Detector:
    """Return a detector: an installed one by its name, or MODULE:NAME; raises Mistake, PhysicalError."""
    if ":" in word:
        return load_detector(word)
    require_known(word, DETECTORS, (), f"there is no detector '{word:.40}'")
    return load_detector(_only(DETECTORS, word).value)


def require_known(word: str, group: str, ours: Collection[str], message: str) -> None:
    """Raise Mistake for an undeclared name; the hint lists the declared ones."""
    known = [*ours, *dict.fromkeys(entry.name for entry in installed(group))]
    if word not in known:
        hint = suggestion(word, known) or f"there are {', '.join(known) or 'none'}"
        raise Mistake(message, f"{hint}; bigactors plugins lists those installed")


def _only(group: str, called: str) -> EntryPoint:
    """Return the only entry point with a declared name; raises Mistake if two packages declare it."""
    found = [entry for entry in installed(group) if entry.name == called]
    if len(found) > 1:
        packages = " and ".join(map(package_of, found))
        raise Mistake(f"'{called}' is declared by {packages}", "uninstall all but one of them")
    return found[0]


def _made(group: str, called: str, arguments: tuple[Any, ...]) -> tuple[Plugin, Callable[[str], Mistake]]:
    """Return the plugin that an entry point's function makes, and a function that blames its package for a fault."""
    entry = _only(group, called)

    def blame(fault: str) -> Mistake:
        hint = f"this is a fault of {package_of(entry)} ({entry.value}), not of bigactors or the mission"
        return Mistake(f"the plugin '{called}' {fault}", hint)

    make = _guarded(entry.load, (), lambda reason: blame(f"cannot be loaded: {reason}"))
    plugin = _guarded(make, arguments, lambda reason: blame(f"cannot be made: {reason}"))
    if not isinstance(plugin, Plugin):
        raise blame(f"makes a {type(plugin).__name__}, which lacks something of adapters.plugin.Plugin")
    if plugin.name != arguments[0]:
        raise blame(f"is named {plugin.name!r:.60}, not '{arguments[0]}' as it was asked to be")
    return plugin, blame


def _guarded(call: Callable[..., Any], arguments: tuple[Any, ...], blame: Callable[[str], Mistake]) -> Any:
    """Call another package's code. A PhysicalError is the user's mistake; other errors are the package's fault."""
    try:
        return call(*arguments)
    except PhysicalError:
        raise
    except (Exception, SystemExit) as error:
        raise blame(f"{type(error).__name__}: {error}") from error
