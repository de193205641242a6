"""The gas by OpenFOAM: starts sdphGasFoam on a case folder, talks to it, and leaves nothing running."""

from __future__ import annotations

import os
import secrets
import subprocess
import time
from collections.abc import Callable
from pathlib import Path

import numpy as np

from coupling.gas import SOURCES, CheckpointError, GasError, GasState, Unfinished, known_fields, refuse_full_cells
from coupling.openfoam import case as case_files
from coupling.openfoam import cell_sizes
from coupling.openfoam import told as told_by
from coupling.openfoam.links import Links
from coupling.openfoam.programs import barrier, install
from coupling.openfoam.programs import run as programs
from coupling.openfoam.programs.build import silent
from coupling.openfoam.programs.run import end_group
from coupling.transport import files
from coupling.transport.messages import Kind, Message, MessageError, message_limit
from coupling.transport.sockets import SocketServer
from sdph.engine.clock import Clock
from sdph.engine.reading import one_line
from sdph.schema import CaseError

ANSWER_TIME = 3600.0  # s that a solver that lives may take to read its case, or for one step
QUIET = 2.0  # s of waiting after which the user is told what is waited for
END_TIME = 5.0  # s that the solver may take to end by itself


# [coupling] transport -> what waits for the solver of a run in `folder`
SERVERS = {
    "socket": lambda secret, folder: SocketServer(secret),
    "file": files.FileServer.inside,
}


