#!/usr/bin/env bash
# Installs the two full-wave solvers: NGSolve in target/full_wave/venv, and Meep from Debian's packages, which this
# script asks for but leaves to you: they need root.
set -euo pipefail
cd "$(dirname "$0")/../.."

if ! /usr/bin/python3 -c 'import meep' 2>/dev/null; then
    printf 'first, as root: apt-get install -y python3-meep\n' >&2
    exit 1
fi

python3 -m venv target/full_wave/venv
target/full_wave/venv/bin/pip install --quiet --requirement benches/full_wave/requirements.txt
cargo build --release --locked
