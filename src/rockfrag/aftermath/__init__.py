"""After an earthquake: which objects to look at first, and the same objects for the programs of others."""

import lazy_loader

__getattr__, __dir__, __all__ = lazy_loader.attach_stub(__name__, __file__)
