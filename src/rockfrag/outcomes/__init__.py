"""What comes out: outcomes of cases, bodies and contacts, and the limit states that are read off them."""

import lazy_loader

__getattr__, __dir__, __all__ = lazy_loader.attach_stub(__name__, __file__)
