"""Runs the program's main() in forked children of one loaded process (fork_server.cpp says how)."""

import dataclasses
import os
import pathlib
import socket
import struct
import subprocess


@dataclasses.dataclass
class Limits:
    cpu_s: int = 60
    wall_ms: int = 90000
    memory_mb: int = 2500  # of address space; 0: none, as sanitizers need it
    file_mb: int = 256


@dataclasses.dataclass
class Answer:
    status: int  # exit code, or minus the signal
    wall_ms: int
    cpu_ms: int
    peak_mb: int
    killed: bool  # after wall_ms
    left_process: bool  # something of it still ran


class Program:
    def __init__(self, binary, library, preload=()):
        self.here, there = socket.socketpair()
        environment = {name: value for name, value in os.environ.items() if not name.startswith("FUSEBENCH")}
        environment["FUSEBENCH_FORK_SERVER"] = str(there.fileno())
        module = pathlib.Path(binary).parent / "lib" / "fusebench" / "fusebench_images.so"
        if module.exists():
            environment["FUSEBENCH_FORK_SERVER_LOADS"] = str(module)
        environment["LD_BIND_NOW"] = "1"  # else every child looks up again what it calls
        environment["LD_PRELOAD"] = ":".join([*preload, str(library)])
        self.process = subprocess.Popen([binary], env=environment, pass_fds=[there.fileno()],
                                        stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL)
        there.close()

    def run(self, folder, arguments, output, errors, limits, settings=()):
        words = [folder, output, errors, str(len(settings)), *settings, *arguments]
        body = struct.pack("=4I", limits.cpu_s, limits.wall_ms, limits.memory_mb, limits.file_mb)
        body += b"".join(os.fsencode(word) + b"\0" for word in words)
        self.here.sendall(struct.pack("=I", len(body)) + body)
        answer = b""
        while len(answer) < 20:
            part = self.here.recv(20 - len(answer))
            if not part:
                raise RuntimeError("the fork server has ended")
            answer += part
        status, wall_ms, cpu_ms, peak_mb, flags = struct.unpack("=i4I", answer)
        return Answer(status, wall_ms, cpu_ms, peak_mb, bool(flags & 1), bool(flags & 2))

    def close(self):
        self.here.close()
        self.process.wait()


def find_library(binary, name):
    """The library of tests beside the program, in its build folder."""
    for place in (pathlib.Path(binary).parent / "tests" / name, pathlib.Path(binary).parent / "lib" / name):
        if place.exists():
            return place
    raise SystemExit(f"attack: {name} is not in {pathlib.Path(binary).parent}/tests; build the preset ci")
