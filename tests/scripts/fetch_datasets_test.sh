#!/usr/bin/env bash
# Lets scripts/fetch_datasets.sh fetch made-up recordings from a server on loopback that can cut a connection, and expects it to
# go on where it stopped, and to refuse what is broken without leaving anything in place.
set -euo pipefail

fetch=$(cd "$(dirname "${BASH_SOURCE[0]}")/../../scripts" && pwd)/fetch_datasets.sh
folder=$(mktemp -d)
server=
trap 'kill $server 2>/dev/null || true; rm -rf "$folder"' EXIT
mkdir -p "$folder"/{catalogue,www/files,control,data}
data=$folder/data
failures=0
output=

fail() {
  printf '%s\n%s\n' "$1" "$output" >&2
  failures=1
}

# Archives: recordings of three pairs in each layout, and the malicious ones. The images are noise, so that they do not
# compress and a cut falls into the middle of the archive.
python3 - "$folder/www/files" <<'PYTHON'
import io, pathlib, random, sys, tarfile, zipfile

out = pathlib.Path(sys.argv[1])
image = lambda seed: random.Random(seed).randbytes(20000)


def tum(prefix, count=3):
    files = {prefix + 'rgb.txt': b'# color images\n', prefix + 'depth.txt': b'# depth maps\n',
             prefix + 'groundtruth.txt': b'# empty\n'}
    for i in range(count):
        for kind in ('rgb', 'depth'):
            files[f'{prefix}{kind}/{i}.5.png'] = image(f'{kind}{i}')
            files[f'{prefix}{kind}.txt'] += f'{i}.5 {kind}/{i}.5.png\n'.encode()
    return files


def tgz(name, files, links={}):
    with tarfile.open(out / name, 'w:gz') as archive:
        for path, content in files.items():
            member = tarfile.TarInfo(path)
            member.size = len(content)
            archive.addfile(member, io.BytesIO(content))
        for path, target in links.items():
            member = tarfile.TarInfo(path)
            member.type, member.linkname = tarfile.SYMTYPE, target
            archive.addfile(member)


def zipped(name, files):
    with zipfile.ZipFile(out / name, 'w') as archive:
        for path, content in files.items():
            archive.writestr(path, content)


tgz('walk.tgz', tum('rgbd_walk/'))
tgz('few.tgz', {k: v for k, v in tum('few/').items() if k != 'few/depth/1.5.png'})
tgz('escape.tgz', {**tum('escape/'), 'escape/../../../evil.txt': b'evil'})
tgz('link.tgz', tum('link/'), {'link/rgb/out': '/tmp'})
icl = {'associations.txt': b''}
for i in range(3):
    icl['associations.txt'] += f'{i} depth/{i}.png {i} rgb/{i}.png\n'.encode()
    icl.update({f'depth/{i}.png': image(f'd{i}'), f'rgb/{i}.png': image(f'c{i}')})
tgz('flat.tar.gz', icl)
associated = b''.join(f'{i}.5 rgb/{i}.5.png {i}.5 depth/{i}.5.png\n'.encode() for i in range(3))
shake = {**tum('shake/'), 'shake/calibration.txt': b'1 1 1 1\n', 'shake/associated.txt': associated}
zipped('shake_rgbd.zip', shake)
zipped('apart_rgbd.zip', {k: v for k, v in shake.items() if k != 'shake/associated.txt'})
zipped('lost_rgbd.zip', {**shake, 'shake/associated.txt': associated + b'9.5 rgb/9.5.png 9.5 depth/9.5.png\n'})
zipped('shake_imu.zip', {'shake/imu.txt': b'# empty\n'})
zipped('escape.zip', {**tum('zipescape/'), '../../evil.txt': b'evil'})
(out / 'torn.tgz').write_bytes((out / 'walk.tgz').read_bytes()[:-5000])
(out / 'page.tgz').write_bytes(b'<html>not here any more</html>')
PYTHON

