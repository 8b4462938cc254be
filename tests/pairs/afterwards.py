"""What is done with a finished run: each command on its own, and what it must leave."""
import csv
import hashlib
import json
import os
import signal
import subprocess
import time

import numpy as np

import geometry
import pictures
from dataset import Finding, need

# Entries of a manifest that a repetition must give again.
REPEATED = ("seed", "state_hash", "pile", "frames", "metrics", "outputs", "frame_hashes", "scenario")

PYTHON_CHECK = """
import json, os, sys
import numpy as np
import rubble
folder = sys.argv[1]
pile = rubble.open_pile(folder, assets=[os.path.dirname(os.path.abspath(folder))])
vertices, triangles = pile.mesh()
distance = pile.cast_rays(np.array([[0.0, 0.0, 50.0]]), np.array([[0.0, 0.0, -1.0]]))["distance"]
answer = {"state": "%016x" % pile.state_hash, "settled": bool(pile.settled), "triangles": len(triangles), "down": float(distance[0])}
if len(sys.argv) > 2:
    data = rubble.open_dataset(folder)
    answer["topics"] = {name: int(count) for name, count in data.topics.items()}
    if "/ground_truth/pose" in data.topics and data.topics["/ground_truth/pose"]:
        answer["poses"] = data.poses()[1].tolist()
print(json.dumps(answer))
"""


class Tools:
    """program: path of rubble; mission, out: those of the row; work: a folder for what is made; python: PYTHONPATH or None."""

    def __init__(self, program, mission, out, work, seed, python=None):
        self.program, self.mission, self.out, self.work, self.seed = program, mission, out, work, seed
        self.python = python

    def rubble(self, *arguments, codes=(0,)):
        done = subprocess.run([self.program, *arguments], capture_output=True, text=True, check=False)
        need(done.returncode in codes, "rubble %s: exit code %d: %s", arguments[0], done.returncode,
             (done.stderr or done.stdout).strip()[-300:])
        return done

    def folder(self, name):
        return os.path.join(self.work, name)


def compare_runs(one, other, what):
    manifests = []
    for folder in (one, other):
        with open(os.path.join(folder, "manifest.json"), encoding="utf-8") as file:
            manifests.append(json.load(file))
    for key in REPEATED:
        need(manifests[0].get(key) == manifests[1].get(key), "%s: `%s` of the manifest differs", what, key)
    lists = [sorted(os.path.relpath(os.path.join(folder, name), top) for folder, _, names in os.walk(top) for name in names)
             for top in (one, other)]
    need(lists[0] == lists[1], "%s: other files: %s", what, sorted(set(lists[0]) ^ set(lists[1]))[:5])
    for name in lists[0]:
        if name in ("manifest.json", "README.md"):
            continue
        with open(os.path.join(one, name), "rb") as a, open(os.path.join(other, name), "rb") as b:
            need(a.read() == b.read(), "%s: %s has other bytes", what, name)


