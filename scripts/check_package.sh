#!/usr/bin/env bash
# The Debian package on a bare Debian 12: installed, used and removed in a folder of its own (chroot).
# shellcheck disable=SC2016  # $HOME and such are of the shells in the chroot
set -euo pipefail

usage() {
  cat <<'TEXT'
Usage: scripts/check_package.sh [--build FOLDER | --deb FILE] [--root FOLDER] [--mirror URL] [--libraries]

Packs FOLDER (default: build/release), or takes FILE, and makes a minimal Debian 12 with debootstrap, in which it
  - installs the package with apt, with what it depends on and nothing else,
  - runs the quickstart as a user without rights, on a recording that it simulates,
  - opens the manual page of each verb, and completes a verb in bash and in zsh,
  - opens the results with the Python module,
  - removes the package, and looks for anything that it has left behind.
  --root FOLDER   keep the system there, and use it again if it is there already (default: a temporary one)
  --libraries     also builds the programs of tests/installed against the package (downloads another 700 MB)
Needs root, the network (Debian's mirror), debootstrap, 2 GB and some minutes, so that it is run on request only.
Exit code: 0 all went well, 1 something did not, 2 usage, 77 a need is not met.
TEXT
}

build=build/release deb='' root='' mirror=http://deb.debian.org/debian libraries=false
while (($# > 0)); do
  case "$1" in
    -h | --help) usage; exit 0 ;;
    --libraries) libraries=true; shift; continue ;;
    --build | --deb | --root | --mirror) (($# > 1)) || { usage >&2; exit 2; } ;;
    *) usage >&2; exit 2 ;;
  esac
  case "$1" in
    --build) build=$2 ;;
    --deb) deb=$(realpath -- "$2") ;;
    --root) root=$(realpath -m -- "$2") ;;
    --mirror) mirror=$2 ;;
  esac
  shift 2
done
cd "$(dirname "${BASH_SOURCE[0]}")/.."
if ((EUID != 0)) || ! command -v debootstrap >/dev/null; then
  printf 'check_package: skipped: it needs root and debootstrap (apt-get install debootstrap)\n' >&2
  exit 77
fi
# Mounts of the chroot are seen by nobody else, and gone with this process.
if [[ -z ${CHECK_PACKAGE_INSIDE:-} ]]; then
  arguments=(--build "$build" --root "$root" --mirror "$mirror")
  [[ -n $deb ]] && arguments+=(--deb "$deb")
  $libraries && arguments+=(--libraries)
  scratch=$(mktemp -d)
  [[ -n $root ]] || arguments[3]=$scratch/root
  status=0
  CHECK_PACKAGE_INSIDE=$scratch unshare --mount -- "$0" "${arguments[@]}" || status=$?
  rm -rf "$scratch"
  exit "$status"
fi
scratch=$CHECK_PACKAGE_INSIDE

failed() {
  printf 'check_package: FAILED: %s\n' "$1" >&2
  if [[ -s $scratch/log ]]; then tail -30 "$scratch/log" | sed 's/^/    /' >&2; fi
  exit 1
}
step() { printf 'check_package: %s\n' "$1" >&2; }
# inside COMMAND LINE: in the system, as root; its output is in the file log. as_user COMMAND LINE: as a user without rights.
inside() {
  env -i PATH=/usr/sbin:/usr/bin:/sbin:/bin HOME=/root LC_ALL=C.UTF-8 TERM=dumb DEBIAN_FRONTEND=noninteractive \
    chroot "$root" bash -euo pipefail -c "$1" >"$scratch/log" 2>&1
}
as_user() {
  env -i PATH=/usr/sbin:/usr/bin:/sbin:/bin HOME=/tmp/user LC_ALL=C.UTF-8 TERM=dumb \
    chroot --userspec=nobody:nogroup "$root" bash -euo pipefail -c "cd /tmp/user; $1" >"$scratch/log" 2>&1
}
# Every file of the system but those that apt, dpkg and the users of this script write.
list_files() {
  inside 'find / -xdev \( -path /proc -o -path /tmp -o -path /var/cache -o -path /var/log -o -path "/var/lib/dpkg" -o -path /var/lib/apt \) -prune -o -print'
  LC_ALL=C sort "$scratch/log" >"$1"
}

if [[ -z $deb ]]; then
  step "packing $build"
  cpack --config "$build/CPackConfig.cmake" -G DEB -B "$scratch/packed" >"$scratch/log" 2>&1 || failed "cpack"
  deb=$(find "$scratch/packed" -maxdepth 1 -name '*.deb')
fi
dpkg-deb --info "$deb"

if [[ ! -x $root/usr/bin/apt-get ]]; then
  step "a minimal Debian 12 from $mirror"
  debootstrap --variant=minbase bookworm "$root" "$mirror" >"$scratch/log" 2>&1 || failed "debootstrap"