# Serves the folder www with byte ranges. control/cut holds "PATH BYTES": the next answer for PATH ends after BYTES. Each
# request is a line of control/log: "PATH RANGE". With control/no_ranges, ranges are ignored.
cat >"$folder/server.py" <<'PYTHON'
import http.server, pathlib, re, sys

folder = pathlib.Path(sys.argv[1])
cut, log = folder / 'control/cut', folder / 'control/log'


class Handler(http.server.BaseHTTPRequestHandler):
    def do_GET(self):
        asked = self.headers.get('Range', '-')
        with log.open('a') as lines:
            lines.write(f'{self.path} {asked}\n')
        file = folder / 'www' / self.path.lstrip('/')
        if not file.is_file():
            return self.send_error(404)
        content = file.read_bytes()
        ranges = asked != '-' and not (folder / 'control/no_ranges').exists()
        start = int(re.match(r'bytes=(\d+)-', asked)[1]) if ranges else 0
        if start and start >= len(content):
            self.send_response(416)
            self.send_header('Content-Range', f'bytes */{len(content)}')
            self.send_header('Content-Length', '0')
            return self.end_headers()
        self.send_response(206 if start else 200)
        if start:
            self.send_header('Content-Range', f'bytes {start}-{len(content) - 1}/{len(content)}')
        self.send_header('Content-Length', str(len(content) - start))
        self.end_headers()
        end = len(content)
        if cut.exists() and cut.read_text().split()[0] == self.path:
            end = start + int(cut.read_text().split()[1])
            cut.unlink()
        self.wfile.write(content[start:end])

    def log_message(self, *_):
        pass


server = http.server.ThreadingHTTPServer(('127.0.0.1', 0), Handler)
(folder / 'control/port.new').write_text(str(server.server_port))
(folder / 'control/port.new').rename(folder / 'control/port')
server.serve_forever()
PYTHON
python3 "$folder/server.py" "$folder" &
server=$!
for _ in $(seq 100); do
  if [[ -f $folder/control/port ]]; then break; fi
  sleep 0.1
done
mirror=http://127.0.0.1:$(<"$folder/control/port")

# recording NAME FORMAT ARCHIVES [LINE...]: a file of the catalogue.
recording() {
  local name=$1 format=$2 archives=$3
  shift 3
  {
    printf 'kind = "recording"\nname = "%s"\ntitle = "made up"\nfamily = "tum"\nformat = "%s"\n' "$name" "$format"
    printf 'folders = ["there/%s", "%s"]\npage = "https://example.invalid/"\nlicence = "none"  # "none" at all\n' "$name" "$name"
    printf '%s\n' "${archives:+download = [$archives]}" "$@"
  } >"$folder/catalogue/$name.toml"
}
digest() { sha256sum "$folder/www/files/$1" | cut -d ' ' -f 1; }
bytes() { stat -c %s "$folder/www/files/$1"; }
address() { printf '"https://example.invalid/files/%s"' "$1"; }

walk_facts=("archive_bytes = $(bytes walk.tgz)" "archive_sha256 = \"$(digest walk.tgz)\"" 'color_images = 3 # counted' 'depth_images = 3')
recording walk tum "$(address walk.tgz)" "${walk_facts[@]}"
recording flat icl "$(address flat.tar.gz)" 'frames = 3'
recording shake eth3d "$(address shake_rgbd.zip), $(address shake_imu.zip)" 'frames = 3'
recording apart eth3d "$(address apart_rgbd.zip)"
recording lost eth3d "$(address lost_rgbd.zip)"
recording by_hand zr300 '' 'download_note = "It is on a drive"' 'frames = 2'
recording few tum "$(address few.tgz)"
recording counted tum "$(address walk.tgz)" 'depth_images = 4'
recording other_sum tum "$(address walk.tgz)" "archive_sha256 = \"$(printf '0%.0s' {1..64})\""
recording other_size tum "$(address walk.tgz)" 'archive_bytes = 12345678'
recording torn tum "$(address torn.tgz)"
recording page tum "$(address page.tgz)"
recording escape tum "$(address escape.tgz)"
recording link tum "$(address link.tgz)"
recording zipescape tum "$(address escape.zip)"
recording gone tum "$(address gone.tgz)"
printf 'kind = "calibration"\nname = "lens"\n[color]\nfx_px = 1\n' >"$folder/catalogue/lens.toml"

