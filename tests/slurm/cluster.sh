#!/usr/bin/env bash
# A Slurm cluster of one controller and three nodes on this machine, to test runs that are spread over nodes, and
# what becomes of them when a node or the controller is lost.
#
# The controller and each node live in namespaces of their own: network (own address, joined by a veth pair to a
# bridge), processes, mounts and host name. The file system is shared, as on a real cluster with a common folder.
# So these are faithful:
#   kill-node        a power cut: every process of the node and its network are gone at once, nothing says goodbye
#   cut-node         a pulled cable: the node goes on computing and writing, but nobody can talk to it
#   kill-controller  a power cut of the machine with the queue, which has on disk what it last saved
# There is no database, no cgroup and no systemd in it. The munge daemon has a key and a socket of its own, so that
# neither an installed Slurm nor a second cluster in another folder is disturbed. Everything is named after DIR:
# bridge and links after a hash of it, the subnet from 198.18.0.0/15 (the range for benchmarks, not routed anywhere),
# and processes are recognised by DIR on their command line. No mount and no file outside DIR is left.
set -euo pipefail
umask 022
PATH=$PATH:/usr/sbin:/sbin

readonly nodes=(1 2 3)
readonly cpus_per_node=2
readonly wait_seconds=30
readonly skipped=77
readonly packages='slurm-wlm munge iproute2'

usage() {
  cat <<'TEXT'
Usage: tests/slurm/cluster.sh COMMAND DIR [N]

Runs a Slurm cluster of three nodes (n1, n2, n3; 2 CPUs each) on this machine, as root, with its files in DIR.

  up DIR                 start afresh (ends what still runs there), wait until all nodes are idle, and print
                         'export SLURM_CONF=...' for the shell that is to use it
  down DIR               end everything that belongs to DIR; its logs stay; always succeeds
  kill-node DIR N        power cut of node N (1, 2 or 3)
  cut-node DIR N         pull the network cable of node N; it goes on computing
  join-node DIR N        start node N again, or put its cable back, and wait until it takes jobs
  kill-controller DIR    power cut of the controller
  start-controller DIR   start slurmctld again from its saved state, and wait until it answers

FUSEBENCH_SLURM_CONF names a file whose lines are added at the end of slurm.conf: they win over those above them.
Exit code: 0 success, 1 failure (with the ends of the logs), 2 wrong use, 77 this machine does not permit it.
TEXT
}

say() { printf 'cluster: %s\n' "$*" >&2; }

die() {
  say "$1"
  exit "${2:-1}"
}

skip() { die "skipped: $1" "$skipped"; }

# --- what the machine must offer ------------------------------------------------------------------------------------

require_machine() {
  ((EUID == 0)) || skip 'a Slurm cluster in namespaces needs root'
  local tool
  for tool in slurmctld slurmd sbatch squeue sinfo scontrol munged ip unshare setsid flock hostname; do
    command -v "$tool" >/dev/null || skip "$tool is not installed (Debian packages: $packages)"
  done
  unshare --net --pid --fork --kill-child --mount --mount-proc --uts -- \
    bash -c 'hostname probe && ip link set lo up' >/dev/null 2>&1 ||
    skip 'namespaces are not permitted here (a container needs CAP_SYS_ADMIN and CAP_NET_ADMIN)'
  unshare --net -- bash -c 'ip link add probe0 type bridge && ip link add probe1 type veth peer name probe2' \
    >/dev/null 2>&1 || skip 'the kernel offers no bridge or veth network interfaces here'
}

# --- processes and links of DIR -------------------------------------------------------------------------------------

