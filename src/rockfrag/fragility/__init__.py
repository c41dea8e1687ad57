"""Fragility: how probable is overturning at a given intensity of shaking, and how sure is that?"""

import lazy_loader

__getattr__, __dir__, __all__ = lazy_loader.attach_stub(__name__, __file__)
