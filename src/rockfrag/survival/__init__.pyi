from .answer import (
    Constrained as Constrained,
    constrain as constrain,
)
from .branches import (
    Branch as Branch,
    read_branches as read_branches,
)
from .evidence import (
    Age as Age,
    StandingObject as StandingObject,
)
from .rates import (
    VelocityRelation as VelocityRelation,
)
from .reweight import (
    Reweighted as Reweighted,
    reweight as reweight,
)
from .site import (
    Site as Site,
    read_site as read_site,
)
