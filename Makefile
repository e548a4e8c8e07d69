# `make` alone lists the targets.

# The ROS distribution's name, and the Python versions that it has wheels for.
DISTRIBUTION := $(shell sed -n 's/^  "name": "\(.*\)",/\1/p' autograder/ros/distribution.json)
PYTHONS := $(shell sed -n '/^  "pythons"/{s/.*\[//;s/[]",]//g;p;}' autograder/ros/distribution.json)

# The first interpreter that runs (pyenv leaves shims that do not), that can create environments (Debian's may not), and
# that ROS has wheels for. The system's own comes early, because it is built with optimizations: it is a sixth faster.
SYSTEM_PYTHON ?= /usr/bin/python3
PYTHON ?= $(shell for python in $(firstword $(PYTHONS:%=python%)) $(SYSTEM_PYTHON) python3 $(PYTHONS:%=python%); do \
	$$python -c 'import ensurepip, sys; sys.exit("{}.{}".format(*sys.version_info) not in "$(PYTHONS)".split())' 2>/dev/null \
	&& echo $$python && exit; done; echo python3)
BIN := .venv/bin
BOOTSTRAP = $(PYTHON) -I autograder/bootstrap.py
# `autograder ros COMMAND` runs a command with ROS activated.
WITH_ROS := $(BIN)/autograder ros

# With this variable, each program that a test starts compiles the autograder again.
unexport PYTHONDONTWRITEBYTECODE
# If another virtual environment is active, IPython warns, and a warning fails a test.
unexport VIRTUAL_ENV

# More than the two cores of a small machine, because tests often wait. Unit tests do not.
WORKERS ?= 4
check: WORKERS := 2
PYTEST_ARGS ?=
LAB_ARGS ?=
VERIFY_ARGS ?=

# A crashed worker ends the tests, because xdist can wait forever when it reassigns the worker's tests.
PYTEST = $(BIN)/python -m pytest -n $(WORKERS) --dist loadscope --no-loadscope-reorder --max-worker-restart 0
LINTERS := lint-types lint-standins lint-style lint-imports
SIDE_BY_SIDE = $(MAKE) --no-print-directory -j $(words $(LINTERS)) --output-sync

.PHONY: help setup demo test check nightly lint $(LINTERS) fast-engine lab tour classes docs bench cluster hub-setup hub image cluster-certificates fuzz verify capstones real-launch sourced-layout public-packages tutorials lock clean

help:           ## list the targets
	@sed -n 's/^\([a-z-]*\):[^#]*## \(.*\)/  make \1\t\2/p' $(MAKEFILE_LIST) | expand -t 16

setup:          ## create .venv from the pinned packages, unless it is up to date (ROS2_STANDINS=1: without the real launch)
	@$(BOOTSTRAP)

demo:           ## set up, grade the reference and flawed submissions, write .build/demo/
	@$(BOOTSTRAP)
	@$(BIN)/autograder demo

test:           ## set up, then lint, types, doctor and all tests except the nightly ones (WORKERS=4 PYTEST_ARGS=)
	@$(BOOTSTRAP) --dev --browser
	@$(SIDE_BY_SIDE) $(LINTERS) fast-engine
	$(BIN)/autograder doctor
	$(PYTEST) -m "not nightly" $(PYTEST_ARGS)

check:          ## lint, types and the quick unit tests: a few minutes
	@$(BOOTSTRAP) --dev
	@$(SIDE_BY_SIDE) $(LINTERS) fast-engine
	$(PYTEST) tests/unit -m "not slow" $(PYTEST_ARGS)

nightly:        ## tests that take hours: each chapter's class and tour, hundreds of launches, the complete verification
	@$(BOOTSTRAP) --dev --browser
	$(PYTEST) -m nightly $(PYTEST_ARGS)
	@$(BIN)/autograder verify -j $(WORKERS) $(VERIFY_ARGS)

# Tests check the reference packages and the notebooks, which follow ament's style.
LINTED := autograder sim tests assets docs nbgrader_config.py
STANDINS := launch launch_xml launch_yaml launch_ros launch_testing launch_pytest rosidl_runtime_py ament_copyright standin_notice standin_submodules
lint:           ## check style, types and imports in parallel
	@$(BOOTSTRAP) --dev
	@$(SIDE_BY_SIDE) $(LINTERS)

