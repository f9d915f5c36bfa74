# deamat: `make all` reprocesses raw/ into processed/, `make test` runs the tests, `make help` lists the rest.
VENV := .venv
BIN := $(VENV)/bin
PIP := $(BIN)/python -m pip --disable-pip-version-check --quiet
PYTHON ?=
COUNT ?= 20000
QUICK := tests/core tests/formats tests/materials tests/actuator tests/run/test_incremental.py \
  tests/test_cli_design.py tests/test_public.py

.DEFAULT_GOAL := help
.PHONY: all paper test quick check shell bench chart stability mutants situations fuzz docs schema help clean

all: $(VENV)/.runtime  ## reprocess raw/ into processed/: read, fit, refuse, publish cards
	@$(BIN)/deamat all

paper: all  ## write processed/paper/: the article's numbers, printed beside recomputed
	@$(BIN)/deamat paper

test: $(VENV)/.dev  ## run the whole test suite
	@$(BIN)/python -m pytest --numprocesses=auto --dist=loadfile

quick: $(VENV)/.dev  ## the tests of half a minute: core, formats, cards, actuator, one small run
	@$(BIN)/python -m pytest --numprocesses=auto --dist=loadfile $(QUICK)

check: $(VENV)/.dev .link/deamat  ## style, types and import contracts
	@$(BIN)/ruff check . && $(BIN)/ruff format --check . && $(BIN)/mypy && $(BIN)/lint-imports

shell: $(VENV)/.runtime  ## a shell in which deamat can be called; `exit` leaves it
	@PATH="$$PWD/$(BIN):$$PATH" "$${SHELL:-sh}"

bench: $(VENV)/.dev  ## measure speed against rivals (ratios in one run)
	@$(BIN)/python -m benchmarks.read_and_fit

chart: $(VENV)/.dev  ## draw accuracy against speed of all estimators (simulated)
	@$(BIN)/python -m benchmarks.chart

stability: $(VENV)/.dev  ## map where estimators hold, flag, refuse or are silently wrong (simulated)
	@$(BIN)/python -m benchmarks.stability

mutants: $(VENV)/.dev  ## put 150 slips into each of three packages: how many do the tests notice?
	@$(BIN)/python -m benchmarks.mutation estimators materials
	@$(BIN)/python -m benchmarks.mutation run --tests tests/run tests/test_cli.py tests/test_cli_design.py

situations: $(VENV)/.dev  ## write docs/situations.md anew: how often a wrong number passes in silence (simulated)
	@$(BIN)/python -m benchmarks.situations --count 200 --docs

fuzz: $(VENV)/.dev  ## spoil COUNT=20000 good files and registers: crash, hang, silence? (goes on where it stopped)
	@$(BIN)/python -m benchmarks.fuzz --count $(COUNT)

docs: $(VENV)/.dev  ## write docs/benchmarks.md, reading-speed.md and the pictures of docs/methods anew
	@$(BIN)/python -m benchmarks.chart --docs && $(BIN)/python -m benchmarks.stability --docs
	@$(BIN)/python -m benchmarks.read_and_fit --docs

schema: $(VENV)/.runtime  ## write docs/card.schema.json, docs/registers/ and the table of forms from the code
	@$(BIN)/python -m deamat.materials.json_schema > docs/card.schema.json
	@$(BIN)/python -m deamat.run.register_schemas docs/registers
	@$(BIN)/python -m deamat.formats.forms_table docs/formats.md

clean:  ## forget everything that can be made again
	rm -rf $(VENV) && cd processed && find . ! -name . ! -name README.md -prune -exec rm -rf {} +

.link/deamat:  # the folder pipeline/ under the name that imports use, for mypy
	@mkdir -p .link && ln -s ../pipeline $@

$(VENV)/.runtime: pyproject.toml constraints.txt
	@sh .ci/venv $(VENV) $(PYTHON)
	@echo "installing into $(VENV), about a minute, once"
	@$(PIP) install -c constraints.txt setuptools
	@$(PIP) install -c constraints.txt --no-build-isolation -e .
	@touch $@

$(VENV)/.dev: $(VENV)/.runtime
	@echo "installing the tools for tests into $(VENV), about a minute, once"
	@$(PIP) install -c constraints.txt --no-build-isolation -e '.[dev]'
	@touch $@

help:  ## print this chain
	@awk -F ':.*## ' '/^[a-z]+:.*## / {printf "make %-10s %s\n", $$1, $$2}' $(MAKEFILE_LIST)
