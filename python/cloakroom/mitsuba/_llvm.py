"""The LLVM that Dr.Jit compiles with: some versions end the process, so one that works is found first."""

from __future__ import annotations

import ctypes.util
import os
import re
from collections.abc import Iterable
from pathlib import Path

__all__ = ["choose"]

#: The oldest version that has been seen to work: Dr.Jit 1.5 aborts the process with 15, and refuses 14.
OLDEST = 19

#: What to do where there is none.
MEND = (
    "install a newer one (Debian, Ubuntu: apt-get install libllvm19; macOS: brew install llvm; Windows: the installer of "
    "llvm.org), or let DRJIT_LIBLLVM_PATH name its library"
)

_FOLDERS = (
    "/usr/lib/x86_64-linux-gnu",
    "/usr/lib/aarch64-linux-gnu",
    "/usr/lib64",
    "/usr/lib",
    "/usr/local/lib",
    "/usr/lib/llvm-*/lib",
    "/opt/homebrew/opt/llvm/lib",
    "/usr/local/opt/llvm/lib",
)


def version_of(path: Path) -> int | None:
    """The major version of a library of LLVM, as its name says or the one that it is a link to."""
    for name in (path.name, path.resolve().name):
        found = re.fullmatch(r"libLLVM(?:-(\d+)|\.so\.(\d+)|\.(\d+)).*", name)
        if found:
            return int(next(filter(None, found.groups())))
    return None


def libraries() -> list[Path]:
    """The libraries of LLVM in the usual places."""
    places: Iterable[Path] = (
        path for folder in _FOLDERS for path in Path("/").glob(f"{folder[1:]}/libLLVM*") if "C" not in path.name
    )
    return [path for path in places if path.suffix != ".a"]


def choose() -> None:
    """Lets Dr.Jit take the newest LLVM that works, unless the environment names one.

    Raises
    ------
    ImportError
        If the one that it would take is known to fail.
    """
    named = os.environ.get("DRJIT_LIBLLVM_PATH")
    if named:
        version = version_of(Path(named))
        if version is not None and version < OLDEST:
            raise ImportError(f"DRJIT_LIBLLVM_PATH is {named}, of LLVM {version}, with which Mitsuba fails: {MEND}")
        return
    found = {path: version_of(path) for path in libraries()}
    known = {path: version for path, version in found.items() if version is not None}
    if not known:
        # Dr.Jit looks in more places, and says itself if there is none.
        if os.name == "posix" and not found and ctypes.util.find_library("LLVM") is None:
            raise ImportError(f"Mitsuba's LLVM variants need LLVM, and none was found: {MEND}")
        return
    newest = max(known, key=lambda path: (known[path], -len(path.name)))
    if known[newest] < OLDEST:
        raise ImportError(f"the newest LLVM here is {known[newest]}, with which Mitsuba fails: {MEND}")
    os.environ["DRJIT_LIBLLVM_PATH"] = str(newest)
