#!/usr/bin/env python3
"""Packs the root of a system as an OCI image of one layer: an archive in the layout of the OCI image
specification 1.0. The same root gives the same bytes.
usage: oci_archive.py ROOT IMAGE.tar VERSION ARCHITECTURE"""
import gzip
import hashlib
import io
import json
import os
import sys
import tarfile

EPOCH = 0  # of every file: times are no part of what the image is


def flatten(entry):
    entry.mtime = EPOCH
    entry.uname = entry.gname = ""
    # Of processes, devices and this script's own mark.
    hidden = ("./proc/", "./sys/", "./dev/", "./installed", "./tmp/")
    return None if entry.name.startswith(hidden) else entry


class Digest(io.RawIOBase):
    """Counts and hashes what passes through to a file."""

    def __init__(self, file=None):
        self.file, self.hash, self.size = file, hashlib.sha256(), 0

    def writable(self):
        return True

    def write(self, data):
        self.hash.update(data)
        self.size += len(data)
        if self.file:
            self.file.write(data)
        return len(data)

    def name(self):
        return "sha256:" + self.hash.hexdigest()


class Both(io.RawIOBase):
    def __init__(self, *files):
        self.files = files

    def writable(self):
        return True

    def write(self, data):
        for file in self.files:
            file.write(data)
        return len(data)


def add_sorted(tar, root, path):
    tar.add(os.path.join(root, path), arcname="./" + path if path else ".", recursive=False, filter=flatten)
    if os.path.isdir(os.path.join(root, path)) and not os.path.islink(os.path.join(root, path)):
        for name in sorted(os.listdir(os.path.join(root, path))):
            add_sorted(tar, root, os.path.join(path, name))


def write_layer(root, path):
    """The digests of the layer as it is stored and as it is unpacked, and its size."""
    with open(path, "wb") as file:
        stored, plain = Digest(file), Digest()
        with gzip.GzipFile(filename="", mode="wb", fileobj=stored, mtime=EPOCH, compresslevel=6) as packed:
            with tarfile.open(fileobj=Both(packed, plain), mode="w|", format=tarfile.GNU_FORMAT) as tar:
                add_sorted(tar, root, "")
    return stored.name(), plain.name(), stored.size


def main():
    root, image, version, architecture = sys.argv[1:]
    layer_path = image + ".layer"
    stored, plain, size = write_layer(root, layer_path)
    blobs = {}

    def blob(value, kind):
        data = json.dumps(value, sort_keys=True).encode()
        name = "sha256:" + hashlib.sha256(data).hexdigest()
        blobs[name] = data
        return {"mediaType": "application/vnd.oci.image." + kind, "digest": name, "size": len(data)}

    config = blob({
        "architecture": architecture, "os": "linux", "created": "1970-01-01T00:00:00Z",
        "config": {
            "User": "1000:1000", "WorkingDir": "/work", "Cmd": ["rubble", "--help"],
            "Env": ["PATH=/usr/local/bin:/usr/bin:/bin", "RUBBLE_CACHE=/tmp/rubble", "LC_ALL=C.UTF-8"],
            "Labels": {"org.opencontainers.image.title": "rubble", "org.opencontainers.image.version": version,
                       "org.opencontainers.image.licenses": "BSD-3-Clause"}},
        "rootfs": {"type": "layers", "diff_ids": [plain]},
        "history": [{"created_by": "tools/package/make_image.sh"}]}, "config.v1+json")
    layer = {"mediaType": "application/vnd.oci.image.layer.v1.tar+gzip", "digest": stored, "size": size}
    manifest = blob({"schemaVersion": 2, "config": config, "layers": [layer]}, "manifest.v1+json")
    manifest["annotations"] = {"org.opencontainers.image.ref.name": "rubble:" + version}
    with tarfile.open(image, "w") as tar:
        def add(name, data):
            entry = tarfile.TarInfo(name)
            entry.size, entry.mtime = len(data), EPOCH
            tar.addfile(entry, io.BytesIO(data))
        add("oci-layout", b'{"imageLayoutVersion": "1.0.0"}')
        add("index.json", json.dumps({"schemaVersion": 2, "manifests": [manifest]}).encode())
        for name, data in sorted(blobs.items()):
            add("blobs/sha256/" + name[7:], data)
        tar.add(layer_path, arcname="blobs/sha256/" + stored[7:], filter=flatten)
    os.remove(layer_path)
    print(f"{image}: rubble {version} for {architecture}, {size / 1e6:.0f} MB packed")


if __name__ == "__main__":
    main()
