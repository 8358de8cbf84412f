#!/usr/bin/env bash
# Studies how the cost of a frame grows: with the frames and the map behind it, with the sizes that are chosen, and what a
# room takes.
set -euo pipefail

usage() {
  cat <<'TEXT'
Usage: scripts/study_growth.sh [PART...] [--binary FILE] [--out DIR] [--recordings DIR] [--frames N] [--repetitions N]
                               [--recordings-only]

Simulates a furnished room of about 5 x 5 x 2.8 m in which a hand-held camera turns around, runs `full` over it with one
thread, and prints Markdown tables (docs/performance.md has the summary). Parts (default: all of them):
  flat   N frames, 480 x 360 (at 640 x 480 they would be 4 GB; at 320 x 240 depth is so noisy that the map drifts and goes on
         growing); 500 frames a turn, so that every 500 show the same: times of each turn, and how they grow from turn to
         turn once all has been seen twice
  sizes  90 frames: times by voxel size, number of patches and image size, with the exponents of power laws
  room   900 frames, 640 x 480, that show nearly all of the room, and beginnings of them: memory, meshing, area of the mesh
Times are medians over the frames of a run, and then over the repetitions, which are interleaved.
  --binary FILE      default: build/release/fusebench
  --out DIR          of PART.csv, PART_slopes.csv, suites and runs; default: build/growth
  --recordings DIR   recordings that are there are used again; default: recordings in --out. All parts: 4 GB, 20 minutes
  --frames N         of flat, 2 .. 10000; default: 5000
  --repetitions N    of sizes and room; default: 3
  --recordings-only  simulate and measure nothing
Finished runs of the same program are not repeated. Exit codes: 0 ok, 2 usage; otherwise those of `fusebench`.
TEXT
}

die() {
  printf 'study_growth: %s\n' "$1" >&2
  exit 2
}

