"""Reading the sweeps of a study for the stages behind them, part by part."""

from collections.abc import Iterator

from rockfrag.shaketable.swept import Swept, read_swept
from rockfrag.stages.job import Job
from rockfrag.study.configurations import Configuration
from rockfrag.study.study import Study


def sweeps_of(
    job: Job[Study], configuration: Configuration, *, slid: bool = False
) -> Iterator[Swept]:
    """Yield the verdicts of a configuration, see :func:`rockfrag.shaketable.swept.read_swept`."""
    study = job.study
    jobs = range(study.sweep_jobs)
    files = (job.file(study.sweep_file(configuration, one)) for one in jobs)
    yield from read_swept(files, slid=slid)
