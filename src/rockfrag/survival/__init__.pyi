from .reweight import (
    Constrained as Constrained,
    Reweighted as Reweighted,
    constrain as constrain,
)
from .site import Site as Site, read_site as read_site
