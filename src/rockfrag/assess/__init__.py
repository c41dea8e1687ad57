"""One object at one place: does it rock, does it topple, how probable is that, and what helps?"""

import lazy_loader

__getattr__, __dir__, __all__ = lazy_loader.attach_stub(__name__, __file__)
