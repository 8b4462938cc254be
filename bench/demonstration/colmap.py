"""COLMAP 3.8 of Debian at its defaults, on the processor: pictures in a row to FOLDER/database.db and FOLDER/sparse/N."""
import work

NO_MODEL = "failed to create sparse model"


def reconstruct(folder, images, camera, log, nice=0):
    """camera: the true fx,fy,cx,cy, which stay; "": COLMAP guesses and refines its own model. To find no model is a result."""
    database, sparse = folder / "database.db", folder / "sparse"
    sparse.mkdir()
    model = ["--ImageReader.camera_model", "PINHOLE", "--ImageReader.camera_params", camera] if camera else []
    fixed = ["--Mapper.ba_refine_focal_length", 0, "--Mapper.ba_refine_extra_params", 0] if camera else []
    work.run(["colmap", "feature_extractor", "--database_path", database, "--image_path", images, "--ImageReader.single_camera", 1,
              "--SiftExtraction.use_gpu", 0, *model], log, nice)
    work.run(["colmap", "sequential_matcher", "--database_path", database, "--SiftMatching.use_gpu", 0], log, nice)
    code = work.run(["colmap", "mapper", "--database_path", database, "--image_path", images, "--output_path", sparse, *fixed], log,
                    nice, allowed=(0, 1))
    if code and NO_MODEL not in log.read_text(errors="replace"):
        raise SystemExit("the mapper of COLMAP failed: %s" % log)
