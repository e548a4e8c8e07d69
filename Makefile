# `make` alone lists the targets.

# What is the distribution's own: its name, and the versions of Python that it has wheels for.
DISTRIBUTION := $(shell sed -n 's/^  "name": "\(.*\)",/\1/p' autograder/ros/distribution.json)
PYTHONS := $(shell sed -n '/^  "pythons"/{s/.*\[//;s/[]",]//g;p;}' autograder/ros/distribution.json)

# The first interpreter that really runs (pyenv leaves shims that do not), that makes environments (Debian's need not),
# and that ROS has wheels for. The system's own comes early: it is built with optimizations, a sixth faster.
SYSTEM_PYTHON ?= /usr/bin/python3
PYTHON ?= $(shell for python in $(firstword $(PYTHONS:%=python%)) $(SYSTEM_PYTHON) python3 $(PYTHONS:%=python%); do \
	$$python -c 'import ensurepip, sys; sys.exit("{}.{}".format(*sys.version_info) not in "$(PYTHONS)".split())' 2>/dev/null \
	&& echo $$python && exit; done; echo python3)
BIN := .venv/bin
BOOTSTRAP = $(PYTHON) -I autograder/bootstrap.py
# `autograder ros COMMAND` runs a command with ROS switched on.
WITH_ROS := $(BIN)/autograder ros

# Where a machine forbids compiled modules, each of the programs that tests start compiles the autograder again.
unexport PYTHONDONTWRITEBYTECODE
# In a terminal that has another virtual environment active, IPython warns, and a warning fails a test.
unexport VIRTUAL_ENV

# More than the two cores of a small machine: much of a test is waiting. Unit tests wait for nothing.
WORKERS ?= 4
check: WORKERS := 2
PYTEST_ARGS ?=
LAB_ARGS ?=
VERIFY_ARGS ?=

# A worker that crashes ends the tests: xdist hands its tests on in a way that can wait forever.
PYTEST = $(BIN)/python -m pytest -n $(WORKERS) --dist loadscope --no-loadscope-reorder --max-worker-restart 0
LINTERS := lint-types lint-standins lint-style lint-imports
SIDE_BY_SIDE = $(MAKE) --no-print-directory -j $(words $(LINTERS)) --output-sync

.PHONY: help setup demo test check nightly lint $(LINTERS) fast-engine lab tour classes docs bench cluster hub-setup hub cluster-certificates fuzz verify capstones real-launch sourced-layout public-packages tutorials lock clean

help:           ## list the targets
	@sed -n 's/^\([a-z-]*\):[^#]*## \(.*\)/  make \1\t\2/p' $(MAKEFILE_LIST) | expand -t 16

setup:          ## make .venv from the pinned packages; does nothing when it stands (ROS2_STANDINS=1: without the real launch)
	@$(BOOTSTRAP)

demo:           ## set up, grade the reference and flawed submissions, write .build/demo/
	@$(BOOTSTRAP)
	@$(BIN)/autograder demo

test:           ## set up, then lint, types, doctor and every test but the nightly ones (WORKERS=4 PYTEST_ARGS=)
	@$(BOOTSTRAP) --dev --browser
	@$(SIDE_BY_SIDE) $(LINTERS) fast-engine
	$(BIN)/autograder doctor
	$(PYTEST) -m "not nightly" $(PYTEST_ARGS)

check:          ## lint, types and the quick unit tests: a minute
	@$(BOOTSTRAP) --dev
	@$(SIDE_BY_SIDE) $(LINTERS) fast-engine
	$(PYTEST) tests/unit -m "not slow" $(PYTEST_ARGS)

nightly:        ## the tests that take hours: each chapter's class and tour, launches by the hundred, the whole verification
	@$(BOOTSTRAP) --dev --browser
	$(PYTEST) -m nightly $(PYTEST_ARGS)
	@$(BIN)/autograder verify -j $(WORKERS) $(VERIFY_ARGS)

# The reference packages and the notebooks keep to ament's style; tests hold them to it.
LINTED := autograder sim tests assets docs nbgrader_config.py
STANDINS := launch launch_xml launch_yaml launch_ros launch_testing launch_pytest rosidl_runtime_py ament_copyright standin_notice standin_submodules
lint:           ## style, types and imports, all at once
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

# Workers that need the simulator's compiled engine at the same time would each compile it.
fast-engine:
	@$(BIN)/python -W ignore -c "from tests.unit.sim.test_engines import golden; golden('numba')"

# The settings take away two of nbgrader's buttons: "Validate" would praise an unsolved notebook.
lab:            ## open JupyterLab on the chapters, with ROS switched on (LAB_ARGS=)
	@$(BOOTSTRAP)
	@JUPYTER_CONFIG_PATH=$(CURDIR)/assets/students/jupyter $(WITH_ROS) jupyter lab --ServerApp.root_dir=chapters \
		$(if $(filter 0,$(shell id -u)),--allow-root) $(LAB_ARGS)

tour:           ## solve each chapter's release in JupyterLab, keep screenshots in .build/screenshots
	@$(BOOTSTRAP) --dev --browser
	$(BIN)/python -m pytest tests/browser/test_solve_in_jupyterlab.py $(PYTEST_ARGS)