fi
mount --bind "$root" "$root"
mount -t proc proc "$root/proc"
mount -t devpts devpts "$root/dev/pts" -o newinstance,ptmxmode=0666  # zsh completes on a terminal
cp /etc/resolv.conf "$root/etc/resolv.conf"
cp "$deb" "$root/tmp/fusebench.deb"
rm -rf "$root/tmp/user"
install -d -m 777 "$root/tmp/user"

step 'installing it with what it depends on'
inside 'apt-get update -q; apt-get install -y -q --no-install-recommends /tmp/fusebench.deb' || failed "it cannot be installed"
step 'quickstart, as a user without rights'
as_user 'fusebench --version
  fusebench simulate --preset slow --size 320x240 --duration 2.5 --out data/slow
  fusebench list suites | grep -q quickstart
  fusebench bench quickstart --data data --out runs
  fusebench table runs
  fusebench report runs --out report.html
  test $(wc -c <report.html) -gt 100000' || failed "the quickstart"
cat "$scratch/log"
inside 'test ! -e /usr/bin/gnuplot' || failed "gnuplot came with it, so that the quickstart was not on a bare system"

step 'manual pages, completion, Python module'
inside 'apt-get install -y -q --no-install-recommends man-db groff zsh python3' || failed "what shows manual pages"
as_user 'man -P cat fusebench-run | grep -q -- "--variant NAME=full"
  man -P cat fusebench | grep -q "fusebench-eval(1)"
  count=0
  for page in /usr/share/man/man1/fusebench*.1.gz; do
    name=$(basename "$page" .1.gz)
    man --warnings -P cat "$name" 2>warnings >page
    if [[ -s warnings ]]; then echo "$name"; cat warnings; exit 1; fi
    grep -q NAME page
    count=$((count + 1))
  done
  test "$count" -gt 25' || failed "manual pages"
as_user 'source /usr/share/bash-completion/completions/fusebench
  COMP_WORDS=(fusebench eval at) COMP_CWORD=2
  _fusebench
  test "${COMPREPLY[*]}" = ate' || failed "bash does not complete"
cat >"$root/tmp/user/complete.zsh" <<'ZSH'
# Types a line and Tab in a shell of its own, and prints what is then on the line.
zmodload zsh/zpty
zpty shell zsh -f -i
sleep 2  # until its line editor reads keys, here and below
zpty -w shell 'autoload -U compinit; compinit -u -d /tmp/user/zcompdump; PS1=""; echo rea""dy'
local line
zpty -r -m shell line '*ready*'
sleep 2
zpty -n -w shell $'fusebench completion b\t\n'
zpty -r -m shell line '*written by*'
print -r -- "$line"
zpty -d shell
ZSH
as_user 'timeout 60 zsh -f complete.zsh | grep -a "fusebench completion bash"' || failed "zsh does not complete"
as_user 'python3 -c "
import fusebench_runs
runs = fusebench_runs.open_runs(\"runs\")
print(fusebench_runs.summary(runs, frames=False))
assert all(run.status == \"ok\" for run in runs)"' || failed "the Python module"
inside 'python3 -c "import fusebench_runs"' || failed "the Python module"  # as root, which writes what it compiles

if $libraries; then
  step 'programs built against it'
  suggested=$(dpkg-deb --field "$deb" Suggests | tr -d , | tr ' ' '\n' | grep -- '-dev$' | paste -s -d ' ')
  inside "apt-get install -y -q --no-install-recommends g++ cmake ninja-build $suggested" || failed "what programs need"
  cp -r tests/installed "$root/tmp/user/installed"
  for part in metrics estimator; do
    as_user "cmake -G Ninja -S installed -B $part -DPART=$part; cmake --build $part; $part/$part" || failed "the program with the $part"
    tail -4 "$scratch/log"
  done
fi

step 'removing it'
inside 'apt-get purge -y -q fusebench' || failed "it cannot be removed"
if inside 'dpkg -s fusebench'; then failed "dpkg still knows it"; fi
list_files "$scratch/after"
if grep -i fusebench "$scratch/after" >"$scratch/log"; then failed "it leaves files behind"; fi
# The same system without the package, with and without it having been used once more.
inside 'dpkg -i /tmp/fusebench.deb' || failed "it cannot be installed again"
as_user 'fusebench list variants; man -P cat fusebench' || failed "it does not run again"
inside 'dpkg --purge fusebench' || failed "it cannot be removed again"
list_files "$scratch/again"
diff "$scratch/after" "$scratch/again" >"$scratch/log" || failed "it leaves files behind"
printf 'check_package: %s installs, runs and leaves nothing behind\n' "$(basename "$deb")"
