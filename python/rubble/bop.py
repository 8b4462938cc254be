#!/usr/bin/env python3
"""Writes a run with plain images as a dataset of BOP (6-D poses of objects): python -m rubble.bop out/run -o bop

The run needs outputs.frames and the channel `instance`. Each kind and scale of piece is an object. It calls the program
`rubble` for meshes and poses, and needs numpy, Pillow and OpenEXR (pip). Exit code 1: a run that BOP cannot hold, with the
reason.
"""
import argparse
import csv
import io
import json
import math
import subprocess
import sys
from pathlib import Path

MM = 1000.0
DEPTH_STEP = 0.1  # of depth images; unit: mm
NEAR = 0.01       # triangles are cut there; unit: m
STEPS = 8         # of silhouettes, in a pixel


class BopError(Exception):
    """What is wrong, with the file."""


def load(path):
    try:
        return json.loads(path.read_text(encoding="utf-8"))
    except (OSError, ValueError) as error:
        raise BopError(f"{path}: {error}") from error


def ask(program, *arguments):
    try:
        done = subprocess.run([program, *map(str, arguments)], check=False, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
    except OSError as error:
        raise BopError(f"{program}: {error}: --program names the program") from error
    if done.returncode:
        raise BopError(f"{program} {arguments[0]}: {done.stderr.strip()}")
    return done.stdout


def matrix(np, w, x, y, z):
    return np.array([[1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)],
                     [2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)],
                     [2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)]])


def read_pieces(np, program, run, folder):
    """By number: object, rotation, place in the world and, of the first of an object, its mesh."""
    ask(program, "export", run, "--format", "obj", "--out", folder, "--force", "--quiet")
    vertices, faces, name = [], {}, None
    for line in (folder / "pile.obj").read_text(encoding="utf-8").splitlines():
        words = line.split()
        if words and words[0] == "v":
            vertices.append(tuple(map(float, words[1:4])))
        elif words and words[0] == "o":
            name = words[1]
        elif words and words[0] == "f":
            corners = [int(word.split("/")[0]) - 1 for word in words[1:]]
            faces.setdefault(name, []).extend((corners[0], corners[i], corners[i + 1]) for i in range(1, len(corners) - 1))
    vertices, objects, pieces = np.array(vertices), {}, {}
    for row in csv.DictReader(io.StringIO(ask(program, "pieces", run))):
        if row["status"] == "lost":
            continue
        if row["name"] not in faces:
            raise BopError(f"{folder}/pile.obj: has no mesh of {row['name']}")
        rotation = matrix(np, *(float(row[key]) for key in ("qw", "qx", "qy", "qz")))
        place = np.array([float(row[key]) for key in "xyz"])
        key = (row["asset"], row["scale"])
        if key not in objects:
            triangles = np.array(faces[row["name"]])
            used, index = np.unique(triangles, return_inverse=True)
            objects[key] = {"id": len(objects) + 1, "asset": row["asset"], "scale": float(row["scale"]),
                            "vertices": (vertices[used] - place) @ rotation, "triangles": index.reshape(-1, 3)}
        pieces[int(row["number"])] = (objects[key], rotation, place)
    return list(objects.values()), pieces


def diameter(np, vertices):
    """The largest distance of two vertices."""
    largest = 0.0
    for first in range(0, len(vertices), 256):
        difference = vertices[first:first + 256, None, :] - vertices[None, :, :]
        largest = max(largest, float((difference ** 2).sum(axis=2).max()))
    return largest ** 0.5


def write_models(np, folder, objects):
    folder.mkdir(parents=True)
    info = {}
    for thing in objects:
        vertices = thing["vertices"] * MM
        low, size = vertices.min(axis=0), np.ptp(vertices, axis=0)
        info[str(thing["id"])] = {"diameter": diameter(np, vertices), **{f"min_{a}": float(v) for a, v in zip("xyz", low)},
                                  **{f"size_{a}": float(v) for a, v in zip("xyz", size)}, "asset": thing["asset"], "scale": thing["scale"]}
        with open(folder / f"obj_{thing['id']:06d}.ply", "w", encoding="ascii") as out:
            out.write("ply\nformat ascii 1.0\n" + f"element vertex {len(vertices)}\nproperty float x\nproperty float y\nproperty float z\n"
                      f"element face {len(thing['triangles'])}\nproperty list uchar int vertex_indices\nend_header\n")
            out.writelines("%.6g %.6g %.6g\n" % tuple(v) for v in vertices)
            out.writelines("3 %d %d %d\n" % tuple(t) for t in thing["triangles"])
    (folder / "models_info.json").write_text(json.dumps(info, indent=1) + "\n", encoding="ascii")


def clipped(triangle):
    """The part of it in front of the camera: a polygon."""
    polygon = []
    for a, b in zip(triangle, (triangle[1], triangle[2], triangle[0])):
        if a[2] >= NEAR:
            polygon.append(a)
        if (a[2] >= NEAR) != (b[2] >= NEAR):
            polygon.append(a + (b - a) * ((NEAR - a[2]) / (b[2] - a[2])))
    return polygon


