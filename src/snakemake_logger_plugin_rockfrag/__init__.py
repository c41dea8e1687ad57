"""The screen of a run: one line a stage with what it found, how far the run is and what it still takes.

Snakemake finds this package by its name: ``snakemake --logger rockfrag``.
"""

import logging
import sys
import time
from collections import Counter
from collections.abc import Mapping
from pathlib import Path

from snakemake_interface_logger_plugins.base import LogHandlerBase
from snakemake_interface_logger_plugins.common import LogEvent

from rockfrag.stages.log import KILLED, last_finding, last_seconds, says_why

__all__ = ["LogHandler"]


class LogHandler(LogHandlerBase):
    """Prints what people want to know of Snakemake's messages, and leaves out the rest."""

    # it replaces Snakemake's own lines, leaves its log file alone, and chooses and words by itself
    writes_to_stream = True
    writes_to_file = False
    has_filter = True
    has_formatter = True
    needs_rulegraph = False

    def __post_init__(self) -> None:
        """Start with nothing known."""
        # with Snakemake 9.0 nobody else does
        logging.Handler.__init__(self)
        self.start = time.monotonic()
        self.report = Path()
        self.failed = False
        self.running: dict[int, tuple[str, Path, float]] = {}
        self.waiting: Counter[str] = Counter()
        self.done: Counter[str] = Counter()

    def emit(self, record: logging.LogRecord) -> None:
        """Print a line about what happened, if it concerns people."""
        event, about = getattr(record, "event", None), record.__dict__
        if event == LogEvent.RUN_INFO:
            rules = {
                rule: n
                for rule, n in about["stats"].items()
                if rule not in ("all", "total")
            }
            self.waiting = Counter(rules)
        elif event == LogEvent.JOB_INFO:
            log = Path(about["log"][0] if about["log"] else "")
            self.running[about["jobid"]] = about["rule_name"], log, time.time()
            # Snakemake 9.0 does not hand on what is said of the report while the rules are read
            made = [Path(str(file)) for file in about.get("output") or ()]
            self.report = next(
                (file for file in made if file.name == "report.html"), self.report
            )
        elif event == LogEvent.JOB_FINISHED:
            self._finish(int(about["job_id"]))
        elif event == LogEvent.JOB_ERROR:
            self._fail(int(about["jobid"]))
        elif "report" in about:
            self.report = Path(about["report"])
        elif str(record.msg).startswith("Nothing to be done"):
            _say(f"Nothing to do; the report is {self.report}")
        elif str(record.msg).startswith("Terminating processes on user request"):
            self.failed = True
            _say("stopped; the same command takes it up again")
        elif str(record.msg).startswith("RuleException"):
            self.failed = True
        elif record.levelno >= logging.ERROR and not self.failed:
            _say(record.getMessage().strip())

    def _fail(self, job: int) -> None:
        """Say that a job died, unless it has said itself what is wrong and where its log is."""
        self.failed = True
        # Snakemake 9.0 tells of a failed job twice
        rule, log, begun = self.running.pop(job, ("", Path(), 0.0))
        if rule and not says_why(log, begun):
            _say(f"{rule} failed: it {KILLED} (log: {log})")

    def _finish(self, job: int) -> None:
        """Say that a job has ended, with what it found, how long it took and what is left."""
        rule, log, _ = self.running.pop(job, ("all", Path(), 0.0))
        if self.waiting[rule]:
            left = self._left(rule)
            number = f"[{self.done.total()}/{self.done.total() + self.waiting.total()}]"
            took = _duration(last_seconds(log) or 0.0)
            _say(f"{number} {rule}: {last_finding(log)} ({took}{left})")
        elif not self.failed:
            _say(
                f"The report is {self.report} ({_duration(time.monotonic() - self.start)})"
            )

    def _left(self, rule: str) -> str:
        """Count a rule's job as done, and say what the rest takes if it goes as in an earlier run."""
        self.waiting[rule] -= 1
        self.done[rule] += 1
        done, rest = self._seconds_of(self.done), self._seconds_of(self.waiting)
        seconds = rest / done * (time.monotonic() - self.start)
        return f", about {_duration(seconds)} left" if seconds else ""

    def _seconds_of(self, rules: Mapping[str, int]) -> float:
        """Seconds that jobs of some rules took in an earlier run; 1 s for one that is not known."""
        logs = self.report.parent / "logs"
        total = 0.0
        for name, count in rules.items():
            total += count * (last_seconds(logs / f"{name}.log") or 1.0)
        return total


def _duration(seconds: float) -> str:
    return f"{seconds:.0f} s" if seconds < 90 else f"{seconds / 60:.0f} min"


def _say(line: str) -> None:
    print(line, file=sys.stderr, flush=True)
