#!/usr/bin/env bash
# Installs the programs that cloakroom is measured against. The Python ones go into target/compare/venv;
# the rest are Debian's packages, which this script asks for but leaves to you: they need root.
set -euo pipefail
cd "$(dirname "$0")/../.."

missing=()
command -v povray >/dev/null || missing+=(povray)
command -v valgrind >/dev/null || missing+=(valgrind)
# Mitsuba compiles its kernels with LLVM.
ldconfig -p | grep -q 'libLLVM-1[5-9]\.so\|libLLVM\.so\.19' || missing+=(libllvm19)
if ((${#missing[@]})); then
    printf 'first, as root: apt-get install -y %s\n' "${missing[*]}" >&2
    exit 1
fi

python3 -m venv target/compare/venv
target/compare/venv/bin/pip install --quiet --requirement benches/compare/requirements.txt
cargo build --release --locked
