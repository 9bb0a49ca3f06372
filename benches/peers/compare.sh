#!/bin/sh
# Times the workloads by Mesa's llvmpipe and by ninebit in turn, and prints medians of the rounds and their ratio.
#   benches/peers/compare.sh [ROUNDS [ISA [THREADS]]]
# W13 has no peer: in place of one it is timed under the default policies, and as ours under another.
# One thread stays on one processor, the last that the script may use: both are timed there.
# Installs Mesa, EGL, libpng and a C compiler from Debian's packages where they are missing (as root).
set -eu
rounds=${1:-5} isa=${2:-} threads=${3:-1}
here=$(cd "$(dirname "$0")" && pwd)
root=$(cd "$here/../.." && pwd)
scenes=$root/vectors/scenes/bench
work=$(mktemp -d)
trap 'rm -r "$work"' EXIT

packages="gcc libc6-dev libegl-dev libegl-mesa0 libgl-dev libgl1-mesa-dri libpng-dev"
# shellcheck disable=SC2086 # one word a package
dpkg -s $packages >/dev/null 2>&1 || { apt-get update -q && apt-get install -y -q --no-install-recommends $packages; }
gcc -O2 -Wall -Wextra "$here/llvmpipe.c" -o "$work/llvmpipe" -lEGL -lGL -lpng -lm
ninebit=${NINEBIT:-}
if [ -z "$ninebit" ]; then
    (cd "$root" && cargo build --release --quiet)
    ninebit=$root/target/release/ninebit
fi

# The peer counts the caller's thread as none of its own.
export LIBGL_ALWAYS_SOFTWARE=1 EGL_LOG_LEVEL=fatal GALLIUM_DRIVER=llvmpipe
if [ "$threads" = 1 ]; then LP_NUM_THREADS=0; else LP_NUM_THREADS=$threads; fi
export LP_NUM_THREADS

pin=
if [ "$threads" = 1 ] && command -v taskset >/dev/null; then pin="taskset -c $(taskset -cp $$ | sed 's/.*[ ,-]//')"; fi

# A wrong name of an instruction set is said here: the pipes below would hide it.
"$ninebit" bench "$scenes/w1.ron" ${isa:+--isa "$isa"} >"$work/first.txt"

round=0
while [ "$round" -lt "$rounds" ]; do
    round=$((round + 1))
    # shellcheck disable=SC2086 # a command and its arguments, or nothing
    $pin "$work/llvmpipe" "$scenes" 60 2>/dev/null | tee "$work/peer.txt" | grep -v '^#' | while read -r name pixels median least; do
        echo "$name peer $pixels $median $least" >>"$work/all"
    done
    for n in 1 2 3 4 5 6 7 8 9 10 11 12 13 14 15 policy; do
        # W13 under a policy takes the place of a peer: none has its stages.
        who=ours file=$n policy=
        case $n in
        13) who=peer ;; # under the default policies
        policy) file=13 policy="--policy CMB-4=127.5" ;;
        esac
        # shellcheck disable=SC2086
        $pin "$ninebit" bench "$scenes/w$file.ron" --threads "$threads" ${isa:+--isa "$isa"} $policy --format json |
            awk -v name="w$file" -v who="$who" '
                /"shaded_pixels"/ { gsub(/[^0-9]/, ""); pixels = $0 }
                /"ns_per_shaded_pixel"/ { inside = 1 }
                inside && /"least"/ { gsub(/[^0-9.]/, ""); least = $0 }
                inside && /"median"/ { gsub(/[^0-9.]/, ""); median = $0; inside = 0 }
                END { print name, who, pixels, median, least }' >>"$work/all"
    done
done
grep '^#' "$work/peer.txt"
printf '%d rounds, %s thread(s), isa %s; ns a shaded pixel\n' "$rounds" "$threads" "${isa:-widest}"
printf '%-4s %10s %10s %10s %7s %18s\n' '' pixels llvmpipe ninebit ratio 'ratio of the least'
for n in 1 2 3 4 5 6 7 8 9 10 11 12 13 14 15; do
    for who in peer ours; do
        awk -v name="w$n" -v who="$who" '$1 == name && $2 == who { print $4 }' "$work/all" | sort -n |
            awk '{ all[NR] = $1 } END { print all[int((NR + 1) / 2)] }' >"$work/$who"
        awk -v name="w$n" -v who="$who" '$1 == name && $2 == who { print $5 }' "$work/all" | sort -n | head -1 >"$work/$who.least"
    done
    pixels=$(awk -v name="w$n" '$1 == name { print $3 }' "$work/all" | sort -u | paste -sd= -)
    awk -v name="w$n" -v pixels="$pixels" -v p="$(cat "$work/peer")" -v o="$(cat "$work/ours")" \
        -v pl="$(cat "$work/peer.least")" -v ol="$(cat "$work/ours.least")" \
        'BEGIN { printf "%-4s %10s %10.2f %10.2f %7.2f %18.2f\n", name, pixels, p, o, p / o, pl / ol }'
done
