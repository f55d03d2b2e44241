"""Pictures as SVG: shapes and text on a canvas, with the widths of text, and the same picture as PNG.

It has its own font, so a picture has the same bytes on every machine. It knows nothing of bigraphs or of
maps, and every room may import it.
"""

import lazy_loader

__getattr__, __dir__, __all__ = lazy_loader.attach_stub(__name__, __file__)
