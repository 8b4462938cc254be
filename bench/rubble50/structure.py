"""Structure from motion by COLMAP, which is run, never linked: the pictures of a recording alone, with its defaults
and the true intrinsics."""
import pathlib
import sys
import tempfile

import cv2
import numpy as np
import slam

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent.parent / "demonstration"))
import colmap  # noqa: E402
from work import run  # noqa: E402


def write_pictures(frames, folder):
    folder.mkdir()
    for i, (_, rgb, _) in enumerate(frames):
        cv2.imwrite(str(folder / ("%06d.png" % i)), rgb[..., ::-1])


def reconstruct(frames, k, work):
    """The folders of the models that COLMAP finds: none is a result, too."""
    images = work / "images"
    write_pictures(frames, images)
    # COLMAP counts its image from corner to corner.
    camera = ",".join("%.17g" % v for v in (k[0, 0], k[1, 1], k[0, 2] + 0.5, k[1, 2] + 0.5))
    colmap.reconstruct(work, images, camera, work / "colmap.log")
    return sorted((work / "sparse").iterdir())


def read_poses(model, work):
    """{number of the frame: pose of the body of the camera}, at the model's own scale."""
    text = work / (model.name + "_text")
    text.mkdir()
    run(["colmap", "model_converter", "--input_path", model, "--output_path", text, "--output_type", "TXT"], work / "colmap.log")
    poses = {}
    lines = [line for line in (text / "images.txt").read_text().splitlines() if not line.startswith("#")]
    for line in lines[::2]:  # every other one lists points
        _, w, x, y, z, *rest = line.split()
        optical_from_world = np.eye(4)
        optical_from_world[:3, :3] = slam.rotation_matrix(float(x), float(y), float(z), float(w))
        optical_from_world[:3, 3] = [float(v) for v in rest[:3]]
        poses[int(pathlib.Path(rest[4]).stem)] = np.linalg.inv(slam.BODY_FROM_OPTICAL @ optical_from_world)
    return poses


def follow(frames, k):
    """The frames that the largest model has, their poses, and how many others there are. COLMAP's failures end the
    program with the end of its log; to find no model is none."""
    with tempfile.TemporaryDirectory(prefix="rubble50_colmap_") as folder:
        work = pathlib.Path(folder) / "model"
        work.mkdir()
        models = reconstruct(frames, k, work)
        poses = max((read_poses(model, work) for model in models), key=len, default={})
    numbers = sorted(poses)
    return [frames[i] for i in numbers], [poses[i] for i in numbers], len(frames) - len(numbers)
