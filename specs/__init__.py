"""The mission language: from a text to a mission, or to the mistakes in it.

It knows nothing of exploring configurations, of vehicles or of the command line. The way of a mission through the
modules: `text` (bounds, comments), `grammar` and the two builders (`build_world`, `build_behaviour`), `syntax` (the
tree), `recovery`, `syntax_errors`, `common_mistakes` and `codes` (what can be wrong), `diagnostics` (how it is
printed); and back to text: `writing`, `layout`, `formatter`.
"""

import lazy_loader

__getattr__, __dir__, __all__ = lazy_loader.attach_stub(__name__, __file__)
