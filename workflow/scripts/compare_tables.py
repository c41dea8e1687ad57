"""Compute Tables 3.1, 3.3 and 4.1 of the thesis beside their printed values."""

from rockfrag.files import write_table
from rockfrag.records.motion import read_motion_set
from rockfrag.stages.log import logged
from rockfrag.study.study import study_from
from rockfrag.thesis.printed_tables import (
    TABLE_3_1,
    TABLE_3_3,
    TABLE_4_1,
    block_properties,
    compare,
    ground_measures,
    uplift_table,
)

with logged(snakemake.log[0], "tables") as log:
    study = study_from(snakemake.config, snakemake.params.study)
    computed = {
        "table_3_1": (block_properties(study.specimens), TABLE_3_1),
        "table_3_3": (ground_measures(read_motion_set(snakemake.input.motions)), TABLE_3_3),
        "table_4_1": (uplift_table(study.configurations), TABLE_4_1),
    }
    for number, (name, (table, quantities)) in enumerate(computed.items()):
        printed = study.printed and study.printed / f"{name}.csv"
        beside = compare(table, quantities, printed)
        write_table(beside, *snakemake.output[2 * number : 2 * number + 2])
        known = beside["agrees"].dropna()
        log.info("%s: %d of %d printed values agree", name, known.sum(), len(known))