cd "$(dirname "${BASH_SOURCE[0]}")/.."
export LC_ALL=C
binary=build/release/fusebench
out=build/growth
recordings=
frames=5000
repetitions=3
recordings_only=false
parts=()
while (($# > 0)); do
  case $1 in
    --help | -h)
      usage
      exit 0
      ;;
    flat | sizes | room)
      parts+=("$1")
      shift
      ;;
    --recordings-only)
      recordings_only=true
      shift
      ;;
    --binary | --out | --recordings | --frames | --repetitions)
      if (($# < 2)); then die "$1 needs a value"; fi
      declare "${1#--}=$2"
      shift 2
      ;;
    *)
      usage >&2
      exit 2
      ;;
  esac
done
if ((${#parts[@]} == 0)); then parts=(flat sizes room); fi
if [[ ! $frames =~ ^[0-9]+$ ]] || ((frames < 2 || frames > 10000)); then die "--frames $frames (allowed: 2 .. 10000)"; fi
if [[ $binary != */* ]]; then binary=./$binary; fi
if [[ ! -x $binary ]]; then die "there is no program $binary; ./scripts/build.sh release builds it"; fi
recordings=${recordings:-$out/recordings}
# Runs of another program are others.
runs=$out/runs/$("$binary" --version | cksum | cut -d' ' -f1)
mkdir -p "$recordings" "$out/suites" "$runs"

turn=500 # frames
rate=30  # Hz
room_frames=(75 150 300 600 900)  # all, and beginnings that are runs of their own
sizes=(320x240 640x480 960x720 1280x960)
stages=(decode preprocess predict update fuse refresh all)
# Arguments of camera_path. Paths go on after the last frame.
around=(10200 "$turn" -0.3 -20 -20 10)
everywhere=(1000 300 -0.6 -40 32 6)

# ---- recordings

# camera_path FRAMES TURN RADIUS LOW HIGH SWING: a camera on a circle that looks outwards, or across it if RADIUS (m) is
# negative, raised from LOW to HIGH and by SWING up and down three times a turn (degrees; a turn has TURN frames), with the
# unrest of a hand. TUM text; x right, y down, z forward, in a world with z up.
camera_path() {
  awk -v frames="$1" -v turn="$2" -v radius="$3" -v low="$4" -v high="$5" -v swing="$6" -v rate="$rate" '
    function set(w, x, y, z) { q[0] = w; q[1] = x; q[2] = y; q[3] = z }
    function times(w, x, y, z,    a, b, c, d) {
      a = q[0]; b = q[1]; c = q[2]; d = q[3]
      set(a * w - b * x - c * y - d * z, a * x + b * w + c * z - d * y, a * y - b * z + c * w + d * x,
          a * z + b * y - c * x + d * w)
    }
    function wave(hz) { return sin(2 * pi * hz * t) }
    BEGIN {
      pi = atan2(0, -1)
      for (k = 0; k < frames; k++) {
        t = k / rate
        angle = 2 * pi * k / turn
        heading = angle + 0.02 * wave(0.83)
        pitch = (low + (high - low) * k / frames + swing * sin(3 * angle)) * pi / 180 + 0.015 * wave(1.13)
        roll = 0.03 * wave(0.47)
        set(cos(heading / 2), 0, 0, sin(heading / 2))
        times(0.5, -0.5, 0.5, -0.5)  # level, along x
        times(cos(pitch / 2), sin(pitch / 2), 0, 0)
        times(cos(roll / 2), 0, 0, sin(roll / 2))
        printf "%.6f %.6f %.6f %.6f %.9f %.9f %.9f %.9f\n", t, radius * cos(angle) + 0.01 * wave(0.97),
          radius * sin(angle) + 0.01 * wave(0.71), 1.4 + 0.2 * sin(2 * angle) + 0.01 * wave(1.31), q[1], q[2], q[3], q[0]
      }
    }'
}

# simulate NAME SIZE FRAMES CAMERA_PATH...: does nothing if the recording is there.
simulate() {
  local seconds
  seconds=$(awk -v frames="$3" -v rate="$rate" 'BEGIN { printf "%.6f", frames / rate }')
  camera_path "${@:4}" >"$recordings/$1.path"
  "$binary" simulate --trajectory "$recordings/$1.path" --format tum --seed 2 --size "$2" --duration "$seconds" \
    --rate "$rate" --blur-samples 4 --threads 1 --out "$recordings/$1" >&2
}

# simulate_for PART
simulate_for() {
  local size
  case $1 in
    flat) simulate "around_$frames" 480x360 "$frames" "${around[@]}" ;;
    sizes) for size in "${sizes[@]}"; do simulate "view_$size" "$size" 90 "${around[@]}"; done ;;
    room) simulate room 640x480 "${room_frames[-1]}" "${everywhere[@]}" ;;
  esac
}

# ---- runs

# bench SUITE ARGUMENT...: runs the suite of standard input, after what all have in common, into $runs/SUITE.
bench() {
  local suite=$out/suites/$1.toml
  {
    printf 'name = "%s"\nvariants = ["full"]\n' "$1"
    cat
  } >"$suite"
  "$binary" bench "$suite" --data "$recordings" --out "$runs/$1" -j 1 --threads 1 "${@:2}" >&2
}

# folders SUITE
folders() { find "$runs/$1" -name record.json -not -path '*/.*/*' -printf '%h\n' | sort; }

# recorded KEY FOLDER: the first value of the key in the run's record; of an option, its value.
recorded() {
  awk -v key="\"$1\": " '
    begin = index($0, key) {
      value = substr($0, begin + length(key))
      if (value == "{") {
        getline value
        sub(/^[^:]*: /, "", value)
      }
      gsub(/^"|"?,?$/, "", value)
      print value
      exit
    }' "$2/record.json"
}

calculate() { awk "BEGIN { print $1 }"; }

statistics='
  # Sorts values[1] to values[n].
  function median(values, n,    i, j, value) {
    for (i = 2; i <= n; i++) {
      value = values[i]
      for (j = i - 1; j >= 1 && values[j] > value; j--) values[j + 1] = values[j]
      values[j + 1] = value
    }
    return n % 2 ? values[(n + 1) / 2] : (values[n / 2] + values[n / 2 + 1]) / 2
  }'

row_header="frames,blocks,patches,$(IFS=, && printf '%s' "${stages[*]}")"

# stage_rows FOLDER [EVERY]: a row for each EVERY frames of a run (default: one of all): blocks of the model at their end,
# and medians of the patches of a frame and of its milliseconds by stage.
stage_rows() {
  awk -F, -v every="${2:-1000000}" -v stages="${stages[*]}" "$statistics"'
    function end_row(    s, i) {
      printf "%d,%d", n, blocks
      for (s = 0; s <= stage_count; s++) {
        for (i = 1; i <= n; i++) values[i] = cells[s, i]
        printf ",%.10g", median(values, n)
      }
      print ""
      n = 0
    }
    NR == 1 {
      for (i = 1; i <= NF; i++) column[$i] = i
      stage_count = split(stages, stage, " ")
      next
    }
    {
      n++
      blocks = $column["model_blocks"]
      cells[0, n] = $column["patches"]
      cells[stage_count, n] = 0
      for (s = 1; s < stage_count; s++) {
        cells[s, n] = $column[stage[s] "_ms"] + 0
        cells[stage_count, n] += cells[s, n]
      }
      if (n == every) end_row()
    }
    END { if (n > 0) end_row() }' "$1/frames.csv"
}

# medians_by COLUMNS: the rows of standard input that have the same first COLUMNS, as one with the medians of the others.
medians_by() {
  awk -F, -v keys="$1" "$statistics"'
    NR == 1 { print; next }
    {
      key = $1
      for (i = 2; i <= keys; i++) key = key "," $i
      if (!(key in count)) order[++groups] = key
      row = ++count[key]
      for (i = keys + 1; i <= NF; i++) cells[key, i, row] = $i + 0
      columns = NF
    }
    END {
      for (g = 1; g <= groups; g++) {
        key = order[g]
        printf "%s", key
        for (i = keys + 1; i <= columns; i++) {
          for (row = 1; row <= count[key]; row++) values[row] = cells[key, i, row]
          printf ",%.10g", median(values, count[key])
        }
        print ""
      }
    }'
}

# slopes NAME linear|power X Y...: least squares of each column Y of standard input against column X, of a power those of
# their logarithms; a row each: name, x, y, points, slope and its standard error.
slopes() {
  awk -F, -v name="$1" -v power="$([[ $2 == power ]] && printf 1 || printf 0)" -v x="$3" -v ys="${*:4}" '
    NR == 1 { for (i = 1; i <= NF; i++) column[$i] = i; next }
    { for (name_of in column) cells[name_of, NR - 1] = power ? log($column[name_of] + 1e-9) : $column[name_of] }
    END {
      n = NR - 1
      count = split(ys, y, " ")
      for (c = 1; c <= count; c++) {
        mx = my = sxx = sxy = rest = 0
        for (i = 1; i <= n; i++) { mx += cells[x, i] / n; my += cells[y[c], i] / n }
        for (i = 1; i <= n; i++) {
          sxx += (cells[x, i] - mx) ^ 2
          sxy += (cells[x, i] - mx) * (cells[y[c], i] - my)
        }
        if (n < 3 || sxx == 0) {
          printf "%s,%s,%s,%d,,\n", name, x, y[c], n
          continue
        }
        for (i = 1; i <= n; i++) rest += (cells[y[c], i] - my - sxy / sxx * (cells[x, i] - mx)) ^ 2
        printf "%s,%s,%s,%d,%.6g,%.6g\n", name, x, y[c], n, sxy / sxx, sqrt(rest / (n - 2) / sxx)
      }
    }'
}
slopes_header=name,x,y,points,slope,standard_error

# ---- tables

# markdown: CSV as a table, numbers with three digits unless they are whole.
markdown() {
  awk -F, '
    {
      line = "|"
      for (i = 1; i <= NF; i++) line = line " " ($i ~ /^-?[0-9]+\.[0-9e+-]+$/ ? sprintf("%.3g", $i) : $i) " |"
      print line
      if (NR == 1) { gsub(/[^|]+/, "---", line); print line }
    }'
}

# slope_table: rows of slopes, a line for each name and x with a column for each y.
slope_table() {
  awk -F, '
    NR == 1 { next }
    {
      line = $1 "," $2 "," $4
      if (!(line in known)) { known[line] = 1; lines[++line_count] = line }
      if (!($3 in seen)) { seen[$3] = 1; ys[++y_count] = $3 }
      cell[line, $3] = $5 == "" ? "-" : sprintf("%.3f +- %.3f", $5, $6)
    }
    END {
      printf "slope,against,points"
      for (y = 1; y <= y_count; y++) printf ",%s", ys[y]
      print ""
      for (l = 1; l <= line_count; l++) {
        printf "%s", lines[l]
        for (y = 1; y <= y_count; y++) printf ",%s", cell[lines[l], ys[y]]
        print ""
      }
    }' | markdown
}

# print_tables PART TITLE: its CSV files.
print_tables() {
  printf '\n**%s**\n\n' "$2"
  markdown <"$out/$1.csv"
  printf '\n'
  slope_table <"$out/$1_slopes.csv"
}

# ---- flat

flat() {
  local run header=thousand_frames,$row_header
  bench "flat_$frames" <<<"
    recordings = [\"around_$frames\"]
    keep = \"small\""
  run=$(folders "flat_$frames" | sed -n 1p)
  {
    printf '%s\n' "$header"
    stage_rows "$run" "$turn" | awk -v turn="$turn" '{ printf "%g,%s\n", (NR - 1) * turn / 1000, $0 }'
  } >"$out/flat.csv"
  {
    printf '%s\n' "$slopes_header"
    awk -F, -v turn="$turn" 'NR == 1 || ($1 >= 2 * turn / 1000 && $2 == turn)' "$out/flat.csv" |
      slopes 'after two turns' linear thousand_frames "${stages[@]}" blocks
  } >"$out/flat_slopes.csv"
  print_tables flat "Milliseconds a frame by turn, and their growth in 1000 frames"
  printf '\n%s of %s frames tracked, ATE %.1f mm, %.0f MB at most, %.0f ms of CPU a frame, all in all.\n' \
    "$(recorded tracked "$run")" "$(recorded frames "$run")" "$(calculate "1000 * $(recorded rmse "$run")")" \
    "$(calculate "$(recorded peak_rss_bytes "$run") / 1e6")" "$(calculate "1000 * $(recorded cpu_s "$run") / $frames")"
}

# ---- sizes

# What a sweep varies, as a number of the run in the folder.
voxels_of() { calculate "1000 * $(recorded tsdf.voxel_m "$1")"; }
patches_of() { recorded patches.max_count "$1"; }
images_of() { recorded name "$1" | sed 's/.*_\(.*\)x\(.*\)/\1 * \2/' | { read -r product && calculate "$product"; }; }

bench_sizes() {
  bench voxels --repetitions "$repetitions" <<<'
    recordings = ["view_640x480"]
    keep = "small"
    [[sweep]]
    tsdf.voxel_m = [0.004, 0.006, 0.008, 0.010, 0.014, 0.020]'
  # Room for 400 of them: they are 20 px apart by default.
  bench patches --repetitions "$repetitions" <<<'
    recordings = ["view_640x480"]
    keep = "small"
    [config]
    patches.min_distance_px = 8
    [[sweep]]
    patches.max_count = [25, 50, 100, 200, 400]'
  bench images --repetitions "$repetitions" <<<"
    recordings = [$(printf '"view_%s", ' "${sizes[@]}")]
    keep = \"small\""
}

# sweep_rows SWEEP: a row for each of its runs.
sweep_rows() {
  local run
  folders "$1" | while read -r run; do
    printf '%s,%s,%s\n' "$1" "$("$1_of" "$run")" "$(stage_rows "$run")"
  done | sort -t, -k2,2n
}

# sweep_slopes SWEEP X
sweep_slopes() {
  awk -F, -v sweep="$1" 'NR == 1 || $1 == sweep' "$out/sizes.csv" | slopes "$1" power "$2" "${stages[@]}" blocks
}

sizes() {
  bench_sizes
  {
    printf 'sweep,value,%s\n' "$row_header"
    sweep_rows voxels
    sweep_rows patches
    sweep_rows images
  } | medians_by 2 >"$out/sizes.csv"
  {
    printf '%s\n' "$slopes_header"
    sweep_slopes voxels value
    sweep_slopes patches patches
    sweep_slopes images value
  } >"$out/sizes_slopes.csv"
  print_tables sizes "Milliseconds a frame by voxel (mm), patches (at most) and image (pixels), and exponents of power laws"
}

# ---- room

# mesh_area FILE.ply: square metres of a binary PLY whose vertices begin with three floats.
mesh_area() {
  local header begin vertices stride
  header=$(head -c 2000 "$1" | sed '/^end_header$/q')
  begin=$((${#header} + 1))
  vertices=$(sed -n 's/^element vertex //p' <<<"$header")
  stride=$(awk '/^element face/ { exit } $2 == "float" { n += 4 } $2 == "uchar" { n++ } END { print n }' <<<"$header")
  {
    od -An -v -t u1 -w"$stride" -j "$begin" -N $((vertices * stride)) "$1"
    od -An -v -t u1 -w13 -j $((begin + vertices * stride)) "$1"
  } | awk -v vertices="$vertices" '
    function number(at,    exponent, fraction) {
      exponent = $(at + 3) % 128 * 2 + ($(at + 2) >= 128)
      if (exponent == 0) return 0
      fraction = (($(at + 2) % 128 * 256 + $(at + 1)) * 256 + $at) / 8388608
      return ($(at + 3) >= 128 ? -1 : 1) * (1 + fraction) * power[exponent]
    }
    function index_at(at) { return (($(at + 3) * 256 + $(at + 2)) * 256 + $(at + 1)) * 256 + $at }
    BEGIN { for (e = 0; e < 256; e++) power[e] = 2 ^ (e - 127) }
    NR <= vertices { x[NR - 1] = number(1); y[NR - 1] = number(5); z[NR - 1] = number(9); next }
    {
      a = index_at(2); b = index_at(6); c = index_at(10)
      ux = x[b] - x[a]; uy = y[b] - y[a]; uz = z[b] - z[a]
      vx = x[c] - x[a]; vy = y[c] - y[a]; vz = z[c] - z[a]
      area += sqrt((uy * vz - uz * vy) ^ 2 + (uz * vx - ux * vz) ^ 2 + (ux * vy - uy * vx) ^ 2) / 2
    }
    END { printf "%.3f\n", area }'
}

# room_rows: a row for each run. Repetitions have the same mesh.
room_rows() {
  local run count area
  declare -A areas=()
  folders room | while read -r run; do
    count=$(recorded frames "$run")
    area=${areas[$count]:-$(mesh_area "$run/mesh.ply")}
    areas[$count]=$area
    printf '%s,%s,%s,%s,%s,%s,%s\n' "$count" "$area" "$(recorded triangles "$run")" "$(recorded blocks "$run")" \
      "$(calculate "4096e-6 * $(recorded blocks "$run")")" \
      "$(calculate "1e-6 * $(recorded peak_rss_bytes "$run")")" "$(recorded mesh_once "$run")"
  done | sort -t, -k1,1n
}

room() {
  bench room --repetitions "$repetitions" <<<"
    recordings = [\"room\"]
    frames = [$(printf '"0:%d", ' "${room_frames[@]}")]"
  {
    printf 'frames,area_m2,triangles,blocks,model_MB,peak_MB,mesh_ms\n'
    room_rows
  } | medians_by 1 >"$out/room.csv"
  {
    printf '%s\n' "$slopes_header"
    slopes exponent power area_m2 blocks peak_MB mesh_ms <"$out/room.csv"
    slopes 'per model MB' linear model_MB area_m2 peak_MB mesh_ms <"$out/room.csv"
  } >"$out/room_slopes.csv"
  print_tables room "A room: what a model takes by the surface that was seen"
}

for part in "${parts[@]}"; do
  simulate_for "$part"
  if $recordings_only; then continue; fi
  "$part"
done
if ! $recordings_only; then
  printf '\n%s on %s.\n' "$("$binary" --version)" \
    "$(recorded cpu "$(find "$runs" -name record.json -not -path '*/.*/*' -printf '%h\n' | sed -n 1p)")"
fi
