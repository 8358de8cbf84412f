"""Mutations that know the structure of what they change: tables, TOML, JSON, PNG, archives, binary files, and files as such.

A change of a file is a dictionary of one entry: {"bytes": content}, or {"remove": True}, {"folder": True}, {"fifo": True},
{"link": target}, {"sparse": size}.
"""

import io
import json
import re
import struct
import warnings
import zipfile
import zlib

import images

NUMBERS = ["nan", "inf", "-inf", "NaN", "-nan(ind)", "0", "-0", "-1", "1", "0.5", "1e308", "-1e308", "1e309", "1e-308", "5e-324", "1e30",
           "1e9", "1e7", "1e-9", "4294967295", "4294967296", "4294967300", "2147483647", "2147483648", "-2147483649", "65535", "65536",
           "9223372036854775807", "9223372036854775808", "18446744073709551616", "99999999999999999999999999", "1.5", "2x", "0x10",
           "1e", "+1", "1_000", "1,5", ".", "-", "1" * 400, "0." + "0" * 400 + "1", "1600000000", "1600000000.0", "1600000000000000000",
           "0.1", "3.14159", "1e3", "-1e3", "100", "1000000"]
WORDS = ["", "\"\"", "''", "abc", "true", "false", "null", "[]", "{}", "\x00", "\x1b[31m", "<b>x</b>", "=1+1", "@x", "../../etc/passwd",
         "/dev/zero", "/dev/null", ".", "..", "a/b", "é", "\ufeff", "x" * 300, "x" * 5000, "%s%n", "$(id)", "`id`", "-", "#", "\r", "\t",
         "'; drop", "&amp;", "1 2 3", "1979-05-27", "12:00:00"]
INTEGERS = [0, 1, 2, 3, 255, 256, 65535, 65536, 0x7FFFFFFF, 0x80000000, 0xFFFFFFFF, 0x7FFFFFFFFFFFFFFF, 0x8000000000000000,
            0xFFFFFFFFFFFFFFFF, 1000000, 100000000]
FLOATS = [float("nan"), float("inf"), -float("inf"), 0.0, -0.0, 1e308, -1e308, 5e-324, 1.0, -1.0, 1e30]
TOKEN = re.compile(rb"[^\s,;=\[\]{}()/\"']+")
NUMBER = re.compile(rb"[-+]?(?:\d+\.?\d*|\.\d+)(?:[eE][-+]?\d+)?")


def some_number(rng):
    if rng.random() < 0.2:
        return repr(rng.choice([-1, 1]) * rng.random() * 10 ** rng.randint(-20, 20))
    return rng.choice(NUMBERS)


def some_token(rng):
    return some_number(rng) if rng.random() < 0.75 else rng.choice(WORDS)


def replaced(rng, data, pattern):
    """One match of the pattern replaced."""
    places = list(pattern.finditer(data))
    if not places:
        return data + some_token(rng).encode()
    # The first rows have the counts and the headers.
    place = rng.choice(places[:20]) if rng.random() < 0.3 else rng.choice(places)
    return data[:place.start()] + some_token(rng).encode("utf-8", "surrogateescape") + data[place.end():]


def of_lines(rng, data):
    lines = data.split(b"\n")
    at = rng.randrange(len(lines))
    other = rng.randrange(len(lines))
    how = rng.randrange(9)
    if how == 0:
        del lines[at]
    elif how == 1:
        lines.insert(other, lines[at])
    elif how == 2:
        lines[at], lines[other] = lines[other], lines[at]
    elif how == 3:
        lines = lines[:at]
    elif how == 4:
        lines[at] += rng.choice([b" 1", b",1", b" ", b"\t#", b" nan", b"\r", b",", b" \x00"])
    elif how == 5:
        cells = re.split(rb"([ ,\t]+)", lines[at])
        del cells[rng.randrange(len(cells))]
        lines[at] = b"".join(cells)
    elif how == 6:
        lines[at:at] = [lines[at]] * rng.choice([2, 10, 500])
    elif how == 7:
        lines.reverse()
    else:
        lines[at] = rng.choice([b"", b"#", b"# x", b" ", b"\xff\xfe", b"a b c d e f g h", b"0 0 0 0 0 0 0 0", b"[x]", b"= 1"])
    return b"\n".join(lines)


def of_encoding(rng, data):
    how = rng.randrange(6)
    if how == 0:
        return data.replace(b"\n", b"\r\n")
    if how == 1:
        return b"\xef\xbb\xbf" + data
    if how == 2:
        return data.decode("latin-1").encode("utf-16")
    if how == 3:
        return data.replace(b"\n", b"\r")
    if how == 4:
        return data.rstrip(b"\n")
    return data.replace(b" ", rng.choice([b"  ", b"\t", b",", b"\xc2\xa0"]))


