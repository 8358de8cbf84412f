#!/usr/bin/env bash
# In planted files, scripts/check_words.py --check finds each forbidden term, and without --check the other candidates as well.
set -euo pipefail

check=$(cd "$(dirname "${BASH_SOURCE[0]}")/../../scripts" && pwd)/check_words.py
if ! command -v python3 >/dev/null; then
  printf 'skipped: python3 is not installed\n'
  exit 77
fi
tree=$(mktemp -d)
trap 'rm -rf "$tree"' EXIT
failures=0

# expect STATUS WORDS FILE TEXT [OPTION]...: FILE holds TEXT; WORDS are part of the output.
expect() {
  local output status=0 file=$tree/$3
  printf '%b\n' "$4" >"$file"
  output=$("$check" "${@:5}" "$file" 2>&1) || status=$?
  if ((status != $1)) || [[ $output != *"$2"* ]]; then
    printf '%b\nexit code %d and "%s", expected %d and "%s"\n' "$4" "$status" "$output" "$1" "$2" >&2
    failures=1
  fi
}

expect 1 'a.hpp:2: forbidden term "undone"' a.hpp 'int a;\nint b;  ///< motion that is undone' --check
expect 1 'forbidden term "the truth"' a.cpp 'fail("the truth has no pose");' --check
expect 1 'write accepted, rejected' a.md 'A pose is not believed.' --check
expect 1 '2 forbidden terms' a.py '# rival places\nprint("it is looked at")' --check
expect 0 '0 forbidden terms' a.hpp '// the ground truth, undetected, untold_time_offset_s\nint undone = 0;' --check
expect 0 '0 forbidden terms' a.md 'The file `the truth`, [here](the truth).' --check
expect 0 'fragment: "The same once more."' a.hpp '// The same once more.'
expect 0 '"filter knows": software reads' a.cpp '// the filter knows the pose'
expect 0 '0 candidates' a.hpp '// Removes the folder if its owner has exited.\n// Errors: io.'
expect 2 'no such file' a.hpp '' gone.hpp
expect 2 'Usage' a.hpp '' --unknown
exit "$failures"
