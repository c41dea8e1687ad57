"""The shaking table: its limits, the protocols of its tests, and tables of measured ones."""

import lazy_loader

__getattr__, __dir__, __all__ = lazy_loader.attach_stub(__name__, __file__)
