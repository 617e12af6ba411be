# make reproduce and make test each work on a fresh clone: they make .venv and install what they need.
VENV := .venv
BIN := $(VENV)/bin
RUN := $(BIN)/python -m dcg_torch
# Without --no-compile pip compiles every module of every package, which takes longer than all the rest; Python compiles
# what is used as it is used.
PIP := $(BIN)/python -m pip install --quiet --no-compile --disable-pip-version-check --root-user-action=ignore

# What is compiled is kept, whatever the environment says: else each of a dozen processes would compile torch anew.
unexport PYTHONDONTWRITEBYTECODE

# python3.11 where there is one (PyBullet has wheels for it), else a python3 that is new enough.
PYTHON ?= $(shell for p in python3.11 python3; do \
	$$p -c 'import sys; sys.exit(sys.version_info < (3, 11))' 2>/dev/null && echo $$p && break; done)

.PHONY: help reproduce test torture check lint bench board clean docs pretrain
.DEFAULT_GOAL := help

help: ## Show this list
	@awk -F ':.*## ' '/^[a-z]+:.*## / {printf "make %-10s %s\n", $$1, $$2}' Makefile

reproduce: $(VENV)/installed ## Run the paper's experiment (written, then canonical commands) and the ablation
	$(RUN) experiment=paper hydra.run.dir=runs/paper
	$(RUN) experiment=paper speaker=canonical hydra.run.dir=runs/paper_canonical
	$(RUN) experiment=ablation hydra.sweep.dir=runs/ablation
	@$(BIN)/python -m dcg_torch.report runs/paper runs/paper_canonical
	@$(BIN)/python -m dcg_torch.report runs/paper
	@echo "pictures: runs/paper/figures, runs/paper_canonical/figures, runs/ablation/comparison.png; curves: make board"

test: $(VENV)/installed-dev ## Run the tests, the fast ones first
	$(BIN)/python -m pytest -n logical --maxprocesses 4 --dist loadgroup

torture: $(VENV)/installed-dev ## Kills, full disks, hostile files, a soak: up to half an hour
	$(BIN)/python tests/torture

check: lint test ## Lint, types and tests

lint: $(VENV)/installed-dev ## Lint and types alone
	$(BIN)/ruff check .
	$(BIN)/ruff format --check .
	$(BIN)/mypy

bench: $(VENV)/installed-bench ## Time the parts; a table, and runs/bench.json
	$(BIN)/python -m dcg_torch.bench --json runs/bench.json

board: $(VENV)/installed ## Open TensorBoard over runs/
	$(BIN)/tensorboard --logdir runs

docs: $(VENV)/installed-docs ## Build the documentation as a site, in build/site
	NO_MKDOCS_2_WARNING=1 $(BIN)/mkdocs build --strict

pretrain: $(VENV)/installed ## Make the shipped model anew from what is in the repository
	$(BIN)/python -m dcg_torch.cli.pretrain

clean: ## Remove .venv, caches and build products; runs/ stays
	rm -rf $(VENV) build dist .coverage .hypothesis .mypy_cache .pytest_cache .ruff_cache
	find dcg_torch tests -name __pycache__ -prune -exec rm -rf {} +

# torch first and pinned by itself: resolved among other requirements, pip may fetch several GB of CUDA for another one.
$(VENV)/torch:
	@test -n "$(PYTHON)" || { echo "make: no Python 3.11 or newer here; name one: make $(MAKECMDGOALS) PYTHON=/path/to/python3.11" >&2; exit 2; }
	@$(PYTHON) -c 'import sys; sys.exit(sys.version_info < (3, 11))' || { echo "make: $(PYTHON) is not Python 3.11 or newer; name another with PYTHON=" >&2; exit 2; }
	$(PYTHON) -m venv $(VENV)
	$(PIP) torch==2.13.0
	@touch $@

$(VENV)/installed: $(VENV)/torch pyproject.toml
	$(PIP) -e .
	@touch $@

$(VENV)/installed-%: $(VENV)/torch pyproject.toml
	$(PIP) -e ".[$*]"
	@touch $@
