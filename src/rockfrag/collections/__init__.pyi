from .dimension_text import (
    Dimensions as Dimensions,
    Length as Length,
    read_dimensions as read_dimensions,
)
from .exported_table import (
    CollectedObject as CollectedObject,
    inventory_table as inventory_table,
    read_export as read_export,
)
