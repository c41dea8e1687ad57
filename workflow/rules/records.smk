# Records out of pinned packages, into a shared folder: fetched once, whatever study asks for them.


rule fetch_records:
    output:
        "resources/records/{source}/provenance.json",
    log:
        "resources/logs/fetch_{source}.log",
    wildcard_constraints:
        source="[a-z0-9-]+",
    retries: 2
    conda:
        "../envs/rockfrag.yaml"
    script:
        "../scripts/fetch_records.py"
