#!/bin/sh
# Measures other evaluators of W1, a dot product of a filtered normal map: Mesa's llvmpipe, and the printed C of the draw and of its whole pixel.
# Nanoseconds a pixel on one thread, and how far their own pixels are from ninebit's bytes. NINEBIT_GPU may name `ninebit-gpu`, which runs the printed
# WGSL; its replay has no other bytes. Prints the file that `ninebit chart --evaluators FILE` reads.
#   benches/peers/evaluators.sh [ROUNDS] >benches/peers/evaluators.json
# Needs what compare.sh installs, and python3. NINEBIT may name the program.
set -eu
rounds=${1:-9}
here=$(cd "$(dirname "$0")" && pwd)
root=$(cd "$here/../.." && pwd)
scenes=$root/vectors/scenes/bench
ninebit=${NINEBIT:-$root/target/release/ninebit}
work=$(mktemp -d)
trap 'rm -r "$work"' EXIT
gcc -O2 -Wall -Wextra "$here/llvmpipe.c" -o "$work/llvmpipe" -lEGL -lGL -lpng -lm
"$ninebit" render "$scenes/w1.ron" -o "$work/w1.png"
# The peer counts the caller's thread as none of its own.
export LIBGL_ALWAYS_SOFTWARE=1 EGL_LOG_LEVEL=fatal GALLIUM_DRIVER=llvmpipe LP_NUM_THREADS=0
pin=
if command -v taskset >/dev/null; then pin="taskset -c $(taskset -cp $$ | sed 's/.*[ ,-]//')"; fi
round=0
while [ "$round" -lt "$rounds" ]; do
    round=$((round + 1))
    # shellcheck disable=SC2086 # a command and its arguments, or nothing
    $pin "$work/llvmpipe" "$scenes" 60 1 "$work/w1.png" 2>/dev/null >>"$work/all"
done
grep '^w1' "$work/all" | awk '{ print $3 }' | sort -n >"$work/times"
awk -v renderer="$(grep -m 1 '^#' "$work/all" | sed 's/^# //; s/["\\]//g')" -v against="$(grep -m 1 '^rms' "$work/all")" '
    { all[NR] = $1 }
    function at(share) { return all[1 + int((NR - 1) * share + 0.5)] }
    END {
        split(against, of, " ")
        printf "{\n  \"format\": \"ninebit-evaluators-1\",\n  \"evaluators\": [\n    {\n"
        printf "      \"name\": \"llvmpipe\",\n      \"surface\": \"one unit, one stage\",\n"
        printf "      \"yields\": \"bytes by floats, W1 of the benches (%s)\",\n", renderer
        printf "      \"error\": %s,\n      \"largest\": %s,\n", of[2], of[4]
        printf "      \"time\": { \"median\": %s, \"lower\": %s, \"upper\": %s }\n    },\n", at(0.5), at(0.25), at(0.75)
    }' "$work/times"
# Prints an evaluator without an error, of which a file has the times.
exact() {
    sort -n "$1" | awk -v name="$2" -v yields="$3" '
        { all[NR] = $1 }
        function at(share) { return all[1 + int((NR - 1) * share + 0.5)] }
        END {
            printf "    {\n      \"name\": \"%s\",\n      \"surface\": \"one unit, one stage\",\n      \"yields\": \"%s\",\n", name, yields
            printf "      \"error\": 0.0,\n      \"largest\": 0.0,\n"
            printf "      \"time\": { \"median\": %s, \"lower\": %s, \"upper\": %s }\n    },\n", at(0.5), at(0.25), at(0.75)
        }'
}
round=0
while [ "$round" -lt "$rounds" ]; do
    round=$((round + 1))
    # shellcheck disable=SC2086
    NINEBIT=$ninebit $pin "$root/benches/lower.sh" "$scenes/w1.ron" | sed 's/.*whole: \([0-9.]*\) ns.*/\1/' >>"$work/whole"
    if [ -n "${NINEBIT_GPU:-}" ]; then
        "$NINEBIT_GPU" bench --adapter llvmpipe --threads 1 --frames 60 "$scenes/w1.ron" 2>/dev/null | awk '/w1.ron/ { print 1e6 * $4 / $1 }' >>"$work/wgsl"
    fi
done
exact "$work/whole" "printed C, whole pixel" "the stored word from the pixel's place, at random places (\`ninebit lower --whole --to c99\`), gcc -O2"
if [ -n "${NINEBIT_GPU:-}" ]; then
    exact "$work/wgsl" "printed WGSL" "the stored words of W1 by \`ninebit-gpu bench\` on llvmpipe (LLVM 15.0.6, 256 bits), time of the CPU"
fi
# shellcheck disable=SC2086
$pin "$here/c_text.py" "$ninebit" "$scenes/w1.ron" "$rounds" "$work" | sed 's/^/    /'
printf '  ]\n}\n'
