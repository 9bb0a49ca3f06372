#!/bin/sh
# Times scenes that are large in one way each: a million triangles of two pixels, a frame of 4096 x 4096, 4096 draws; 512, 1024 ... of them for
# how cost grows. Prints nanoseconds a pixel, a triangle and a draw, and the largest memory of a whole `render` (GNU time).
#   benches/limits.sh [FRAMES]
set -eu
frames=${1:-5}
root=$(cd "$(dirname "$0")/.." && pwd)
work=$(mktemp -d)
trap 'rm -r "$work"' EXIT
ninebit=${NINEBIT:-}
if [ -z "$ninebit" ]; then
    (cd "$root" && cargo build --release --quiet)
    ninebit=$root/target/release/ninebit
fi

# scene WIDTH HEIGHT DRAWS: `vertices` of one draw are read from stdin; %X% stands for its column.
scene() {
    printf '(version: 1, profile: Nv2a, targets: [(name: "frame", width: %s, height: %s)],\n' "$1" "$2"
    printf 'textures: {"checks": (source: Checker(width: 64, height: 64, cell: 8, colors: ((200, 40, 40), (220, 220, 200))))},\n'
    printf 'names: (programs: {"dot": Combiners(stages: [(rgb: (a: ExpandNormal(Texture0), b: ExpandNormal(PrimaryColor), ab: Spare0, ab_dot_product: true))], '
    printf 'final_combiner: (d: Spare0))}),\ndraws: [\n'
    awk -v draws="$3" '{ all = all $0 } END { for (n = 0; n < draws; n++) { one = all; gsub("%X%", n % 64 * 10, one); gsub("%Y%", int(n / 64) % 48 * 10, one);
        print "(name: \"" n "\", " one ", textures: [(texture: \"checks\", min_filter: Linear, mag_filter: Linear)], program: \"dot\")," } }'
    printf '])\n'
}

grid() { echo "vertices: Matrix(matrix: Identity, mesh: Grid(columns: $1, rows: $2, repeat: (9, 7)), diffuse: Position)"; }

# quad SIDE: two triangles; the rasteriser's domain ends before 4096.
quad() {
    end=$(($1 < 4096 ? $1 : 4095))
    echo "vertices: Window([(position: (0, 0, 0, 1), t0: (0, 0), diffuse: (20, 90, 200)), (position: ($end, 0, 0, 1), t0: (3, 0), diffuse: (220, 90, 20))," \
        "(position: ($end, $end, 0, 2), t0: (3, 4), diffuse: (90, 200, 60)), (position: (0, $end, 0, 2), t0: (0, 4), diffuse: (9, 200, 160))]), indices: [0, 1, 3, 1, 2, 3]"
}

triangle() {
    echo 'vertices: Window([(position: (%X%, %Y%, 0, 1), t0: (0, 0), diffuse: (20, 90, 200)), (position: (%X%, 470, 0, 1), t0: (0, 1), diffuse: (220, 90, 20)),' \
        '(position: (639, %Y%, 0, 1), t0: (1, 0), diffuse: (90, 200, 60))])'
}

# measure NAME UNITS FRAME_PIXELS
measure() {
    "$ninebit" bench "$work/$1.ron" --threads 1 --frames "$frames" --format json >"$work/json"
    awk -v name="$1" -v units="$2" -v frame="$3" '
        function number() { gsub(/[^0-9.]/, ""); return $0 }
        /"shaded_pixels"/ { pixels = number() }
        /"frame_microseconds"/ { inside = 1 }
        inside && /"least"/ { least = number(); inside = 0 }
        /"peak_memory_bytes"/ { peak = number() }
        END { printf "%-18s %10d %10.2f %9.2f %10.1f %8.0f %8.0f\n", name, pixels, least / 1000, least * 1000 / pixels, least * 1000 / units, peak / 1048576,
            (peak - 4 * frame) / 1048576 }' "$work/json"
}

printf '%-18s %10s %10s %9s %10s %8s %8s\n' scene pixels ms ns/pixel ns/unit MB 'no frame'
for cells in 250 500 1000; do
    grid "$cells" $((cells / 2)) | scene 1600 1250 1 >"$work/triangles-$((cells * cells)).ron"
    measure "triangles-$((cells * cells))" $((cells * cells)) 2000000
done
for side in 512 1024 2048 4096; do
    quad "$side" | scene "$side" "$side" 1 >"$work/side-$side.ron"
    measure "side-$side" 1 $((side * side))
done
for draws in 512 1024 2048 4096; do
    triangle | scene 640 480 "$draws" >"$work/draws-$draws.ron"
    measure "draws-$draws" "$draws" 307200
done
