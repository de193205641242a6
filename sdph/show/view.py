"""Pictures and movies of a run: one look for all of them."""

from __future__ import annotations

import time
from collections.abc import Callable, Iterator
from pathlib import Path

from sdph.schema import CaseError
from sdph.show import flat, shot, space, style
from sdph.show.look import Look
from sdph.show.shot import Shot

KINDS = (".png", ".svg", ".pdf")  # of pictures
MOVIES = {".gif": {"duration": 100, "loop": 0}, ".mp4": {"fps": 10, "macro_block_size": 2}}  # ten pictures a second
TELL_DRAWN = 10.0  # s between two lines on how far a movie is


def _silent(text: str) -> None:
    """Tell nobody."""


def show(
    folder: Path, png: Path | None = None, time: float | None = None, field: str | None = None, look: Look | None = None
) -> None:
    """A picture of a run at a time [s], the last without one; without a file a window on the run."""
    look = look or Look(field)
    if png is None:
        from sdph.show import window

        window.open_window(folder, time, look)
        return
    if png.suffix not in KINDS:
        raise CaseError(f"--png {png}: its name must end with {' or '.join(KINDS)}")
    save(sheet(shot.of_folder(folder, time), look), png)


def save(drawn, png: Path) -> None:
    try:
        drawn.figure.savefig(png, facecolor=drawn.theme.paper)
    except OSError as error:
        raise CaseError(f"--png {png} cannot be written: {error}") from None


def sheet(
    taken: Shot, look: Look, scales: dict[str, style.Scale] | None = None, last: float | None = None, fine: int = 2
):
    """A shot drawn: sdph.show.canvas.Sheet. `scales` by field (None: of what `look` names, by the shot itself), `last`
    [s]: end of the run, `fine`: pixels drawn along one that is shown."""
    scales = scales or _scales([taken], look)
    room = flat if taken.axes else space
    return room.draw(taken, look, scales, taken.time if last is None else last, fine)


def _scales(shots: list[Shot], look: Look) -> dict[str, style.Scale]:
    """Scale of each field that `look` names, of all shots; a second one has a map of its own."""
    first, *over = shot.all_chosen(shots, look.field)
    found = {first: style.scale(first, [own for taken in shots for own in taken.values(first, *over)])}
    for name in over:
        own = style.scale(name, [own for taken in shots for own in taken.values(name)])
        found[name] = own if own.map == style.SIGNED else own._replace(map=style.SECOND)
    return found


def movie(
    folder: Path,
    target: Path,
    field: str | None = None,
    look: Look | None = None,
    tell: Callable[[str], None] = _silent,
) -> None:
    """All times of a run as a .gif or .mp4, in one range of colours; `tell` hears now and then how far it is."""
    import imageio.v2 as imageio

    if target.suffix not in MOVIES:
        raise CaseError(f"--movie {target}: its name must end with {' or '.join(MOVIES)}")
    shots, look = shot.all_of_folder(folder), look or Look(field)
    scales, draft = _scales(shots, look), target.with_name(f".{target.stem}.part{target.suffix}")
    try:
        with imageio.get_writer(draft, mode="I", **MOVIES[target.suffix]) as film:
            for taken in _told(shots, tell):
                film.append_data(sheet(taken, look, scales, shots[-1].time, fine=1).image())
        draft.replace(target)
    except OSError as error:
        raise CaseError(f"{target} cannot be written: {error}") from None
    finally:
        draft.unlink(missing_ok=True)


def _told(shots: list[Shot], tell: Callable[[str], None]) -> Iterator[Shot]:
    """The shots one after the other; `tell` hears every TELL_DRAWN seconds how many are drawn and how long the rest
    takes."""
    begun = last = time.perf_counter()
    for number, taken in enumerate(shots):
        now = time.perf_counter()
        if number and now - last > TELL_DRAWN:
            last = now
            tell(f"picture {number} of {len(shots)}, {(now - begun) * (len(shots) - number) / number:.0f} s left")
        yield taken
