# Two commands do all the set-up: `make demo` and `make test`. Everything lives in .venv.
PYTHON ?= python3
VENV   := .venv
BIN    := $(VENV)/bin
COMPILED := $(addprefix tests/checker/engines/fast/test_,rows.py checkpoints.py long_runs.py spill.py hash_compaction.py)
STAMP  := $(VENV)/.installed

.PHONY: demo live-demo test lint types fuzz bounds bench bench-bigraphs bench-cluster docs clean

$(STAMP): pyproject.toml
	$(PYTHON) -m venv $(VENV)
	$(BIN)/python -m pip install --quiet --disable-pip-version-check --editable '.[dev]'
	touch $@

demo: $(STAMP)  ## check the shipped missions and draw them
	$(BIN)/bigactors demo --out demo

live-demo: $(STAMP)  ## fly a verified mission with a simulated plane and a replayed AIS feed, into live-demo/
	$(BIN)/python -m bigactors.live_demo live-demo

test: lint types $(STAMP)  ## everything that must hold
	$(BIN)/python -m pytest -n 2 -q

lint: $(STAMP)
	$(BIN)/ruff check .
	$(BIN)/ruff format --check .

types: $(STAMP)
	$(BIN)/mypy

fuzz: $(STAMP)  ## 100,000 mutated missions, a million mutated packets and sentences (some 25 minutes on two cores)
	BIGACTORS_FUZZ=100000 BIGACTORS_FUZZ_PACKETS=1000000 $(BIN)/python -m pytest -n 2 -q -m fuzz

bounds: $(STAMP)  ## the compiled loops with checks of bounds over all missions, cut and gone on with at many sizes (nightly: some 40 minutes)
	NUMBA_BOUNDSCHECK=1 NUMBA_CACHE_DIR=.numba-bounds $(BIN)/python -m pytest -n 2 -q -m bounds
	NUMBA_BOUNDSCHECK=1 NUMBA_CACHE_DIR=.numba-bounds $(BIN)/python -m pytest -n 2 -q $(COMPILED)

bench: $(STAMP)  ## the explorer beside SPIN, its growth, the largest missions; writes docs/performance.md (some 25 minutes)
	$(BIN)/python benchmarks/run.py
	$(BIN)/python benchmarks/growth.py
	$(BIN)/python benchmarks/largest.py
	$(BIN)/python benchmarks/tables.py

bench-bigraphs: $(STAMP)  ## the bigraph engine beside BigraphER, up to 100,000 states
	$(BIN)/python benchmarks/bigraph_systems.py --growth

bench-cluster: $(STAMP)  ## the patrol with Ray workers beside one process (some 5 minutes)
	$(BIN)/python benchmarks/cluster.py 2x6 2x6+handover

docs: $(STAMP)  ## write the generated pages of docs/
	$(BIN)/python -m bigactors.docs

clean:
	rm -rf $(VENV) .numba-bounds demo live-demo dist .pytest_cache .mypy_cache .ruff_cache .hypothesis
