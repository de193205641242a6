"""Reference values of the gel droplet: closed forms and quadratures with 20 to 40 digits, see "meta" of the file."""

import json
from pathlib import Path

from sdph.effects.gas import gel

FILE = Path(__file__).parents[1] / "data" / "gel_reference.json"
VALUES = {value["name"]: value["expected"] for value in json.loads(FILE.read_text())["values"]}
VAPOUR = gel.vapour(gel.Fuel())
PAPER = gel.vapour(gel.Fuel(equation_of_state="redlich_kwong_paper"))
