"""The maps that docs/explanation/map_score.md compares."""

# Name, title, and where it lies below the folder of a seed.
MAPS = [
    ("tsdf", "true depth and poses fused to a mesh (Open3D, voxels of 2 cm)", "meshes/fused_tsdf.ply"),
    ("points", "true depth and poses fused to points", "meshes/fused_points.ply"),
    ("mrpt", "key frames at true poses, MRPT's `observations2map`", "meshes/mrpt_points.ply"),
    ("rgbd", "OpenCV's `RgbdOdometry`, fused to a mesh", "slam_lit/slam/rgbd.ply"),
    ("mrpt_icp", "MRPT's `icp-slam`, fused to a mesh", "slam_lit/slam/mrpt_icp.ply"),
    ("full", "COLMAP's sparse points, 157 frames of 1024x1024", "full/lit/sfm/details/*_points.ply"),
    ("clahe", "COLMAP's sparse points, 53 frames of 640x640, CLAHE on the pictures",
     "quick/lit/sfm_clahe/details/*_points.ply"),
    ("sparse", "COLMAP's sparse points, 53 frames of 640x640", "quick/lit/sfm/details/*_points.ply"),
]
PICTURE = "clahe"
