// Datasets for odometry, radiance fields and learning. Each is a folder, complete in itself.
//
// kitti_odometry/   KITTI odometry, as pykitti and ORB-SLAM's stereo_kitti read it
//   sequences/00/image_0, image_1    grey left and right; image_1 and image_3 only of a stereo camera
//   sequences/00/image_2, image_3    colour left and right, 000000.png and so on
//   sequences/00/velodyne            scans of the first LiDAR that is not planar, free of its own motion: each point is
//                                    where it would be at the stamp of the picture; x y z intensity / 100, float32
//   sequences/00/calib.txt           P0 to P3, and Tr from the LiDAR to the left camera; without a LiDAR from its body
//   sequences/00/times.txt           seconds since the first picture
//   poses/00.txt                     3x4: the left optical frame in that of the first picture
// A picture that no scan covers, at the end of a recording, is left out.
//
// nerfstudio/       transforms.json of nerfstudio, which gsplat, splatfacto and instant-ngp read as well
//   transforms.json                  camera-to-world in OpenGL's axes (X right, Y up, Z backwards); of all cameras
//   images, depths                   PNG, NAME_000000.png of several cameras; depth in millimetres, 0: none
//   sparse_pc.ply                    points of the true surfaces with their colours, one for each 5 cm voxel
// Depth is that of the depth sensor, where there is one. Only the left pictures of stereo cameras are in it, because the
// format wants depth for all pictures or for none.
//
// coco/             COCO, as pycocotools reads it; of one camera, which needs the stream `instance`
//   images/000000.png
//   annotations.json                 one annotation for each piece in each picture: category (its label), box, area, mask
//                                    (compressed run lengths), and `instance`, its number; victims have their own
//                                    supercategory. The visible parts alone; the ground and the sky have no annotation
//
// webdataset/       WebDataset: tar files of at most 128 MB, or one frame; of one camera
//   rubble-000000.tar                for each frame KEY.rgb.png, right.png, depth.npy (float32, m, NaN: none),
//                                    depth_true.npy, a .npy of each stream of ground truth, and KEY.json: stamp, pose,
//                                    intrinsics. Arrays are rows x columns (x values)
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "io/base/ordered_tasks.h"
#include "io/recording/recorder.h"
#include "io/recording/recording.h"

namespace rubble {

// Each throws RunError when `path` cannot be created.
std::unique_ptr<Recorder> make_kitti_odometry_recorder(const std::string& path, const Recording& recording = {},
                                                       int threads = recording_threads());
// The direction that a pixel looks in, in the optical frame; nothing where its lens sees nothing.
using PixelRay = std::function<std::optional<Vec3>(double u, double v)>;
// rays: of each camera, for the points of its depth; empty: of pinholes.
std::unique_ptr<Recorder> make_nerfstudio_recorder(const std::string& path, const Recording& recording = {},
                                                   std::vector<PixelRay> rays = {}, int threads = recording_threads());
std::unique_ptr<Recorder> make_coco_recorder(const std::string& path, const Recording& recording = {},
                                             int threads = recording_threads());
std::unique_ptr<Recorder> make_webdataset_recorder(const std::string& path, const Recording& recording = {},
                                                   int threads = recording_threads());

}  // namespace rubble