class OpenFoamGas:
    """`coupling.gas.Gas` by sdphGasFoam, in `folder`; its log is `folder/log.sdphGasFoam`.

    `template` is an OpenFOAM case with 0, constant and system; None takes `folder` as an earlier run left it. Code in
    either is refused, and kept from running, unless `allow_code`.
    Time folders are written at the outputs of the case; `case_folder/case.foam` opens them, of `ranks` ranks, in
    ParaView.
    """

    def __init__(
        self,
        case,
        folder: Path,
        template: Path | None,
        *,
        status: Callable[[str], None] = silent,
        allow_code: bool = False,
    ):
        self._case, self._folder, self._status = case, Path(folder).resolve(), status
        self._log, self.case_folder = self._folder / "log.sdphGasFoam", self._folder
        self.ranks = case.coupling.gas_ranks
        self._process, self._connection, self._asking = None, None, False
        self._time, self._clock, self._fields = 0.0, Clock(case.run), ()
        self._heard = True  # the solver, of the last window
        self._allow_code, self._known, self._links = allow_code, {}, Links()
        try:
            self._begin(Path(folder), template)
        except BaseException:
            self.close()
            raise

    def _begin(self, folder: Path, template: Path | None) -> None:
        """Make the case of a template, or take the folder as it is, and start the solver."""
        case_files.refuse_path(self._links.plain(self._folder))
        if template is None:
            self._refuse_code(folder)
        files.sweep(self._folder)
        program = install.gas_solver(self._status)
        self._turbulence = install.gas_turbulence(self._status) if self._case.gas.turbulent else None
        if template is not None:
            options = self._case.coupling.gas_ranks, self._allow_code, self._known
            case_files.write_case(self._case, Path(template), self._folder, *options)
            case_files.refuse_unread(Path(template))
            self._make_mesh()
        self._launch(program)

    def _make_mesh(self) -> None:
        if not (self._folder / "constant" / "polyMesh").exists():
            self._run("blockMesh")
            case_files.write_start_fields(self._case, self._folder)
        if self._case.coupling.gas_ranks > 1:
            self._run("decomposePar", "-force")
        (self._folder / "case.foam").touch()

    def _run(self, program: str, *options: str) -> None:
        """A program of OpenFOAM, which finds no code in what the one before it has written."""
        self._refuse_code(self._folder)
        own, log = self._links, self._folder / f"log.{program}"
        command = [program, "-case", str(own.plain(self._folder)), *options]
        programs.run(command, own.place(self._folder), log, self._environment())

    def _refuse_code(self, folder: Path) -> None:
        if not self._allow_code:
            case_files.refuse_code(folder, self._known)

    def _environment(self) -> dict[str, str]:
        return install.environment() if self._allow_code else barrier.environment()

    def _launch(self, program: Path) -> None:
        """Start the solver and wait for its greeting."""
        self._refuse_code(self._folder)
        secret = secrets.token_hex(32)
        server = SERVERS[self._case.coupling.transport](secret, self._folder)
        try:
            self._process = self._start(program, server.address, secret)
            self._connection, first = self._guard(lambda alive: server.accept(ANSWER_TIME, alive), "to start")
        finally:
            server.close()
        self._expect(first, Kind.HELLO)
        told = self._expect(
            self._guard(lambda alive: self._connection.receive(ANSWER_TIME, alive), "to start"), Kind.MESH
        )
        self._guard(lambda alive: self._meet(told), "to start")
        self._connection.limit = message_limit(len(self.mesh.volumes))

    def _meet(self, told: Message) -> None:
        """Take what the solver tells of itself and its mesh."""
        told_by.check(told, self._case)
        self.mesh = cell_sizes.spread(told_by.mesh(told), self._case, self._folder)
        self.solver = f"{told.text('solver')}, {told.text('openfoam')}, {told.number('ranks')} ranks"

    def _start(self, program: Path, address: str, secret: str) -> subprocess.Popen:
        ranks = self._case.coupling.gas_ranks
        named, address = str(self._links.plain(self._folder)), self._links.address(address)
        command = [str(program), "-case", named, "-address", address, "-watch", str(os.getpid())]
        if self._turbulence:
            command += ["-turbulence", str(self._turbulence)]
        if ranks > 1:
            command = [*install.mpirun(ranks), *command, "-parallel"]
        # a result that is not a number is named and reported by the solver, not trapped by the processor
        environment = self._environment() | {"SDPH_SECRET": secret, "FOAM_SIGFPE": "false", "FOAM_SETNAN": "false"}
        with self._log.open("wb") as log, programs.starting(command[0]):
            return subprocess.Popen(
                command, cwd=self._links.place(self._folder), env=environment, stdin=subprocess.DEVNULL, stdout=log,
                stderr=log, start_new_session=True,
            )  # fmt: skip

    def start(self, alpha_g: np.ndarray | None, sources: tuple[str, ...], fields: tuple[str, ...] = ()) -> GasState:
        """See `Gas.start`."""
        self._fields = known_fields(fields)
        values = {"sources": " ".join(sources), "fields": " ".join(fields)}
        if alpha_g is not None:
            values["alpha_g"] = np.asarray(alpha_g, float)
        state = self._ask(Message(Kind.START, values, {"alpha_g": "1"}))
        if state.time:
            self.close()
            raise CaseError(
                f"{self._folder}: the gas begins at {state.time:g} s; give startFrom startTime and startTime 0 in "
                "system/controlDict, and its start fields in 0"
            )
        return state

    def advance(self, dt: float, sources: dict[str, np.ndarray]) -> GasState:
        """See `Gas.advance`."""
        self._heard = False
        if "alpha_g" in sources:
            refuse_full_cells(sources["alpha_g"], self.mesh.centres)
        self._heard = True
        units = {name: SOURCES[name][0] for name in sources} | {"dt": "s"}
        return self._ask(
            Message(Kind.ADVANCE, {"dt": float(dt), "write": self._clock.writes(self._time + dt), **sources}, units)
        )

    def retreat(self) -> GasState:
        """See `Gas.retreat`. Of a window that was refused here the solver has not heard: it stands at its start."""
        return self._ask(Message(Kind.RETREAT)) if self._heard else self._state

    def checkpoint(self, folder: Path) -> None:
        """See `Gas.checkpoint`."""
        Path(folder).mkdir(parents=True, exist_ok=True)
        self._request(Message(Kind.CHECKPOINT, {"folder": str(self._links.plain(folder))}), Kind.DONE)

    def restore(self, folder: Path, sources: tuple[str, ...] | None = None, fields: tuple[str, ...] = ()) -> GasState:
        """See `Gas.restore`."""
        self._fields = known_fields(fields)
        known = {} if sources is None else {"sources": " ".join(sources)}
        return self._ask(
            Message(Kind.RESTORE, {"folder": str(self._links.plain(folder)), "fields": " ".join(fields)} | known)
        )

    def close(self) -> None:
        """End the solver and all its ranks; a second call does nothing."""
        if self._connection is not None:
            self._say_goodbye()
            self._connection.close()
            self._connection = None
        if self._process is not None:
            end_group(self._process)
            self._process = None
        self._links.close()

    def _say_goodbye(self) -> None:
        if self._asking:  # it has not answered yet, so that it would not hear
            return
        try:
            self._connection.send(Message(Kind.CLOSE))
            self._process.wait(END_TIME)
        except (OSError, MessageError, subprocess.TimeoutExpired):
            pass  # it is ended by force next

    def _ask(self, message: Message) -> GasState:
        answer = self._request(message, Kind.STATE)
        state = self._guard(
            lambda alive: told_by.state(answer, len(self.mesh.volumes), self._case.vapour is not None, self._fields),
            f"for {message.kind.name}",
        )
        self._time, self._state = state.time, state
        return state

    def _request(self, message: Message, answer: Kind) -> Message:
        if self._connection is None:
            raise GasError("the gas solver was closed")

        def exchange(alive):
            self._asking = True
            self._connection.send(message)
            answer = self._connection.receive(ANSWER_TIME, alive)
            self._asking = False
            return answer

        refused = CheckpointError if message.kind is Kind.RESTORE else GasError
        return self._expect(self._guard(exchange, f"for {message.kind.name}"), answer, refused)

    def _guard(self, action: Callable, what: str):
        """The result of an action that waits for the solver; whatever goes wrong becomes a GasError and ends the
        solver."""
        try:
            return action(self._watch())
        except (ConnectionError, TimeoutError, MessageError) as error:
            reason = self._reason(str(error), what)
            self.close()
            raise GasError(f"{reason} (log: {self._log})") from None

    def _watch(self) -> Callable[[], bool]:
        """Says whether the solver runs, and tells the user what is waited for when that takes long."""
        begin = told = time.monotonic()

        def alive() -> bool:
            nonlocal told
            now = time.monotonic()
            if now - begin >= QUIET and now - told >= 1.0:
                told = now
                self._status(f"waiting for sdphGasFoam, {now - begin:.0f} s, log: {self._log}")
            return self._process.poll() is None

        return alive

    def _reason(self, error: str, what: str) -> str:
        """Reason that the solver does not answer: how it ended, with the end of its log, or what was wrong with its
        answer."""
        try:
            return f"sdphGasFoam {programs.ending(self._process.wait(1.0))}: {programs.reason(self._log)}"
        except subprocess.TimeoutExpired:
            return f"sdphGasFoam, waited {what}: {programs.cause(self._log) or error}"

    def _expect(self, message: Message, kind: Kind, refused: type[GasError] = GasError) -> Message:
        if message.kind is kind:
            return message
        if message.kind is Kind.UNFINISHED:
            raise Unfinished(f"sdphGasFoam says: {one_line(message.values.get('text'))} (log: {self._log})")
        self.close()
        said = (
            message.values.get("text")
            if message.kind is Kind.ERROR
            else f"{message.kind.name} where {kind.name} was expected"
        )
        raise refused(f"sdphGasFoam says: {one_line(said)} (log: {self._log})")
