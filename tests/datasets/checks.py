"""Checks of read_datasets.py, each by a reader that others wrote: checks.py DATA [CHECK...]"""
import json
import os
import sys
from pathlib import Path

import numpy as np

from recorded import DATA, Frames, close, matrix, need, of_webdataset, rotation
from ros_checks import (mcap_has_one_schema_for_each_type, mcap_ros2_decodes_all_topics, rerun_converts_without_an_error,
                        robots_are_as_rep_105_says, rosbags_reads_the_folder)


def nerfstudio_projects_points():
    """Poses are those of the tables; every point of the cloud is on the depth of a picture."""
    from PIL import Image
    from plyfile import PlyData
    folder = DATA / "single"
    frames, root = Frames(folder), folder / "nerfstudio"
    meta = json.loads((root / "transforms.json").read_text(encoding="ascii"))
    cloud = PlyData.read(str(root / meta["ply_file_path"]))["vertex"]
    points = np.stack([cloud["x"], cloud["y"], cloud["z"], np.ones(len(cloud))])
    need(len(cloud) > 1000, "%d points", len(cloud))
    near = np.zeros(len(cloud), bool)
    for i, entry in enumerate(meta["frames"]):
        pose = np.array(entry["transform_matrix"]) @ np.diag([1, -1, -1, 1])
        close(pose, frames.optical[i], 1e-12, "pose %d", i)
        need(np.array_equal(np.array(Image.open(root / entry["file_path"])), frames.rgb(i)), "picture %d", i)
        depth = np.array(Image.open(root / entry["depth_file_path"])) * meta["depth_unit_scale_factor"]
        x, y, z, _ = np.linalg.inv(pose) @ points
        with np.errstate(all="ignore"):  # nerfstudio's pixels have their centres at a half
            u, v = np.floor(meta["fl_x"] * x / z + meta["cx"]), np.floor(meta["fl_y"] * y / z + meta["cy"])
        inside = (z > 0) & (u >= 0) & (v >= 0) & (u < meta["w"]) & (v < meta["h"])
        found = np.where(inside, depth[np.where(inside, v, 0).astype(int), np.where(inside, u, 0).astype(int)], 0)
        near |= inside & (np.abs(found - z) < 0.002)
    need(near.mean() > 0.999, "only %.4f of the points are on a surface", near.mean())


def nerfstudio_has_all_cameras():
    meta = json.loads((DATA / "rig" / "nerfstudio" / "transforms.json").read_text(encoding="ascii"))
    sizes = {entry["file_path"].split("_")[0]: (entry["w"], entry["h"]) for entry in meta["frames"]}
    need(sizes == {"images/front": (160, 120), "images/left": (100, 80)}, "cameras %s", sizes)
    need(len({Path(entry["file_path"]).name for entry in meta["frames"]}) == len(meta["frames"]), "names are not unique")


def pycolmap_reads_rigs():
    """COLMAP 4: three sensors in one rig, frames by stamp, poses of the tables."""
    import pycolmap
    model = pycolmap.Reconstruction(DATA / "rig" / "colmap" / "sparse")
    need((model.num_rigs(), model.num_cameras(), model.num_reg_frames()) == (1, 3, 6), "rigs, cameras, frames: %s",
         (model.num_rigs(), model.num_cameras(), model.num_reg_frames()))
    need(next(iter(model.rigs.values())).num_sensors() == 3, "sensors of the rig")
    truth = {name: Frames(DATA / "rig" / "cameras" / name) for name in ("front", "left")}
    for image in model.images.values():
        parts = image.name.split("/")
        frames, k = truth[parts[0]], int(parts[-1][:6])
        if parts[0] == "left":  # of every second instant
            need(k % 2 == 0, "instant %d", k)
            k //= 2
        offset = matrix(np.eye(3), [0.12 if parts[1] == "right" else 0, 0, 0])
        world_from_eye = matrix(*(lambda t: (t.rotation.matrix(), t.translation))(image.cam_from_world().inverse()))
        close(world_from_eye, frames.optical[k] @ offset, 1e-9, "pose of %s", image.name)
        composed = image.frame.sensor_from_world(image.camera.sensor_id)
        close(composed.translation, image.cam_from_world().translation, 1e-9, "rig pose of %s", image.name)
        need((image.camera.width, image.camera.height) == (frames.camera["width"], frames.camera["height"]), "size of %s", image.name)
    single = pycolmap.Reconstruction(DATA / "single" / "colmap" / "sparse")
    need((single.num_rigs(), single.num_cameras(), single.num_reg_images()) == (1, 1, 6), "a single camera")


