# Everything a person types here; what each target does is in `make help`.
.DEFAULT_GOAL := help
.PHONY: run test smoke check long-test integration-test alone-test test-tools judge-test ros-test ros-build kilted-test newest-test wheel-check aarch64-check images nightly campaign drawn-campaign devices-campaign crash-campaign standby-campaign kills hosts mutants exercises cost lines names-taken performance firmware firmware-test firmware-robot fuzz install lint diagrams reference proof shots example-pictures moving-picture gallery clean help docs playground

export PYTHON
export PYTHONDONTWRITEBYTECODE := # what a target here runs hundreds of times is compiled once
BIN := .venv/bin
PYTEST_ARGS ?= -n auto --dist worksteal
INTEGRATION_ARGS ?= -n 4 --dist worksteal # more than cores: most of the time, tests of the real chain wait
SMOKE_ARGS ?= -n 2 --dist worksteal
REAL = scripts/with-messages $(BIN)/python -m pytest -p tests.second_tries
TESTS ?= tests/unit tests/scenario tests/meta tools/tests/fast $(wildcard packages/*/tests/fast)
INTEGRATION_TESTS ?= tests/processes tests/contract tests/system tests/tutorial tools/tests/real $(wildcard packages/*/tests/real)
KILTED_TESTS ?= tests/unit/ros $(addprefix tests/system/test_ros_,tools.py link.py log.py)
NEWEST_TESTS ?= packages/arboleda_drivers/tests/fast tools/tests/fast/fuzzers tools/tests/real/fuzzers tests/unit/adapters $(addprefix packages/arboleda_drivers/tests/real/,contract modbus opcua s7 serial_arm) packages/arboleda_fleet/tests/real/opcua_view tests/contract/test_mqtt.py
SIMULATE = $(BIN)/arboleda simulate $(if $(JOBS),--jobs $(JOBS))
CALM_SEEDS ?= 100
SEEDS ?= 1000
CYCLES ?= 36
DRAWN_SEEDS ?= 500
DRAWN_CYCLES ?= 4 # of each drawn plant; it ends at a full minute, so there are more
DEVICE_SEEDS ?= 12
DEVICE_CYCLES ?= 4
CRASH_SEEDS ?= 6
CRASH_CYCLES ?= 4
STANDBY_SEEDS ?= 20
STANDBY_CYCLES ?= 3
KILLS ?= --kills 1000
HOSTS ?= --faults 1000
MUTANTS ?= --sample 400

run: install  ## start the simulated plant as a demonstration: tasks without end, now and then a fault, until Ctrl-C
	@$(BIN)/arboleda up --demo

test:  ## run the tests that move time by hand, and those of the repository itself; TESTS=tests/unit/core for others
	@scripts/install test
	$(BIN)/python -m pytest $(TESTS) -m "not long" $(PYTEST_ARGS)

smoke:  ## run one test of each real part: a plant and its page, brokers, ROS 2, databases, drivers; needs what .ci/run installs
	@scripts/install test
	@scripts/install colcon
	@.colcon/venv/bin/python scripts/ros-test messages
	$(REAL) -m smoke $(INTEGRATION_TESTS) $(SMOKE_ARGS)

check:  ## run every test there is, about an hour; goes on where it was interrupted; ONLY="kills ur" for jobs, or tests by a word in their names
	@scripts/install test
	@$(BIN)/python -S scripts/check $(ONLY) # -S: wheels of ROS 2 put the paths of their libraries into what is started

nightly:  ## the same with all cases and seeds; hours
	@scripts/install test
	@$(BIN)/python -S scripts/check --whole $(ONLY)

long-test:  ## run the tests that move time by hand and that `make test` leaves out: more seeds, plants and instants
	@scripts/install test
	$(BIN)/python -m pytest $(TESTS) -m long $(PYTEST_ARGS)

integration-test:  ## run the tests with threads and processes: our own, adapters, the page, the tutorial; INTEGRATION_TESTS=... for others
	@scripts/install test
	$(REAL) $(INTEGRATION_TESTS) $(INTEGRATION_ARGS)

test-tools:  ## install the programs of others, too large for everybody, that some tests try what we write with: rerun
	@scripts/install tools

alone-test:  ## run what `make test` runs in a clone without packages/, in an environment of its own; TESTS=... for others
	@scripts/without-packages make test

judge-test:  ## plant a bug for each invariant of the simulator, which has to find it; tools/tests/mutants
	@scripts/install test
	$(BIN)/python -m pytest tools/tests/mutants $(PYTEST_ARGS)

ros-test:  ## build and test the ROS 2 packages with colcon, in .colcon
	@scripts/install colcon
	@.colcon/venv/bin/python scripts/ros-test

