#!/usr/bin/env bash
# Makes what is given to others: release.sh [STEP...], by default all of
#
#   linux     the command for every x86-64 Linux, linked statically
#   windows   the command for x86-64 Windows
#   wheel     the Python package for CPython 3.10 and later on Linux (manylinux 2.17, abi3)
#   web       the page that computes in the browser: a folder, packed, and one file
#
# in target/release-files, with SHA256SUMS. A step that cannot be done says what it lacks, the others go on, and in the end the
# script fails. SKIP="windows web" leaves steps out. PROFILE=dev makes all but the page quickly, to try this script.
#
# Needs rustup, or the standard libraries of the targets; for windows mingw-w64, for the wheel Python with its package index.
set -uo pipefail
cd "$(dirname "$0")" || exit
export CARGO_INCREMENTAL=0 CARGO_TARGET_DIR=$PWD/target
profile=${PROFILE:-release}
# Where Cargo puts what it has made with a profile.
folder=$profile
if [[ $profile == dev ]]; then folder=debug; fi
out=target/release-files
version=$(sed -n '/^\[workspace.package\]/,/^\[/s/^version = "\(.*\)"/\1/p' Cargo.toml)
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

# lacking WHAT HOW: says why a step cannot be done.
lacking() {
  printf '\n*** %s is missing: %s\n' "$1" "$2" >&2
  return 1
}

# Has a standard library for that target, or gets one.
has_target() {
  local library
  library=$(rustc --print sysroot)/lib/rustlib/$1/lib
  if ! compgen -G "$library/libstd-*.rlib" >/dev/null && command -v rustup >/dev/null; then
    timeout 300 rustup target add "$1" >&2 || true
  fi
  compgen -G "$library/libstd-*.rlib" >/dev/null || lacking "Rust's standard library for $1" "rustup target add $1"
}

# What is packed beside the command.
documents() { cp README.md CHANGELOG.md LICENSE-APACHE LICENSE-MIT "$1"; }

linux() {
  local target=x86_64-unknown-linux-musl name=cloakroom-$version-linux-x86_64
  has_target $target || return
  # The ordinary C compiler assembles the few lines that one library has in assembly language.
  CC_x86_64_unknown_linux_musl=${CC_x86_64_unknown_linux_musl:-cc} \
    cargo build -p cloakroom-cli --profile "$profile" --target $target --locked || return
  local made=target/$target/$folder/cloakroom
  # Loaded by the kernel alone: it names no interpreter.
  if LC_ALL=C grep -aq '/lib64/ld-linux' "$made"; then lacking "static linking" "$made asks for a loader" || return; fi
  "$made" --version || return
  mkdir "$work/$name" && documents "$work/$name" && install -m 755 "$made" "$work/$name" || return
  strip "$work/$name/cloakroom" 2>/dev/null || true
  tar -C "$work" --sort=name --owner=0 --group=0 --numeric-owner -czf "$out/$name.tar.gz" "$name"
}

windows() {
  local target=x86_64-pc-windows-gnu name=cloakroom-$version-windows-x86_64
  command -v x86_64-w64-mingw32-gcc >/dev/null ||
    lacking "a linker for Windows (x86_64-w64-mingw32-gcc)" "apt-get install mingw-w64" || return
  has_target $target || return
  cargo build -p cloakroom-cli --profile "$profile" --target $target --locked || return
  mkdir "$work/$name" && documents "$work/$name" || return
  cp "target/$target/$folder/cloakroom.exe" "$work/$name" || return
  x86_64-w64-mingw32-strip "$work/$name/cloakroom.exe" || return
  python3 - "$work" "$name" "$out/$name.zip" <<'PYTHON'
import pathlib, sys, zipfile

work, name, archive = sys.argv[1:]
with zipfile.ZipFile(archive, "w", zipfile.ZIP_DEFLATED, compresslevel=9) as packed:
    for path in sorted(pathlib.Path(work, name).iterdir()):
        packed.write(path, f"{name}/{path.name}")
PYTHON
}

wheel() {
  python3 -m venv "$work/venv" &&
    "$work/venv/bin/pip" install --quiet 'maturin>=1.9,<2' ziglang ||
    lacking "maturin or zig" "a Python package index (pip install maturin ziglang)" || return
  # Zig links against symbols as old as glibc 2.17 has them, whatever is installed here.
  PATH="$work/venv/bin:$PATH" "$work/venv/bin/maturin" build --manifest-path python/Cargo.toml --profile "$profile" \
    --compatibility manylinux2014 --zig --strip --locked --interpreter python3 --out "$work/wheel" || return
  # Into an environment that has nothing, and tried.
  python3 -m venv "$work/fresh" && "$work/fresh/bin/pip" install --quiet "$work"/wheel/*.whl || return
  (cd "$work" && fresh/bin/python -c 'import cloakroom; print(cloakroom.__version__)') || return
  cp "$work"/wheel/*.whl "$out"
}

web() {
  local name=cloakroom-$version-web
  web/build.sh "$work/$name" || lacking "the page" "web/build.sh has said why" || return
  tar -C "$work" --sort=name --owner=0 --group=0 --numeric-owner -czf "$out/$name.tar.gz" "$name" || return
  cp "$work/$name.html" "$out"
}

steps=("$@")
if ((${#steps[@]} == 0)); then steps=(linux windows wheel web); fi
for step in "${steps[@]}" ${SKIP:-}; do
  case $step in
    linux | windows | wheel | web) ;;
    *) echo "there is no step $step; there are linux, windows, wheel and web" >&2 && exit 2 ;;
  esac
done
rm -rf "$out"
mkdir -p "$out"
failed=()
for step in "${steps[@]}"; do
  if [[ " ${SKIP:-} " == *" $step "* ]]; then
    printf '\n== %s: left out\n' "$step"
    continue
  fi
  printf '\n== %s (%d s)\n' "$step" "$SECONDS"
  if ! "$step"; then
    printf '\n*** %s WAS NOT MADE\n' "$step" >&2
    failed+=("$step")
  fi
done
(cd "$out" && find . -type f ! -name SHA256SUMS -printf '%P\0' | sort -z | xargs -0r sha256sum >SHA256SUMS)
printf '\n== %s\n' "$out"
ls -l "$out"
if ((${#failed[@]})); then
  printf '\n*** NOT MADE: %s\n' "${failed[*]}" >&2
  exit 1
fi
