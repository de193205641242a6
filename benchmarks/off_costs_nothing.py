"""An effect that is off leaves no code behind: the machine code of the loops is that of loops built without its terms.

    python benchmarks/off_costs_nothing.py [effect ...]

Scenes begin and take two steps, as they are and without each of their effects, in which their loops are heard of with
the types of what they take. A loop has terms of an effect where it takes parameters of its file when that is on. There
it is compiled for the types that it takes when the effect is off, once as it stands and once built without the terms
(without_terms.py). The same instructions take the same time on any machine and under any load, which no timing can
show. Builds of one thread are compared: threads share out the same body.

An effect without such a loop is named with the reason. Not looked at is what Python decides once a step or a window.

Where the texts differ instructions are counted by what they do. The same number of each is the same work: registers
have other names, a load stands a line earlier. Else it is told how many only one of them has.
"""

import inspect
import re
import sys
from collections import Counter
from typing import NamedTuple

from cuda_kernels import loops_in
from numba import typeof
from without_terms import Rebuilt

from sdph import effects, scenes
from sdph.case import read as cases
from sdph.effects.effect import OFF
from sdph.engine.gpu.assembled import Heard, name_of
from sdph.engine.gpu.translation import results
from sdph.schema import CaseError
from sdph.study.explain import effect_costs
from sdph.study.explain.tables import table

COARSE = {"bubbling_bed": effect_costs.BED}
# of which only loops that take neither rows nor parameters are run, which saves to compile the others
HEARD = (
    "bubbling_bed", "segregation", "lifted_grains", "dam_break", "taylor_green", "sloshing_sphere",
    "power_law_poiseuille", "gel_droplet",
)  # fmt: skip
# of which all are run: what comes next is ruled by what they find
RUN = ("radiating_grains", "single_droplet", "capillary_wave", "swirl_sheet", "taylor_bar", "thick_ring")
NAME = re.compile(r"[.$\w@]*[A-Za-z_][.$\w@]*")
HOMES = {file.EFFECT.name: file.__name__ for file in effects.FILES}
SAME, MOVED = "identical", "the same instructions in another order"


class Ear(Heard):
    """Loops that were called; those that take rows, or parameters of effects, are run where `runs`, else return
    zeros."""

    def __init__(self, runs: bool):
        super().__init__()
        self.runs = runs

    def note(self, loop, arguments):
        self.loops[loop, tuple(map(typeof, arguments))] = None

    def hear(self, loop, arguments):
        takes = any(home_of(typeof(given)) for given in arguments)
        if not self.runs and not takes:
            return super().hear(loop, arguments)
        self.note(loop, arguments)
        if self.runs:
            return loop.here(*arguments)
        many = results(loop)
        return None if not many else 0.0 if many == 1 else (0.0,) * many


class Term(NamedTuple):
    """A loop that takes parameters of an effect as its arguments `at`, in a scene."""

    loop: object
    at: frozenset[int]
    scene: str


def home_of(taken) -> str | None:
    """Module of the effect whose parameters are of a type."""
    module = getattr(getattr(taken, "instance_class", None), "__module__", "")
    return module if module.startswith("sdph.effects.") else None