ros-build:  ## build the ROS 2 packages with colcon, in .colcon, which ros-test does, too
	@scripts/install colcon
	@.colcon/venv/bin/python scripts/ros-test build

kilted-test:  ## run the tests of ROS 2 on the wheels of Kilted, in an environment of their own, .kilted; KILTED_TESTS=... for others
	@scripts/install kilted
	.kilted/bin/python -m pytest -p tests.second_tries $(KILTED_TESTS) $(INTEGRATION_ARGS)

newest-test:  ## run the drivers' tests with the newest release of each of their libraries, in an environment of their own, .newest; NEWEST_TESTS=... for others
	@scripts/install newest
	ARBOLEDA_REQUIRE= .newest/bin/python -m pytest -p tests.second_tries $(NEWEST_TESTS) $(INTEGRATION_ARGS) # programs that `make test-tools` installs are in .venv alone

wheel-check:  ## build the wheels in a clone, look into them, and ask the package index for all that they need, for each system and Python
	@scripts/install tools
	@PATH="$(CURDIR)/$(BIN):$$PATH" scripts/wheel-check

aarch64-check:  ## run a plant on an emulated aarch64, before a release; as root, needs debootstrap and qemu-user-static
	@scripts/aarch64-check

images:  ## build the image of a container for amd64 and arm64, arboleda:VERSION; needs podman, or docker with buildx
	@scripts/images

campaign: install  ## simulate 1000 seeds with every kind of fault; SEEDS=... CYCLES=... for others, JOBS=... processes
	$(SIMULATE) --seeds $(CALM_SEEDS) --cycles 20 --faults none
	$(SIMULATE) --seeds $(SEEDS) --cycles $(CYCLES) --json campaign.json
	$(BIN)/python tools/campaign campaign.json $(SEEDS)

drawn-campaign: install  ## simulate 500 plants that are drawn from seeds, with every kind of fault; DRAWN_SEEDS=... for others
	tools/drawn-plants $(if $(JOBS),--jobs $(JOBS)) --seeds $(DRAWN_SEEDS) --cycles $(DRAWN_CYCLES) --json drawn.json
	$(BIN)/python tools/campaign drawn.json $(DRAWN_SEEDS)

devices-campaign: install  ## simulate the examples of cells of devices with every kind of fault; DEVICE_SEEDS=... for more seeds
	@for plant in lab_bench assembly machine_tending own_tree; do \
		$(SIMULATE) --plant examples/$$plant/plant.yaml --seeds $(DEVICE_SEEDS) --cycles $(DEVICE_CYCLES) || exit 1; \
	done

crash-campaign: install  ## simulate plants that die again and again, also of power cuts; CRASH_SEEDS=... for more seeds
	$(SIMULATE) --faults crashes --seeds $(CRASH_SEEDS) --cycles $(CRASH_CYCLES)
	@for plant in lab_bench machine_tending own_tree; do \
		$(SIMULATE) --faults crashes --plant examples/$$plant/plant.yaml --seeds $(CRASH_SEEDS) --cycles $(CRASH_CYCLES) || exit 1; \
	done

standby-campaign: install  ## simulate plants on two hosts, one of which stands by; STANDBY_SEEDS=... for more seeds
	$(SIMULATE) --standby --seeds $(STANDBY_SEEDS) --cycles $(STANDBY_CYCLES)

kills: install  ## kill a plant with -9 at 1000 random instants, count what came of its tasks; an hour; KILLS="--kills 12" for others
	PYTHONPATH=tools:tools/kills $(BIN)/python -m arboleda_kills $(KILLS)

hosts: install  ## a plant on hosts of its own (network namespaces; root): 1000 faults of hosts and links; HOSTS="--faults 60" for others
	PYTHONPATH=tools:tools/kills:tools/bench $(BIN)/python -m arboleda_kills.hosts $(HOSTS)

mutants:  ## plant 400 small bugs in core and wire, see which of them tests and simulator find; hours
	@scripts/install test
	PYTHONPATH=tools:tools/mutation:tools/drawn $(BIN)/python -m arboleda_mutation $(MUTANTS)

lines:  ## try each driver whose machine runs in virtual time at bad lines: all forms, all moments; LINES="gcode-grbl --only stop" for some
	@scripts/install test
	@tools/bad-lines $(LINES)

exercises:  ## judge every right and wrong work of the exercises; minutes
	@scripts/install test
	$(BIN)/python -m pytest packages/arboleda_class/tests/exercises $(PYTEST_ARGS)

cost:  ## count the Python calls and different functions of pinned scenarios; fails where there are more than 2 % more; COST=--pin writes the table anew
	@scripts/install test
	$(BIN)/python -m arboleda_bench.cost $(COST)

