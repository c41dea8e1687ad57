from .blocks import (
    Block as Block,
    Body as Body,
    Column as Column,
    Stack as Stack,
    as_system as as_system,
)
from .body import (
    Circle as Circle,
    Interval as Interval,
    Polygon as Polygon,
    RigidBody as RigidBody,
)
from .bond import Bond as Bond
from .constraints import Tie as Tie, Wall as Wall
from .contact import (
    Contact as Contact,
    Friction as Friction,
    ImpactLaw as ImpactLaw,
)
from .kinds import (
    Kind as Kind,
    block_of_kind as block_of_kind,
    kind_named as kind_named,
)
from .mesh import (
    Shape as Shape,
    read_shape as read_shape,
)
from .support import (
    BilinearIsolator as BilinearIsolator,
    SlidingPendulum as SlidingPendulum,
)
from .system import (
    Start as Start,
    System as System,
    hold as hold,
)
