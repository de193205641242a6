"""The reference values: published closed forms evaluated with 50 digits, see "meta" of the file."""

import json
from pathlib import Path

FILE = Path(__file__).parents[1] / "data" / "sdph_reference_values.json"
CONTENT = json.loads(FILE.read_text())
META = CONTENT["meta"]
VALUES = {value["id"]: value for value in CONTENT["values"]}

GAS = META["gas"]
BED = META["bed"]
JET = META["jet"]
CONSTANTS = META["constants"]
