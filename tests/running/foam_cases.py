"""OpenFOAM cases of others, as the tests write them: a fluidised bed of two fluids, and gas alone."""

import subprocess

from coupling.openfoam.programs import install

HEAD = "FoamFile {{ version 2.0; format ascii; class {cls}; object {name}; }}\n"
CLASSES = {"U": "volVectorField"}
DIMENSIONS = {"U": "[0 1 -1 0 0 0 0]", "T": "[0 0 0 1 0 0 0]", "alpha": "[0 0 0 0 0 0 0]", "p_rgh": "[1 -1 -2 0 0 0 0]",
              "p": "[0 2 -2 0 0 0 0]"}  # fmt: skip
CONTROL = """application twoPhaseEulerFoam;
startFrom startTime; startTime 0; stopAt endTime; endTime 2; deltaT 2e-4; writeControl runTime; writeInterval 0.01;
writeFormat ascii; writePrecision 10; runTimeModifiable yes; // a comment; with a semicolon
"""
PHASES = """phases (particles air);
particles { diameterModel constant; constantCoeffs { d 3e-4; } alphaMax 0.62; residualAlpha 1e-6; }
air { diameterModel constant; constantCoeffs { d 1; } residualAlpha 0; }
blending { default { type none; continuousPhase air; } }
drag ( (particles in air) { type GidaspowErgunWenYu; residualAlpha 1e-6; residualRe 1e-3;
swarmCorrection { type none; } } );
"""
THERMO_AIR = """thermoType { type heRhoThermo; mixture pureMixture; transport const; thermo hConst;
equationOfState perfectGas; specie specie; energy sensibleInternalEnergy; }
mixture { specie { molWeight 28.9; } thermodynamics { Cp 1007; Hf 0; } transport { mu 1.84e-05; Pr 0.7; } }
"""
THERMO_PARTICLES = """thermoType { equationOfState rhoConst; }
mixture { specie { molWeight 100; } thermodynamics { Cp 6000; Hf 0; } transport { mu 0; Pr 1; }
equationOfState { rho 2500; } }
"""
TURBULENCE_PARTICLES = """simulationType RAS;
RAS { RASModel kineticTheory; turbulence on; kineticTheoryCoeffs { e 0.8; alphaMax 0.62; alphaMinFriction 0.5;
frictionalStressModel JohnsonJackson; JohnsonJacksonCoeffs { Fr 0.05; eta 2; p 5; phi 28.5; alphaDeltaMin 0.05; } } }
"""


def put(folder, name: str, text: str, cls: str = "dictionary") -> None:
    path = folder / name
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text(HEAD.format(cls=cls, name=path.name) + text)


def put_field(folder, name: str, inside: str, patches: dict[str, str]) -> None:
    """A field of 0; `patches`: name -> condition."""
    rows = "".join(f"    {patch} {{ {condition} }}\n" for patch, condition in patches.items())
    kind = name.partition(".")[0]
    text = f"dimensions {DIMENSIONS[kind]};\ninternalField {inside};\nboundaryField\n{{\n{rows}}}\n"
    put(folder, f"0/{name}", text, CLASSES.get(kind, "volScalarField"))


def make_mesh(folder, blocks: str, control: str = CONTROL) -> None:
    """constant/polyMesh by blockMesh."""
    put(folder, "system/controlDict", control)
    (folder / "system" / "blockMeshDict").write_text(blocks)
    subprocess.run(["blockMesh"], cwd=folder, env=install.environment(), check=True, capture_output=True)


def fluidised_bed(folder, blocks: str, speed: str, up: str, alpha: str = "uniform 0.55", plane: bool = False):
    """twoPhaseEulerFoam's tutorial fluidisedBed in a vessel of `blocks`, patches inlet, outlet and wall."""
    make_mesh(folder, blocks)
    flat = {"frontAndBack": "type empty;"} if plane else {}
    put(folder, "constant/phaseProperties", PHASES)
    put(folder, "constant/thermophysicalProperties.air", THERMO_AIR)
    put(folder, "constant/thermophysicalProperties.particles", THERMO_PARTICLES)
    put(folder, "constant/turbulenceProperties.particles", TURBULENCE_PARTICLES)
    put(folder, "constant/turbulenceProperties.air", "simulationType laminar;\n")
    put(folder, "constant/g", f"dimensions [0 1 -2 0 0 0 0];\nvalue {up};\n", "uniformDimensionedVectorField")
    free = "type pressureInletOutletVelocity; phi phi.air; value $internalField;"
    inlet = f"type interstitialInletVelocity; inletVelocity uniform {speed}; alpha alpha.air; value $internalField;"
    wall = "type fixedValue; value uniform (0 0 0);"
    put_field(folder, "U.air", f"uniform {speed}", {"inlet": inlet, "outlet": free, "wall": wall} | flat)
    pressure = {"inlet": "type fixedFluxPressure; value $internalField;",
                "outlet": "type prghPressure; p $internalField; value $internalField;",
                "wall": "type fixedFluxPressure; value $internalField;"}  # fmt: skip
    put_field(folder, "p_rgh", "uniform 1e5", pressure | flat)
    heat = {"inlet": "type fixedValue; value uniform 300;", "wall": "type zeroGradient;",
            "outlet": "type inletOutlet; phi phi.air; inletValue uniform 300; value uniform 300;"}  # fmt: skip
    put_field(folder, "T.air", "uniform 300", heat | flat)
    put_field(folder, "T.particles", "uniform 300", {'".*"': "type zeroGradient;"} | flat)
    put_field(folder, "alpha.particles", alpha, {'".*"': "type zeroGradient;"} | flat)
    return folder


def gas_alone(folder, blocks: str, conditions: dict[str, tuple[str, str]]):
    """pimpleFoam's files; `conditions`: patch -> (of U, of p)."""
    make_mesh(folder, blocks)
    put(folder, "constant/transportProperties", "transportModel Newtonian;\nnu [0 2 -1 0 0 0 0] 1.5e-5;\n")
    put(folder, "constant/turbulenceProperties", "simulationType RAS;\nRAS { RASModel kEpsilon; }\n")
    put_field(folder, "U", "uniform (0 0 0)", {name: own[0] for name, own in conditions.items()})
    put_field(folder, "p", "uniform 0", {name: own[1] for name, own in conditions.items()})
    return folder
