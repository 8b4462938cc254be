"""Bags and MCAP files as plain dictionaries, so that both can be compared: rosbag reads the first, and the second is
decoded here by the message definitions that the file itself has."""
import ctypes
import struct

import numpy as np

# name -> (numpy code, size)
PRIMITIVES = {"bool": ("u1", 1), "byte": ("u1", 1), "char": ("u1", 1), "int8": ("i1", 1), "uint8": ("u1", 1),
              "int16": ("<i2", 2), "uint16": ("<u2", 2), "int32": ("<i4", 4), "uint32": ("<u4", 4),
              "int64": ("<i8", 8), "uint64": ("<u8", 8), "float32": ("<f4", 4), "float64": ("<f8", 8)}


class Recording:
    """topics: name -> list of (stamp of the log in ns, message); types: name -> type without `/msg`."""

    def __init__(self):
        self.topics = {}
        self.types = {}

    def add(self, topic, kind, stamp, message):
        self.types[topic] = kind
        self.topics.setdefault(topic, []).append((stamp, message))

    def messages(self, topic):
        return [message for _, message in self.topics.get(topic, [])]

    def of_type(self, kind):
        return sorted(topic for topic, found in self.types.items() if found == kind)


def read_bag(path):
    import rosbag
    recording = Recording()
    with rosbag.Bag(path) as bag:
        for topic, message, time in bag.read_messages():
            recording.add(topic, message._type, time.to_nsec(), plain(message))
        for topic, info in bag.get_type_and_topic_info().topics.items():
            recording.types[topic] = info.msg_type
            recording.topics.setdefault(topic, [])
    return recording


def plain(value):
    """A message of ROS 1 as dictionaries: lower-case names, stamps in ns, no sequence numbers."""
    if hasattr(value, "to_nsec"):
        return value.to_nsec()
    if hasattr(value, "_slot_types"):
        return {name.lower(): plain(getattr(value, name)) for name in value.__slots__ if name != "seq"}
    if isinstance(value, (bytes, str)):
        return value
    if isinstance(value, (tuple, list)):
        return [plain(item) for item in value]
    return value


def decompress_zstd(data, size):
    library = ctypes.CDLL("libzstd.so.1")
    library.ZSTD_decompress.restype = ctypes.c_size_t
    out = ctypes.create_string_buffer(size)
    got = library.ZSTD_decompress(out, ctypes.c_size_t(size), data, ctypes.c_size_t(len(data)))
    if got != size:
        raise ValueError("a chunk does not decompress")
    return out.raw


class Definitions:
    """The types of one schema: type -> list of (type of the field, name, length of an array or None or -1)."""

    def __init__(self, name, text):
        self.types = {}
        self.root = short(name)
        current = self.root
        self.types[current] = []
        for line in text.splitlines():
            line = line.split("#")[0].strip()
            if not line or set(line) == {"="}:
                continue
            if line.startswith("MSG:"):
                current = short(line[4:].strip())
                self.types[current] = []
                continue
            kind, rest = line.split(None, 1)
            if "=" in rest:
                continue  # a constant
            length = None
            if kind.endswith("]"):
                kind, count = kind[:-1].split("[")
                length = int(count) if count.isdigit() else -1
            self.types[current].append((kind, rest.split()[0], length))

    def find(self, kind):
        if kind in self.types:
            return self.types[kind]
        if short(kind) in self.types:
            return self.types[short(kind)]
        ends = [name for name in self.types if name.split("/")[-1] == kind]
        return self.types[ends[0]]


def short(name):
    return name.replace("/msg/", "/")


class Cdr:
    """Little-endian CDR; alignment counts from the end of the encapsulation header."""

    def __init__(self, data, definitions):
        if data[:2] != b"\0\1":
            raise ValueError("no little-endian CDR")
        self.data, self.at, self.definitions = data[4:], 0, definitions

    def array(self, kind, count):
        code, size = PRIMITIVES[kind]
        if count:
            self.at += -self.at % size
        found = np.frombuffer(self.data, code, count, self.at) if count else np.zeros(0, code)
        self.at += count * size
        return found

    def string(self):
        size = int(self.array("uint32", 1)[0])
        found = self.data[self.at:self.at + size - 1]
        self.at += size
        return found.decode("utf-8")

    def value(self, kind, length):
        if length is not None:
            count = int(self.array("uint32", 1)[0]) if length < 0 else length
            if kind in ("uint8", "byte", "char"):
                return self.array(kind, count).tobytes()
            if kind in PRIMITIVES:
                return self.array(kind, count).tolist()
            return [self.value(kind, None) for _ in range(count)]
        if kind in PRIMITIVES:
            found = self.array(kind, 1)[0]
            return bool(found) if kind == "bool" else found.item()
        if kind == "string":
            return self.string()
        message = {name.lower(): self.value(of, size) for of, name, size in self.definitions.find(kind)}
        if set(message) == {"sec", "nanosec"}:
            return message["sec"] * 10**9 + message["nanosec"]
        return message


def mcap_records(data, start, end):
    while start < end:
        kind, size = struct.unpack_from("<BQ", data, start)
        yield kind, data[start + 9:start + 9 + size]
        start += 9 + size


def text_at(data, at):
    size, = struct.unpack_from("<I", data, at)
    return data[at + 4:at + 4 + size], at + 4 + size


def read_mcap(path):
    with open(path, "rb") as file:
        data = file.read()
    if data[:8] != b"\x89MCAP0\r\n" or data[-8:] != data[:8]:
        raise ValueError(path + " is no whole MCAP file")
    recording, schemas, channels = Recording(), {}, {}

    def take(kind, body):
        if kind == 3:
            number, = struct.unpack_from("<H", body)
            name, at = text_at(body, 2)
            _, at = text_at(body, at)
            text, _ = text_at(body, at)
            schemas[number] = Definitions(name.decode(), text.decode())
        elif kind == 4:
            number, schema = struct.unpack_from("<HH", body)
            topic, _ = text_at(body, 4)
            channels[number] = (topic.decode(), schemas[schema])
            recording.types[topic.decode()] = schemas[schema].root
            recording.topics.setdefault(topic.decode(), [])
        elif kind == 5:
            number, _, stamp = struct.unpack_from("<HIQ", body)
            topic, definitions = channels[number]
            message = Cdr(body[22:], definitions).value(definitions.root, None)
            recording.add(topic, definitions.root, stamp, message)
        elif kind == 6:
            _, _, size, _ = struct.unpack_from("<QQQI", body)
            compression, at = text_at(body, 28)
            count, = struct.unpack_from("<Q", body, at)
            inside = body[at + 8:at + 8 + count]
            if compression:
                inside = decompress_zstd(inside, size)
            for record in mcap_records(inside, 0, len(inside)):
                take(*record)

    for record in mcap_records(data, 8, len(data) - 8):
        if record[0] == 15:  # the end of the data; what follows repeats schemas and channels
            break
        take(*record)
    return recording
