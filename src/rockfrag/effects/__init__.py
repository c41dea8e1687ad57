"""The effect of a pedestal on overturning: d = ln a_P - ln a_NP, tested as a referee would."""

import lazy_loader

__getattr__, __dir__, __all__ = lazy_loader.attach_stub(__name__, __file__)
