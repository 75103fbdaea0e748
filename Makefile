# A newcomer needs two commands: `make demo` and `make test`.
VENV ?= .venv
PYTHON ?= $(shell command -v python3.11 || command -v python3)
BIN := $(VENV)/bin
READY := $(VENV)/.ready

.PHONY: help setup demo test test-long lint types bench clean

help:  ## this list
	@grep -E '^[a-z-]+:.*##' $(MAKEFILE_LIST) | sed 's/:.*## /\t/' | expand -t 12

$(READY): pyproject.toml constraints.txt
	$(PYTHON) -m venv $(VENV)
	$(BIN)/python -m pip install --quiet --disable-pip-version-check -c constraints.txt -e '.[test]'
	touch $@

setup: $(READY)  ## the virtual environment, with everything that the other targets need

demo: $(READY)  ## the whole way: optimise Heli4, check it, time its cycle, write out/heli4
	$(BIN)/linkwright run heli4 --out out/heli4

test: lint types  ## ruff, mypy and the tests
	$(BIN)/python -m pytest -n 2 --dist worksteal -m "not long" --ignore=tests/bench

test-long: $(READY)  ## further cases of the tests, random trials and statistics; about 20 minutes
	$(BIN)/python -m pytest -n 2 --dist worksteal -m long --ignore=tests/bench

lint: $(READY)
	$(BIN)/ruff check .
	$(BIN)/ruff format --check .

types: $(READY)
	$(BIN)/mypy

bench: $(READY)  ## speed against a peer in the same run; rewrites the figures in the README
	-$(BIN)/python -m pip install --quiet --disable-pip-version-check -c constraints.txt -e '.[bench]'
	$(BIN)/python -m tests.bench

clean:  ## drop the environment and everything made
	rm -rf $(VENV) out build *.egg-info .mypy_cache .ruff_cache