def resume(tools, data):
    """A run that is killed on its way, at three times, and continued, has the bytes of one that was not."""
    out = tools.folder("resumed")
    begun = time.monotonic()
    process = subprocess.Popen([tools.program, "run", tools.mission, "--out", out, "--quiet", "--checkpoint-every", "0"],
                               stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    # As soon as its mission is kept, which is when it can be continued; a bit later each time.
    while process.poll() is None and not os.path.exists(os.path.join(out, "unfinished", "run.json")):
        time.sleep(0.005)
    time.sleep((tools.seed % 7) * 0.15 * (time.monotonic() - begun + 0.2))
    if process.poll() is None:
        process.send_signal(signal.SIGKILL if tools.seed % 2 else signal.SIGTERM)
        process.wait()
    if os.path.exists(os.path.join(out, "manifest.json")):
        compare_runs(tools.out, out, "resume (the run was done before)")
        return
    tools.rubble("resume", out, "--quiet")
    compare_runs(tools.out, out, "resume")


def remake(tools, data):
    tools.rubble("remake", tools.out, "--out", tools.folder("remade"), "--quiet")
    compare_runs(tools.out, tools.folder("remade"), "remake")


def verify(tools, data):
    tools.rubble("verify", tools.out, "--work", tools.work, "--quiet")
    name = "groundtruth.txt"
    path = next((os.path.join(folder, name) for folder, _, names in os.walk(tools.out) if name in names), None)
    if path is not None:  # a byte that is another one must be found
        with open(path, "rb") as file:
            body = file.read()
        with open(path, "wb") as file:
            file.write(body.replace(b"0", b"1", 1))
        tools.rubble("verify", tools.out, "--quiet", "--pile-only", codes=(5,))
        with open(path, "wb") as file:
            file.write(body)


def render(tools, data):
    """The same mission drawn over its pile gives the same poses and pictures."""
    again = tools.folder("rendered")
    tools.rubble("render", tools.out, "--mission", tools.mission, "--out", again, "--seed", str(tools.seed), "--quiet")
    with open(os.path.join(again, "manifest.json"), encoding="utf-8") as file:
        manifest = json.load(file)
    need(manifest["frames"] == data.manifest["frames"], "render: %s frames, the run has %s", manifest["frames"],
         data.manifest["frames"])
    need(manifest["frame_hashes"] == data.manifest["frame_hashes"], "render: hashes of frames differ from those of the run")


def view(tools, data):
    tools.rubble("view", tools.out, "--out", tools.folder("view.html"), "--frames", "2", "--width", "64")
    need(os.path.getsize(tools.folder("view.html")) > 10000, "view: the page is empty")


def pack(tools, data):
    """The sums are those of the files, and the card names what the manifest does."""
    tools.rubble("pack", tools.out, "--card", "--settings", "--licence", "CC-BY-4.0")
    sums = next((name for name in os.listdir(tools.out) if "sum" in name.lower() or "sha256" in name.lower()), None)
    need(sums is not None, "pack: no sums of files")
    with open(os.path.join(tools.out, sums), encoding="utf-8") as file:
        for line in file:
            wanted, name = line.rstrip("\n").split(None, 1)
            with open(os.path.join(tools.out, name.lstrip("*")), "rb") as body:
                need(hashlib.sha256(body.read()).hexdigest() == wanted, "pack: the sum of %s is another one", name)
    with open(os.path.join(tools.out, "README.md"), encoding="utf-8") as file:
        card = file.read()
    need(str(data.manifest["seed"]) in card, "pack: the card does not name the seed")
    for camera in data.cameras:
        need("%dx%d" % (camera.settings["width"], camera.settings["height"]) in card.replace(" ", "").replace("×", "x"),
             "pack: the card does not name the size of the camera %s", camera.name)


def report(tools, data):
    """A batch of two seeds: the run of this seed has its state."""
    batch = tools.folder("batch")
    tools.rubble("batch", tools.mission, "--seeds", "%d,%d" % (tools.seed, tools.seed + 1000), "--out", batch, "--jobs", "1",
                 "--threads", "1", "--quiet", "--pile-only", codes=(0, 3))
    with open(os.path.join(batch, "index.csv"), encoding="utf-8") as file:
        rows = list(csv.DictReader(file))
    need(len(rows) == 2, "report: %d rows of 2 seeds", len(rows))
    own = next(row for row in rows if row["seed"] == str(tools.seed))
    state = next((own[name] for name in own if "hash" in name), None)
    need(state is None or state == data.manifest["state_hash"], "report: the batch has the state %s, the run %s", state,
         data.manifest["state_hash"])
    tools.rubble("report", batch)
    need(os.path.getsize(os.path.join(batch, "report.html")) > 1000, "report: the page is empty")


def voids(tools, data):
    """The map's volumes are finite, and its files are there."""
    tools.rubble("voids", tools.out, "--radius", "0.2", "--voxel", "0.1", "--outside-radius", "1", "--out", tools.folder("voids"), "--quiet")
    names = os.listdir(tools.folder("voids"))
    need("voids.json" in names, "voids: no voids.json among %s", names)
    with open(tools.folder("voids/voids.json"), encoding="utf-8") as file:
        text = file.read()
    need("nan" not in text.lower() and "inf" not in text.lower().replace("information", ""), "voids: a number is not finite")
    json.loads(text)


def cutaway(tools, data):
    codes = (0, 1) if data.manifest["pile"]["pieces"] == 0 else (0,)
    done = tools.rubble("cutaway", tools.out, "--out", tools.folder("cut.png"), "--width", "200", codes=codes + (1,))
    if done.returncode:
        need("cuts no piece" in done.stderr or "no piece" in done.stderr, "cutaway: %s", done.stderr.strip()[-200:])
        return
    picture = pictures.read_png(tools.folder("cut.png"))
    need(picture.shape[1] >= 200 and picture.std() > 0, "cutaway: the picture is %s", picture.shape)


def export(tools, data):
    """Meshes that are exported later have the bytes of those of the run."""
    tools.rubble("export", tools.out, "--out", tools.folder("exported"), "--quiet")
    for name in ("pile.stl", "pile.ply", "pile.obj", "pile.glb", "sdf/pile.sdf", "mjcf/pile.xml", "usd/pile.usda", "urdf/fixed.urdf"):
        if data.has(*name.split("/")):
            with open(data.file(*name.split("/")), "rb") as a, open(tools.folder("exported/" + name), "rb") as b:
                need(a.read() == b.read(), "export: %s has other bytes than that of the run", name)


def python(tools, data):
    """The package reads the pile and the recording as the judges do."""
    if tools.python is None:
        return
    arguments = ["/usr/bin/python3", "-c", PYTHON_CHECK, tools.out] + (["bag"] if data.bag is not None else [])
    done = subprocess.run(arguments, capture_output=True, text=True, check=False,
                          env=dict(os.environ, PYTHONPATH=tools.python, PYTHONDONTWRITEBYTECODE="1"))
    need(done.returncode == 0, "python: %s", done.stderr.strip()[-300:])
    answer = json.loads(done.stdout.strip().splitlines()[-1])
    need(answer["state"] == data.manifest["state_hash"], "python: the state is %s, that of the run %s", answer["state"],
         data.manifest["state_hash"])
    if data.solid is not None:
        expected = data.solid.cast(np.array([0.0, 0.0, 50.0]), np.array([0.0, 0.0, -1.0]))[0]
        need(abs(answer["down"] - expected) < 0.005, "python: a ray down is %.4f m long, expected %.4f m", answer["down"], expected)
    if data.bag is not None:
        counts = {topic: len(messages) for topic, messages in data.bag.topics.items()}
        need(answer["topics"] == counts, "python: other topics than rosbag's: %s",
             sorted(set(answer["topics"].items()) ^ set(counts.items()))[:4])
    if "poses" in answer and not data.scenario["cameras"]:
        found = np.array(answer["poses"])
        need(np.abs(found[:, :3] - data.cameras[0].poses[1]).max() < 2e-6, "python: poses differ from groundtruth.txt")
        turned = geometry.matrix(*found[-1, 3:]) @ geometry.BODY_FROM_OPTICAL
        need(geometry.angle_between(turned, data.cameras[0].poses[2][-1]) < 2e-4, "python: attitudes differ from groundtruth.txt")


def info(tools, data):
    """Integrity: whole files are whole, and a file that is cut short is not."""
    tools.rubble("info", tools.out)
    for name in ("mission.bag", "mission.mcap", "mission.rawlog"):
        if data.has(name):
            path = data.file(name)
            with open(path, "rb") as file:
                body = file.read()
            with open(path, "wb") as file:
                file.write(body[:len(body) * 2 // 3])
            done = tools.rubble("info", path, codes=(0, 1, 2, 5))
            with open(path, "wb") as file:
                file.write(body)
            need(done.returncode != 0, "info: %s, cut at two thirds, is taken for whole", name)
            return


def nothing(tools, data):
    return


STEPS = {step.__name__: step for step in (nothing, resume, remake, verify, render, view, pack, report, voids, cutaway, export,
                                          python, info)}


def judge(tools, data, name):
    try:
        STEPS[name](tools, data)
    except Finding as finding:
        return [("afterwards:" + name, str(finding))]
    return []
