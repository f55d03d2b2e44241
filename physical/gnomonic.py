"""Gnomonic frames on the ellipsoid: shortest lines are straight in them.

A shortest line between two points at most r metres from the centre leaves its chord by 0.11 m at r = 500 km, and by
1.7 m at r = 1,000 km (tests/physical/test_gnomonic.py measures it). Lengths are not kept: at r metres they are too long
by a share of at most r²/R² and a little.
"""

from __future__ import annotations

from physical.errors import GeometryError


class RegionError(GeometryError):
    """A region too large for its figures, or over a pole."""
