#!/usr/bin/env bash
# Makes the page that computes in the browser: web/build.sh [FOLDER], else target/page. Any web server can serve the
# folder, under any address; nothing in it asks for anything elsewhere. FOLDER.html, beside it, is the same in one file, which a
# browser opens without a server.
#
# Needs the standard library of wasm32-unknown-unknown: `rustup target add wasm32-unknown-unknown`, or packages of a
# distribution. These have a compiler of their own, which RUSTC names (with LD_LIBRARY_PATH, where its libraries are elsewhere).
set -euo pipefail
cd "$(dirname "$0")/.."
# Not `target/web`, where Cargo has what it runs itself while it builds by the profile of that name.
out=$(realpath -m "${1:-target/page}")
target=wasm32-unknown-unknown
export CARGO_INCREMENTAL=0
built=$(realpath -m "${CARGO_TARGET_DIR:-target}")

# With a compiler of its own, Cargo is not asked which one that is.
has_target() {
  compgen -G "$("${RUSTC:-rustc}" --print sysroot)/lib/rustlib/$target/lib/libstd-*.rlib" >/dev/null
}
if ! has_target && [[ -z ${RUSTC:-} ]] && command -v rustup >/dev/null; then
  timeout 120 rustup target add $target || true
fi
if ! has_target; then
  cat >&2 <<END
There is no standard library of $target for ${RUSTC:-rustc}.
With rustup:   rustup target add $target
Without:       install one by the packages of your system (Debian: rustc-web and libstd-rust-web-dev), and set RUSTC to its compiler.
END
  exit 3
fi
# Where a distribution brings the compiler alone, the linker is that of the toolchain there is.
if ! command -v rust-lld >/dev/null && [[ -n ${RUSTC:-} && -z ${CARGO_TARGET_WASM32_UNKNOWN_UNKNOWN_LINKER:-} ]]; then
  for linker in "$(rustc --print sysroot)"/lib/rustlib/*/bin/rust-lld; do
    if [[ -x $linker ]]; then export CARGO_TARGET_WASM32_UNKNOWN_UNKNOWN_LINKER=$linker; fi
  done
fi

CARGO_TARGET_WASM32_UNKNOWN_UNKNOWN_RUSTFLAGS="-Ctarget-feature=+simd128" \
  cargo build -p cloakroom-wasm --profile web --target $target --locked
# The glue runs here, whatever compiles for browsers.
env -u RUSTC cargo build -p cloakroom-web-glue --locked

rm -rf "$out"
mkdir -p "$out"
"$built/debug/cloakroom-web-glue" compiled "$built/$target/web/cloakroom_wasm.wasm" "$out"
cp crates/viewer/page/* "$out"
cp web/line.js web/worker.js "$out"
chmod -R u+w,a+r "$out"
# Comments, indents, spaces and lines are for who reads the source: an eighth of what is loaded of it.
sed -i '/^ *\/\/ /d; /^ *\/\*.*\*\/$/d; /^ *\/\*\*$/,/\*\/$/d; s/^ *//; /^$/d' "$out"/*.js "$out"/*.css
sed -i 's/ *{ */{/g; s/; *}/}/g; s/: \([^:]\)/:\1/g; s/; /;/g' "$out"/*.css
sed -i 's/ => /=>/g; s/ === /===/g; s/) {$/){/; s/^} else {$/}else{/; s/\(const\|let\) \([A-Za-z_$]*\) = /\1 \2=/' "$out"/*.js
sed -i 's/^\([A-Za-z_$.]*\) = /\1=/; s/^\(["A-Za-z._-]*\): \[/\1:[/' "$out"/*.js
# No text of a script goes on in the next line.
sed -i -z 's/\([;,{([]\)\n/\1/g' "$out"/*.js
sed -i -z 's/\n//g' "$out"/*.css
# What a server says in its headers, the page says itself: it loads what is in its folder.
policy="default-src 'none'; script-src 'self' 'wasm-unsafe-eval'; worker-src 'self'; style-src 'self'; img-src 'self' blob: data:; connect-src 'self'; base-uri 'none'; form-action 'none'"
sed -i "s|^  <meta charset=\"utf-8\">|&\n  <meta http-equiv=\"Content-Security-Policy\" content=\"$policy\">|" "$out/index.html"
# The line to the worker comes before the rest of the page.
sed -i 's|^  <script type="module" src="main.js"></script>|  <script type="module" src="line.js"></script>\n&|' "$out/index.html"
grep -q Content-Security-Policy "$out/index.html" && grep -q 'src="line.js"' "$out/index.html"
sed -i 's/^ *//; /^$/d' "$out/index.html"
# For those who have no web server.
"$built/debug/cloakroom-web-glue" one-file "$out" "$out.html"
du -sb "$out" | cut -f1 | xargs printf '%s bytes in '
echo "$out"
du -b "$out.html"
