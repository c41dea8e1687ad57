from .answer import Constrained as Constrained, constrain as constrain
from .reweight import Reweighted as Reweighted
from .site import Site as Site, read_site as read_site
