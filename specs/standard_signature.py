"""The kinds of the paper, which a mission declares by `signature standard`."""

from __future__ import annotations

from functools import cache
from typing import Final

from specs.diagnostics import Source
from specs.parser import parse
from specs.syntax import Kind, Signature

STANDARD: Final = """\
signature {
  kind Location contains Location, OilSpill, UAV, Vessel, Tanker, Drifter, Station
  kind OilSpill contains UAV, Vessel, Tanker, Drifter
  kind UAV driven
  kind Vessel driven carries Drifter, Station
  kind Tanker
  kind Drifter
  kind Station
}
"""


@cache
def standard_kinds() -> tuple[Kind, ...]:
    """Return the kinds that `signature standard` declares; their spans are in `STANDARD`."""
    (section,) = parse(Source("signature standard", STANDARD)).each(Signature)
    return section.kinds
