# Everything is installed into .venv of this folder; nothing else of the machine is touched,
# but for the system packages a window needs, when run as root on Debian or Ubuntu.

PYTHON ?= python3
VENV := .venv
BIN := $(VENV)/bin
STAMP := $(VENV)/.installed
# Several threads in the numeric libraries only get into each other's way: the program runs its own.
export OMP_NUM_THREADS := 1
export OPENBLAS_NUM_THREADS := 1
TEST_ENV := QT_QPA_PLATFORM=offscreen VTK_DEFAULT_OPENGL_WINDOW=vtkEGLRenderWindow

.PHONY: help install demo gui test screen fast lint bench screenshots lock clean

help: ## what can be made
	@grep -E '^[a-z]+:.*##' Makefile | sed 's/:.*##/ -/'

install: $(STAMP) ## set everything up

$(STAMP): pyproject.toml constraints.txt tools/setup.py
	@$(PYTHON) tools/setup.py $(VENV)
	@touch $@

demo: install ## a filmed animal moves a character: video, meshes and project in out/
	@$(BIN)/motionwright demo out

gui: install ## open the window on the sample project
	@$(BIN)/motionwright gui

test: install ## all tests
	@$(TEST_ENV) $(BIN)/python -m pytest -n 2 --dist loadgroup

screen: install ## the window's tests on virtual X screens (needs Xvfb and the X libraries of docs/install.md)
	@QT_QPA_PLATFORM=xcb $(BIN)/python -m pytest -n 2 --dist loadgroup tests/window

fast: install ## the tests that take less than five seconds each
	@$(TEST_ENV) $(BIN)/python -m pytest -n 2 --dist loadgroup -m "not slow and not realdata"

lint: install ## form, types and layers
	@$(BIN)/ruff format --check .
	@$(BIN)/ruff check .
	@$(BIN)/mypy
	@$(BIN)/lint-imports
	@$(BIN)/python tools/check_sizes.py

bench: install ## figures beside their baselines, in build/bench.json
	@$(TEST_ENV) $(BIN)/python -m pytest -m bench -o python_files='bench_*.py' -p no:xdist -o timeout=3600 tests/benchmarks
	@$(BIN)/python -m tests.benchmarks.summary

screenshots: install ## pictures of the window in docs/screenshots
	@$(TEST_ENV) $(BIN)/python tools/screenshots.py

lock: install ## write the versions that were tested to constraints.txt
	@$(BIN)/python tools/lock.py

clean: ## remove what was built
	rm -rf $(VENV) build dist out *.egg-info .pytest_cache .mypy_cache .ruff_cache .hypothesis .import_linter_cache
