#!/usr/bin/env bash
# The pages of the repository have the tables that scripts/results_tables.py makes of results/*.json. In a small tree, the script writes
# medians, ranges and origins, and refuses what it cannot read.
set -euo pipefail

root=$(cd "$(dirname "${BASH_SOURCE[0]}")/../.." && pwd)
script=$root/scripts/results_tables.py
if ! command -v python3 >/dev/null; then
  printf 'skipped: python3 is not installed\n'
  exit 77
fi
"$script" --check
tree=$(mktemp -d)
trap 'rm -rf "$tree"' EXIT
failures=0
mkdir -p "$tree/results" "$tree/docs" "$tree/scripts/python/fusebench_runs"
cp "$root/scripts/python/fusebench_runs/metrics.json" "$tree/scripts/python/fusebench_runs/"

# run VARIANT RECORDING IMU REPLICATE STATUS ATE_M: a run of a summary.
run() {
  printf '{"recording": "%s", "group": "%s", "split": "held-out", "variant": "%s", "imu": "%s", "replicate": %d, "status": "%s", "values": {"ate_rmse_m": %s}}' \
    "$2" "$2" "$1" "$3" "$4" "$5" "$6"
}
# summary NAME VERSION RUN...
summary() {
  local IFS=,
  printf '{"origin": {"command": "fusebench bench x --data DATA", "date": "2026-01-01", "versions": ["%s"], "machines": ["a CPU"], "absent": ["gone: https://example.org"]},
    "criteria": [{"title": "good", "verdict": "PASS", "measured": 1, "limit": "<= 2", "recordings": 3}], "notes": [], "runs": [%s]}' "$2" "${*:3}" >"$tree/results/$1.json"
}
summary a 1.0 "$(run no-imu desk none 0 ok 0.01)" "$(run no-imu desk none 1 ok 0.02)" "$(run no-imu desk none 2 lost null)" \
  "$(run peer desk none 0 ok 0.005)" "$(run full desk 'synthetic IMU' 0 ok 0.03)"
summary b 2.0 "$(run no-imu desk none 0 ok 0.01)"
summary more 1.0 "$(run other desk none 0 ok 0.02)"

# expect STATUS WORDS PAGE [OPTION]: the exit code, and words of the page or of what the script prints.
expect() {
  local output status=0
  printf '%b\n' "$3" >"$tree/docs/page.md"
  output=$("$script" --root "$tree" ${4:+"$4"} 2>&1) || status=$?
  if ((status != $1)) || [[ $output$(<"$tree/docs/page.md") != *"$2"* ]]; then
    printf '%b\nexit code %d, "%s" and the page\n%s\nexpected %d and "%s"\n' "$3" "$status" "$output" "$(<"$tree/docs/page.md")" "$1" "$2" >&2
    failures=1
  fi
}
region() { printf '<!-- results: %s -->\n%s<!-- end of results -->' "$1" "${2:-}"; }

expect 0 '| desk | 1.50 [1.00, 2.00] (lost: 1 of 3) | **0.50** | 3.00 |' "$(region 'a.json view=systems values=ate_rmse_m')"
expect 0 '| recording | `no-imu` | `peer` | `full`, synthetic IMU |' "$(region 'a.json view=systems values=ate_rmse_m')"
expect 0 'version 1.0, 2026-01-01, a CPU. Not run, since not present: `gone`.' "$(region 'a.json view=criteria')"
expect 0 '    fusebench bench x --data DATA' "$(region 'a.json view=criteria')"
expect 0 'version 1.0, 2026-01-01. [Machine, commands and all numbers](../results/README.md).' "$(region 'a.json view=criteria origin=short')"
expect 2 'origin=long (allowed: short)' "$(region 'a.json view=criteria origin=long')"
expect 0 '| good | PASS | 1 | <= 2 | 3 |' "$(region 'a.json view=criteria')"
expect 0 '- `ate_rmse_m` [cm]: desk: `peer` 0.50, `no-imu` 1.50 [1.00, 2.00]' "$(region 'a.json view=worse values=ate_rmse_m system=no-imu peers=peer')"
expect 0 '- `ate_rmse_m` [cm]: none' "$(region 'a.json view=worse values=ate_rmse_m system=peer peers=no-imu')"
expect 0 '| desk | `no-imu` | 1 | 1.50 |' "$(region 'a.json view=groups values=ate_rmse_m variants=no-imu')"
expect 0 'of different versions' "$(region 'a.json view=criteria')\n$(region 'b.json view=criteria')"
expect 0 '| desk | **1.50 [1.00, 2.00]** (lost: 1 of 3) | **2.00** |' "$(region 'a.json,more.json view=systems values=ate_rmse_m variants=no-imu,other')"
expect 1 'run scripts/results_tables.py' "$(region 'a.json view=criteria' 'old\n')" --check
expect 2 "no metric of" "$(region 'a.json view=systems values=ate')"
expect 2 "view=table (allowed: systems" "$(region 'a.json view=table')"
expect 2 "has no 'values'" "$(region 'a.json view=criteria values=ate_rmse_m')"
expect 2 "has no runs of 'dm'" "$(region 'a.json view=systems values=ate_rmse_m variants=dm')"
expect 2 'c.json: no summary' "$(region 'c.json view=criteria')"
expect 2 "has no '<!-- end of results -->'" '<!-- results: a.json view=criteria -->'

# What the script wrote is up to date.
printf '%s\n' "$(region 'a.json view=systems values=ate_rmse_m')" >"$tree/docs/page.md"
"$script" --root "$tree"
"$script" --root "$tree" --check
exit "$failures"