# run CODE WORDS ARGUMENT...: the command ends with CODE and says WORDS.
run() {
  local expected=$1 words=$2 code=0
  shift 2
  : >"$folder/control/log"
  output=$("$fetch" --catalogue "$folder/catalogue" --mirror "$mirror" --data "$data" "$@" 2>&1) || code=$?
  if ((code != expected)); then fail "$*: exit code $code, expected $expected"; fi
  if [[ $output != *"$words"* ]]; then fail "$*: does not say '$words'"; fi
}
requests() { wc -l <"$folder/control/log"; }
fresh() { rm -rf "$data" && mkdir "$data"; }
# expect_nothing NAME: neither the recording nor a part of it nor a working folder is left, and nothing outside.
expect_nothing() {
  local left
  left=$(find "$data" -mindepth 1)
  if [[ -n $left || -e $folder/evil.txt || -e $data/../evil.txt ]]; then fail "$1 leaves $left"; fi
}

# A fresh download appears in the first accepted folder, and the second time nothing is downloaded.
run 0 "walk is in" walk
cmp -s "$data/there/walk/rgb/1.5.png" <(tar -xzOf "$folder/www/files/walk.tgz" rgbd_walk/rgb/1.5.png) || fail 'walk differs from its archive'
if [[ $(find "$data" -mindepth 1 -maxdepth 1) != "$data/there" ]]; then fail "walk leaves more than itself: $(ls -A "$data")"; fi
run 0 "walk is complete" walk
if (($(requests) != 0)); then fail 'a complete recording was downloaded again'; fi
run 0 "walk is complete: $data/there/walk" walk --keep-archive

# A recording that lies in another accepted folder counts; one that lost an image does not, and is left as it is.
mv "$data/there/walk" "$data/walk"
run 0 "walk is complete: $data/walk" walk
rm "$data/walk/rgb/1.5.png"
run 3 "rgb/1.5.png" walk
if [[ ! -d $data/walk || -d $data/there/walk ]]; then fail 'an incomplete recording was touched'; fi

# An archive without a folder of its own, archives of two parts, several names at once.
fresh
run 0 "flat is in" flat shake walk
if [[ ! -f $data/there/flat/associations.txt || ! -f $data/there/shake/imu.txt || ! -f $data/there/shake/rgb.txt ]]; then
  fail 'flat or shake is not whole'
fi

# A connection that is cut: the same run goes on after the bytes that came.
fresh
printf '/files/walk.tgz 50000\n' >"$folder/control/cut"
run 0 "walk is in" walk
if [[ $(<"$folder/control/log") != $'/files/walk.tgz -\n/files/walk.tgz bytes=50000-' ]]; then
  fail "no range request after the cut: $(<"$folder/control/log")"
fi

