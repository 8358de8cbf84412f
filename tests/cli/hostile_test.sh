#!/usr/bin/env bash
# Names and texts from strangers: nothing of them is run, and they are texts in every output (SECURITY.md).
set -uo pipefail

usage() {
  cat <<'TEXT'
Usage: tests/cli/hostile_test.sh BINARY
TEXT
}

if (($# != 1)); then
  usage >&2
  exit 2
fi
binary=$(realpath -- "$1")
unset FUSEBENCH_DATA
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work" || exit 2
failures=0

complain() {
  failures=$((failures + 1))
  printf 'FAILED: %s\n' "$1" >&2
}

# Each would make a file named pwned, or be seen as markup.
# shellcheck disable=SC2016  # meant as they are
names=('<img src=x onerror=alert(1)>' '$(touch pwned)' '`touch pwned`' "'; touch pwned; '" '"; touch pwned; "'
  '\immediate\write18{touch pwned}' '\input{pwned}' "'; system('touch pwned') #" '=cmd|calc!A0' '@SUM(1+1)' '-touch pwned' '&lt;b&gt;'
  $'a\x1b[31mb' $'desk\xe2\x80\xaegpj.exe' $'left\xe2\x81\xa6right' '%n%s' '</script><script>alert(1)</script>')

"$binary" simulate --preset slow --format tum --size 32x24 --duration 0.1 --blur-samples 1 --in-motion --threads 1 --out tiny >/dev/null 2>&1 ||
  complain "simulate: exit code $?"

# Folders of recordings cannot have a slash in their name.
mkdir data
listed=()
for name in "${names[@]}"; do
  folder=${name//\//_}
  cp -r tiny "data/$folder"
  listed+=("$folder")
done
for folder in "${listed[@]}"; do
  "$binary" run "data/$folder" --variant no-imu --set iekf.min_patches=1 --threads 1 --out runs >/dev/null 2>stderr || [[ $? == 4 ]] ||
    complain "run of '$folder': $(tail -n 1 stderr)"
done
# And a system by that name, with such a hint as its unit.
"$binary" import 'x<b>y' tiny/groundtruth.txt --recording tiny --imu none --out runs >/dev/null 2>stderr
[[ -z $(find . -name pwned) ]] || complain "running them has run something"

# not_in FILE TEXT WHAT: the text is nowhere in the file.
not_in() {
  if grep -qF -- "$2" "$1"; then complain "$3: $(grep -F -m 1 -- "$2" "$1" | cut -c1-200)"; fi
}

"$binary" report runs --out report.html --figures figures >/dev/null 2>stderr || complain "report: $(tail -n 1 stderr)"
not_in report.html '<img src=x onerror' 'markup in a report'
not_in report.html '</script><script>alert' 'a script in a report'
not_in report.html '<_script><script>alert' 'a script in a report'
not_in report.html '<script>alert' 'a script in a report'
not_in report.html '&lt;b&gt;x' 'an entity taken over as it is'
grep -q '&lt;img src=x onerror' report.html || complain 'a hostile name is not in the report at all'
grep -qE 'src="http|href="http|url\(http|@import' report.html && complain 'a report that needs the network'
[[ -z $(find . -name pwned) ]] || complain "figures have run something"
for script in figures/*.gp figures/*.gnuplot figures/*.plt; do
  if [[ ! -e $script ]]; then continue; fi
  # gnuplot runs what stands between back quotes within double quotes, and system(...).
  if grep -E '"[^"]*`' "$script" | grep -q 'touch'; then complain "gnuplot would run a name: $script"; fi
done

# steered FILE WHAT: a character in it steers a terminal or reorders text.
steered() {
  if LC_ALL=C grep -qaP '[\x00-\x08\x0b\x0c\x0e-\x1f\x7f]|\xe2\x80[\x8e\x8f\xaa-\xae]|\xe2\x81[\xa6-\xa9]|\xc2[\x80-\x9f]' "$1"; then
    complain "$2: a control character as it is"
  fi
}
"$binary" list runs runs >list.txt 2>stderr || complain "list runs: $(tail -n 1 stderr)"
grep -qF 'desk\xE2\x80\xAEgpj.exe' list.txt || complain 'list runs: a mark of direction is not shown by its bytes'
steered list.txt 'list runs'
for form in markdown csv csv-long json latex; do
  "$binary" table runs --format "$form" >steered.txt 2>/dev/null
  steered steered.txt "table --format $form"
done
"$binary" list runs runs --json >steered.txt 2>/dev/null
steered steered.txt 'list runs --json'
"$binary" best runs >steered.txt 2>/dev/null
steered steered.txt best
"$binary" collect runs >steered.txt 2>/dev/null
steered steered.txt collect
python3 -c 'import re, sys; sys.stdout.buffer.write(re.sub(rb"<script.*?</script>|<style.*?</style>", b"", open("report.html", "rb").read(), flags=re.S))' >steered.txt
steered steered.txt 'the text of a report'

"$binary" inspect "data/${listed[0]}" --page page.html >/dev/null 2>&1
not_in page.html '<img src=x onerror' 'markup in a page of an inspection'

"$binary" table runs --format latex >table.tex 2>stderr || complain "table --format latex: $(tail -n 1 stderr)"
not_in table.tex '\immediate' 'a command in LaTeX'
not_in table.tex '\input{' 'a command in LaTeX'
"$binary" table runs --format json >table.json 2>/dev/null
python3 -c 'import json; json.load(open("table.json"))' || complain "table --format json is none"
"$binary" collect runs --format jsonl >runs.jsonl 2>/dev/null
python3 -c 'import json; [json.loads(line) for line in open("runs.jsonl")]' || complain "collect --format jsonl is none"
for form in csv csv-long; do
  "$binary" table runs --format "$form" >"table.$form" 2>/dev/null
  python3 - "table.$form" <<'PYTHON' || complain "table --format $form: a cell is a formula"
import csv, sys
for row in csv.reader(open(sys.argv[1], newline="")):
    for cell in row:
        number = cell[:1] in "+-" and cell[1:2].isdigit()
        if cell[:1] and cell[:1] in "=+-@\t\r" and cell != "-" and not number:
            print(repr(cell))
            sys.exit(1)
PYTHON
done
"$binary" compare runs runs --format junit >junit.xml 2>/dev/null
python3 -c 'import xml.dom.minidom; xml.dom.minidom.parse("junit.xml")' || complain "compare --format junit is no XML"

# Slurm: a stand-in for sbatch keeps what it is given, and runs the script, which must name files by what they are called.
mkdir bin
cat >bin/sbatch <<'TEXT'
#!/usr/bin/env bash
if [[ ${1:-} == --version ]]; then echo "slurm 22.05"; exit 0; fi
printf '%s\n' "$@" >>"$KEPT/arguments"
for last; do :; done
cp "$last" "$KEPT/script"
SLURM_ARRAY_TASK_ID=0 SLURM_ARRAY_JOB_ID=7 bash "$last" >"$KEPT/output" 2>&1
echo 7
TEXT
printf '#!/bin/sh\nexit 0\n' | tee bin/sinfo bin/squeue bin/scancel >/dev/null
chmod +x bin/*
# shellcheck disable=SC2016
hostile='here $(touch pwned) `touch pwned` "; touch pwned; "'"'; touch pwned; '"
mkdir kept "$hostile"
{
  printf 'name = "s"\nvariants = ["no-imu"]\nrecordings = ['
  for folder in "${listed[@]:1:4}"; do printf "'''%s''', " "$folder"; done
  printf ']\n[config]\niekf.min_patches = 1\n'
} >"$hostile/suite.toml"
KEPT=$work/kept PATH=$work/bin:$PATH timeout 60 "$binary" bench "$hostile/suite.toml" --data data --out "$hostile/out" \
  --executor slurm --submit --chunk 10 >stdout 2>stderr || complain "bench on Slurm: exit code $?: $(tail -n 1 stderr)"
[[ -s kept/script ]] || complain "bench on Slurm: nothing was submitted: $(tail -n 2 stderr)"
[[ -z $(find . -name pwned) ]] || complain "the script of Slurm has run a name: $(find . -name pwned)"
grep -q 'record.json' <(find "$hostile/out") || complain "the task did not make its runs: $(tail -n 2 kept/output)"

# A list that names files elsewhere: they are not read.
cp -r tiny elsewhere
sed -i "s|rgb/1600000000.033333.png|$work/tiny/rgb/1600000000.033333.png|" elsewhere/rgb.txt
rm -f elsewhere/associations.txt
"$binary" convert elsewhere --out out >stdout 2>stderr && complain "an image outside of the recording is taken"
grep -q 'is outside of' stderr || complain "an image outside of the recording: $(tail -n 1 stderr)"
[[ ! -e out ]] || complain "an image outside of the recording: something is written"

# The name of a suite or system is a folder's, and leads nowhere else.
"$binary" import ../../escaped tiny/groundtruth.txt --recording tiny --out runs >/dev/null 2>&1 && complain 'a name that leads elsewhere'
[[ -z $(find "$work/.." -maxdepth 1 -name escaped) ]] || complain 'an import has left its folder'

if ((failures > 0)); then
  printf '%d checks failed\n' "$failures" >&2
  exit 1
fi
printf 'hostile names: passed\n'
