# Everything runs in .venv, which the first target makes from requirements/lock.txt (tools/bootstrap.py says how).
PYTHON ?= python3
VENV_PYTHON = .venv/bin/python
ARGS ?=

# No display is needed, or used where there is one.
export MPLBACKEND = Agg
# One thread: the order of a threaded sum depends on the number of cores, and with it the last digits of a result.
export OPENBLAS_NUM_THREADS = 1
export OMP_NUM_THREADS = 1
# Packages are installed uncompiled; where byte code may not be kept, every `import sympy` costs 3 s instead of 0.6 s.
unexport PYTHONDONTWRITEBYTECODE
# Packages of another Python (module load, for one) must not stand in front of the locked ones.
unexport PYTHONPATH
unexport PYTHONHOME

.PHONY: help figures figures-full test derivations docs lint bench clean distclean lock

help:           ## this list
	@sed -n 's/^\([a-z-]*\):[^#]*## /\1	/p' Makefile | expand -t 14

figures: .venv/.ok        ## draw every figure into figures/out (ARGS= goes to python -m figures)
	$(VENV_PYTHON) -m figures $(ARGS)

figures-full: .venv/.ok   ## the same with the fine runs of N1 to N3, an hour; stopped, it goes on where it was
	$(VENV_PYTHON) -m figures --full $(ARGS)

test: .venv/.ok           ## the tests but for the slow ones (ARGS= goes to pytest; ARGS='-m ""' runs all, as .ci/run does)
	$(VENV_PYTHON) -m pytest -n 2 -m "not slow" $(ARGS)

derivations: .venv/.ok    ## derive the equations again, to verdicts (ARGS= goes to python -m derivations)
	$(VENV_PYTHON) -m derivations $(ARGS)

docs: .venv/.ok           ## compute the tables of docs/closures.md again
	$(VENV_PYTHON) -m docs.tables

lint: .venv/.lint         ## ruff, its formatter, mypy
	.venv/bin/ruff check .
	.venv/bin/ruff format --check .
	$(VENV_PYTHON) -m mypy

bench: .venv/.ok          ## the speed and accuracy measurements (ARGS= goes to python -m benchmarks)
	$(VENV_PYTHON) -m benchmarks $(ARGS)

clean:          ## remove figures/out and caches; .venv stays
	rm -rf figures/out build dist .pytest_cache .mypy_cache .ruff_cache .hypothesis
	find . -path ./.venv -prune -o -name __pycache__ -type d -prune -exec rm -rf {} +

distclean: clean          ## clean, and remove .venv
	rm -rf .venv

LOCK = uv pip compile --quiet --universal --generate-hashes --python-version 3.11 --prerelease disallow \
       --custom-compile-command "make lock" $(ARGS)
lock:           ## write requirements/ anew from pyproject.toml; needs uv (ARGS=--upgrade takes the newest)
	$(LOCK) --extra certify --group test pyproject.toml -o requirements/lock.txt
	$(LOCK) --group lint --constraints requirements/lock.txt -o requirements/lint.txt

.venv/.ok: requirements/lock.txt tools/bootstrap.py
	@$(PYTHON) tools/bootstrap.py

.venv/.lint: requirements/lint.txt .venv/.ok
	@$(PYTHON) tools/bootstrap.py requirements/lint.txt
	@touch $@
