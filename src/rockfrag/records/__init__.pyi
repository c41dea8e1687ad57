from .catalogue import (
    load_motions as load_motions,
    read_catalogue as read_catalogue,
)
from .make_catalogue import make_catalogue as make_catalogue
from .motion import (
    Motion as Motion,
    read_motion_set as read_motion_set,
    write_motion_set as write_motion_set,
)
from .read import (
    Record as Record,
    read_motion as read_motion,
    read_record as read_record,
)
from .write import (
    write_motion as write_motion,
    write_motions as write_motions,
)
