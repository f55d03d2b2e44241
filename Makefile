# Two commands do all the set-up: `make demo` and `make test`. Everything lives in .venv.
PYTHON ?= python3
VENV   := .venv
BIN    := $(VENV)/bin
COMPILED := $(addprefix tests/checker/engines/fast/test_,rows.py checkpoints.py long_runs.py spill.py)
STAMP  := $(VENV)/.installed
USABLE := $(VENV)/.usable
WHEEL  := .wheel
PAGE   := adapters/console/page
PARTS  := $(PAGE)/parts/LICENSES.txt
SMOKE  := $(addprefix tests/,missions paper semantics/state/test_cell_values.py \
	$(addprefix bigactors/test_,big.py cli.py mission_lookup.py public_names.py run.py))

.PHONY: parts demo live-demo test tests test-long lint types test-wheel wheel constraints storm fuzz mutants bounds bench bench-bigraphs bench-time time-oracle docs pictures clean

$(STAMP): pyproject.toml
	$(PYTHON) -m venv $(VENV)
	$(BIN)/python -m pip install --quiet --disable-pip-version-check --editable '.[dev]'
	touch $@

$(USABLE): pyproject.toml  # what a user installs; what is developed with comes with $(STAMP)
	[ -x $(BIN)/python ] || $(PYTHON) -m venv $(VENV)
	[ -e $(STAMP) ] || $(BIN)/python -m pip install --quiet --disable-pip-version-check --editable '.[ais]'
	touch $@

parts: $(PARTS)  ## what the console's page is made of, by npm; without npm all works but the console

$(PARTS): $(PAGE)/package-lock.json | $(STAMP)
	$(BIN)/python hatch_build.py parts

demo: $(USABLE)  ## check the shipped missions and draw them
	$(BIN)/bigactors demo --out demo

live-demo: $(STAMP) $(PARTS)  ## fly a verified mission with a simulated plane and a replayed AIS feed, into live-demo/; CONSOLE=1 serves the console
	$(BIN)/python -m bigactors.live_demo live-demo $(if $(CONSOLE),--console)

# Processes that the tests start would compile all modules again where no bytecode is kept.
tests test-long fuzz: export PYTHONDONTWRITEBYTECODE =

test: lint  ## what must hold at each change; of generated tests a part (tests/scale.py)
	$(MAKE) --jobs 2 types tests

tests: $(STAMP) $(PARTS)
	$(BIN)/python -m pytest -n 3 --dist worksteal -q -m "not long"

test-long: $(STAMP) $(PARTS)  ## whole flights, killed processes, workers, compilations, more of what is generated (some 10 minutes)
	BIGACTORS_LONG=1 $(BIN)/python -m pytest -n 2 --dist worksteal -q -m "long or hypothesis" --timeout 1500

lint: $(STAMP)
	$(BIN)/ruff check .
	$(BIN)/ruff format --check .

types: $(STAMP)
	$(BIN)/mypy

