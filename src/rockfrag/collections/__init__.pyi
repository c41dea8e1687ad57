from .dimension_text import (
    Dimensions as Dimensions,
    Length as Length,
    read_dimensions as read_dimensions,
)
from .exported_table import (
    CollectedObject as CollectedObject,
    inventory_cells as inventory_cells,
    inventory_table as inventory_table,
    is_export as is_export,
    read_export as read_export,
    table_cells as table_cells,
)
