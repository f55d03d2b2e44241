"""Pictures of configurations, the bigraph beside the map, and of traces, as SVG or PNG; the bytes are reproducible.

Beliefs, the actual world and changes come from `semantics`; nothing is decided here.
"""

from bigactors.pictures.configuration import Look, draw_configuration, look_of
from bigactors.pictures.page import PictureError
from bigactors.pictures.panels import Panels, Picture, logical_svg
from bigactors.pictures.scene import channels_of, shown_names
from bigactors.pictures.trace import draw_overview, draw_trace

__all__ = [
    "Look",
    "Panels",
    "Picture",
    "PictureError",
    "channels_of",
    "draw_configuration",
    "draw_overview",
    "draw_trace",
    "logical_svg",
    "look_of",
    "shown_names",
]