lint-style:
	$(BIN)/ruff check $(LINTED)
	$(BIN)/ruff format --check $(LINTED)

lint-types:
	$(BIN)/mypy

lint-standins:
	$(BIN)/mypy --config-file autograder/ros/standins/mypy.ini --cache-dir .mypy_cache/standins \
		$(addprefix -p ,$(STANDINS))

lint-imports:
	$(BIN)/lint-imports --no-cache --no-logo
	cd autograder/ros/standins && $(abspath $(BIN))/lint-imports --no-cache --no-logo --config importlinter.ini

# Compile the simulator's engine before workers need it, or each of them would.
fast-engine:
	@$(BIN)/python -W ignore -c "from tests.unit.sim.test_engines import golden; golden('numba')"

# The settings remove two of nbgrader's buttons. "Validate" would report success for an unsolved notebook.
lab:            ## open JupyterLab on the chapters, with ROS activated (LAB_ARGS=)
	@$(BOOTSTRAP)
	@JUPYTER_CONFIG_PATH=$(CURDIR)/assets/students/jupyter $(WITH_ROS) jupyter lab --ServerApp.root_dir=chapters \
		$(if $(filter 0,$(shell id -u)),--allow-root) $(LAB_ARGS)

tour:           ## solve each chapter's release in JupyterLab; screenshots are in .build/screenshots
	@$(BOOTSTRAP) --dev --browser
	$(BIN)/python -m pytest tests/browser/test_solve_in_jupyterlab.py $(PYTEST_ARGS)

classes:        ## grade a class of five in each chapter, with and without nbgrader
	@$(BOOTSTRAP) --dev
	$(PYTEST) tests/e2e/test_classes.py $(PYTEST_ARGS)

docs:           ## build the site in .build/site/html, with the notebooks' outputs, and test it in a browser
	@$(BOOTSTRAP) --dev --browser
	@$(BIN)/autograder course tables
	@$(BIN)/autograder notebooks --released
	$(BIN)/python -m pytest tests/browser/test_site.py $(PYTEST_ARGS)

BENCH_ARGS ?=
bench:          ## measure simulator, grader, checks and builds, write .build/bench.json (BENCH_ARGS=first_robots: set-up)
	@$(BOOTSTRAP) --dev
	@$(BIN)/pip install --quiet --no-deps --require-hashes -r requirements-bench.lock
	@$(BIN)/python -m tests.benchmarks $(BENCH_ARGS)

cluster:        ## set up, with Dask for `autograder grade --scheduler`
	@$(BOOTSTRAP)
	@$(BIN)/pip install --quiet --no-deps --require-hashes -r requirements-cluster.lock

hub-setup:      ## set up, with JupyterHub and Node.js for its proxy
	@$(BOOTSTRAP)
	@$(BIN)/pip install --quiet --no-deps --require-hashes -r requirements-hub.lock

HUB_ARGS ?=
hub: hub-setup  ## as root: run a trial JupyterHub with three students and a teacher, until Ctrl-C (HUB_ARGS=--port=8000)
	@$(BIN)/python -m autograder.lms.hub $(HUB_ARGS)

IMAGE ?= ros2-python-course
IMAGE_ARGS ?=
image:          ## as root: build the image of a student release with buildah (BASE= PACKAGES= IMAGE_ARGS=)
	@$(BOOTSTRAP)
	@rm -rf .build/image
	@$(BIN)/autograder release --out .build/image
	@assets/image/build .build/image $(IMAGE) $(IMAGE_ARGS)

# A self-signed certificate and its key, for scheduler, workers and client. Existing ones are kept.
cluster-certificates: cluster-certificates/cluster.pem ## create the certificate and key that the machines of a cluster share
cluster-certificates/cluster.pem:
	umask 077 && mkdir -p $(@D) && openssl req -x509 -newkey ec -pkeyopt ec_paramgen_curve:prime256v1 -nodes -days 400 \
		-subj "/CN=autograder cluster" -keyout $(@D)/cluster.key -out $@

FUZZ_SECONDS ?= 600
fuzz:           ## run each fuzz test for ten minutes (FUZZ_SECONDS=600)
	@$(BOOTSTRAP) --dev
	$(PYTEST) -m fuzz tests/unit --hypothesis-profile=fuzz --fuzz-seconds $(FUZZ_SECONDS) --timeout 0 $(PYTEST_ARGS)

