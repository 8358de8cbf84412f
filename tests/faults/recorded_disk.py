"""A folder as a disk may hold it after a power cut, from the calls that changed it (recorded_calls.cpp).

Disk(folder) starts with what is there, all of it synced; apply(record) makes one call. tree(variant) is {name: bytes, or None of a
folder} of

- `live`: what the program sees while there is power.
- `early`: the file system has written all names and sizes, but of the content only what was synced: the rest is zeros, as ext4 and XFS
  leave it, which allocate blocks late.
- `late`: it has written only what was synced: of a file the content of its last sync, of a folder the names of its last sync (so that
  what was created later is not there, and what was removed later is).

Both are allowed by POSIX, where fsync() of a file promises its bytes but not its name, and of a folder its names but not those of the
folders above. A rename is one event in both folders, done once either is synced; syncfs() syncs everything.
"""

import collections
import os
import pathlib
import shutil
import struct

HEAD = struct.Struct("=IIHH12sq")
Record = collections.namedtuple("Record", "kind process path other number data")


def read_records(log):
    data, at, records = pathlib.Path(log).read_bytes(), 0, []
    while at < len(data):
        n_bytes, process, n_path, n_other, kind, number = HEAD.unpack_from(data, at)
        parts = []
        at += HEAD.size
        for size in (n_path, n_other, n_bytes):
            parts.append(data[at:at + size])
            at += size
        path, other = (os.path.normpath(os.fsdecode(part)) for part in parts[:2])
        records.append(Record(kind.rstrip(b"\0").decode(), process, path, other, number, parts[2]))
    return records


class File:
    def __init__(self, data=b""):
        self.live = bytearray(data)
        self.synced = bytes(data)  # as of the last sync
        self.allocated = bytearray(data)  # with zeros for what was not synced

    def truncate(self, size):
        for data in (self.live, self.allocated):
            del data[size:]
            data.extend(bytes(size - len(data)))

    def write(self, at, data):
        end = at + len(data)
        if end > len(self.live):
            self.truncate(end)
        self.live[at:end] = data
        self.allocated[at:end] = bytes(len(data))

    def sync(self):
        self.synced = bytes(self.live)
        self.allocated = bytearray(self.live)


class Folder:
    def __init__(self):
        self.live = {}
        self.synced = {}


class Disk:
    def __init__(self, folder):
        self.root = str(folder)
        self.top = Folder()
        self.moves = []  # renames of which neither folder was synced: (folder, name, folder, name, node)
        for place, folders, files in os.walk(folder):
            here = self.find(place)
            here.live.update({name: Folder() for name in folders})
            here.live.update({name: File(pathlib.Path(place, name).read_bytes()) for name in files})
        self.sync_all()

    def parts(self, path):
        name = os.path.relpath(path, self.root)
        return [] if name == "." else name.split("/")

    def find(self, path):
        """None if there is nothing of that name, as of files that are open and were removed."""
        node = self.top
        for part in self.parts(path):
            node = node.live.get(part) if isinstance(node, Folder) else None
        return node

    def place(self, path):
        """(folder, name)."""
        return self.find(os.path.dirname(path)), os.path.basename(path)

    def sync_all(self):
        folders = [self.top]
        for folder in folders:
            folder.synced = dict(folder.live)
            for node in folder.live.values():
                if isinstance(node, File):
                    node.sync()
                else:
                    folders.append(node)
        self.moves = []

    def sync_folder(self, folder):
        folder.synced = dict(folder.live)
        for source, old, target, new, node in self.moves:
            if target is folder and source.synced.get(old) is node:
                del source.synced[old]
            elif source is folder:
                target.synced[new] = node
        self.moves = [move for move in self.moves if folder not in (move[0], move[2])]

    def rename(self, path, other):
        (source, old), (target, new) = self.place(path), self.place(other)
        node = source.live.pop(old)
        target.live[new] = node
        self.moves.append((source, old, target, new, node))

    def create(self, path, node):
        folder, name = self.place(path)
        folder.live[name] = node

    def apply(self, record):
        """Whether the call changes what a disk may hold."""
        kind, path = record.kind, record.path
        node = self.find(path)
        if kind == "open":
            if node is None:
                self.create(path, File())
            elif record.number and node.live:
                node.truncate(0)
            else:
                return False
        elif kind == "mkdir":
            self.create(path, Folder())
        elif kind == "syncfs":
            self.sync_all()
        elif node is None:
            return False
        elif kind == "write":
            node.write(record.number, record.data)
        elif kind == "truncate":
            node.truncate(record.number)
        elif kind == "sync" and isinstance(node, Folder):
            self.sync_folder(node)
        elif kind == "sync":
            node.sync()
        elif kind == "rename":
            self.rename(path, record.other)
        elif kind == "link":
            self.create(record.other, node)
        elif kind == "remove":
            folder, name = self.place(path)
            del folder.live[name]
        else:
            raise SystemExit(f"faults: {kind} {path} is not modelled")
        return True

    def tree(self, variant):
        found, waiting = {}, [("", self.top)]
        for prefix, folder in waiting:
            for name, node in (folder.synced if variant == "late" else folder.live).items():
                if isinstance(node, Folder):
                    found[prefix + name] = None
                    waiting.append((prefix + name + "/", node))
                else:
                    found[prefix + name] = bytes({"late": node.synced, "early": node.allocated, "live": node.live}[variant])
        return found


def tree_of(folder):
    """As Disk.tree(), of a folder that is there."""
    return Disk(folder).tree("live")


def write_tree(folder, tree, times):
    """Names of folders stand before what is in them. What has the name of a file in the folder `times` gets its time."""
    folder.mkdir()
    for name, data in tree.items():
        if data is None:
            (folder / name).mkdir()
            continue
        (folder / name).write_bytes(data)
        if (times / name).is_file():
            shutil.copystat(times / name, folder / name)
