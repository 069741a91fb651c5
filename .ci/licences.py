#!/usr/bin/env python3
"""Licences and sources of the crates of others, where cargo-deny is not there: the same rules, from deny.toml."""

import json
import re
import subprocess
import sys
from pathlib import Path

rules = (Path(__file__).parent.parent / "deny.toml").read_text()
allow = re.search(r"^allow = \[(.*?)\]", rules, re.MULTILINE | re.DOTALL)
allowed = set(re.findall(r'"([^"]+)"', allow.group(1)))

command = ["cargo", "metadata", "--format-version", "1", "--locked"]
metadata = json.loads(subprocess.run(command, check=True, stdout=subprocess.PIPE).stdout)


def may(licence: str) -> bool:
    """Whether an SPDX expression leaves a licence that is allowed; AND binds closer than OR."""
    words = re.findall(r"[()]|[\w.+-]+(?: WITH [\w.-]+)?", licence.replace("/", " OR "))
    terms = [word.lower() if word in ("AND", "OR") else word if word in "()" else str(word in allowed) for word in words]
    return bool(terms) and eval(" ".join(terms))  # noqa: S307 - nothing but brackets, and, or, True and False


wrong = []
for package in metadata["packages"]:
    name = f"{package['name']} {package['version']}"
    if not may(package["license"] or ""):
        wrong.append(f"{name}: its licence is {package['license'] or 'not given'}")
    if package["source"] not in (None, "registry+https://github.com/rust-lang/crates.io-index"):
        wrong.append(f"{name}: it comes from {package['source']}")
print("\n".join(wrong) or f"{len(metadata['packages'])} packages, all of licences that are allowed")
sys.exit(bool(wrong))