def pycolmap_triangulates_with_rigs():
    """The recipe of docs/reference/formats.md, which fills points3D at the true poses."""
    import shutil
    import pycolmap
    root = DATA / "rig" / "colmap"
    work = DATA / "triangulated"
    shutil.rmtree(work, ignore_errors=True)
    (work / "points").mkdir(parents=True)
    points = triangulate(pycolmap, root, work)
    need(points > 30, "%d points", points)


def triangulate(pycolmap, root, work):
    model = pycolmap.Reconstruction(root / "sparse")
    extraction, matching = pycolmap.FeatureExtractionOptions(), pycolmap.FeatureMatchingOptions()
    extraction.use_gpu = matching.use_gpu = False
    extraction.num_threads = 1
    database = work / "db"
    for number in sorted(model.cameras):  # each with its own calibration; the database numbers cameras as they come
        camera = model.cameras[number]
        names = [image.name for image in model.images.values() if image.camera_id == camera.camera_id]
        reader = pycolmap.ImageReaderOptions()
        reader.camera_model, reader.camera_params = camera.model.name, camera.params_to_string()
        pycolmap.extract_features(database, root / "images", image_names=sorted(names), camera_mode=pycolmap.CameraMode.SINGLE,
                                  reader_options=reader, extraction_options=extraction)
    with pycolmap.Database.open(database) as db:
        db.clear_frames()  # COLMAP made a rig of each camera
        db.clear_rigs()
        for rig in model.rigs.values():
            db.write_rig(rig, use_rig_id=True)
        for frame in model.frames.values():
            db.write_frame(frame, use_frame_id=True)
    pycolmap.match_exhaustive(database, matching_options=matching)
    return pycolmap.triangulate_points(model, database, root / "images", work / "points").num_points3D()


def pycocotools_finds_masks():
    """Masks, boxes and areas are those of the channel `instance`."""
    from pycocotools import mask as masks
    from pycocotools.coco import COCO
    folder = DATA / "single"
    arrays = of_webdataset(folder)
    coco = COCO(str(folder / "coco" / "annotations.json"))
    legend = json.loads((folder / "frames" / "legend.json").read_text(encoding="utf-8"))
    label = {entry["instance"]: entry["label"] for entry in legend["instances"]}
    names = {entry["label"]: entry["name"] for entry in legend["labels"]}
    need(len(coco.getImgIds()) == 6, "%d pictures", len(coco.getImgIds()))
    for image in coco.getImgIds():
        instance = arrays[image - 1]["instance.npy"]
        found = coco.loadAnns(coco.getAnnIds(imgIds=image))
        need({a["instance"] for a in found} == set(np.unique(instance)) - {-1, -2}, "pieces in picture %d", image)
        for a in found:
            wanted = instance == a["instance"]
            need(np.array_equal(coco.annToMask(a), wanted), "mask of piece %d in picture %d", a["instance"], image)
            run_lengths = coco.annToRLE(a)
            need(a["area"] == int(masks.area(run_lengths)) == wanted.sum(), "area")
            close(a["bbox"], masks.toBbox(run_lengths), 0, "box of piece %d", a["instance"])
            need(a["category_id"] == label[a["instance"]], "category of piece %d", a["instance"])
            need(coco.loadCats(a["category_id"])[0]["name"] == names[a["category_id"]], "name of a category")


