#!/usr/bin/env bash
# Counts the instructions of the kernels under callgrind and compares them with the committed counts.
set -euo pipefail

usage() {
  cat <<'TEXT'
Usage: scripts/check_instructions.sh [--binary FILE] [--out DIR]

Runs each kernel of fusebench_kernel_counts once under valgrind's callgrind (about half a minute) and compares how many
instructions it took with results/instructions.csv. A kernel fails that takes over 3 % more, and one that takes over 3 %
less, since counts that are too high hide the next regression: scripts/update_instructions.sh makes new ones. Time is
not looked at. Where compiler, flags, distribution or valgrind are not those of the committed counts, changes are
reported and fail nothing.
  --binary FILE  default: build/ci/tests/perf/fusebench_kernel_counts
  --out DIR      of instructions.csv and of callgrind's files, KERNEL.callgrind; default: build/instructions.
                 Where a kernel spends them: callgrind_annotate DIR/KERNEL.callgrind
Exit codes: 0 all within 3 %, or not comparable; 1 a kernel is not, is new or is gone; 2 usage, or the program failed;
77 valgrind is not installed.
TEXT
}

die() {
  printf 'check_instructions: %s\n' "$1" >&2
  exit 2
}

cd "$(dirname "${BASH_SOURCE[0]}")/.."
export LC_ALL=C
binary=build/ci/tests/perf/fusebench_kernel_counts
out=build/instructions
committed=results/instructions.csv
while (($# > 0)); do
  case $1 in
    --help | -h)
      usage
      exit 0
      ;;
    --binary | --out)
      if (($# < 2)); then die "$1 needs a value"; fi
      if [[ $1 == --binary ]]; then binary=$2; else out=$2; fi
      shift 2
      ;;
    *)
      usage >&2
      exit 2
      ;;
  esac
done
if [[ $binary != */* ]]; then binary=./$binary; fi
if [[ ! -x $binary ]]; then die "there is no program $binary; ./scripts/build.sh ci builds it"; fi
if ! command -v valgrind >/dev/null; then
  printf 'check_instructions: skipped, valgrind is not installed (./scripts/setup.sh installs it)\n' >&2
  exit 77
fi

# What counts depend on besides the sources, as "name: value" lines. Not the CPU: programs see the one that valgrind
# makes up, with AVX2 and without AVX-512.
environment() {
  "$binary" --build
  # shellcheck source=/dev/null
  (. /etc/os-release && printf 'distribution: %s\n' "${PRETTY_NAME:-unknown}")
  printf 'valgrind: %s\n' "$(valgrind --version)"
}

# Leaves KERNEL.callgrind for each kernel and prints "kernel,instructions,items,item" lines.
count_kernels() {
  find "$out" -maxdepth 1 \( -name '*.callgrind' -o -name 'dump*' \) -delete
  # Instrumentation is switched on by the program, for its kernels only.
  if ! valgrind --tool=callgrind --instr-atstart=no --callgrind-out-file="$out/dump" "$binary" \
    >"$out/kernels.txt" 2>"$out/valgrind.txt"; then
    tail -n 5 "$out/valgrind.txt" >&2
    die "$binary failed under valgrind (all it said: $out/valgrind.txt)"
  fi
  local dump kernel
  for dump in "$out"/dump.*; do
    kernel=$(sed -n 's/^desc: Trigger: Client Request: //p' "$dump")
    mv "$dump" "$out/$kernel.callgrind"
  done
  rm -f "$out/dump"
  while IFS=, read -r kernel items item; do
    if [[ ! -f $out/$kernel.callgrind ]]; then die "callgrind says nothing of the kernel $kernel"; fi
    printf '%s,%s,%s,%s\n' "$kernel" "$(sed -n 's/^totals: //p' "$out/$kernel.callgrind")" "$items" "$item"
  done <"$out/kernels.txt"
}

# differing_environment OLD NEW: a sentence for each line of NEW's header that OLD does not have.
differing_environment() {
  awk '
    /^#/ { name = $2; value = $0; sub(/^# [^ ]* /, "", value) }
    !/^#/ { next }
    FNR == NR { before[name] = value; next }
    before[name] != value {
      printf "%s the counts are of %s, this is %s\n", name, name in before ? before[name] : "(not recorded)", value
    }' "$1" "$2"
}

# compare OLD NEW: the table; exit code 1 if a kernel left the band, is new or is gone.
compare() {
  awk -F, '
    /^#/ || /^kernel,/ { next }
    FNR == NR { before[$1] = $2; items_before[$1] = $3; order[++count] = $1; next }
    FNR != NR && !header++ {
      printf "%-24s %13s %13s %9s   %s\n", "kernel", "committed", "now", "change", "instructions"
    }
    {
      seen[$1] = 1
      each = sprintf("%.1f per %s", $2 / $3, $4)
      if (!($1 in before)) {
        printf "%-24s %13s %13.0f %9s   %-22s  NEW\n", $1, "-", $2, "-", each
        failed = 1
        next
      }
      change = 100 * ($2 - before[$1]) / before[$1]
      verdict = change > 3 ? "  MORE" : change < -3 ? "  LESS" : ""
      if ($3 != items_before[$1]) verdict = verdict sprintf("  (%d items, were %d)", $3, items_before[$1])
      row = sprintf("%-24s %13.0f %13.0f %+7.2f %%   %-22s%s", $1, before[$1], $2, change, each, verdict)
      sub(/ +$/, "", row)
      print row
      if (change > 3 || change < -3) failed = 1
    }
    END {
      for (i = 1; i <= count; i++) {
        if (!(order[i] in seen)) {
          printf "%-24s %13.0f %13s %9s   %-22s  GONE\n", order[i], before[order[i]], "-", "-", ""
          failed = 1
        }
      }
      exit failed + 0
    }' "$1" "$2"
}

mkdir -p "$out"
{
  environment | sed 's/^/# /'
  printf 'kernel,instructions,items,item\n'
  count_kernels
} >"$out/counting.csv"
mv "$out/counting.csv" "$out/instructions.csv"
if [[ ! -f $committed ]]; then
  printf 'check_instructions: there is no %s to compare with; scripts/update_instructions.sh makes it\n' "$committed" >&2
  exit 1
fi

status=0
compare "$committed" "$out/instructions.csv" || status=$?
differences=$(differing_environment "$committed" "$out/instructions.csv")
if [[ -n $differences ]]; then
  printf '%s\n' "$differences" | sed 's/^/check_instructions: /' >&2
  printf 'check_instructions: so no change fails; scripts/update_instructions.sh makes counts of this one\n' >&2
  exit 0
fi
if ((status != 0)); then
  printf '%s\n' "check_instructions: MORE: callgrind_annotate $out/KERNEL.callgrind says where, if it was not meant" \
    'check_instructions: what was meant, LESS, NEW and GONE: scripts/update_instructions.sh "REASON"' >&2
fi
exit "$status"
