"""Exports of transition systems: for model checkers, drawing programs, and browsers."""

import lazy_loader

__getattr__, __dir__, __all__ = lazy_loader.attach_stub(__name__, __file__)