def pykitti_reads_odometry():
    """Pictures, poses, calibration; scans, freed of motion, lie on the points of pcd."""
    import pykitti
    folder = DATA / "single"
    frames = Frames(folder)
    sequence = pykitti.odometry(str(folder / "kitti_odometry"), "00")
    need(5 <= len(sequence.poses) <= 6 and len(sequence.timestamps) == len(sequence.poses), "%d poses", len(sequence.poses))
    first = frames.optical[0]
    c = frames.camera
    close(sequence.calib.P_rect_20, [[c["fx"], 0, c["cx"], 0], [0, c["fy"], c["cy"], 0], [0, 0, 1, 0]], 1e-8, "P2")
    motion = np.loadtxt(folder / "pcd" / "top" / "motion.txt")
    scans = [line.split() for line in (folder / "pcd" / "top" / "stamps.txt").read_text(encoding="ascii").splitlines()]
    for i, pose in enumerate(sequence.poses):
        close(pose, np.linalg.inv(first) @ frames.optical[i], 1e-8, "pose %d", i)
        close(sequence.timestamps[i].total_seconds(), (frames.stamps[i] - frames.stamps[0]) * 1e-9, 1e-6, "time %d", i)
        need(np.array_equal(np.array(sequence.get_cam2(i)), frames.rgb(i)), "picture %d", i)
        grey = np.array(sequence.get_cam0(i)).astype(int)
        close(grey, (frames.rgb(i).astype(int) @ [299, 587, 114] + 500) // 1000, 0, "grey picture %d", i)
        velo = sequence.get_velo(i)
        still = (first @ pose @ sequence.calib.T_cam0_velo @ np.c_[velo[:, :3], np.ones(len(velo))].T)[:3].T
        content = (folder / "pcd" / "top" / scans[i][1]).read_bytes()
        kinds = [("x", "<f4"), ("y", "<f4"), ("z", "<f4"), ("intensity", "<f4"), ("ring", "<u2"), ("time", "<f4")]
        p = np.frombuffer(content[content.index(b"DATA binary\n") + 12:], kinds)
        at = float(scans[i][0]) + p["time"].astype(float)
        rows = motion[np.clip(np.searchsorted(motion[:, 0], at), 0, len(motion) - 1)]
        moving = np.array([rotation(r[7], r[4], r[5], r[6]) @ [q["x"], q["y"], q["z"]] + r[1:4] for r, q in zip(rows, p)])
        close(still, moving, 0.02, "scan %d", i)  # within the motion of a millisecond, far away
        close(velo[:, 3], p["intensity"] / 100, 1e-6, "intensity of scan %d", i)


def webdataset_decodes():
    import webdataset
    folder = DATA / "single"
    frames = Frames(folder)
    shards = sorted(str(path) for path in (folder / "webdataset").glob("*.tar"))
    count = 0
    for sample in webdataset.WebDataset(shards, shardshuffle=False).decode("rgb8"):
        i = int(sample["__key__"])
        need(np.array_equal(sample["rgb.png"], frames.rgb(i)), "picture %d", i)
        need(sample["depth.npy"].shape == (120, 160) and sample["normals.npy"].shape == (120, 160, 3), "shapes")
        need(sample["json"]["stamp_ns"] == frames.stamps[i], "stamp %d", i)
        close(sample["json"]["world_from_camera"]["position"], frames.bodies[i][:3, 3], 0, "pose %d", i)
        count += 1
    need(count == len(frames.stamps), "%d samples", count)


def lerobot_is_read_by_pyarrow():
    """Tables by pyarrow and pandas, videos by OpenCV; layout of codebase version 3.0."""
    import cv2
    import pandas
    import pyarrow.parquet as parquet
    for name in ("single", "robot"):
        root = DATA / name / "lerobot"
        frames = Frames(DATA / name)
        info = json.loads((root / "meta" / "info.json").read_text(encoding="ascii"))
        need(info["codebase_version"] == "v3.0" and info["fps"] == 10, "info.json")
        table = parquet.read_table(root / info["data_path"].format(chunk_index=0, file_index=0))
        need(set(table.column_names) == {n for n, f in info["features"].items() if f["dtype"] != "video"}, "columns")
        need(table.num_rows == info["total_frames"] == len(frames.stamps), "rows")
        state = np.array(table["observation.state"].to_pylist(), np.float32)
        need(state.shape == (len(frames.stamps), info["features"]["observation.state"]["shape"][0]), "states")
        need(np.array_equal(np.array(table["action"].to_pylist(), np.float32)[:-1], state[1:]), "actions")
        close(table["timestamp"].to_pylist(), [(s - frames.stamps[0]) * 1e-9 for s in frames.stamps], 1e-6, "times")
        need(table["index"].to_pylist() == list(range(len(frames.stamps))), "index")
        if name == "single":
            close(state[:, :3], [body[:3, 3] for body in frames.bodies], 1e-6, "positions of the rig")
        else:
            need(any(n.endswith(".position") for n in info["features"]["observation.state"]["names"]), "joints")
        tasks = pandas.read_parquet(root / "meta" / "tasks.parquet")
        need(list(tasks.index) == ["move through a collapsed structure"] and tasks["task_index"].iloc[0] == 0, "tasks")
        episode = parquet.read_table(root / "meta" / "episodes" / "chunk-000" / "file-000.parquet").to_pylist()[0]
        need(episode["length"] == episode["dataset_to_index"] == len(frames.stamps) and episode["tasks"] == list(tasks.index), "episode")
        stats = json.loads((root / "meta" / "stats.json").read_text(encoding="ascii"))
        close(stats["observation.state"]["mean"], state.mean(0), 1e-5, "mean of the states")
        key = "observation.images.camera"
        need(np.array(stats[key]["mean"]).shape == (3, 1, 1), "statistics of pictures")
        video = cv2.VideoCapture(str(root / info["video_path"].format(video_key=key, chunk_index=0, file_index=0)))
        need(video.get(cv2.CAP_PROP_FRAME_COUNT) == len(frames.stamps) and abs(video.get(cv2.CAP_PROP_FPS) - 10) < 1e-3, "video")
        for i in range(len(frames.stamps)):
            good, image = video.read()
            need(good, "picture %d of the video", i)
            close(video.get(cv2.CAP_PROP_POS_MSEC) / 1000, (frames.stamps[i] - frames.stamps[0]) * 1e-9, 1e-4, "time in the video")
            need(np.abs(image[:, :, ::-1].astype(int) - frames.rgb(i)).mean() < 4, "picture %d of the video", i)


def lerobot_has_episodes_of_environments():
    """Every row and picture of the rollouts, where they are there; what was drawn of each episode."""
    import cv2
    import pyarrow.parquet as parquet
    for name, lengths, rate in (("void", [7, 7, 7], 5), ("crawler", [5, 5], 10)):
        root = DATA / ("rollouts_" + name)
        if not root.exists():
            continue
        truth = np.load(str(root) + ".npz")
        info = json.loads((root / "meta" / "info.json").read_text(encoding="ascii"))
        need((info["total_episodes"], info["total_frames"], info["fps"]) == (len(lengths), sum(lengths), rate), "info.json")
        table = parquet.read_table(root / info["data_path"].format(chunk_index=0, file_index=0))
        need(set(table.column_names) == {n for n, f in info["features"].items() if f["dtype"] != "video"}, "columns")
        for column, key in (("observation.state", "state"), ("action", "action"), ("next.reward", "reward")):
            need(np.array_equal(np.array(table[column].to_pylist(), np.float32), truth[key].astype(np.float32)), "%s of %s", column, name)
            need(len(info["features"][column]["names"] or [0]) == np.ravel(truth[key][0]).size, "names of %s", column)
        need(table["frame_index"].to_pylist() == [i for length in lengths for i in range(length)], "frame_index")
        need(table["next.done"].to_pylist() == [i + 1 == length for length in lengths for i in range(length)], "next.done")
        close(table["timestamp"].to_pylist(), [i / rate for length in lengths for i in range(length)], 1e-6, "times")
        episodes = parquet.read_table(root / "meta" / "episodes" / "chunk-000" / "file-000.parquet").to_pylist()
        need([e["length"] for e in episodes] == lengths and episodes[-1]["dataset_to_index"] == sum(lengths), "episodes")
        about = [json.loads(e["info"]) for e in episodes]
        need([a["seed"] for a in about] == list(range(3, 3 + len(lengths))) and all(a["truncated"] for a in about), "seeds")
        if name == "crawler":
            continue
        need(len({a["reset"]["randomization"]["calibration.range_noise"] for a in about}) == 3, "what was drawn")
        key = "observation.images.depth"
        video = cv2.VideoCapture(str(root / info["video_path"].format(video_key=key, chunk_index=0, file_index=0)))
        for i, depth in enumerate(truth["depth"]):
            good, image = video.read()
            need(good, "picture %d", i)
            episode = episodes[i // 7]
            close(video.get(cv2.CAP_PROP_POS_MSEC) / 1000, episode["videos/" + key + "/from_timestamp"] + i % 7 / rate, 1e-4, "time %d", i)
            need(np.abs(image.astype(int) - depth).mean() < 4, "picture %d", i)
        need(not video.read()[0], "more pictures than rows")


def lerobot_doctor_finds_no_fault():
    """Layout, times, videos and features by a program for such datasets; it may say that episodes are short."""
    import subprocess
    program = Path(sys.executable).with_name("lerobot-doctor")
    for root in sorted([*DATA.glob("*/lerobot"), *(p for p in DATA.glob("rollouts_*") if p.is_dir())]):
        done = subprocess.run([program, "check", root, "--json"], capture_output=True, text=True, env=dict(os.environ, HF_HUB_OFFLINE="1"))
        report = json.loads(done.stdout)
        found = {check["name"]: check["severity"] for check in report["checks"]}
        need("FAIL" not in found.values() and len(found) > 9, "%s: %s", root, found)
        for name in ("Metadata & Format Compliance", "Temporal Consistency", "Video Integrity", "Feature Consistency", "Portability"):
            need(found[name] == "PASS", "%s: %s: %s", root, name, [c for c in report["checks"] if c["name"] == name])


def evo_agrees():
    """The numbers of `rubble eval trajectory` are evo's, of TUM and of KITTI files."""
    from evo.core import metrics
    from evo.tools import file_interface
    for name, read, truth in (("tum", file_interface.read_tum_trajectory_file, "groundtruth.txt"),
                              ("kitti", file_interface.read_kitti_poses_file, "kitti_odometry/poses/00.txt")):
        reference, estimate = read(str(DATA / "single" / truth)), read(str(DATA / ("estimate_" + name + ".txt")))
        estimate.align(reference)
        error = metrics.APE(metrics.PoseRelation.translation_part)
        error.process_data((reference, estimate))
        found = json.loads((DATA / ("score_" + name + ".json")).read_text(encoding="ascii"))
        for key, statistic in (("rmse", "rmse"), ("mean", "mean"), ("median", "median"), ("max", "max")):
            wanted = error.get_all_statistics()[statistic]
            need(wanted > 0.01, "the errors of %s are too small to compare", name)
            close(found["ate_" + key + "_se3_m"], wanted, 1e-6, "%s of %s", key, name)


def pandas_reads_the_table_of_pieces():
    """The table of `rubble pieces` as Parquet is that as CSV; there is a row for each piece that the legend names."""
    import pandas
    table, text = pandas.read_parquet(DATA / "pieces.parquet"), pandas.read_csv(DATA / "pieces.csv")
    need(list(table.columns) == list(text.columns) and len(table) == len(text), "columns and rows")
    for name in table.columns:
        need((table[name] == text[name]).all(), "column %s", name)
    legend = json.loads((DATA / "single" / "frames" / "legend.json").read_text(encoding="utf-8"))
    names = {entry["label"]: entry["name"] for entry in legend["labels"]}
    assets = {entry["instance"]: names[entry["label"]] for entry in legend["instances"]}
    for row in table.itertuples():
        need(assets[row.number] == row.asset, "piece %d is a %s", row.number, row.asset)
    need((table.mass_kg > 0).all(), "masses")


def bop_has_poses_of_objects():
    """Of every visible object: each pixel, by the depth image, lies on its model in its pose; masks are those of instances."""
    from PIL import Image
    root, frames = DATA / "bop", Frames(DATA / "single")
    scene, models = root / "test" / "000001", json.loads((root / "models" / "models_info.json").read_text(encoding="ascii"))
    cameras, truth, info = (json.loads((scene / f"scene_{name}.json").read_text(encoding="ascii")) for name in ("camera", "gt", "gt_info"))
    need(set(cameras) == set(truth) == {str(i) for i in range(len(frames.rows))}, "images %s", set(truth))
    objects = 0
    for key, entries in truth.items():
        camera, number = cameras[key], int(key)
        need(np.array_equal(np.array(Image.open(scene / "rgb" / f"{number:06d}.png")), frames.rgb(number)), "picture %d", number)
        pose = matrix(np.reshape(camera["cam_R_w2c"], (3, 3)), camera["cam_t_w2c"])
        close(np.linalg.inv(pose)[:3, :3], frames.optical[number][:3, :3], 1e-9, "camera %d", number)
        depth = np.array(Image.open(scene / "depth" / f"{number:06d}.png")) * camera["depth_scale"]
        fx, _, cx, _, fy, cy = camera["cam_K"][:6]
        for i, (entry, about) in enumerate(zip(entries, info[key])):
            mask = np.array(Image.open(scene / "mask_visib" / f"{number:06d}_{i:06d}.png")) > 0
            whole = np.array(Image.open(scene / "mask" / f"{number:06d}_{i:06d}.png")) > 0
            need((whole | ~mask).all() and (mask.sum(), whole.sum()) == (about["px_count_visib"], about["px_count_all"]), "masks %d %d", number, i)
            v, u = np.nonzero(mask & (depth > 0))
            z = depth[v, u]
            points = np.stack([(u - cx) * z / fx, (v - cy) * z / fy, z], axis=1) - entry["cam_t_m2c"]
            points = points @ np.reshape(entry["cam_R_m2c"], (3, 3))
            model = models[str(entry["obj_id"])]
            low = np.array([model["min_" + a] for a in "xyz"])
            high = low + [model["size_" + a] for a in "xyz"]
            need(((points > low - 1) & (points < high + 1)).all(), "pixels beside object %d in image %d", entry["obj_id"], number)
            need(model["diameter"] <= np.linalg.norm(high - low) + 1e-6 and model["diameter"] >= max(high - low) - 1e-6, "diameter %s", model)
            objects += 1
    need(objects > 20, "%d objects", objects)


def jsonschema_accepts_all_missions():
    """What `rubble check` prints of each script fits `rubble check --schema`; a mistake does not."""
    from jsonschema import Draft202012Validator
    schema = json.loads((DATA / "missions" / "schema.json").read_text(encoding="utf-8"))
    Draft202012Validator.check_schema(schema)
    validator, count = Draft202012Validator(schema), 0
    for path in sorted((DATA / "missions").glob("*.lua.json")):
        mission = json.loads(path.read_text(encoding="utf-8"))
        for error in validator.iter_errors(mission):
            need(False, "%s: %s: %s", path.name, error.json_path, error.message)
        count += 1
    need(count > 80, "%d missions", count)
    for key, value in (("seed", "one"), ("pile", {"layres": 2}), ("camera", {"width": -1})):
        need(not validator.is_valid({**mission, key: value}), "%s = %s is accepted", key, value)


CHECKS = [jsonschema_accepts_all_missions, bop_has_poses_of_objects, rosbags_reads_the_folder, robots_are_as_rep_105_says, mcap_has_one_schema_for_each_type, nerfstudio_projects_points,
          nerfstudio_has_all_cameras, pycolmap_reads_rigs, pycolmap_triangulates_with_rigs, pycocotools_finds_masks,
          pykitti_reads_odometry, webdataset_decodes, lerobot_is_read_by_pyarrow, lerobot_has_episodes_of_environments,
          lerobot_doctor_finds_no_fault, mcap_ros2_decodes_all_topics,
          rerun_converts_without_an_error, evo_agrees,
          pandas_reads_the_table_of_pieces]


def main():
    failed = 0
    for check in CHECKS:
        if len(sys.argv) > 2 and not any(word in check.__name__ for word in sys.argv[2:]):
            continue
        try:
            check()
            print("ok  ", check.__name__, flush=True)
        except Exception as error:  # one reader that fails does not hide the others
            failed += 1
            print("FAIL", check.__name__ + ":", type(error).__name__, error, flush=True)
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
