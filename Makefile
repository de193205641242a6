# Two commands: `make demo` sets everything up and runs the main job, `make test` sets up and passes the tests.
# Nothing is built twice: a second call of either goes straight to the work. A comparator that does not run here says so
# in one line (exit code 3) and is left out of the demo.
VENV ?= .venv
SDPH = $(VENV)/bin/sdph
PYTHON ?= python3
RUN = runs/demo

demo: setup
	rm -rf $(RUN)
	$(SDPH) run disc_cluster --set heat.closure=paper --out $(RUN)
	$(SDPH) view $(RUN) --png $(RUN)/disc.png
	$(SDPH) compare $(RUN) --against exact
	if $(SDPH) doctor >/dev/null; then $(SDPH) compare $(RUN) --against tfm || test $$? -eq 3; fi
	@echo pictures: $(RUN)/*.png

# A picture of every scene, of short and coarse runs, into runs/gallery.
gallery: setup
	$(VENV)/bin/python validation/gallery.py

test: setup lint
	$(VENV)/bin/python -m pytest -n auto --maxprocesses 4 --dist loadfile --no-loadscope-reorder

docs: $(VENV)/installed
	$(VENV)/bin/python -m sphinx -W --keep-going -q -E docs docs/site
	@echo the documentation: docs/site/index.html

lint: $(VENV)/installed
	$(VENV)/bin/ruff check .
	$(VENV)/bin/ruff format --check .
	$(VENV)/bin/lint-imports --no-cache

setup: $(VENV)/installed
	@$(SDPH) openfoam setup --install || { echo "no OpenFOAM here: the embedded gas solver does the gas, unless CI=true"; test "$$CI" != true; }

$(VENV)/installed: pyproject.toml
	.ci/system_packages
	$(PYTHON) -m venv $(VENV)
	$(VENV)/bin/pip install --quiet --editable .[test]
	touch $@

clean:
	rm -rf $(VENV) runs build dist docs/site docs/generated docs/scenes docs/studies

.PHONY: demo gallery test docs lint setup clean
