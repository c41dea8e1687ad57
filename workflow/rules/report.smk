# The report: printed tables beside computed ones, figures, and the page that tells the findings.


rule compare_tables:
    input:
        motions=f"{RESULTS}/motions/ground.parquet",
        specimens=str(STUDY.specimens_file),
        configurations=str(STUDY.configurations_file),
        printed=PRINTED,
    output:
        tables("table_3_1", "table_3_3", "table_4_1"),
    log:
        f"{RESULTS}/logs/compare_tables.log",
    conda:
        "../envs/rockfrag.yaml"
    params:
        study=STUDY_FILE,
        settings=settings("bodies", "printed"),
        code=source_digest("report"),
    script:
        "../scripts/compare_tables.py"


rule draw_figures:
    input:
        ground=f"{RESULTS}/motions/ground.parquet",
        sweeps=expand(
            f"{RESULTS}/sweep/{{configuration}}.parquet", configuration=CONFIGURATIONS
        ),
        tests=f"{RESULTS}/tests.parquet",
        effects=f"{RESULTS}/pedestal/effects.parquet" if STUDY.has_pairs else [],
    output:
        report(
            figures(*figure_names(STUDY)),
            category="Figures",
            caption="../report/figure.rst",
        ),
    log:
        f"{RESULTS}/logs/draw_figures.log",
    conda:
        "../envs/rockfrag.yaml"
    params:
        study=STUDY_FILE,
        settings=settings("bodies", "fragility"),
        code=source_digest("report"),
    script:
        "../scripts/draw_figures.py"


rule write_report:
    input:
        tables=[path for path in tables(*REPORT_TABLES) if path.endswith(".parquet")],
        figures=figures(*figure_names(STUDY), *supplement_figures(STUDY)),
    output:
        report(
            f"{RESULTS}/report.html",
            category="Report",
            caption="../report/report.rst",
        ),
    log:
        f"{RESULTS}/logs/write_report.log",
    conda:
        "../envs/rockfrag.yaml"
    params:
        study=STUDY_FILE,
        settings=json.dumps(config, sort_keys=True, default=str),
        code=source_digest("report"),
    script:
        "../scripts/write_report.py"
