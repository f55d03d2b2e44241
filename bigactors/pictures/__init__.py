"""Pictures of configurations, the bigraph beside the map, and of traces; the bytes of their files are reproducible.

Beliefs, the actual world and changes come from `semantics`; nothing is decided here.
"""

from bigactors.pictures.configuration_picture import (
    Look,
    Panels,
    draw_configuration,
    legend_picture,
    logical_picture,
    look_of,
)
from bigactors.pictures.region_marks import RegionMarks, marks_of
from bigactors.pictures.scene import channels_of, shown_names
from bigactors.pictures.trace import draw_overview, draw_trace

__all__ = [
    "Look",
    "Panels",
    "RegionMarks",
    "channels_of",
    "draw_configuration",
    "draw_overview",
    "draw_trace",
    "legend_picture",
    "logical_picture",
    "look_of",
    "marks_of",
    "shown_names",
]
