"""Writes the files of this folder: `python3 conformance/generate.py [FOLDER]`, in a minute.

Needs Python 3.10 or newer and what stands in `requirements.txt`. Nothing here shares code with the tracer.
"""

from __future__ import annotations

import sys
from pathlib import Path

import interfaces
import plates
import rays
from write import write


def main() -> None:
    folder = Path(sys.argv[1]) if len(sys.argv) > 1 else Path(__file__).resolve().parent
    for name, part in [("interfaces", interfaces), ("plates", plates), ("rays", rays)]:
        cases = list(part.cases())
        write(folder, f"{name}.json", part.ABOUT, cases)
        print(f"{name}.json: {len(cases)} cases")


if __name__ == "__main__":
    main()
