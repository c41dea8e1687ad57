"""Buildings: elastic and hysteretic shear models, floor motions, and how far they can be believed."""

import lazy_loader

__getattr__, __dir__, __all__ = lazy_loader.attach_stub(__name__, __file__)