# Prints the ids of this cluster's processes: those whose program is named $1 and that have the word $2 on
# their command line. No pid files: a stale one could name a stranger, and they vanish with a deleted folder.
find_processes() {
  local wanted=$1 word=$2 entry program words
  for entry in /proc/[0-9]*; do
    # Without a process of our own for each of the machine's.
    { mapfile -d '' -t words <"$entry/cmdline"; } 2>/dev/null || continue
    printf -v words '%s\n' "${words[@]}"
    [[ $'\n'$words == *$'\n'"$word"$'\n'* ]] || continue
    program=$(readlink "$entry/exe" 2>/dev/null) || continue
    program=${program% (deleted)}
    if [[ ${program##*/} == "$wanted" ]]; then printf '%s\n' "${entry#/proc/}"; fi
  done
}

# kill -9 of these processes, then waits until they are gone.
end_processes() {
  local program=$1 word=$2 found attempt
  for ((attempt = 0; attempt < 100; ++attempt)); do
    mapfile -t found < <(find_processes "$program" "$word")
    ((${#found[@]})) || return 0
    kill -KILL "${found[@]}" 2>/dev/null || true
    sleep 0.05
  done
  say "these processes of $dir do not end: ${found[*]}"
}

has_link() { ip link show dev "$1" >/dev/null 2>&1; }
delete_link() { if has_link "$1"; then ip link delete dev "$1" 2>/dev/null || true; fi; }

# --- network --------------------------------------------------------------------------------------------------------

# Gives the bridge the first subnet, from one chosen by the hash of DIR on, that no other interface has. Under a lock,
# so that two clusters that start at once do not choose the same.
create_bridge() {
  local lock try number subnet
  exec {lock}<"${BASH_SOURCE[0]}"
  flock "$lock"
  for ((try = 0; try < 512; ++try)); do
    number=$(((16#$hash + try) % 512))
    subnet=198.$((18 + number / 256)).$((number % 256))
    if [[ -z $(ip -4 route show root "$subnet.0/24") ]]; then break; fi
  done
  ((try < 512)) || die 'no subnet of 198.18.0.0/15 is free'
  ip link add "$bridge" type bridge
  ip address add "$subnet.254/24" dev "$bridge"
  ip link set "$bridge" up
  exec {lock}<&-
  printf '%s\n' "$subnet" >"$dir/run/subnet"
}

# --- settings -------------------------------------------------------------------------------------------------------

write_settings() {
  local subnet node
  subnet=$(<"$dir/run/subnet")
  cat >"$dir/slurm.conf" <<CONF
ClusterName=fusebench
SlurmctldHost=controller($subnet.1)
SlurmctldPort=6817
SlurmdPort=6818
SlurmUser=root
SlurmdUser=root
AuthType=auth/munge
CredType=cred/munge
# cred_expire is also how long Slurm holds back a job that it has put into the queue again (default 120 s).
AuthInfo=socket=$dir/run/munge.socket,cred_expire=5
StateSaveLocation=$dir/state
SlurmctldPidFile=$dir/run/slurmctld.pid
SlurmctldLogFile=$dir/log/slurmctld.log
SlurmdSpoolDir=$dir/spool/%n
SlurmdPidFile=$dir/run/slurmd.%n.pid
SlurmdLogFile=$dir/log/slurmd.%n.log
ProctrackType=proctrack/linuxproc
TaskPlugin=task/none
SwitchType=switch/none
MpiDefault=none
JobAcctGatherType=jobacct_gather/none
AccountingStorageType=accounting_storage/none
JobCompType=jobcomp/none
PropagateResourceLimits=NONE
SelectType=select/cons_tres
SelectTypeParameters=CR_CPU
SchedulerType=sched/backfill
SchedulerParameters=batch_sched_delay=0,sched_interval=2,bf_interval=2
MaxArraySize=10001
# a node that comes back takes jobs again, whatever took it out
ReturnToService=2
JobRequeue=1
# a silent node is DOWN after this long
SlurmdTimeout=10
SlurmctldTimeout=10
MessageTimeout=5
TCPTimeout=2
BatchStartTimeout=5
KillWait=2
InactiveLimit=0
CompleteWait=0
# finished jobs are forgotten after this long (default 300 s)
MinJobAge=10
SlurmctldDebug=info
SlurmdDebug=info
# the nodes have what is written here, however small the machine is
SlurmdParameters=config_overrides
CONF
  for node in "${nodes[@]}"; do
    printf 'NodeName=n%d NodeHostname=n%d NodeAddr=%s.1%d CPUs=%d RealMemory=2000 State=UNKNOWN\n' \
      "$node" "$node" "$subnet" "$node" "$cpus_per_node"
  done >>"$dir/slurm.conf"
  printf 'PartitionName=test Nodes=ALL Default=YES MaxTime=INFINITE State=UP\n' >>"$dir/slurm.conf"
  if [[ -n ${FUSEBENCH_SLURM_CONF:-} ]]; then cat "$FUSEBENCH_SLURM_CONF" >>"$dir/slurm.conf"; fi
  # slurmd wants a cgroup plug-in even when none of its work uses one; this one needs nothing mounted.
  printf 'CgroupPlugin=cgroup/v1\n' >"$dir/cgroup.conf"
}

# --- daemons --------------------------------------------------------------------------------------------------------

# --force: it would refuse a folder that belongs to another user than root.
start_munge() {
  (umask 077 && head -c 128 /dev/urandom >"$dir/run/munge.key")
  munged --force --key-file="$dir/run/munge.key" --socket="$dir/run/munge.socket" --num-threads=2 \
    --pid-file="$dir/run/munged.pid" --log-file="$dir/log/munged.log" --seed-file="$dir/run/munge.seed" \
    </dev/null >"$dir/log/munged.console" 2>&1
}

end_munge() { end_processes munged "--key-file=$dir/run/munge.key"; }

# Starts a machine: its name (n1, controller), the last number of its address, and the words of its daemon, which is
# its first process. That waits for its network, which can be made only once its namespace exists.
launch_machine() {
  local name=$1 address link first own attempt
  address=$(<"$dir/run/subnet").$2
  link=$bridge${name:0-1}
  shift 2
  own=$(readlink /proc/self/ns/net)
  delete_link "$link"
  # shellcheck disable=SC2016  # expanded by the inner shell
  setsid unshare --net --pid --fork --kill-child --mount --mount-proc --uts -- bash -c '
    hostname "$1"
    until ip -4 -oneline address show dev eth0 up 2>/dev/null | grep -q inet; do sleep 0.02; done
    exec "${@:3}"' bash "$name" "$(machine_word "$name")" "$@" \
    </dev/null >>"$dir/log/$name.console" 2>&1 &
  first=$!
  disown "$first" # no word about its end from this shell
  for ((attempt = 0; attempt < 250; ++attempt)); do
    if [[ $(readlink "/proc/$first/ns/net" || printf '%s' "$own") != "$own" ]]; then break; fi
    sleep 0.02
  done
  ip link add "$link" type veth peer name eth0 netns "$first"
  ip link set "$link" master "$bridge" up
  # shellcheck disable=SC2016  # expanded by the inner shell
  nsenter --target "$first" --net -- bash -c '
    ip link set lo up && ip address add "$1/24" dev eth0 && ip link set eth0 up' bash "$address"
}

# A word that only the outermost process of this machine has on its command line; --kill-child does the rest.
machine_word() { printf 'machine:%s:%s' "$dir" "$1"; }

is_running() { [[ -n $(find_processes unshare "$(machine_word "$1")") ]]; }

# The link goes first: a connection that the kernel closes would tell the others that the machine ends.
end_machine() {
  delete_link "$bridge${1:0-1}"
  end_processes unshare "$(machine_word "$1")"
}

launch_controller() { launch_machine controller 1 slurmctld -D -f "$conf"; }
launch_node() { launch_machine "n$1" "1$1" slurmd -D -N "n$1" -f "$conf"; }

# --- waiting --------------------------------------------------------------------------------------------------------

# Runs the rest of the words until it succeeds, at most wait_seconds long.
wait_for() {
  local what=$1 deadline=$((SECONDS + wait_seconds))
  shift
  until "$@"; do
    if ((SECONDS >= deadline)); then
      say "$what did not happen within $wait_seconds s"
      return 1
    fi
    sleep 0.1
  done
}

controller_answers() { [[ $(timeout 5 scontrol ping 2>/dev/null) == *' is UP'* ]]; }

all_idle() { [[ $(timeout 5 sinfo -h -N -o '%T' 2>/dev/null | grep -cx idle) == "${#nodes[@]}" ]]; }

node_takes_jobs() { [[ $(timeout 5 sinfo -h -N -n "n$1" -o '%T' 2>/dev/null) =~ ^(idle|mixed|allocated)$ ]]; }

show_logs() {
  local log
  for log in "$dir"/log/*; do
    if [[ -s $log ]]; then
      printf -- '--- %s\n' "$log" >&2
      tail -n 15 "$log" >&2
    fi
  done
}

# --- commands -------------------------------------------------------------------------------------------------------

up() {
  require_machine
  local part
  if [[ ! -e $dir/cluster.id ]]; then
    for part in run log state spool; do
      [[ ! -e $dir/$part ]] || die "$dir/$part exists and is not of this script: choose another folder" 2
    done
  fi
  down
  rm -rf "${dir:?}"/{run,log,state,spool}
  mkdir -p "$dir"/{run,log,state,spool/n1,spool/n2,spool/n3}
  printf '%s\n' "$hash" >"$dir/cluster.id"
  # Whatever fails from here on leaves nothing behind but the logs.
  trap 'show_logs; down' EXIT
  create_bridge
  write_settings
  start_munge
  launch_controller
  local node
  for node in "${nodes[@]}"; do launch_node "$node"; done
  wait_for 'three idle nodes' all_idle
  trap - EXIT
  printf 'export SLURM_CONF=%s\n' "$conf"
}

down() {
  local node
  end_machine controller || true
  for node in "${nodes[@]}"; do end_machine "n$node" || true; done
  end_munge || true
  delete_link "$bridge" || true
  rm -f "$dir"/run/munge.socket* 2>/dev/null || true
}

kill_controller() { end_machine controller; }

start_controller() {
  if is_running controller; then die 'the controller runs already' 2; fi
  launch_controller
  wait_for 'an answer of the controller' controller_answers || { show_logs; exit 1; }
}

kill_node() { end_machine "n$1"; }

cut_node() {
  has_link "$bridge$1" || die "node n$1 does not run" 2
  ip link set dev "$bridge$1" down
}

join_node() {
  if is_running "n$1"; then
    ip link set dev "$bridge$1" up
    # The controller looks at a node that is DOWN only now and then (40 s were seen); this makes it look at once.
    timeout 10 scontrol update NodeName="n$1" State=RESUME >/dev/null 2>&1 || true
  else
    launch_node "$1"
  fi
  wait_for "node n$1 taking jobs" node_takes_jobs "$1" || { show_logs; exit 1; }
}

# --- command line ---------------------------------------------------------------------------------------------------

case "${1:-}" in
  -h | --help) usage; exit 0 ;;
  up | down | kill-controller | start-controller) (($# == 2)) || { usage >&2; exit 2; } ;;
  kill-node | cut-node | join-node) [[ $# == 3 && $3 =~ ^[123]$ ]] || { usage >&2; exit 2; } ;;
  *) usage >&2; exit 2 ;;
esac

command=${1//-/_}
dir=$(realpath -m -- "$2")
[[ $dir =~ ^/[A-Za-z0-9._/+-]+$ ]] || die "slurm.conf cannot hold this path: $dir" 2
# The kernel limits the path of a socket to 107 characters, and those of Slurm lie some 40 characters below DIR.
((${#dir} <= 64)) || die "the path of the folder is longer than 64 characters: $dir" 2
hash=$(printf '%s' "$dir" | sha256sum)
hash=${hash:0:8}
bridge=fb$hash
conf=$dir/slurm.conf
export SLURM_CONF=$conf
if [[ $command != up && $command != down ]]; then
  [[ -e $dir/cluster.id && -e $conf ]] || die "no cluster was started in $dir" 2
fi
"$command" "${@:3}"
