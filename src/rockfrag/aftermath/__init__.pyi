from .shakemap import (
    MappedShaking as MappedShaking,
    ShakeMap as ShakeMap,
    read_shakemap as read_shakemap,
)
from .shaken_ground import (
    GroundShaking as GroundShaking,
    mapped_ground as mapped_ground,
    recorded_ground as recorded_ground,
)
from .shaken_objects import (
    ShakenCollection as ShakenCollection,
    ShakenObject as ShakenObject,
    after_earthquake as after_earthquake,
    shaken_table as shaken_table,
)
