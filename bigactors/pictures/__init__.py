"""Pictures of configurations, the bigraph beside the map, and of traces; SVG or PNG, the same bytes every time.

Nothing is decided here: what is believed, what is actual and what changed is asked of `semantics`.
"""

from bigactors.pictures.configuration import draw_configuration
from bigactors.pictures.page import PictureError
from bigactors.pictures.trace import draw_overview, draw_trace

__all__ = ["PictureError", "draw_configuration", "draw_overview", "draw_trace"]
