#!/usr/bin/env bash
# A sweep on a Slurm cluster that loses a node and, later, its controller in the middle ends with the bytes of the same
# sweep on this machine, and no run is lost. The cluster is made of real daemons on this machine (cluster.sh).
set -uo pipefail

usage() {
  cat <<'TEXT'
Usage: tests/slurm/slurm_test.sh BINARY [SECONDS]
SECONDS: a sweep on the cluster that takes longer is a failure (150); programs with sanitizers are many times as slow.
Exit code 77: no cluster can be started here; the reason is printed.
TEXT
}

if (($# < 1 || $# > 2)); then
  usage >&2
  exit 2
fi
binary=$(realpath -- "$1")
engine_s=${2:-150}
here=$(dirname "$(realpath -- "$0")")
unset FUSEBENCH_DATA

work=$(mktemp -d /tmp/fbslurm.XXXXXX)
tidy() {
  "$here/cluster.sh" down "$work/cluster" >/dev/null 2>&1
  rm -rf "$work"
}
trap tidy EXIT
cd "$work" || exit 2

failures=0
complain() {
  failures=$((failures + 1))
  printf 'FAILED: %s\n' "$1" >&2
  if [[ -s stderr ]]; then tail -n 8 stderr | sed 's/^/    stderr: /' >&2; fi
  show_cluster
}

# Why jobs wait, and why nodes take none: states with reasons, and the ends of the daemons' logs.
show_cluster() {
  {
    timeout 5 sinfo -N -o '%N %T %E'
    timeout 5 squeue -r -o '%i %T %N %r' | head -n 30
    tail -n 15 cluster/log/*
  } 2>&1 | sed 's/^/    cluster: /' >&2
}

# A fresh cluster for each loss, so that one that does not recover cannot spoil the next.
fresh_cluster() {
  local environment status
  environment=$("$here/cluster.sh" up "$work/cluster")
  status=$?
  if ((status == 0)); then eval "$environment"; fi
  return "$status"
}
fresh_cluster || exit $?

cat >sweep.toml <<'TEXT'
name = "cluster"
variants = ["no-imu"]
keep = "small"
[[simulations]]
name = "small"
format = "tum"
preset = "slow"
start = "motion"
seed = 1
duration_s = 0.7
size = "320x240"
blur_samples = 1
[[sweep]]
design = "latin-hypercube"
samples = 24
tsdf.voxel_m = { from = 0.01, to = 0.02 }
iekf.max_iterations = { from = 1, to = 8 }
TEXT

bench() { "$binary" bench sweep.toml --simulated simulated "$@"; }
on_slurm() { timeout "$engine_s" "$binary" bench sweep.toml --simulated simulated --executor slurm --chunk 1 --slurm-silence 4 "$@"; }
table() { "$binary" collect "$1" --without-timing --out "$2" 2>stderr || complain "collect $1: exit code $?"; }
finished() { find "$1" -name record.json -not -path '*/.*/*' 2>/dev/null | wc -l; }

# A controller that was killed may have forgotten its last jobs and start them again; a node that still runs one
# drains itself ("Duplicate jobid"), and takes jobs again when an administrator says so.
resume_drained_nodes() {
  local node
  while sleep 2; do
    for node in $(timeout 5 sinfo -h -N -t drained -o '%N' 2>/dev/null); do
      timeout 5 scontrol update NodeName="$node" State=RESUME >/dev/null 2>&1
    done
  done
}

# until_finished OUT N: bounded, so that a cluster that does nothing is a failure and not a hang.
until_finished() {
  for _ in $(seq 600); do
    if (($(finished "$1") >= $2)); then return; fi
    sleep 0.1
  done
  complain "$1: not $2 runs after a minute"
}

bench --out local -j 2 --threads 1 >stdout 2>stderr || complain "the local sweep: exit code $?"
table local local.csv
[[ $(finished local) == 24 ]] || complain "the local sweep: not 24 runs"

# A node is lost without a word.
on_slurm --out node >stdout 2>stderr &
engine=$!
until_finished node 4
"$here/cluster.sh" kill-node "$work/cluster" 2 || complain "kill-node"
wait "$engine" || complain "with a killed node: exit code $?"
table node node.csv
cmp -s local.csv node.csv || complain "with a killed node: not the table of the local sweep"
"$here/cluster.sh" join-node "$work/cluster" 2 || complain "join-node"

fresh_cluster || complain "a second cluster"
# The controller is killed and comes back. The engine that only submitted is long gone.
on_slurm --out controller --submit >stdout 2>stderr || complain "--submit: exit code $?"
until_finished controller 3
"$here/cluster.sh" kill-controller "$work/cluster" || complain "kill-controller"
sleep 2
"$here/cluster.sh" start-controller "$work/cluster" || complain "start-controller"
resume_drained_nodes &
administrator=$!
on_slurm --out controller >stdout 2>stderr || complain "with a killed controller: exit code $?"
kill "$administrator"
wait "$administrator" 2>/dev/null
table controller controller.csv
cmp -s local.csv controller.csv || complain "with a killed controller: not the table of the local sweep"

fresh_cluster || complain "a third cluster"
# A node that is cut off goes on writing while its runs are made again elsewhere.
on_slurm --out cut >stdout 2>stderr &
engine=$!
until_finished cut 4
"$here/cluster.sh" cut-node "$work/cluster" 3 || complain "cut-node"
wait "$engine" || complain "with a node cut off: exit code $?"
table cut cut.csv
cmp -s local.csv cut.csv || complain "with a node cut off: not the table of the local sweep"

if ((failures > 0)); then
  printf 'slurm: %d checks failed\n' "$failures" >&2
  exit 1
fi
printf 'slurm: passed\n'