classes:        ## a class of five hands in each chapter, graded through nbgrader and without
	@$(BOOTSTRAP) --dev
	$(PYTEST) tests/e2e/test_classes.py $(PYTEST_ARGS)

docs:           ## build the site in .build/site/html, with the notebooks' outputs, and look at it in a browser
	@$(BOOTSTRAP) --dev --browser
	@$(BIN)/autograder course tables
	@$(BIN)/autograder notebooks --released
	$(BIN)/python -m pytest tests/browser/test_site.py $(PYTEST_ARGS)

bench:          ## measure simulator, grader and builds, write .build/bench.json
	@$(BOOTSTRAP) --dev
	@$(BIN)/pip install --quiet --no-deps --require-hashes -r requirements-bench.lock
	@$(BIN)/python -m tests.benchmarks

cluster:        ## set up, with what `autograder grade --scheduler` needs
	@$(BOOTSTRAP)
	@$(BIN)/pip install --quiet --no-deps --require-hashes -r requirements-cluster.lock

hub-setup:      ## set up, with JupyterHub and what runs its proxy
	@$(BOOTSTRAP)
	@$(BIN)/pip install --quiet --no-deps --require-hashes -r requirements-hub.lock

HUB_ARGS ?=
hub: hub-setup  ## as root: a JupyterHub for trying, with three students and a teacher, until Ctrl-C (HUB_ARGS=--port=8000)
	@$(BIN)/python -m autograder.lms.hub $(HUB_ARGS)

# One certificate, which signs itself, and its key: for scheduler, workers and client. What is there is kept.
cluster-certificates: cluster-certificates/cluster.pem ## the certificate and the key by which the machines of a cluster know each other
cluster-certificates/cluster.pem:
	umask 077 && mkdir -p $(@D) && openssl req -x509 -newkey ec -pkeyopt ec_paramgen_curve:prime256v1 -nodes -days 400 \
		-subj "/CN=autograder cluster" -keyout $(@D)/cluster.key -out $@

FUZZ_SECONDS ?= 600
fuzz:           ## made-up input for ten minutes each at what reads strangers' bytes (FUZZ_SECONDS=600)
	@$(BOOTSTRAP) --dev
	$(PYTEST) -m fuzz tests/unit --hypothesis-profile=fuzz --fuzz-seconds $(FUZZ_SECONDS) --timeout 0 $(PYTEST_ARGS)

verify:         ## prove the grader: reference, release and mutants (WORKERS=4 VERIFY_ARGS=--quick)
	@$(BOOTSTRAP) --dev
	@$(BIN)/autograder verify -j $(WORKERS) $(VERIFY_ARGS)

TIMES ?= 1000
capstones:      ## grade the reference capstone again and again, half of them under load (TIMES=1000)
	@$(BOOTSTRAP) --dev
	@$(BIN)/python -m tests.benchmarks.repeat_capstone -n $(TIMES)

real-launch:    ## install the real launch, launch_ros and ros2cli, as setup tries, and test them (ROS2_LAUNCH_SOURCE=... for a clone)
	@$(BOOTSTRAP) --dev --real-launch
	@$(BIN)/python -m pytest -q tests/e2e/launch_cases tests/e2e/launch_standin tests/e2e/launch_test_cases \
		tests/e2e/ros2_records tests/e2e/test_created_packages.py \
		-m "not nightly" $(PYTEST_ARGS)

PREFIX ?= .build/opt/ros/$(DISTRIBUTION)
sourced-layout: ## after real-launch: copy this ROS to PREFIX=, laid out as in /opt/ros, for `source setup.bash`
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
tutorials:      ## do what the Python tutorials of ROS say, and see what they say one sees (ROS2_DOCUMENTATION_SOURCE=)
	@$(BOOTSTRAP) --dev
	@test -d $(DOCUMENTATION) || git clone --depth 1 -b $(DISTRIBUTION) https://github.com/ros2/ros2_documentation.git $(DOCUMENTATION)
	ROS2_DOCUMENTATION_SOURCE=$(DOCUMENTATION) $(BIN)/python -m pytest tests/e2e/test_tutorials.py -m nightly $(PYTEST_ARGS)

# Universal: one lock serves all versions of Python. --no-emit-index-url keeps this machine's package source out of it.
COMPILE = .build/lock/bin/uv pip compile --quiet --universal --python-version $(firstword $(sort $(PYTHONS))) --generate-hashes \
	--no-emit-index-url --no-annotate --no-header $(LOCK_ARGS)
lock:           ## pin the dependencies of pyproject.toml again (LOCK_ARGS=--upgrade for newer versions)
	@$(PYTHON) -m venv .build/lock
	@.build/lock/bin/pip install -qq uv
	$(COMPILE) pyproject.toml -o requirements.lock
	$(COMPILE) pyproject.toml --all-extras -c requirements.lock -o requirements-dev.lock
	$(COMPILE) --group bench -c requirements-dev.lock -o requirements-bench.lock
	$(COMPILE) --group cluster -c requirements-dev.lock -o requirements-cluster.lock
	$(COMPILE) --group hub -c requirements-dev.lock -o requirements-hub.lock

clean:          ## remove what is made, .venv too
	rm -rf .venv .build .pytest_cache .mypy_cache .ruff_cache .hypothesis *.egg-info
