"""The figures of the paper."""

from __future__ import annotations

import os
from collections.abc import Iterable
from pathlib import Path

from . import _cloakroom
from ._progress import Progress, told

__all__ = ["figures"]


def figures(
    only: str | Iterable[str] = (),
    folder: str | os.PathLike[str] = "figures",
    *,
    photo: str | os.PathLike[str] | None = None,
    size: tuple[int, int] = (1024, 768),
    samples: int = 4,
    progress: Progress = False,
) -> list[Path]:
    """Makes the figures of Halimeh & Wegener, Opt. Express 21, 9457 (2013), as ``cloakroom figures`` does.

    Parameters
    ----------
    only : str or iterable of str, optional
        Figures and panels, ``"6"`` or ``["2", "6c"]``; all if none is named.
    folder : path, default "figures"
        Where they are written, made if it is not there: panels as ``fig6c.png``, and labelled sheets of whole figures as
        ``fig6.png``, ``.svg`` and ``.pdf``.
    photo : path, optional
        What hangs behind the devices instead of the builtin photograph.
    size : (int, int), default (1024, 768)
        Width and height of a panel in pixels.
    samples : int, default 4
        Camera rays per pixel.
    progress : bool or callable, default False
        ``True`` for a line on standard error, or a function that is called with the rows done and all rows.

    Returns
    -------
    list of Path
        The files, in the order in which they were written.

    Raises
    ------
    TypeError, ValueError
        If there is no such figure, the photograph cannot be read, or a number makes no sense.
    OSError
        If a file cannot be written.
    """
    names = [only] if isinstance(only, str) else [str(name) for name in only]
    width, height = size
    image = None if photo is None else os.fspath(photo)
    with told(progress, "figures") as tell:
        files = _cloakroom.figures(names, os.fspath(folder), image, [width, height], samples, tell)
    return [Path(file) for file in files]
