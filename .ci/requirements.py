#!/usr/bin/env python3
"""Prints what the Python package needs, with the extras that are named."""

import sys
import tomllib
from pathlib import Path

project = tomllib.loads((Path(__file__).parents[1] / "python/pyproject.toml").read_text())["project"]
extras = (project["optional-dependencies"][extra] for extra in sys.argv[1:])
print(*project["dependencies"], *(line for extra in extras for line in extra), sep="\n")
