# deamat: `make all` reprocesses raw/ into processed/, `make test` runs the tests, `make help` lists the rest.
VENV := .venv
BIN := $(VENV)/bin
PIP := $(BIN)/pip --disable-pip-version-check --quiet
PYTHON ?= python3.11

.DEFAULT_GOAL := help
.PHONY: all paper test check bench chart stability docs help clean

all: $(VENV)/.runtime  ## reprocess raw/ into processed/: read, fit, refuse, publish cards
	@$(BIN)/deamat all

paper: all  ## write processed/paper/: the article's numbers, printed beside recomputed
	@$(BIN)/deamat paper

test: $(VENV)/.dev  ## run the whole test suite
	@$(BIN)/python -m pytest --numprocesses=auto --dist=loadfile

check: $(VENV)/.dev  ## style, types and import contracts
	@mkdir -p .link && ln -sfn ../pipeline .link/deamat
	@$(BIN)/ruff check . && $(BIN)/ruff format --check . && $(BIN)/mypy && $(BIN)/lint-imports

bench: $(VENV)/.dev  ## measure speed against rivals (ratios in one run)
	@$(BIN)/python -m benchmarks.read_and_fit

chart: $(VENV)/.dev  ## draw accuracy against speed of all estimators (simulated)
	@$(BIN)/python -m benchmarks.chart

stability: $(VENV)/.dev  ## map where estimators hold, flag, refuse or are silently wrong (simulated)
	@$(BIN)/python -m benchmarks.stability

docs: $(VENV)/.dev  ## write docs/benchmarks.md, reading-speed.md and the pictures of docs/methods anew
	@$(BIN)/python -m benchmarks.chart --docs && $(BIN)/python -m benchmarks.stability --docs
	@$(BIN)/python -m benchmarks.read_and_fit --docs

clean:  ## forget everything that can be made again
	rm -rf $(VENV) && find processed -mindepth 1 ! -name README.md -delete

$(VENV)/.runtime: pyproject.toml constraints.txt
	@test -d $(VENV) || $(PYTHON) -m venv $(VENV)
	@$(PIP) install -c constraints.txt setuptools
	@$(PIP) install -c constraints.txt --no-build-isolation -e .
	@touch $@

$(VENV)/.dev: $(VENV)/.runtime
	@$(PIP) install -c constraints.txt --no-build-isolation -e '.[dev,bench]'
	@touch $@

help:  ## print this chain
	@awk -F ':.*## ' '/^[a-z]+:.*## / {printf "make %-10s %s\n", $$1, $$2}' $(MAKEFILE_LIST)
