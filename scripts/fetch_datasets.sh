#!/usr/bin/env bash
# Downloads published recordings from their official addresses, checks them, and unpacks them into the data folder. What it
# knows of each is in configs/recordings/*.toml, which it reads itself, so it works before the build.
set -euo pipefail

usage() {
  cat <<'TEXT'
Usage: scripts/fetch_datasets.sh NAME... [--data DIR] [--keep-archive] [--mirror URL] [--catalogue DIR]
       scripts/fetch_datasets.sh --list [--data DIR] [--catalogue DIR]

Downloads the recordings NAME... (fr1_desk, icl_lr_kt2, ...) into DIR. A recording that is already there and complete is left
alone. An interrupted download goes on where it stopped when the command is repeated. Size, checksum and the number of images
are compared with configs/recordings/NAME.toml as far as they are known, and a recording appears in DIR only when it
is complete.

  --data DIR        folder of recordings (default: FUSEBENCH_DATA)
  --list            print what there is: name, whether it is in DIR, size of the download, licence, title
  --keep-archive    leave the archive in DIR; an archive that lies there already is used instead of a download
  --mirror URL      download from this server instead, with the paths of the official one (default: FUSEBENCH_MIRROR)
  --catalogue DIR   folder of the TOML files (default: configs/recordings)

Exit codes: 0 all is there; 2 usage, or an unknown name; 3 data that could not be downloaded, is corrupt or incomplete, or
has to be fetched by hand (the message says where).
TEXT
}

say() { printf 'fetch_datasets: %s\n' "$*" >&2; }

die() {
  local code=$1
  shift
  say "$@"
  exit "$code"
}

