"""usage: judge_pycolmap.py IMAGES OUT incremental|global CAMERA: as the commands of COLMAP, by pycolmap 4.x.
CAMERA: fx,fy,cx,cy, or empty. Writes OUT/database.db and OUT/sparse/N."""
import pathlib
import sys

import pycolmap


def main():
    images, out, mapper, camera = sys.argv[1:]
    out = pathlib.Path(out)
    sparse = out / "sparse"
    sparse.mkdir()
    reader = pycolmap.ImageReaderOptions()
    if camera:
        reader.camera_model, reader.camera_params = "PINHOLE", camera
    cpu = pycolmap.Device.cpu
    pycolmap.extract_features(out / "database.db", images, camera_mode=pycolmap.CameraMode.SINGLE, reader_options=reader, device=cpu)
    pycolmap.match_sequential(out / "database.db", device=cpu)
    if mapper == "incremental":
        options = pycolmap.IncrementalPipelineOptions()
        options.ba_refine_focal_length = options.ba_refine_extra_params = not camera
        models = pycolmap.incremental_mapping(out / "database.db", images, sparse, options)
    else:
        options = pycolmap.GlobalPipelineOptions()
        bundle = options.mapper.bundle_adjustment
        bundle.refine_focal_length = bundle.refine_extra_params = not camera
        models = pycolmap.global_mapping(out / "database.db", images, sparse, options)
    print(len(models), "models")


if __name__ == "__main__":
    main()
