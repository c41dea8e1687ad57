# make run      the thesis's study, from records to report (STUDY=config/other.yaml for another; VERBOSE=1)
# make smoke    a small study in under a minute
# make report-pdf  the report of STUDY on paper, by a browser of the Chromium family
# make test     the tests; make validate the long ones (PART=engines, statistics, pages or workflow for a part of them);
#               make coverage what they reach; make lint the checks of form
# make torture  a small study killed, starved and misused; make fuzz damaged inputs
#               (INPUTS=10000 for fewer), random requests of assess (REQUESTS=200), studies (STUDIES=20), calls (CALLS=50)
# make mutants  one line changed of what computes, MUTANTS=100 times: do the quick tests notice (SEED=1)
# make docs     the documentation as a site, docs/_build/index.html
# make bench    speed against other programs, and what a user waits for
# Only Python (3.11 or newer) and a package index are needed; everything else goes into .venv.
# Paths are relative throughout, so the checkout may stand anywhere, spaces included.

# jobs and tests are processes of their own; without bytecode each would translate all modules again
unexport PYTHONDONTWRITEBYTECODE

PYTHON ?= python3
STUDY ?= config/thesis.yaml
INPUTS ?= 1000000
REQUESTS ?= 2000
STUDIES ?= 500
CALLS ?= 200
# long tests by parts, so that none has to run for a whole night
PART ?= all
LONG_engines = tests/engines tests/simulation tests/system tests/base tests/scale
LONG_statistics = tests/validation tests/campaign tests/effects tests/fragility tests/survival thesis/tests
LONG_pages = tests/end_to_end tests/web tests/assess tests/aftermath tests/report
LONG_workflow = tests/workflow tests/project tests/records tests/cli
LONG_all = $(LONG_engines) $(LONG_statistics) $(LONG_pages) $(LONG_workflow)
MUTANTS ?= 100
SEED ?= 1
# one line a stage; all that Snakemake says with VERBOSE=1
SCREEN := $(if $(VERBOSE),,--logger rockfrag)
RUN := .venv/bin/python -m
PIP := $(RUN) pip install --quiet --disable-pip-version-check
# where the digests of all wheels are known they are checked (maintenance/pins.py writes them)
HASHES = requirements/$(shell "$(PYTHON)" -c 'import sys, platform; print(f"{sys.platform}-{platform.machine()}-py{sys.version_info[0]}{sys.version_info[1]}")').txt
# what failed has said so in a sentence, which stays the last: SIGQUIT makes make end with status 1 and without a word
# (where that signal is ignored, as in the background of some shells, make adds its line and ends with status 2)
QUIETLY := || { trap 'kill -QUIT $$PPID; sleep 1; exit 0' QUIT; kill -QUIT $$$$; exit 1; }

.PHONY: run smoke report-pdf test validate coverage lint docs bench fuzz torture mutants format
.DEFAULT_GOAL := run

run: .venv/installed
	@.venv/bin/python workflow/run.py "$(STUDY)" --cores all $(SCREEN) $(QUIETLY)

smoke: STUDY := config/smoke.yaml
smoke: run

report-pdf: .venv/installed
	@$(RUN) rockfrag.report.pdf "$(STUDY)"

# each process has a processor to itself, so threads of its linear algebra would only wait for each other
test validate coverage fuzz mutants: export OPENBLAS_NUM_THREADS = 1

test: .venv/installed
	@$(RUN) pytest -n auto --dist worksteal -m "not slow"

validate: .venv/installed
	@$(if $(LONG_$(PART)),,echo "PART: expected engines, statistics, pages or workflow, found $(PART)."; exit 2)
	@$(RUN) pytest -n auto --dist loadfile -m slow $(LONG_$(PART))

coverage: .venv/installed
	@$(RUN) pytest -n auto --dist worksteal -m "not slow" --cov --cov-report=term --cov-report=xml

lint: .venv/installed
	@$(RUN) ruff check .
	@$(RUN) ruff format --check .
	@$(RUN) mypy
	@$(RUN) codespell_lib
	@.venv/bin/python .venv/bin/snakefmt --check workflow thesis/src
	@$(RUN) snakemake --lint

format: .venv/installed
	@$(RUN) ruff format .
	@.venv/bin/python .venv/bin/snakefmt workflow thesis/src

fuzz: .venv/installed
	@$(RUN) tests.fuzz --inputs $(INPUTS)
	@$(RUN) tests.fuzz --only requests --inputs $(REQUESTS)
	@$(RUN) tests.fuzz --only studies --inputs $(STUDIES)
	@$(RUN) tests.fuzz --only commands --inputs $(CALLS)

torture: .venv/installed
	@$(RUN) tests.fault_injection

mutants: .venv/installed
	@$(RUN) tests.mutants --number $(MUTANTS) --seed $(SEED)

docs: .venv/installed
	@$(RUN) pip install --quiet --constraint requirements/constraints.txt --editable ".[docs]"
	@$(RUN) sphinx -q -E -W --keep-going -b html docs docs/_build
	@echo "docs/_build/index.html"

bench: .venv/installed
	@$(RUN) pip install --quiet --constraint requirements/constraints.txt --editable ".[peers]" || \
		echo "Not all other programs can be had here: rows of those that are absent are left out"
	@.venv/bin/python benchmarks/run.py
	@.venv/bin/python benchmarks/space.py || echo "MuJoCo cannot be had here: bodies in space are not compared"
	@.venv/bin/python benchmarks/latency.py

.venv/installed: pyproject.toml thesis/pyproject.toml requirements/constraints.txt $(wildcard requirements/*.txt)
	@"$(PYTHON)" -c 'import sys; sys.exit(sys.version_info < (3, 11) and "Python 3.11 or newer is needed, found " + sys.version.split()[0] + "; name another with make PYTHON=…")'
	@test -x .venv/bin/python || "$(PYTHON)" -m venv .venv
	@echo "Installing into .venv (once)"
	@if test -f "$(HASHES)"; then $(PIP) --require-hashes --no-deps --requirement "$(HASHES)" && \
		$(PIP) --no-deps --no-build-isolation --editable . --editable thesis; \
		else $(PIP) --constraint requirements/constraints.txt --editable ".[workflow,test,lint]" --editable thesis; fi
	@touch .venv/installed
