"""Let the study's building feel every ground motion, and keep the motions of its floors."""

from rockfrag.building.floors import floor_motions
from rockfrag.building.settings import read_building
from rockfrag.records.motion import read_motion_set, write_motion_set
from rockfrag.stages.floors import on_the_ground
from rockfrag.stages.log import logged

with logged(snakemake.log[0], "building") as log:
    ground = read_motion_set(snakemake.input.motions)
    if snakemake.input.get("building"):
        building = read_building(snakemake.input.building)
        motions = [floor for one in ground for floor in floor_motions(building, one)]
    else:
        motions = [on_the_ground(one) for one in ground]
    write_motion_set(motions, snakemake.output[0])
    log.info("%d motions of %d records", len(motions), len(ground))