def silhouette(np, camera, points, triangles):
    """Pixels whose centres the mesh covers. It is drawn finer by STEPS around the mesh, as Pillow widens polygons by a pixel."""
    from PIL import Image, ImageDraw  # type: ignore[import-not-found,unused-ignore]
    width, height = camera["width"], camera["height"]
    mask = np.zeros((height, width), bool)
    focal, centre = np.array([camera["fx"], camera["fy"]]), np.array([camera["cx"], camera["cy"]])
    front = points[:, 2] >= NEAR
    with np.errstate(divide="ignore", invalid="ignore"):
        pixels = focal * points[:, :2] / points[:, 2:] + centre
    polygons = []
    for triangle in triangles:
        polygon = pixels[triangle] if front[triangle].all() else [focal * p[:2] / p[2] + centre for p in clipped(points[triangle])]
        if len(polygon) > 2:
            polygons.append(np.asarray(polygon))
    if not polygons:
        return mask
    corners = np.concatenate(polygons)
    low = np.clip(np.floor(corners.min(axis=0)), 0, [width, height]).astype(int)
    high = np.clip(np.ceil(corners.max(axis=0)) + 1, 0, [width, height]).astype(int)
    size = high - low
    if (size <= 0).any():
        return mask
    image = Image.new("1", tuple(map(int, size * STEPS)))
    draw = ImageDraw.Draw(image)
    for polygon in polygons:
        draw.polygon([tuple(corner) for corner in (polygon - low + 0.5) * STEPS - 0.5], fill=1)
    mask[low[1]:high[1], low[0]:high[0]] = np.array(image)[STEPS // 2::STEPS, STEPS // 2::STEPS]
    return mask


def box(np, mask):
    rows, columns = np.flatnonzero(mask.any(axis=1)), np.flatnonzero(mask.any(axis=0))
    if not len(rows):
        return [-1, -1, -1, -1]
    return [int(columns[0]), int(rows[0]), int(columns[-1] - columns[0] + 1), int(rows[-1] - rows[0] + 1)]


def read_exr(np, path, camera):
    import OpenEXR  # type: ignore[import-not-found,unused-ignore]
    try:
        with OpenEXR.File(str(path)) as file:
            pixels = next(iter(file.channels().values())).pixels.astype(np.float64)
    except Exception as error:  # it has no class of its own
        raise BopError(f"{path}: cannot be read: {' '.join(str(error).split()) or type(error).__name__}") from error
    if pixels.shape != (camera["height"], camera["width"]):
        raise BopError(f"{path}: has {pixels.shape} pixels: expected {(camera['height'], camera['width'])}, as camera.json says")
    return pixels


def read_png(path, camera):
    """Its bytes, of a whole picture."""
    from PIL import Image  # type: ignore[import-not-found,unused-ignore]
    content = path.read_bytes()
    try:
        with Image.open(io.BytesIO(content)) as picture:
            picture.load()
            size = picture.size
    except Exception as error:
        raise BopError(f"{path}: cannot be read: {' '.join(str(error).split())}") from error
    if size != (camera["width"], camera["height"]):
        raise BopError(f"{path}: has {size} pixels: expected {(camera['width'], camera['height'])}, as camera.json says")
    return content


def read_poses(path):
    """Number, rotation as w x y z, and place, of each row."""
    with open(path, encoding="ascii") as opened:
        for line, row in enumerate(csv.DictReader(opened), 2):
            try:
                values = [float(row[key]) for key in ("qw", "qx", "qy", "qz", "x", "y", "z")]
                if not all(map(math.isfinite, values)) or abs(sum(v * v for v in values[:4]) - 1) > 1e-3:
                    raise ValueError("a pose that is none")
                yield int(row["frame"]), values[:4], values[4:]
            except (KeyError, TypeError, ValueError) as error:
                raise BopError(f"{path}:{line}: {error}: expected frame, x, y, z and a unit quaternion") from error


def check(run, frames):
    """The scenario, of which BOP holds a pinhole camera in a pile at rest."""
    if not (frames / "poses.csv").is_file():
        raise BopError(f"{frames}: expected the plain images of one camera: outputs.frames = true")
    if not (frames / "instance").is_dir():
        raise BopError(f"{frames}: has no instances: camera.channels = {{ \"instance\" }}")
    camera = load(frames / "camera.json")
    missing = [key for key in ("lens", "distortion", "width", "height", "fx", "fy", "cx", "cy") if key not in camera]
    if missing:
        raise BopError(f"{frames}/camera.json: lacks {', '.join(missing)}")
    if camera["lens"] != "plumb_bob" or any(camera["distortion"]):
        raise BopError(f"{frames}/camera.json: has a lens with distortion: BOP holds pinhole cameras alone")
    scenario = load(run / "manifest.json")["scenario"]
    if scenario.get("record_settling", {}).get("on"):
        raise BopError(f"{run}: record_settling: pieces move, and `rubble pieces` has where they rest")
    if scenario.get("robots") and scenario.get("robot_run", {}).get("debris") != "fixed":
        raise BopError(f"{run}: robots may move pieces: run it with robot_run.debris = \"fixed\"")
    return camera


def write_scene(np, run, folder, camera, pieces):
    from PIL import Image  # type: ignore[import-not-found,unused-ignore]
    frames, scene = run / "frames", folder / "test" / "000001"
    for name in ("rgb", "depth", "mask", "mask_visib"):
        (scene / name).mkdir(parents=True)
    optical = np.array([[0.0, 0, 1], [-1, 0, 0], [0, -1, 0]])  # camera body from optical frame
    cameras, truths, infos = {}, {}, {}
    rows = list(read_poses(frames / "poses.csv"))
    for number, turn, place in rows:
        image = f"{number:06d}"
        rotation = (matrix(np, *turn) @ optical).T
        offset = -rotation @ np.array(place)
        depth = np.nan_to_num(read_exr(np, frames / "depth" / (image + ".exr"), camera)) * (MM / DEPTH_STEP)
        Image.fromarray(np.clip(np.rint(depth), 0, 65535).astype(np.uint16)).save(scene / "depth" / (image + ".png"))
        (scene / "rgb" / (image + ".png")).write_bytes(read_png(frames / "rgb" / (image + ".png"), camera))
        cameras[str(number)] = {"cam_K": [camera["fx"], 0, camera["cx"], 0, camera["fy"], camera["cy"], 0, 0, 1], "depth_scale": DEPTH_STEP,
                                "cam_R_w2c": rotation.ravel().tolist(), "cam_t_w2c": (offset * MM).tolist()}
        instances = read_exr(np, frames / "instance" / (image + ".exr"), camera)
        truths[str(number)], infos[str(number)] = [], []
        for piece in sorted({int(i) for i in np.unique(instances)} & set(pieces)):
            thing, turned, at_rest = pieces[piece]
            visible = instances == piece
            to_camera, at = rotation @ turned, rotation @ at_rest + offset
            whole = silhouette(np, camera, thing["vertices"] @ to_camera.T + at, thing["triangles"]) | visible
            index = len(truths[str(number)])
            for name, mask in (("mask", whole), ("mask_visib", visible)):
                Image.fromarray(mask.astype(np.uint8) * 255).save(scene / name / f"{image}_{index:06d}.png")
            truths[str(number)].append({"obj_id": thing["id"], "cam_R_m2c": to_camera.ravel().tolist(), "cam_t_m2c": (at * MM).tolist(), "piece": piece})
            infos[str(number)].append({"bbox_obj": box(np, whole), "bbox_visib": box(np, visible), "px_count_all": int(whole.sum()),
                                       "px_count_valid": int((visible & (depth > 0)).sum()), "px_count_visib": int(visible.sum()),
                                       "visib_fract": float(visible.sum() / whole.sum())})
    for name, content in (("camera", cameras), ("gt", truths), ("gt_info", infos)):
        (scene / f"scene_{name}.json").write_text(json.dumps(content, indent=1) + "\n", encoding="ascii")
    return len(rows)


def main(arguments=None):
    parser = argparse.ArgumentParser(prog="rubble.bop", description=__doc__.split("\n", maxsplit=1)[0])
    parser.add_argument("run", type=Path, help="the output folder of a run with outputs.frames and the channel instance")
    parser.add_argument("-o", "--out", type=Path, required=True, help="the new dataset")
    parser.add_argument("--program", default="rubble", help="default: rubble")
    try:
        options = parser.parse_args(arguments)
    except SystemExit as end:  # 2, that of argparse, is another code in all other commands
        return 1 if end.code else 0
    try:
        try:
            import numpy as np
            import OpenEXR  # type: ignore[import-not-found,unused-ignore] # noqa: F401
            import PIL  # type: ignore[import-not-found,unused-ignore] # noqa: F401
        except ImportError as error:
            raise BopError(f"{error}: pip install numpy pillow OpenEXR") from error
        camera = check(options.run, options.run / "frames")
        if options.out.exists() and any(options.out.iterdir()):
            raise BopError(f"{options.out}: is not empty")
        options.out.mkdir(parents=True, exist_ok=True)
        objects, pieces = read_pieces(np, options.program, options.run, options.out / "pile")
        write_models(np, options.out / "models", objects)
        (options.out / "camera.json").write_text(json.dumps({**{key: camera[key] for key in ("cx", "cy", "fx", "fy", "height", "width")},
                                                             "depth_scale": DEPTH_STEP}, indent=1) + "\n", encoding="ascii")
        count = write_scene(np, options.run, options.out, camera, pieces)
    except (BopError, OSError) as error:
        print(f"rubble.bop: {error}", file=sys.stderr)
        return 1
    except Exception as error:  # of a picture or a table that is damaged
        print(f"rubble.bop: {options.run}: cannot be taken: {type(error).__name__}: {' '.join(str(error).split())}", file=sys.stderr)
        return 1
    print(f"{options.out}: {len(objects)} objects, {count} images")
    return 0


if __name__ == "__main__":
    sys.exit(main())
