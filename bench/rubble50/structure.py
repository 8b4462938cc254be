"""Structure from motion by COLMAP, which is run, never linked: the pictures of a recording alone, with its defaults
and the true intrinsics."""
import pathlib
import shutil
import subprocess
import tempfile

import cv2
import numpy as np
import slam


def run(words, log):
    with open(log, "a") as file:
        done = subprocess.run([str(word) for word in words], stdout=file, stderr=subprocess.STDOUT)
    return done.returncode == 0


def write_pictures(frames, folder):
    folder.mkdir()
    for i, (_, rgb, _) in enumerate(frames):
        cv2.imwrite(str(folder / ("%06d.png" % i)), rgb[..., ::-1])


def reconstruct(frames, k, work):
    """The folders of the models that COLMAP finds: none is a result, too."""
    log, database, models = work / "colmap.log", work / "database.db", work / "sparse"
    write_pictures(frames, work / "images")
    models.mkdir()
    camera = ",".join("%.17g" % v for v in (k[0, 0], k[1, 1], k[0, 2] + 0.5, k[1, 2] + 0.5))  # COLMAP counts from corners
    steps = (["feature_extractor", "--database_path", database, "--image_path", work / "images",
              "--ImageReader.single_camera", 1, "--ImageReader.camera_model", "PINHOLE",
              "--ImageReader.camera_params", camera, "--SiftExtraction.use_gpu", 0],
             ["sequential_matcher", "--database_path", database, "--SiftMatching.use_gpu", 0],
             ["mapper", "--database_path", database, "--image_path", work / "images", "--output_path", models,
              "--Mapper.ba_refine_focal_length", 0, "--Mapper.ba_refine_extra_params", 0])
    for step in steps:
        if not run(["colmap", *step], log):
            break
    return sorted(models.iterdir())


def read_poses(model, work):
    """{number of the frame: pose of the body of the camera}, at the model's own scale."""
    text = work / (model.name + "_text")
    text.mkdir()
    run(["colmap", "model_converter", "--input_path", model, "--output_path", text, "--output_type", "TXT"],
        work / "colmap.log")
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
    """The frames that the largest model has, and their poses; the others are lost."""
    work = pathlib.Path(tempfile.mkdtemp(prefix="rubble50_colmap_"))
    try:
        models = [read_poses(model, work) for model in reconstruct(frames, k, work)]
    finally:
        shutil.rmtree(work)
    poses = max(models, key=len, default={})
    numbers = sorted(poses)
    return [frames[i] for i in numbers], [poses[i] for i in numbers], len(frames) - len(numbers)
