# Every target sets up what it needs; once set up, that costs nothing.
#   make demo       sew, hook, cover, judge, draw and score the demo seat; leaves out/demo/index.html
#   make test       the tests that take under 20 s each
#   make validate   the long ones: convergence, fuzzing, path tracing
#   make browser    the gallery page and the GLB in headless Chromium
#   make fuzz       damage to files of every format: what comes out of its reader
#   make check      style, types, import contract, spelling
#   make bench      timings
#   make docs       the reference, from the docstrings, in out/reference
VENV ?= .venv
OUT ?= out/demo
COUNT ?= 10000
BIN := $(VENV)/bin
PYTEST := $(BIN)/python -m pytest -q
TESTS := --doctest-modules tests src/seatlook

# Packages load their names on first use, which the reference does not see: it goes by modules.
MODULES := $(shell cd src && find seatlook -name '[a-z]*.py' -not -path '*/cli/*' \
	-not -path '*/kernels/*' | sort | sed 's|/|.|g; s|\.py$$||')

# Numba sees a change in the file of a kernel, not in the files of the kernels it calls.
export NUMBA_CACHE_DIR ?= $(CURDIR)/.numba_cache/$(shell find src -path "*/kernels/*.py" | LC_ALL=C sort | xargs cat | cksum | cut -d ' ' -f 1)

.PHONY: demo test validate browser fuzz check format bench docs clean
.DELETE_ON_ERROR:

demo: $(VENV)/.gl
	$(BIN)/seatlook demo --out $(OUT)

test: $(VENV)/.gl $(VENV)/.dev
	$(PYTEST) -n auto --dist loadfile --no-loadscope-reorder -m "not validate and not browser and not bench" $(TESTS)

validate: $(VENV)/.gl $(VENV)/.dev $(VENV)/.reference
	$(PYTEST) -m validate --timeout 3600 tests

browser: $(VENV)/.gl $(VENV)/.dev $(VENV)/.browser
	$(PYTEST) -m browser tests

bench: $(VENV)/.gl $(VENV)/.dev
	$(PYTEST) -m bench --timeout 3600 tests

# Paths of the environment are seen from here.
fuzz: $(VENV)/.dev
	cd tests && $(abspath $(BIN))/python -m support.fuzz --cover --count $(COUNT)

check: $(VENV)/.dev
	$(BIN)/ruff check .
	$(BIN)/ruff format --check .
	$(BIN)/mypy
	$(BIN)/lint-imports
	$(BIN)/codespell

docs: $(VENV)/.dev
	$(BIN)/python -m pip --disable-pip-version-check install --quiet --group docs
	$(BIN)/pdoc --docformat numpy --output-directory out/reference $(MODULES)

format: $(VENV)/.dev
	$(BIN)/ruff check --fix .
	$(BIN)/ruff format .

clean:
	rm -rf $(VENV) out

# The time of each stamp is the time of the last successful installation.
$(VENV)/.packages: pyproject.toml .ci/environment.sh
	bash .ci/environment.sh $(VENV)
	@touch $@

$(VENV)/.dev: $(VENV)/.packages
	$(BIN)/python -m pip --disable-pip-version-check install --quiet --group dev
	@touch $@

$(VENV)/.gl: $(VENV)/.packages .ci/gl.sh
	bash .ci/gl.sh $(VENV)
	@touch $@

$(VENV)/.reference: $(VENV)/.dev .ci/reference.sh
	bash .ci/reference.sh $(VENV)
	@touch $@

$(VENV)/.browser: $(VENV)/.dev .ci/browser.sh
	bash .ci/browser.sh $(VENV)
	@touch $@