wheel: $(STAMP) $(PARTS)  ## what is released, into dist/: the source, and the wheel that is made of it
	rm -rf dist
	$(BIN)/python -m hatchling build -t sdist
	$(BIN)/python -m pip wheel --quiet --disable-pip-version-check --no-deps --no-build-isolation --wheel-dir dist dist/*.tar.gz

test-wheel: wheel  ## a quick part of the suite against the installed wheel, with the repository out of its reach
	rm -rf $(WHEEL)
	$(PYTHON) -m venv $(WHEEL)
	$(WHEEL)/bin/python -m pip install --quiet --disable-pip-version-check "$$(ls dist/*.whl)[ais,live,lsp,strategies]" pytest pytest-asyncio pytest-timeout pytest-xdist
	$(BIN)/python hatch_build.py tests $(WHEEL)/suite/tests
	mkdir $(WHEEL)/suite/specs
	cp -r specs/missions $(WHEEL)/suite/specs
	cp -r docs pyproject.toml $(WHEEL)/suite
	cd $(WHEEL)/suite && ../bin/pytest -n 2 -q $(SMOKE) --pyargs bigactors
	cd $(WHEEL) && bin/bigactors demo --out demo

constraints:  ## write constraints.txt anew: the newest of all that is needed, in a new .venv; then `make test`
	rm -rf $(VENV)
	PIP_CONSTRAINT= $(MAKE) $(STAMP) storm
	echo '# The versions of all that .[dev] and .[storm] need with which CI tests; `make constraints` writes them. A user installs without this file.' > constraints.txt
	$(BIN)/python -m pip freeze --exclude-editable >> constraints.txt

storm: $(STAMP)  ## the model checker Storm, for `big check --storm` and its tests, where there is a wheel of it
	$(BIN)/python -m pip install --quiet --disable-pip-version-check --only-binary stormpy --editable '.[storm]'

fuzz: $(STAMP)  ## the long tests whole, 100,000 mutated missions, a million mutated packets and sentences, flights for BIGACTORS_FLIGHTS_MINUTES=30 from where the last run ended (nightly: an hour or more)
	BIGACTORS_FUZZ=100000 BIGACTORS_FUZZ_PACKETS=1000000 $(BIN)/python -m pytest -n 2 -q --timeout 0 -m "fuzz or hypothesis"

mutants: $(STAMP)  ## change semantics/ and the reductions one operator at a time: which changes does no test notice? (nightly; MUTANTS=semantics.control* for a part)
	$(BIN)/python -m pip install --quiet --disable-pip-version-check 'mutmut>=3.8'
	-timeout --signal=INT $(or $(TIME),150m) $(BIN)/python -m mutmut run --max-children 2 $(MUTANTS) | tr '\r' '\n' | tail -n 1
	$(BIN)/python -m mutmut results | grep -E ': (survived|timeout|suspicious)' || true
	$(BIN)/python -m mutmut export-cicd-stats && cat mutants/mutmut-cicd-stats.json

bounds: $(STAMP)  ## the compiled loops with checks of bounds over all missions, cut and gone on with at many sizes (nightly: some 40 minutes)
	NUMBA_BOUNDSCHECK=1 NUMBA_CACHE_DIR=.numba-bounds $(BIN)/python -m pytest -n 2 -q --timeout 0 -m bounds
	NUMBA_BOUNDSCHECK=1 NUMBA_CACHE_DIR=.numba-bounds $(BIN)/python -m pytest -n 2 -q $(COMPILED)

bench: $(STAMP)  ## the explorer beside SPIN, and wide missions; writes docs/explanation/performance.md (some 10 minutes)
	$(BIN)/python benchmarks/run.py
	$(BIN)/python benchmarks/wide.py
	$(BIN)/python benchmarks/tables.py

bench-bigraphs: $(STAMP)  ## the bigraph engine beside BigraphER, up to 100,000 states, and on the real files in the folder $BIGRAPHS
	$(BIN)/python benchmarks/bigraph_systems.py --growth
	$(BIN)/python benchmarks/real_bigraphs.py

bench-time: $(STAMP)  ## zones of the timed family; TCHECKER=tck-reach puts TChecker's beside them
	$(BIN)/python benchmarks/timed.py

time-oracle: $(STAMP)  ## TChecker's verdicts on shipped missions with times and 200 generated ones; TCHECKER=tck-reach
	BIGACTORS_FUZZ=1 $(BIN)/python -m pytest tests/checker/engines/zones/test_tchecker.py

docs: $(STAMP)  ## write the generated pages of docs/, and all of them as a site, into site/
	$(BIN)/python -m bigactors.docs
	$(BIN)/python -m sphinx -W --keep-going --quiet -c docs . site

pictures: $(STAMP) $(PARTS)  ## draw the README's pictures again; the page of a trace and the console with chromium
	rm -rf .pictures
	for mission in oil_spill broken_inconsistent look_before_entry_racy; do \
		$(BIN)/bigactors check $$mission --trace .pictures > /dev/null; done; true
	$(BIN)/bigactors show --trace .pictures/oil_spill/over_the_spill-witness/trace.json --output docs/pictures/oil_spill.svg
	$(BIN)/bigactors show --trace .pictures/broken_inconsistent/local_consistency-inconsistent/trace.json \
		--output docs/pictures/broken_inconsistent.svg
	chromium --headless --no-sandbox --hide-scrollbars --window-size=1400,940 --screenshot=docs/pictures/trace_page.png \
		"file://$(CURDIR)/.pictures/look_before_entry_racy/race_freedom-stale-observation_race/trace.html#c12"
	$(BIN)/python -m bigactors.live_demo .pictures/flight
	$(BIN)/python tests/console_picture.py .pictures/flight/run.mcap docs/pictures/console.png

clean:
	rm -rf $(VENV) $(WHEEL) mutants $(PAGE)/node_modules $(PAGE)/parts .pictures .numba-bounds demo live-demo dist site .pytest_cache .mypy_cache .ruff_cache .hypothesis
