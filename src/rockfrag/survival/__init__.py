"""What standing objects say about seismic hazard: branches of a logic tree reweighted by survival.

An object that has stood for T years makes branches of the hazard in which it would probably have toppled less
likely (Baker, Abrahamson, Whitney, Board and Hanks 2013, Bull. Seism. Soc. Am. 103: 2927-2939; Rood and others
2020, AGU Advances 1: e2020AV000182).
"""

import lazy_loader

__getattr__, __dir__, __all__ = lazy_loader.attach_stub(__name__, __file__)