names-taken:  ## write lower numbers of what packages take from the runner beside its doors; `make test` says when
	@scripts/names-taken --lower

performance:  ## measure, and write docs/performance.md; on a quiet machine, about twenty minutes; PERFORMANCE="--quick" takes at most ten
	@scripts/install test
	$(BIN)/arboleda bench $(PERFORMANCE) --json docs/performance.json; [ $$? -le 1 ]
	$(BIN)/python -m arboleda_bench.page docs/performance.json docs/performance.md

firmware:  ## build the board for Linux, firmware/build/board
	@$(MAKE) --no-print-directory -C firmware board

firmware-test:  ## test the boards' firmware: on this machine, as rv32imc in qemu, against the virtual boards
	@scripts/install test
	@$(MAKE) --no-print-directory -j "$$(nproc)" -C firmware test PYTHON=$(CURDIR)/$(BIN)/python
	$(BIN)/python -m pytest firmware/test

fuzz:  ## fuzz the firmware's reader of messages, 10 million runs; FUZZ_RUNS=... for others
	@$(MAKE) --no-print-directory -C firmware fuzz

firmware-robot:  ## write firmware/core/robot_scara.h anew from the robot's YAML
	@scripts/install
	@header=$$($(BIN)/python scripts/firmware-robot) && printf '%s\n' "$$header" >firmware/core/robot_scara.h

docs:  ## write the documentation as a site to build/docs; fails at a link that leads nowhere
	@scripts/install docs
	NO_MKDOCS_2_WARNING=1 $(BIN)/mkdocs build --quiet
	@if [ -d build/playground ]; then cp -r build/playground build/docs/playground; fi # as made before

playground:  ## write a plant in a tab of a browser, as files alone, to build/playground and its zip; needs npm
	@scripts/install test
	$(BIN)/python scripts/playground

install:  ## make .venv with the arboleda command; PYTHON=python3.12 chooses the interpreter, ROS=1 brings ROS 2, too
	@scripts/install $(if $(ROS),ros)

lint:  ## check style, format, types, the import rules and the budget (scripts/budget.tsv)
	@scripts/install test
	$(BIN)/ruff check
	$(BIN)/ruff format --check
	$(BIN)/mypy
	$(BIN)/mypy --explicit-package-bases firmware/test/*.py
	$(BIN)/mypy --scripts-are-modules $$(grep -lE '^#!.*python' scripts/* tools/* 2>/dev/null) scripts/*.py tools/*.py
	@PYTHONPATH=src/arboleda_bringup:tools:tools/drawn $(BIN)/lint-imports # pip does not install these
	$(BIN)/python scripts/budget

diagrams:  ## write docs/reference/states.md anew from the state tables of the core
	@scripts/install
	@page=$$($(BIN)/python scripts/state-diagrams) && printf '%s\n' "$$page" >docs/reference/states.md

reference:  ## write docs/reference/api.md and verbs.md anew from docstrings and the table of verbs
	@scripts/install
	@page=$$($(BIN)/python scripts/api-reference) && printf '%s\n' "$$page" >docs/reference/api.md
	@page=$$($(BIN)/python scripts/verb-reference) && printf '%s\n' "$$page" >docs/reference/verbs.md

proof:  ## write docs/reference/proof.md anew from runs of the shipped plant and the examples; minutes
	@scripts/install
	@page=$$($(BIN)/python tools/proof-table) && printf '%s\n' "$$page" >docs/reference/proof.md

shots:  ## take pictures of the page, on screens of several sizes, into shots/; needs chromium
	@scripts/install test
	$(BIN)/python scripts/shots

example-pictures:  ## take the pictures of the examples for their pages in docs/; needs chromium
	@scripts/install test
	$(BIN)/python scripts/shots --examples

gallery:  ## write docs/gallery.md and its Spanish page; GALLERY=--pictures takes its pictures, needs chromium and `make playground` before
	@scripts/install test
	$(BIN)/python scripts/gallery $(GALLERY)

moving-picture:  ## take the picture of README.md that moves, docs/images/task.webp; needs chromium
	@scripts/install test
	$(BIN)/python scripts/shots --moving

clean:  ## remove .venv and whatever builds and tests left behind
	rm -rf .venv .colcon .kilted .newest .check .build build firmware/build install log dist .hypothesis .import_linter_cache .mypy_cache .pytest_cache .ruff_cache
	rm -rf *.egg-info src/*/*.egg-info packages/*/build shots
	find src tests tools -name __pycache__ -type d -prune -exec rm -rf {} +

help:  ## show this list
	@awk -F ':.*## ' '/^[a-z-]+:.*## / { printf "make %-17s%s\n", $$1, $$2 }' Makefile