# values FILE KEY: the value of a top-level key, a line for each element of a list; nothing if there is none. Reads the small
# part of TOML that the catalogue uses: one line per key, texts without escapes, integers, lists of texts.
values() {
  awk -v key="$2" '
    /^[ \t]*\[/ { exit }  # tables belong to the calibrations
    match($0, "^" key "[ \t]*=[ \t]*") {
      rest = substr($0, RLENGTH + 1)
      if (rest ~ /^[["]/) {
        while (match(rest, /^[^"#]*"[^"]*"/)) {
          item = substr(rest, 1, RLENGTH)
          rest = substr(rest, RLENGTH + 1)
          sub(/^[^"]*"/, "", item)
          sub(/"$/, "", item)
          print item
          if (rest !~ /^[ \t]*,/) break
        }
      } else {
        sub(/[ \t]*(#.*)?$/, "", rest)
        print rest
      }
      exit
    }' "$1"
}

# value FILE KEY: the first of them.
value() { values "$1" "$2" | sed -n 1p; }

# The names of all recordings: those of their files.
names() {
  { grep -l '^kind[[:space:]]*=[[:space:]]*"recording"' "$catalogue"/*.toml || true; } | sed 's|.*/||; s|[.]toml$||'
}

# nearest NAME: the known name with the least edit distance.
nearest() {
  awk -v wanted="$1" '
    function least(a, b) { return a < b ? a : b }
    function distance(a, b,    i, j, row, above) {
      for (j = 0; j <= length(b); j++) row[j] = j
      for (i = 1; i <= length(a); i++) {
        above = row[0]
        row[0] = i
        for (j = 1; j <= length(b); j++) {
          step = above + (substr(a, i, 1) != substr(b, j, 1))
          above = row[j]
          row[j] = least(step, least(row[j], row[j - 1]) + 1)
        }
      }
      return row[length(b)]
    }
    { d = distance(wanted, $1); if (NR == 1 || d < best) { best = d; name = $1 } }
    END { print name }' <<<"$all_names"
}

# present FILE: the accepted folder that exists in the data folder; nothing if none does.
present() {
  local folder
  if [[ -z $data ]]; then return; fi
  while read -r folder; do
    if [[ -d $data/$folder ]]; then
      printf '%s\n' "$data/$folder"
      return
    fi
  done < <(values "$1" folders)
}

list() {
  local name file bytes size
  while read -r name; do
    file=$catalogue/$name.toml
    bytes=$(value "$file" archive_bytes)
    size='?'
    if [[ -n $bytes ]]; then size=$(((bytes + 500000) / 1000000))MB; fi
    if [[ -z $(value "$file" download) ]]; then size='by hand'; fi
    printf '%-16s %-8s %-8s %-36s %s\n' "$name" "$([[ -n $(present "$file") ]] && echo present || echo -)" "$size" \
      "$(value "$file" licence)" "$(value "$file" title)"
  done <<<"$all_names"
}

# The lists that make a folder a recording of the format, those of them that count its frames, and its folders of colour and of
# depth images.
layout() {
  case "$1" in
    tum) markers=(rgb.txt depth.txt) color=rgb depth=depth ;;
    icl) markers=(associations.txt) color=rgb depth=depth ;;
    eth3d) markers=(rgb.txt depth.txt associated.txt calibration.txt) color=rgb depth=depth ;;
    zr300) markers=(TIMESTAMP.txt IMU.txt) color=color depth=depth ;;
    *) die 2 "format '$1' is not known to this script" ;;
  esac
  counted=("${markers[@]}")
  if [[ $1 == eth3d ]]; then counted=(associated.txt); fi
}

# listed FOLDER LIST...: the images that the lists name.
listed() {
  local folder=$1 list
  shift
  for list in "$@"; do
    case "$list" in
      rgb.txt | depth.txt) awk '!/^#/ && NF >= 2 { print $2 }' "$folder/$list" ;;
      associations.txt | associated.txt) awk '!/^#/ && NF >= 4 { print $2; print $4 }' "$folder/$list" ;;
      TIMESTAMP.txt) awk -F, -v c="$color" -v d="$depth" '!/^#/ && NF >= 3 { print c "/" $2; print d "/" $3 }' "$folder/$list" ;;
    esac
  done | tr -d '\r'
}

count_images() { find "$1" -maxdepth 1 -type f -name '*.png' 2>/dev/null | wc -l; }

# incomplete FOLDER FILE: prints what the recording lacks; nothing if it is complete.
incomplete() {
  local folder=$1 file=$2 list missing pair expected found
  layout "$(value "$file" format)"
  for list in "${markers[@]}"; do
    if [[ ! -s $folder/$list ]]; then
      printf 'there is no %s\n' "$list"
      return
    fi
  done
  missing=$(awk '
    FILENAME == ARGV[1] { have[$0]; next }
    { rows++; sub(/^\.\//, "") }
    !($0 in have) { count++; if (count == 1) first = $0 }
    END {
      if (!rows) print "its lists are empty"
      else if (count) printf "%d listed images are missing or empty, the first is %s\n", count, first
    }' <(find "$folder" -name '*.png' -type f -size +0 -printf '%P\n') <(listed "$folder" "${markers[@]}"))
  if [[ -n $missing ]]; then
    printf '%s\n' "$missing"
    return
  fi
  for pair in "color_images:$color" "depth_images:$depth"; do
    expected=$(value "$file" "${pair%%:*}")
    found=$(count_images "$folder/${pair#*:}")
    if [[ -n $expected ]] && ((found != expected)); then
      printf '%d images in %s, but %d are expected\n' "$found" "${pair#*:}" "$expected"
      return
    fi
  done
  # The formats that list pairs; two images are listed for each.
  expected=$(value "$file" frames)
  found=$(($(listed "$folder" "${counted[@]}" | wc -l) / 2))
  if [[ -n $expected ]] && ((found != expected)); then
    printf '%d frames are listed, but %d are expected\n' "$found" "$expected"
  fi
}

# download URL PART PAGE: into PART, going on after its bytes. Servers cut long downloads, so it is tried again as long as
# each attempt brings something, and a few times when none does.
download() {
  local url=$1 part=$2 page=$3 fruitless=0 restarted=false before after status code
  local progress=(--silent --show-error)
  if [[ -t 2 ]]; then progress=(--progress-bar); fi
  while true; do
    before=$(stat -c %s "$part" 2>/dev/null || echo 0)
    if ((before > 0)); then say "going on after $before bytes of ${url##*/}"; fi
    status=0
    code=$(curl --fail --location "${progress[@]}" --connect-timeout 30 --speed-limit 1 --speed-time 60 \
      --continue-at - --output "$part" --write-out '%{http_code}' "$url") || status=$?
    if ((status == 0)); then return; fi
    # The part is as long as the file, or belongs to another: the checks that follow will tell.
    if [[ $code == 416 ]] && ((before > 0)); then return; fi
    # 33: the server cannot go on in the middle. Then once more from the start, in one piece.
    if ((status == 33)); then
      if $restarted; then die 3 "$url: does not come in one piece, and the server cannot go on in the middle"; fi
      restarted=true
      rm -f "$part"
      continue
    fi
    if [[ $code == 4?? && $code != 408 && $code != 429 ]]; then
      die 3 "$url: the server answers $code; has it moved? The page of the recording is $page"
    fi
    after=$(stat -c %s "$part" 2>/dev/null || echo 0)
    if ((after > before)); then fruitless=0; else fruitless=$((fruitless + 1)); fi
    if ((fruitless == 3)); then
      die 3 "$url: cannot be downloaded (curl ends with $status); repeat the command to go on after $after bytes"
    fi
    sleep $((2 * fruitless))
  done
}

# refuse ARCHIVE WHY: an archive that failed a check is of no use, and would fail again.
refuse() {
  local archive=${1##*/}
  if [[ $1 == "$work"/* ]]; then die 3 "$data/$archive: $2; remove it to download it instead"; fi
  rm -f "$1"
  die 3 "${archive%.part}: $2; it is removed, repeat the command to download it afresh"
}

# check_archive ARCHIVE FILE: size and checksum as far as they are known, integrity, and that it stays in its folder. Only
# plain files and folders are accepted: recordings hold nothing else, and a link could point out of the folder.
check_archive() {
  local archive=$1 expected found bad
  local list=$work/members  # lines "type name"
  expected=$(value "$2" archive_bytes)
  found=$(stat -c %s "$archive")
  if [[ -n $expected ]] && ((found != expected)); then refuse "$archive" "$found bytes, but $expected are expected"; fi
  expected=$(value "$2" archive_sha256)
  if [[ -n $expected && $(sha256sum "$archive" | cut -d ' ' -f 1) != "$expected" ]]; then
    refuse "$archive" "its SHA-256 is not $expected"
  fi
  if is_zip "$archive"; then
    unzip -tqq "$archive" >/dev/null 2>&1 || refuse "$archive" "not a complete zip archive"
    unzip -Z1 "$archive" | sed 's/^/- /' >"$list"
    unzip -Z "$archive" | awk '/^[lbcps]/ && NF >= 9 { print substr($1, 1, 1) " " $NF }' >>"$list"
  else
    gzip -t <"$archive" 2>/dev/null || refuse "$archive" "not a complete gzip archive"
    # "-rw-r--r-- 0/0 123 2011-09-30 15:14 name"
    tar --list --verbose --numeric-owner --gzip --file "$archive" 2>/dev/null |
      awk '{ name = $0; for (i = 0; i < 5; i++) sub(/^[^ ]+ +/, "", name); print substr($1, 1, 1) " " name }' >"$list" ||
      refuse "$archive" "not a complete tar archive"
  fi
  bad=$(awk '{ name = substr($0, 3) }
    !/^[-d] / || name ~ /^\// || name ~ /(^|\/)\.\.(\/|$)/ || name ~ /\\/ { print name; exit }' "$list")
  if [[ -n $bad ]]; then refuse "$archive" "it holds '$bad', which could be written outside of its folder"; fi
}

is_zip() { [[ $1 == *.zip || $1 == *.zip.part ]]; }

unpack() {
  if is_zip "$1"; then
    unzip -qq -o "$1" -d "$2"
  else
    tar --extract --gzip --no-same-owner --no-same-permissions --file "$1" --directory "$2"
  fi
}

# get_archive URL FILE: leaves the path of a checked archive in `archive`.
get_archive() {
  local url=$1 name=${1##*/} expected bytes
  if [[ -n $mirror ]]; then url=${mirror%/}/${url#*://*/}; fi
  if [[ -f $data/$name ]]; then
    say "using $data/$name"
    archive=$work/$name
    ln -f "$data/$name" "$archive" 2>/dev/null || cp "$data/$name" "$archive"
  else
    archive=$parts/$name.part
    expected=$(value "$2" archive_bytes)
    bytes=$(stat -c %s "$archive" 2>/dev/null || echo 0)
    if [[ -n $expected ]] && ((bytes > expected)); then rm -f "$archive"; fi
    if [[ -z $expected ]] || ((bytes != expected)); then
      say "downloading $url${expected:+ ($expected bytes)}"
      download "$url" "$archive" "$(value "$2" page)"
    fi
  fi
  check_archive "$archive" "$2"
}

# fetch NAME
fetch() {
  local name=$1 file=$catalogue/$1.toml folder lack url marker archives=() archive
  folder=$(present "$file")
  if [[ -n $folder ]]; then
    lack=$(incomplete "$folder" "$file")
    if [[ -z $lack ]]; then
      say "$name is complete: $folder"
      return
    fi
    die 3 "$name: $folder is there, but incomplete: $lack; move it away and repeat the command"
  fi
  folder=$data/$(value "$file" folders)
  if [[ -z $(value "$file" download) ]]; then
    die 3 "$name has to be fetched by hand: $(value "$file" download_note). Unpack it to $folder"
  fi

  local unpacked=$work/unpacked
  rm -rf "$unpacked"
  mkdir -p "$unpacked"
  while read -r url; do
    if [[ $url == *.zip ]]; then need unzip; fi
    get_archive "$url" "$file"
    archives+=("$archive")
    say "unpacking ${url##*/}"
    unpack "$archive" "$unpacked" || die 3 "${url##*/} cannot be unpacked"
  done < <(values "$file" download)
  chmod -R u+rwX "$unpacked"

  # Some archives have a folder of their own, others have not.
  layout "$(value "$file" format)"
  marker=$(find "$unpacked" -maxdepth 3 -name "${markers[0]}" -type f -print -quit)
  if [[ -z $marker ]]; then die 3 "$name: the archive (${archives[*]}) holds no ${markers[0]}"; fi
  lack=$(incomplete "${marker%/*}" "$file")
  if [[ -n $lack ]]; then die 3 "$name: the archive (${archives[*]}) is not what was expected: $lack"; fi
  mkdir -p "${folder%/*}"
  mv -T "${marker%/*}" "$folder"
  for archive in "${archives[@]}"; do
    if $keep_archive && [[ $archive == *.part ]]; then
      local kept=${archive##*/}
      mv "$archive" "$data/${kept%.part}"
    else
      rm -f "$archive"
    fi
  done
  say "$name is in $folder"
}

need() {
  command -v "$1" >/dev/null || die 2 "the program $1 is needed: ./scripts/setup.sh installs it"
}

root=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
catalogue=$root/configs/recordings
data=${FUSEBENCH_DATA:-}
mirror=${FUSEBENCH_MIRROR:-}
keep_archive=false
listing=false
wanted=()
while (($# > 0)); do
  case "$1" in
    -h | --help) usage; exit 0 ;;
    --list) listing=true ;;
    --keep-archive) keep_archive=true ;;
    --data | --mirror | --catalogue)
      if (($# < 2)); then die 2 "$1 needs a value"; fi
      case "$1" in
        --data) data=$2 ;;
        --mirror) mirror=$2 ;;
        --catalogue) catalogue=$2 ;;
      esac
      shift
      ;;
    --data=*) data=${1#*=} ;;
    --mirror=*) mirror=${1#*=} ;;
    --catalogue=*) catalogue=${1#*=} ;;
    -*) usage >&2; die 2 "unknown option $1" ;;
    *) wanted+=("$1") ;;
  esac
  shift
done
if [[ ! -d $catalogue ]]; then die 2 "there is no folder $catalogue"; fi
all_names=$(names)
if $listing; then
  list
  exit 0
fi
if ((${#wanted[@]} == 0)); then
  usage >&2
  exit 2
fi
for name in "${wanted[@]}"; do
  if ! grep -Fxq -- "$name" <<<"$all_names"; then
    die 2 "no recording is called '$name'; did you mean $(nearest "$name")? --list prints all"
  fi
done
if [[ -z $data ]]; then die 2 "which folder? --data or FUSEBENCH_DATA names it"; fi
need curl
mkdir -p "$data"
data=$(cd "$data" && pwd)

# Downloads that are not finished stay here; all else goes when the command ends. On the same file system as the
# recordings, so that they appear at once.
parts=$data/.fusebench_fetch
mkdir -p "$parts"
exec 9>"$parts/lock"
flock -n 9 || die 3 "another fetch_datasets.sh is at work in $data"
work=$(mktemp -d "$parts/work.XXXXXX")
cleanup() {
  rm -rf "$work"
  # Nothing half downloaded: leave no trace.
  if ! compgen -G "$parts/*.part" >/dev/null; then rm -rf "$parts"; fi
}
trap cleanup EXIT
trap 'exit 130' INT TERM

for name in "${wanted[@]}"; do fetch "$name"; done
