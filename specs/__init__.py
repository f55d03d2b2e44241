"""The mission language: from a text to a mission, or to the mistakes in it.

It knows nothing of exploration, vehicles or the command line. A mission passes through the modules in this order:

- `preprocessing` (bounds, comments)
- `grammar` and the builders of the `syntax` tree (`build_world`, `build_timing`, `build_behaviour`)
- `recovery`, `syntax_errors`, `common_mistakes` and `codes` (the mistakes)
- `diagnostics` (the printing of mistakes)

`construct_text`, `mission_layout` and `formatter` turn a tree into text.
"""

import lazy_loader

__getattr__, __dir__, __all__ = lazy_loader.attach_stub(__name__, __file__)
