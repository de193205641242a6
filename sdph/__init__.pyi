from sdph import laws as laws
from sdph import scenes as scenes
from sdph.api.case import Case as Case
from sdph.api.explaining import explain as explain
from sdph.api.results import Run as Run
from sdph.api.results import load as load
from sdph.api.running import resume as resume
from sdph.api.running import run as run
from sdph.api.running import stepping as stepping
from sdph.api.tank import Tank as Tank
from sdph.schema import CaseError as CaseError

__version__: str
