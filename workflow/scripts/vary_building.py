"""Change one assumption about the building at a time, and follow amplitudes and statements."""

from rockfrag.files import write_table
from rockfrag.records.motion import read_motion_set
from rockfrag.shaketable.sensitivity import Specimen, building_sensitivity, building_variants
from rockfrag.stages.log import logged
from rockfrag.stages.protocol import protocol_of
from rockfrag.study.study import study_from
from rockfrag.study.yaml_file import read_yaml

with logged(snakemake.log[0], "sensitivity") as log:
    study = study_from(snakemake.config, snakemake.params.study)
    building = snakemake.input.building
    variants = building_variants(read_yaml(building), study.more.sensitivity, building)
    specimens = [
        Specimen(one.name, one.object, one.label, one.body) for one in study.configurations
    ]
    tests, margins = building_sensitivity(
        variants,
        read_motion_set(snakemake.input.motions),
        specimens,
        study.amplitudes.values_g,
        protocol_of(study),
        snakemake.threads,
        lambda done: log.info("%d of %d buildings", done, len(variants)),
    )
    for number, table in enumerate((tests, margins)):
        write_table(table, *snakemake.output[2 * number : 2 * number + 2])
