"""What is shaken: bodies, the contacts between them, and the ways in which people write a system."""

import lazy_loader

__getattr__, __dir__, __all__ = lazy_loader.attach_stub(__name__, __file__)