verify:         ## verify the grader: reference, release and mutants (WORKERS=4 VERIFY_ARGS=--quick)
	@$(BOOTSTRAP) --dev
	@$(BIN)/autograder verify -j $(WORKERS) $(VERIFY_ARGS)

TIMES ?= 1000
capstones:      ## grade the reference capstone many times, half of them under load (TIMES=1000)
	@$(BOOTSTRAP) --dev
	@$(BIN)/python -m tests.benchmarks.repeat_capstone -n $(TIMES)

real-launch:    ## install the real launch, launch_ros and ros2cli, or fail, and test them (ROS2_LAUNCH_SOURCE=... for a clone)
	@$(BOOTSTRAP) --dev --real-launch
	@$(BIN)/python -m pytest -q tests/e2e/launch_cases tests/e2e/launch_standin tests/e2e/launch_test_cases \
		tests/e2e/ros2_records tests/e2e/test_created_packages.py \
		-m "not nightly" $(PYTEST_ARGS)

PREFIX ?= .build/opt/ros/$(DISTRIBUTION)
sourced-layout: ## after real-launch: copy this ROS to PREFIX=, with the layout of /opt/ros, for `source setup.bash`
	@$(BIN)/python -m tests.e2e.sourced_prefix $(PREFIX)

EXAMPLES = $(or $(ROS2_EXAMPLES_SOURCE),.build/public/examples)
DEMOS = $(or $(ROS2_DEMOS_SOURCE),.build/public/demos)
public-packages: ## build, test and run ROS's own examples and demos (ROS2_EXAMPLES_SOURCE=, ROS2_DEMOS_SOURCE=)
	@$(BOOTSTRAP) --dev
	@test -d $(EXAMPLES) || git clone --depth 1 -b $(DISTRIBUTION) https://github.com/ros2/examples.git $(EXAMPLES)
	@test -d $(DEMOS) || git clone --depth 1 -b $(DISTRIBUTION) https://github.com/ros2/demos.git $(DEMOS)
	ROS2_EXAMPLES_SOURCE=$(EXAMPLES) ROS2_DEMOS_SOURCE=$(DEMOS) $(BIN)/python -m pytest tests/e2e/test_public_packages.py \
		-m nightly $(PYTEST_ARGS)

DOCUMENTATION = $(or $(ROS2_DOCUMENTATION_SOURCE),.build/public/documentation)
tutorials:      ## execute the Python tutorials of ROS and compare their output (ROS2_DOCUMENTATION_SOURCE=)
	@$(BOOTSTRAP) --dev
	@test -d $(DOCUMENTATION) || git clone --depth 1 -b $(DISTRIBUTION) https://github.com/ros2/ros2_documentation.git $(DOCUMENTATION)
	ROS2_DOCUMENTATION_SOURCE=$(DOCUMENTATION) $(BIN)/python -m pytest tests/e2e/test_tutorials.py -m nightly $(PYTEST_ARGS)

# Universal: one lock for all Python versions. --no-emit-index-url keeps this machine's package source out of it.
COMPILE = .build/lock/bin/uv pip compile --quiet --universal --python-version $(firstword $(sort $(PYTHONS))) --generate-hashes \
	--no-emit-index-url --no-annotate --no-header $(LOCK_ARGS)
lock:           ## update the locks from pyproject.toml (LOCK_ARGS=--upgrade for newer versions)
	@$(PYTHON) -m venv .build/lock
	@.build/lock/bin/pip install -qq uv
	$(COMPILE) pyproject.toml -o requirements.lock
	$(COMPILE) pyproject.toml --all-extras -c requirements.lock -o requirements-dev.lock
	$(COMPILE) --group bench -c requirements-dev.lock -o requirements-bench.lock
	$(COMPILE) --group cluster -c requirements-dev.lock -o requirements-cluster.lock
	$(COMPILE) --group hub -c requirements-dev.lock -o requirements-hub.lock

clean:          ## remove everything that make creates, including .venv
	rm -rf .venv .build .pytest_cache .mypy_cache .ruff_cache .hypothesis *.egg-info
