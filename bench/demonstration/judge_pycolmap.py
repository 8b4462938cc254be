"""As the commands of COLMAP, by pycolmap 4.x. CAMERA: fx,fy,cx,cy, or empty.
usage: judge_pycolmap.py match IMAGES OUT CAMERA: writes OUT/database.db
       judge_pycolmap.py incremental|global IMAGES OUT CAMERA: from OUT/database.db to OUT/sparse/N"""
import pathlib
import sys

import pycolmap


def match(database, images, camera):
    reader = pycolmap.ImageReaderOptions()
    if camera:
        reader.camera_model, reader.camera_params = "PINHOLE", camera
    cpu = pycolmap.Device.cpu
    pycolmap.extract_features(database, images, camera_mode=pycolmap.CameraMode.SINGLE, reader_options=reader, device=cpu)
    pycolmap.match_sequential(database, device=cpu)


def reconstruct(mapper, database, images, sparse, camera):
    if mapper == "incremental":
        options = pycolmap.IncrementalPipelineOptions()
        options.ba_refine_focal_length = options.ba_refine_extra_params = not camera
        return pycolmap.incremental_mapping(database, images, sparse, options)
    options = pycolmap.GlobalPipelineOptions()
    bundle = options.mapper.bundle_adjustment
    bundle.refine_focal_length = bundle.refine_extra_params = not camera
    return pycolmap.global_mapping(database, images, sparse, options)


def main():
    task, images, out, camera = sys.argv[1:]
    out = pathlib.Path(out)
    if task == "match":
        match(out / "database.db", images, camera)
    else:
        (out / "sparse").mkdir()
        print(len(reconstruct(task, out / "database.db", images, out / "sparse", camera)), "models")


if __name__ == "__main__":
    main()
