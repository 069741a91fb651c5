"""Progress: a line on standard error, or what the caller makes of it."""

from __future__ import annotations

import sys
from collections.abc import Callable, Iterator
from contextlib import contextmanager

#: ``True`` for a line on standard error, ``False`` for silence, or a function of the steps done and the steps in all.
Progress = bool | Callable[[int, int], object]


@contextmanager
def told(progress: Progress, what: str) -> Iterator[Callable[[int, int], object] | None]:
    """What the compiled half is to call, for as long as the work lasts."""
    if callable(progress):
        yield progress
        return
    if not progress:
        yield None
        return
    shown = [""]

    def show(done: int, total: int) -> None:
        text = f"{what} {100 * done // max(total, 1):3d} %"
        if text != shown[0]:
            shown[0] = text
            print("\r" + text, end="", file=sys.stderr, flush=True)

    try:
        yield show
    finally:
        if shown[0]:
            print("\r" + " " * len(shown[0]) + "\r", end="", file=sys.stderr, flush=True)
