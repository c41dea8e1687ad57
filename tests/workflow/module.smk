configfile: "study.yaml"

module rockfrag:
    snakefile: {snakefile!r}
    config: {config}

use rule * from rockfrag as rf_*

rule everything:
    default_target: True
    input:
        rules.rf_all.input
