"""`sdph init`: a folder of one's own from a scene or from an OpenFOAM case."""

from __future__ import annotations

from sdph.schema import CaseError

JOB = "job.sh"
SCRIPT = """#!/bin/sh
#SBATCH --nodes=1
#SBATCH --ntasks=16
#SBATCH --cpus-per-task=1
#SBATCH --time=12:00:00
# A job that was cut goes on from its last checkpoint when it is sent again.
export NUMBA_NUM_THREADS=$SLURM_CPUS_PER_TASK
if [ -f run/origin.json ]; then
    sdph run --resume run --ranks $SLURM_NTASKS
else
    sdph run case.toml --out run --ranks $SLURM_NTASKS --set run.launcher="srun --mpi=pmix"
fi
"""


def init_case(options) -> int:
    """Make the folder; returns the exit code."""
    if options.from_openfoam:
        return _adopted(options)
    if options.scene is None:
        raise CaseError("init takes SCENE DIR, or --from-openfoam CASE DIR; see sdph init --help")
    from sdph import scenes
    from sdph.running import inputs, output, vessel
    from sdph.scenes import paths

    name, file = scenes.find(options.scene)
    inputs.check(vessel.load(file))
    folder = output.create(options.folder, ())
    inputs.copy_case(file, folder)
    output.copy_template(inputs.beside(file) or paths.gas_template(name), folder / "gas")
    print(f"{folder}/case.toml and {folder}/gas are yours to edit; run them with: sdph run {folder}")
    _job(options)
    return 0


def _job(options) -> None:
    """Write the job for SLURM where one is asked for."""
    from sdph.running import output

    if options.slurm:
        output.write_text(options.folder / JOB, SCRIPT)
        print(f"{options.folder}/{JOB} is for SLURM: sbatch {JOB}, from {options.folder}")


def _adopted(options) -> int:
    from sdph.running import adopted

    if options.scene is not None:
        raise CaseError(f"init --from-openfoam CASE DIR takes no scene: leave {options.scene} out")
    for note in adopted.adopt(options.from_openfoam, options.folder):
        print(f"note: {note}")
    made = options.folder
    print(f"{made}/case.toml and {made}/gas are yours to edit; see what it calls for: sdph explain {made}")
    _job(options)
    return 0