# A part that an earlier run left: the next run goes on after it. One that is longer than the file is not used.
fresh
mkdir "$data/.fusebench_fetch"
head -c 30000 "$folder/www/files/walk.tgz" >"$data/.fusebench_fetch/walk.tgz.part"
run 0 "going on after 30000 bytes" walk
if [[ $(<"$folder/control/log") != '/files/walk.tgz bytes=30000-' ]]; then fail "not resumed: $(<"$folder/control/log")"; fi
fresh
mkdir "$data/.fusebench_fetch"
cat "$folder/www/files/walk.tgz" "$folder/www/files/page.tgz" >"$data/.fusebench_fetch/walk.tgz.part"
run 0 "walk is in" walk
# The whole file as a part, without a known size: the server's 416 is no error.
fresh
mkdir "$data/.fusebench_fetch"
cp "$folder/www/files/flat.tar.gz" "$data/.fusebench_fetch/flat.tar.gz.part"
run 0 "flat is in" flat
# A server that cannot go on in the middle: from the start.
fresh
mkdir "$data/.fusebench_fetch"
head -c 30000 "$folder/www/files/walk.tgz" >"$data/.fusebench_fetch/walk.tgz.part"
touch "$folder/control/no_ranges"
run 0 "walk is in" walk
# ... and not for ever, if it cuts as well.
fresh
printf '/files/walk.tgz 50000\n' >"$folder/control/cut"
run 0 "walk is in" walk
rm "$folder/control/no_ranges"
# Bytes of something else before the cut are found by the checksum, removed, and do not come back.
fresh
mkdir "$data/.fusebench_fetch"
head -c 30000 /dev/urandom >"$data/.fusebench_fetch/walk.tgz.part"
run 3 "SHA-256" walk
expect_nothing 'a part of something else'
run 0 "walk is in" walk

# An archive in the data folder is used, and kept; --keep-archive puts it there.
fresh
run 0 "walk is in" walk --keep-archive
if [[ ! -f $data/walk.tgz ]]; then fail 'the archive was not kept'; fi
rm -rf "$data/there"
run 0 "using" walk
if (($(requests) != 0)) || [[ ! -f $data/walk.tgz ]]; then fail 'the archive at hand was not used, or is gone'; fi
rm -rf "$data/there"
printf 'broken' >"$data/walk.tgz"
run 3 "walk.tgz: 6 bytes" walk
if [[ ! -f $data/walk.tgz ]]; then fail "the user's own archive was removed"; fi

# What is broken is refused and leaves nothing.
fresh
run 3 "SHA-256 is not" other_sum
expect_nothing other_sum
run 3 "12345678 are expected" other_size
expect_nothing other_size
run 3 "not a complete gzip archive" torn
expect_nothing torn
run 3 "not a complete gzip archive" page
expect_nothing page
run 3 "escape/../../../evil.txt" escape
expect_nothing escape
run 3 "link/rgb/out" link
expect_nothing link
run 3 "../../evil.txt" zipescape
expect_nothing zipescape
run 3 "404" gone
expect_nothing gone
run 3 "depth/1.5.png" few
if [[ -d $data/there/few ]]; then fail 'an incomplete recording is in place'; fi
run 3 "there is no associated.txt" apart
run 3 "the first is rgb/9.5.png" lost
run 3 "3 images in depth, but 4 are expected" counted
if [[ -d $data/there/counted ]]; then fail 'a recording with other counts is in place'; fi

# What no server has: a sentence that says where to get it, until it is there.
fresh
run 3 "It is on a drive. Unpack it to $data/there/by_hand" by_hand
mkdir -p "$data/by_hand"/{color,depth}
for stamp in 100 200; do
  printf 'x' | tee "$data/by_hand/color/$stamp.png" >"$data/by_hand/depth/$stamp.png"
done
printf '#timestamp(us) colorname depthname\n100,100.png,100.png\n200,200.png,200.png\n' >"$data/by_hand/TIMESTAMP.txt"
printf '#timestamp(us) gx gy gz ax ay az\n' >"$data/by_hand/IMU.txt"
run 0 "by_hand is complete" by_hand

# Usage.
run 2 "did you mean walk?" wakl
if (($(requests) != 0)); then fail 'an unknown name was asked for'; fi
run 2 "did you mean link?" lens
run 2 "Usage" --list-all
run 2 "Usage"
run 0 "by_hand          present" --list
run 0 "Exit codes" --help
output=$(FUSEBENCH_DATA='' "$fetch" --catalogue "$folder/catalogue" walk 2>&1) && fail 'without --data it goes on'
if [[ $output != *FUSEBENCH_DATA* ]]; then fail 'without --data it does not say so'; fi

if ((failures == 0)); then printf 'fetch_datasets: all cases as expected\n'; fi
exit "$failures"
