"""Collections as museums export them: dimensions in words made an inventory (``docs/collections.md``)."""

import lazy_loader

__getattr__, __dir__, __all__ = lazy_loader.attach_stub(__name__, __file__)
