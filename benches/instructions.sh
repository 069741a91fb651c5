#!/usr/bin/env bash
# Instructions that the program executes, counted by valgrind: they hardly wobble, whatever else the machine
# does. Prints a Markdown table of frames of 1 sample a pixel on one thread: the whole process at 64 x 64
# pixels, and what a camera ray takes (the frame at 128 x 128 less the one at 64 x 64, over the difference in
# rays; the writing of the picture is in it). An argument is another binary of the command, to compare.
# ONLY='(iv)' counts one frame; PROFILE=1 lists the costliest functions, by what the rays take there.
#
# valgrind knows no AVX-512: counted is what the program does on a processor with AVX2.
set -euo pipefail
cd "$(dirname "$0")/.."

binary=${1:-target/release/cloakroom}
folder=target/compare/instructions
mkdir -p "$folder"

# A name, and the keys of the one device of the scene.
frames=(
    "empty|"
    "flat mirror|kind = 'square-cloak'; show = 'mirror'"
    "(iii)|kind = 'square-cloak'"
    "(iv)|kind = 'double-gaussian-cloak'"
    "(i)|kind = 'square-cloak'; material = 'positive-uniaxial'"
    "(ii)|kind = 'square-cloak'; material = 'negative-uniaxial'"
    "cylinder cloak|kind = 'cylinder-cloak'"
    "cylinder cloak, radial axis|kind = 'cylinder-cloak'; material = 'radial-uniaxial'"
    "sphere cloak|kind = 'sphere-cloak'"
    "Luneburg lens|kind = 'luneburg-lens'"
    "regularized invisible sphere|kind = 'invisible-sphere'; material = 'regularized'"
)

count() { # edge in pixels, keys
    {
        printf '[camera]\nresolution = [%s, %s]\nsamples = 1\n' "$1" "$1"
        if [[ -n $2 ]]; then printf '[[device]]\nrotation = 10\n%s\n' "${2//; /$'\n'}"; fi
    } >"$folder/frame.toml"
    valgrind --tool=callgrind --callgrind-out-file="$folder/$1.out" \
        "$binary" render "$folder/frame.toml" --threads 1 -o "$folder/frame.png" 2>&1 |
        sed -n 's/.*Collected : \([0-9]*\).*/\1/p'
}

# The instructions of each function, by its name.
functions() {
    # Recursion is told apart by a mark; here it is not.
    callgrind_annotate --threshold=100 "$1" | awk '/^ *[0-9,]+ \(/ && !/PROGRAM TOTALS/ {
        gsub(",", "", $1); count = $1
        sub(/^[^)]*\) +/, ""); sub(/ \[[^]]*\]$/, ""); sub(/^[^:]*:/, ""); sub(/\x27[0-9]+$/, "")
        print count "\t" $0
    }'
}

# What the rays of the larger frame take, by function.
profile() {
    awk -F '\t' -v all="$1" 'NR == FNR { small[$2] += $1; next } { large[$2] += $1 }
        END { for (name in large) printf "%5.1f %%  %s\n", 100 * (large[name] - small[name]) / all, name }' \
        <(functions "$folder/64.out") <(functions "$folder/128.out") |
        sort --reverse --numeric-sort | head -12 | cut -c 1-120 || true
}

printf '| frame | 64 x 64, million instructions | instructions a ray |\n| --- | ---: | ---: |\n'
for frame in "${frames[@]}"; do
    if [[ -n ${ONLY:-} && ${frame%%|*} != "$ONLY" ]]; then continue; fi
    small=$(count 64 "${frame#*|}")
    large=$(count 128 "${frame#*|}")
    printf '| %s | %d | %d |\n' "${frame%%|*}" $((small / 1000000)) \
        $(((large - small) / (128 * 128 - 64 * 64)))
    if [[ -n ${PROFILE:-} ]]; then profile $((large - small)); fi
done