def of_bytes(rng, data):
    data = bytearray(data)
    if not data:
        return bytes(rng.randrange(256) for _ in range(rng.choice([1, 10, 100])))
    how = rng.randrange(8)
    # Fields of sizes are at the beginning.
    at = rng.randrange(min(len(data), 400)) if rng.random() < 0.5 else rng.randrange(len(data))
    if how == 0:
        data[at] ^= 1 << rng.randrange(8)
    elif how == 1:
        data[at:at + 4] = struct.pack(rng.choice("<>") + "I", rng.choice(INTEGERS) & 0xFFFFFFFF)
    elif how == 2:
        data[at:at + 8] = struct.pack("<Q", rng.choice(INTEGERS))
    elif how == 3:
        data[at:at + 8] = struct.pack("<d", rng.choice(FLOATS))
    elif how == 4:
        data[at:at + 4] = struct.pack("<f", rng.choice([f for f in FLOATS if not 1e39 < abs(f) < 1e400]))
    elif how == 5:
        del data[at:]
    elif how == 6:
        end = min(len(data), at + rng.choice([1, 4, 16, 200]))
        if rng.random() < 0.5:
            del data[at:end]
        else:
            data[at:at] = data[at:end]
    else:
        for _ in range(rng.choice([2, 8, 40])):
            data[rng.randrange(len(data))] = rng.randrange(256)
    return bytes(data)


def of_toml(rng, data):
    text = data.decode("utf-8", "surrogateescape")
    lines = text.split("\n")
    values = [i for i, line in enumerate(lines) if "=" in line and not line.lstrip().startswith("#")]
    if not values:
        return of_lines(rng, data)
    at = rng.choice(values)
    key, value = lines[at].split("=", 1)
    how = rng.randrange(9)
    if how <= 3:
        new = rng.choice([some_number(rng), some_number(rng), json.dumps(rng.choice(WORDS)), "true", "[]", "{}", "[1, 2, 3]",
                          "[" * 200 + "]" * 200, "[" + "1, " * 5000 + "]", "{ a = 1 }", "{ from = 1, to = 0, steps = 3 }",
                          "{ from = 1, to = 2, steps = 1000000000 }", "[[1], [2]]", "[nan]", "[\"\"]", "1979-05-27T00:00:00Z", "\"\"\"x",
                          "[1, \"a\"]", "-1", "0"])
        lines[at] = f"{key}= {new}"
    elif how == 4:
        lines[at] = rng.choice(["a", key.strip() + "s", key.strip() + "." + key.strip(), "\"\"", "é", "x" * 2000]) + " =" + value
    elif how == 5:
        lines.insert(at, rng.choice([lines[at], "unknown = 1", "[unknown]", "[[sweep]]", "[config]", "[" + "a." * 500 + "a]",
                                     "[[" + key.strip() + "]]", "name = \"../x\"", "= 1", "\"a\\u0000b\" = 1"]))
    elif how == 6:
        lines.insert(at, "[[simulations]]\nname = \"a\"\nduration_s = " + some_number(rng))
    elif how == 7:
        return replaced(rng, data, NUMBER)
    else:
        return of_lines(rng, data)
    return "\n".join(lines).encode("utf-8", "surrogateescape")


def json_places(node, path=()):
    yield path
    children = node.items() if isinstance(node, dict) else enumerate(node) if isinstance(node, list) else ()
    for key, child in children:
        yield from json_places(child, path + (key,))


def json_text(rng):
    return rng.choice(["nan", "1e400", "-1e400", "null", "true", "\"\"", "\"x\"", "[]", "{}", "-1", "0", "1.5", "1e308", "4294967296",
                       "18446744073709551616", "\"<script>alert(1)</script>\"", "\"=1+1\"", "\"\\u001b[31m\"", "\"\\ud800\"",
                       "\"" + "x" * 3000 + "\"", "[" * 600 + "]" * 600, "\"../../x\"", "\"nan\"", "\"/dev/zero\"", "[null, null]",
                       "{\"a\": 1}", "1e30", "-0.0", "\"a\\nb\""])


def of_json(rng, data):
    try:
        document = json.loads(data)
    except (ValueError, RecursionError):  # the second by an earlier mutation
        return of_bytes(rng, data)
    places = list(json_places(document))
    place = rng.choice(places[1:] or places)
    if not place or rng.random() < 0.1:
        return replaced(rng, data, NUMBER)
    owner = document
    for key in place[:-1]:
        owner = owner[key]
    if rng.random() < 0.25:
        del owner[place[-1]]
        return json.dumps(document, indent=2).encode()
    if rng.random() < 0.1:
        if isinstance(owner, list):
            owner.extend([owner[place[-1]]] * rng.choice([1, 3, 1000]))
        else:
            owner["unknown"] = owner[place[-1]]
        return json.dumps(document, indent=2).encode()
    # What Python's numbers cannot say is put in as text.
    new = json_text(rng)
    if new == "\"nan\"" and isinstance(owner[place[-1]], str):
        new = "\"x\""  # a name may be "nan", and is printed
    owner[place[-1]] = "@here@"
    return json.dumps(document, indent=2).replace("\"@here@\"", new, 1).encode("utf-8", "surrogateescape")