class Scenes:
    """Types of what loops take in scenes, as these are and without an effect."""

    def __init__(self, names=(*HEARD, *RUN)):
        self.cases = {name: cases.load(scenes.find(name)[1], COARSE.get(name, ())) for name in names}
        self.less: dict[tuple[str, str], list] = {}
        self.heard = {name: loops_in(case, Ear(name in RUN)) for name, case in self.cases.items()}
        homes = {home_of(kind) for loops in self.heard.values() for _, taken in loops for kind in taken} - {None}
        self.homes = {home.rpartition(".")[2]: home for home in sorted(homes)} | HOMES

    def terms(self, effect: str) -> list[Term]:
        """Loops that take parameters of an effect, each once."""
        found: dict = {}
        home = self.homes[effect]
        for scene, loops in self.heard.items():
            for loop, taken in loops:
                at = frozenset(n for n, kind in enumerate(taken) if home_of(kind) == home)
                if at:
                    found.setdefault(loop, Term(loop, at, scene))
        return list(found.values())

    def off(self, term: Term, effect: str) -> tuple | None:
        """Types of what the loop of a term takes where the effect is off; None where nobody calls it then."""
        return next(self._off(term, effect), None)

    def _off(self, term: Term, effect: str):
        """All such types, of the term's scene without the effect first."""
        for loops in (self._without(term.scene, effect), *self.heard.values()):
            for loop, taken in loops:
                if loop is term.loop and all(taken[n] == typeof(OFF) for n in term.at):
                    yield taken

    def _without(self, scene: str, effect: str) -> list:
        """Loops of a scene without an effect; none where it cannot do without."""
        if effect in effects.REGISTRY and (scene, effect) not in self.less:
            try:
                case = effect_costs.without(self.cases[scene], effect)
                self.less[scene, effect] = loops_in(case, Ear(scene in RUN))
            except CaseError:
                self.less[scene, effect] = []
        return self.less.get((scene, effect), [])


def instructions(loop, taken: tuple) -> list[str]:
    """Machine code of a loop for the types of its arguments, with symbols by the order in which they come up."""
    loop.compile(taken)
    (text,) = loop.inspect_asm().values()
    seen: dict[str, str] = {}
    lines = (line.split("#")[0].strip() for line in text.splitlines())
    code = [line for line in lines if (line and not line.startswith((".", "_", "\t."))) or line.startswith(".L")]
    return [NAME.sub(lambda m: _symbol(m[0], seen), line) for line in code]


def _symbol(word: str, seen: dict) -> str:
    """Names made by the compiler, which hold the module's name and running numbers, become s0, s1, ...; others stay."""
    made = word.startswith((".L", "__")) or "_Z" in word or "numba" in word or "$" in word
    return seen.setdefault(word, f"s{len(seen)}") if made else word


def compared(term: Term, effect: str, home: str, taken: tuple) -> dict:
    """The row of a loop that takes `taken` where the effect is off."""
    names = list(inspect.signature(term.loop.py_func).parameters)
    off = frozenset(names[n] for n in term.at)
    own, bare = (Rebuilt(home, strip) for strip in (False, True))
    whole, less = (instructions(built.of(term.loop, off), taken) for built in (own, bare))
    return {
        "effect off": effect,
        "loop": name_of(term.loop),
        "places": bare.places,
        "instructions": len(whole),
        "built without": len(less),
        "": f"not taken out: {', '.join(bare.left)}" if bare.left else verdict(whole, less),
    }


def verdict(whole: list[str], less: list[str]) -> str:
    """Tell two texts of machine code apart: by the order of their instructions, or by how many only one of them has."""
    if whole == less:
        return SAME
    own, bare = (Counter(line.split()[0] for line in code) for code in (whole, less))
    apart = (own - bare).total(), (bare - own).total()
    return MOVED if apart == (0, 0) else "not identical: {} only here, {} only there".format(*apart)


def looked_into(effect: str, heard: Scenes) -> tuple[list[dict], str]:
    """Rows of the loops that have terms of an effect and are called without it, and what else is to be said."""
    rows, uncalled, terms = [], [], heard.terms(effect)
    for term in terms:
        if taken := heard.off(term, effect):
            rows.append(compared(term, effect, heard.homes[effect], taken))
        else:
            uncalled.append(name_of(term.loop))
    if terms:
        return rows, f"not called without it: {', '.join(uncalled)}" if uncalled else ""
    on = any(effect in case.effects for case in heard.cases.values())
    return rows, "no loop takes its parameters" if on else "none of the scenes has it"


def main(names) -> int:
    heard, rows, beside = Scenes(), [], []
    for effect in names or heard.homes:
        found, said = looked_into(effect, heard)
        print("\n".join(str(list(row.values())) for row in found), file=sys.stderr, flush=True)
        rows += found
        beside += [{"effect": effect, "": said}] if said else []
    print(f"{table(rows)}\n\n{table(beside)}")
    return 0 if all(row[""] in (SAME, MOVED) for row in rows) else 1


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
