from .catalogue import (
    load_motions as load_motions,
    read_catalogue as read_catalogue,
)
from .integration import (
    integrate as integrate,
    peak_displacement as peak_displacement,
    peak_velocity as peak_velocity,
)
from .make_catalogue import make_catalogue as make_catalogue
from .motion import (
    Motion as Motion,
    read_motion_set as read_motion_set,
    write_motion_set as write_motion_set,
)
from .peer_search import read_search_results as read_search_results
from .read import (
    Record as Record,
    read_motion as read_motion,
    read_record as read_record,
)
from .sources.wheel import fetch_wheel as fetch_wheel
from .write import (
    write_motion as write_motion,
    write_motions as write_motions,
)
