"""What every command owes, whatever it is given; problems(...) are the sentences about what it does not keep."""

import os
import re

EXIT_CODES = {0, 1, 2, 3, 4}
# Numbers that are none, as they are written by C++ and Python; words like "info" and names of files are others.
# What stands in quotes is a text of the input: an option of a record may be the text "nan".
NOT_FINITE = re.compile(rb"(?<![\w./<\"'-])(?<!&quot;)[-+]?(?:nan|inf|infinity)(?![\w./>\"'-])", re.I)
NOT_FINITE_IN_PAGE = re.compile(rb"[>:\[,]\s*[-+]?(?:nan|inf)(?![\w./>\"'-])")  # its scripts may speak of NaN
OPTION_IN_PAGE = re.compile(rb"<tr><td>[a-z_]+\.\w+</td><td>[^<]*</td><td>[a-z][a-z -]*</td></tr>")  # a text of the input
NOT_FINITE_IN_JSON = re.compile(rb"[:\[,]\s*[-+]?(?:nan|inf|infinity)\b", re.I)
CONTROL = re.compile(rb"[\x00-\x08\x0b-\x1f\x7f]")
TEXT = (".json", ".csv", ".tum", ".txt", ".jsonl", ".html", ".tex", ".toml", ".kitti")
WORST_CPU_MS = 6000
CPU_MS_OF_A_RUN = 100  # of a recording of a few small frames
WORST_PEAK_MB = 500


def listing(folder):
    """Every name below, hidden ones too."""
    found = []
    for place, folders, files in os.walk(os.fsencode(folder)):
        found += [os.path.relpath(os.path.join(place, name), os.fsencode(folder)) for name in folders + files]
    return set(found)


def about_errors(status, errors, arguments):
    said = []
    lines = errors.split(b"\n")
    wrong = [line for line in lines if line.startswith(b"error: ")]
    if b"this is a bug" in errors or b"check failed" in errors:
        said.append("says that it is a bug")
    is_verdict = status == 3 and arguments[0] == "inspect" and not wrong  # its findings are on standard output
    if (status in (2, 3) and not is_verdict) or (status == 4 and arguments[0] not in ("run", "bench", "rerun", "slurm-task")):
        if len(wrong) != 1:
            said.append(f"{len(wrong)} errors instead of one")
    if status in (2, 3, 4) and wrong:
        sentence = wrong[0]
        if len(sentence) > 6000:
            said.append("an error of more than 6000 characters")
        if len(sentence) < 15:
            said.append("an error that says nothing")
        places = {part for word in arguments for part in re.split(r"[/.=]", word) if len(part) > 1}
        if not re.search(rb"[/.'=:`(-]|\d", sentence[7:]) and not any(os.fsencode(place) in sentence for place in places):
            said.append("an error without a file, key or option")
    if CONTROL.search(errors):
        said.append("control characters on standard error")
    if status == 0 and wrong:
        said.append("an error with exit code 0")
    return said


def about_numbers(folder, new, output):
    said = []
    if output[:1] in (b"{", b"["):
        if NOT_FINITE_IN_JSON.search(output):
            said.append("not finite in JSON on standard output")
    elif NOT_FINITE.search(output):
        said.append("not finite on standard output")
    for name in sorted(new):
        path = os.path.join(os.fsencode(folder), name)
        if not name.endswith(tuple(end.encode() for end in TEXT)) or not os.path.isfile(path) or os.path.islink(path):
            continue
        with open(path, "rb") as file:
            content = file.read()
        pattern = NOT_FINITE_IN_JSON if name.endswith(b".json") else NOT_FINITE_IN_PAGE if name.endswith(b".html") else NOT_FINITE
        found = pattern.search(OPTION_IN_PAGE.sub(b"", content) if name.endswith(b".html") else content)
        if found and not name.endswith(b"log.txt"):
            said.append(f"not finite in {re.sub(rb'[0-9a-f]{8}', b'HASH', name).decode(errors='replace')}")
    return said


def about_files(status, new, gone, arguments):
    said = []
    half = [name for name in new if name.endswith(b".tmp") or b".tmp/" in name]
    if half:
        said.append("leaves a temporary file")
    keeps = arguments[0] in ("bench", "rerun", "gc", "slurm-task")
    is_failed_run = arguments[0] in ("run", "import") and status == 4
    is_verdict = status == 3 and arguments[0] == "inspect"  # of findings; the page is written
    if status not in (0, 1) and new and not keeps and not is_failed_run and not is_verdict:
        said.append("fails and leaves " + sorted(new)[0].decode(errors="replace")[:40])
    if gone and arguments[0] not in ("gc", "bench", "rerun"):
        said.append("removes an input")
    return said


def problems(answer, folder, before, output, errors, arguments):
    """answer: of the program; before: listing() of the folder before."""
    if answer.killed:
        return ["hangs" if answer.cpu_ms < 1000 else "computes without an end"]
    said = []
    if answer.status < 0:
        return [f"ended by signal {-answer.status}"]
    if answer.status not in EXIT_CODES:
        said.append(f"exit code {answer.status}")
    if answer.left_process:
        said.append("leaves a process")
    # A suite may ask for hundreds of runs; each of those that it says it has done counts.
    worst_cpu_ms = WORST_CPU_MS + CPU_MS_OF_A_RUN * len(re.findall(rb"^\[\d+/\d+\]", errors, re.M))
    if answer.cpu_ms > worst_cpu_ms:
        said.append(f"takes more than {worst_cpu_ms} ms")
    if answer.peak_mb > WORST_PEAK_MB:
        said.append(f"takes more than {WORST_PEAK_MB} MB")
    after = listing(folder)
    said += about_errors(answer.status, errors, arguments)
    said += about_files(answer.status, after - before, before - after, arguments)
    is_named_so = any(re.search(r"\b(nan|inf)", word, re.I) for word in arguments)  # its own words are given back
    if answer.status in (0, 1) and not is_named_so:
        said += about_numbers(folder, after - before, output)
    return said