def of_png(rng, data):
    chunks = images.png_chunks(data)
    if len(chunks) < 3 or len(chunks[0][1]) < 13:
        return of_bytes(rng, data)
    how = rng.randrange(7)
    at = rng.randrange(len(chunks))
    if how <= 2:
        header = bytearray(chunks[0][1])
        if rng.random() < 0.6:
            field = rng.choice([0, 4])
            header[field:field + 4] = struct.pack(">I", rng.choice([0, 1, 47, 48, 49, 63, 65, 640, 16000, 65535, 0x7FFFFFFF, 0xFFFFFFFF]))
        else:
            header[rng.randrange(8, 13)] = rng.choice([0, 1, 2, 3, 4, 6, 8, 16, 255])
        chunks[0] = (chunks[0][0], bytes(header))
    elif how == 3:
        del chunks[at]
    elif how == 4:
        chunks.insert(at, rng.choice([chunks[at], (b"tRNS", b"\0\0"), (b"PLTE", b"\0" * 9), (b"acTL", b"\0" * 8), (b"tEXt", b"a\0b"),
                                      (b"IDAT", b""), (b"gAMA", b"\0\0\0\0"), (b"iCCP", b"x\0\0" + zlib.compress(b"y" * 100))]))
    elif how == 5:
        for i, (kind, content) in enumerate(chunks):
            if kind == b"IDAT":
                try:
                    rows = of_bytes(rng, zlib.decompress(content))
                except zlib.error:
                    rows = content
                chunks[i] = (kind, zlib.compress(rows, 1))
    else:
        return of_bytes(rng, data)
    return images.png_of(chunks)


def of_zip(rng, data):
    if rng.random() < 0.4:
        return of_bytes(rng, data)
    try:
        with zipfile.ZipFile(io.BytesIO(data)) as archive:
            members = [(name, archive.read(name)) for name in archive.namelist()]
    except Exception:  # whatever an earlier mutation made of it
        return of_bytes(rng, data)
    at = rng.randrange(len(members))
    name, content = members[at]
    how = rng.randrange(5)
    if how == 0:
        del members[at]
    elif how == 1:
        members.append(rng.choice([members[at], ("../x", b"1"), ("x" * 300, b""), ("/abs", b"")]))
    else:
        members[at] = (name, of_json(rng, content) if name.endswith(".json") else of_bytes(rng, content))
    out = io.BytesIO()
    with warnings.catch_warnings(action="ignore"), zipfile.ZipFile(
            out, "w", rng.choice([zipfile.ZIP_STORED, zipfile.ZIP_DEFLATED])) as archive:
        for name, content in members:
            try:
                archive.writestr(name, content)
            except Exception:
                pass
    return out.getvalue()


TEXT = (".txt", ".csv", ".obj", ".tum", ".log", ".yaml", ".freiburg", ".mtl")


def of_content(rng, name, data):
    if name.endswith(".toml"):
        return of_toml(rng, data) if rng.random() < 0.85 else rng.choice([of_bytes, of_lines, of_encoding])(rng, data)
    if name.endswith(".json"):
        return of_json(rng, data) if rng.random() < 0.85 else rng.choice([of_bytes, of_lines, of_encoding])(rng, data)
    if name.endswith(".png"):
        return of_png(rng, data)
    if name.endswith(".zip"):
        return of_zip(rng, data)
    is_text = name.endswith(TEXT) or (name.endswith(".ply") and b"ascii" in data[:60])
    if is_text or (name.endswith(".ply") and rng.random() < 0.4):
        choice = rng.random()
        if choice < 0.55:
            return replaced(rng, data, NUMBER if rng.random() < 0.7 else TOKEN)
        if choice < 0.85:
            return of_lines(rng, data)
        return of_encoding(rng, data) if choice < 0.92 else of_bytes(rng, data)
    return of_bytes(rng, data)


def of_file(rng):
    """What is no longer a file of that content at all."""
    if rng.random() < 0.05:
        return {"sparse": 60 << 30}
    how = rng.randrange(11)
    return [{"remove": True}, {"folder": True}, {"fifo": True}, {"link": "nowhere"}, {"link": "/dev/zero"}, {"link": "/dev/null"},
            {"link": "."}, {"sparse": 70000}, {"bytes": b""}, {"bytes": b"\0" * 100}, {"link": "/proc/self/mem"}][how]
