#!/bin/sh
# Stands in for cloakroom where the commands of the book are tested: the same program on small pictures with few rays.
run() { exec "$CLOAKROOM" "$@"; }
unless() { case " $words " in *" $1 "*) ;; *) printf '%s %s' "$1" "$2" ;; esac; }
words="$*"
scene="--set camera.resolution=[40,30] --set camera.samples=1"
case "$1" in
  render | animate) run "$@" $scene ;;
  quality) run "$@" --set camera.resolution=[12,9] --set camera.samples=1 --set trace.min_power=0.01 ;;
  figures | gallery) run "$@" $(unless --size 40x30) $(unless --samples 1) ;;
  flux) run "$@" $(unless --rays 64) $(unless --samples 2) ;;
  view)
    # It serves until Ctrl-C: wait for its address.
    "$CLOAKROOM" "$@" --no-open --port 0 > address &
    page=$!
    tries=200
    until [ -s address ] || [ $tries = 0 ]; do
      sleep 0.1
      tries=$((tries - 1))
    done
    kill -TERM $page
    wait $page
    grep -q '^http://127.0.0.1:[0-9]*/[0-9a-f]*/$' address
    ;;
  *) run "$@" ;;
esac
