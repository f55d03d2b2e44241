"""The kinds of the paper, declared by `signature standard`."""

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
    """Return the kinds of `signature standard`; their spans are offsets in `STANDARD`."""
    (section,) = parse(Source("signature standard", STANDARD)).each(Signature)
    return section.kinds
