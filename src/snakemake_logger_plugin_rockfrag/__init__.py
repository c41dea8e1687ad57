"""The screen of a run: one line a stage with what it found, how far the run is and what it still takes.

Snakemake finds this package by its name: ``snakemake --logger rockfrag``.
"""

import logging
import sys
import time
from pathlib import Path
from typing import Any

from snakemake_interface_logger_plugins.base import LogHandlerBase
from snakemake_interface_logger_plugins.common import LogEvent

from rockfrag.stages.log import last_finding, last_seconds, says_why

__all__ = ["LogHandler"]


class LogHandler(LogHandlerBase):
    """Prints what people want to know of Snakemake's messages, and leaves out the rest."""

    def __post_init__(self) -> None:
        """Start with nothing known."""
        super().__post_init__()
        self.start = time.monotonic()
        self.report = ""
        self.failed = False
        self.total = 0
        self.done = 0
        self.running: dict[int, tuple[str, str]] = {}
        self.begun: dict[int, float] = {}
        self.waiting: dict[str, int] = {}
        self.expected: dict[str, float] = {}
        self.expected_done = 0.0

    @property
    def writes_to_stream(self) -> bool:
        """Replaces Snakemake's own lines."""
        return True

    @property
    def writes_to_file(self) -> bool:
        """Leaves Snakemake's log file alone."""
        return False

    @property
    def has_filter(self) -> bool:
        """Chooses by itself what to print."""
        return True

    @property
    def has_formatter(self) -> bool:
        """Words its lines itself."""
        return True

    @property
    def needs_rulegraph(self) -> bool:
        """Draws no graph."""
        return False

    def emit(self, record: logging.LogRecord) -> None:
        """Print a line about what happened, if it concerns people."""
        event = getattr(record, "event", None)
        if event == LogEvent.RUN_INFO:
            self._plan(record.stats)  # type: ignore[attr-defined]
        elif event == LogEvent.JOB_INFO:
            self._begin(record.__dict__)
        elif event == LogEvent.JOB_FINISHED:
            self._finish(int(record.job_id))  # type: ignore[attr-defined]
        elif event == LogEvent.JOB_ERROR:
            self._fail(int(record.jobid))  # type: ignore[attr-defined]
        elif str(record.msg).startswith("RuleException"):
            self.failed = True
        elif hasattr(record, "report"):
            self.report = str(record.report)
            self._remember()
        elif str(record.msg).startswith("Nothing to be done"):
            _say(f"Nothing to do; the report is {self.report}")
        elif record.levelno >= logging.ERROR and not self.failed:
            _say(str(record.getMessage()).strip())

    def _remember(self) -> None:
        """Take from the logs of an earlier run how long each stage took."""
        for log in (Path(self.report).parent / "logs").glob("*.log"):
            seconds = last_seconds(log)
            if seconds is not None:
                self.expected[log.stem] = seconds

    def _plan(self, stats: dict[str, int]) -> None:
        self.waiting = {rule: n for rule, n in stats.items() if rule not in ("all", "total")}
        self.total = sum(self.waiting.values())

    def _begin(self, job: dict[str, Any]) -> None:
        log = job["log"][0] if job["log"] else ""
        self.running[job["jobid"]] = (job["rule_name"], log)
        self.begun[job["jobid"]] = time.time()

    def _fail(self, job: int) -> None:
        """Say that a job died, unless it has said itself what is wrong and where its log is."""
        self.failed = True
        rule, log = self.running.pop(job, ("a job", ""))
        if not says_why(Path(log), self.begun.get(job, 0.0)):
            _say(
                f"{rule} failed: it was killed or ran out of memory; run the study again, with fewer "
                f"cores if it was memory (log: {log})"
            )

    def _finish(self, job: int) -> None:
        rule, log = self.running.pop(job, ("all", ""))
        if rule == "all":
            if not self.failed:
                _say(f"The report is {self.report} ({_duration(time.monotonic() - self.start)})")
            return
        self.done += 1
        self.expected_done += self._expected(rule)
        self.waiting[rule] -= 1
        left = self._left()
        end = f", about {_duration(left)} left" if left else ""
        took = last_seconds(Path(log)) or 0.0
        found = last_finding(Path(log))
        _say(f"[{self.done}/{self.total}] {rule}: {found} ({_duration(took)}{end})")

    def _expected(self, rule: str) -> float:
        """Seconds that a stage took before, or the mean of those that are known."""
        known = list(self.expected.values())
        return self.expected.get(rule, sum(known) / len(known) if known else 1.0)

    def _left(self) -> float:
        """Seconds that the run will still take, if the rest goes as what is done."""
        rest = sum(count * self._expected(rule) for rule, count in self.waiting.items())
        elapsed = time.monotonic() - self.start
        return rest * elapsed / self.expected_done if self.expected_done else 0.0


def _duration(seconds: float) -> str:
    if seconds < 90:
        return f"{seconds:.0f} s"
    return f"{seconds / 60:.0f} min"


def _say(line: str) -> None:
    print(line, file=sys.stderr, flush=True)
