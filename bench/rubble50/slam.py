"""RGB-D odometry from a recorded ROS bag by programs that nobody here wrote, fed as by a robot: OpenCV's rgbd module
(contrib) and Open3D. An odometry that fails keeps its last motion. (OpenCV's KinFu is there, but Debian leaves it out as
patented.)
"""
import os

import cv2
import numpy as np

os.environ.setdefault("OMP_WAIT_POLICY", "passive")  # threads that spin cost tenfold on a busy machine
import open3d as o3d  # noqa: E402

NEAR, FAR = 0.2, 8.0  # of the depth that is used; unit: m
BODY_FROM_OPTICAL = np.eye(4)  # the bag's poses are of the camera body (REP 103)
BODY_FROM_OPTICAL[:3, :3] = [[0, 0, 1], [-1, 0, 0], [0, -1, 0]]


def read(bag):
    """(stamp, grey, colour, depth in metres with NaN for none) of each frame, K, and the true poses."""
    depth_topic, rgb_topic = "/camera/depth_registered/image_raw", "/camera/rgb/image_raw"
    k, truth, frames, pending = None, {}, [], {}
    topics = [depth_topic, rgb_topic, "/camera/rgb/camera_info", "/ground_truth/pose"]
    for topic, message, _ in bag.read_messages(topics=topics):
        stamp = message.header.stamp.to_nsec()
        if topic == topics[2]:
            k = np.array(message.K if hasattr(message, "K") else message.k).reshape(3, 3)
        elif topic == topics[3]:
            truth[stamp] = pose_matrix(message.pose)
        else:
            pending.setdefault(stamp, {})[topic] = message
            if len(pending[stamp]) == 2:
                both = pending.pop(stamp)
                frames.append((stamp, colour_of(both[rgb_topic]), depth_of(both[depth_topic])))
    return frames, k, truth


def colour_of(message):
    return np.frombuffer(message.data, np.uint8).reshape(message.height, message.width, 3)


def depth_of(message):
    millimetres = np.frombuffer(message.data, "<u2").reshape(message.height, message.width)
    depth = millimetres.astype(np.float32) / 1000
    depth[(depth < NEAR) | (depth > FAR)] = np.nan
    return depth


def rotation_matrix(x, y, z, w):
    return np.array([[1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)],
                     [2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)],
                     [2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)]])


def pose_matrix(pose):
    """world_from_optical"""
    m = np.eye(4)
    q, p = pose.orientation, pose.position
    m[:3, :3] = rotation_matrix(q.x, q.y, q.z, q.w)
    m[:3, 3] = p.x, p.y, p.z
    return m @ BODY_FROM_OPTICAL


def quaternion(r):
    """x y z w of a rotation matrix."""
    vector, _ = cv2.Rodrigues(r)
    angle = float(np.linalg.norm(vector))
    axis = vector.ravel() / angle if angle > 0 else np.zeros(3)
    return [*(np.sin(angle / 2) * axis), np.cos(angle / 2)]


def make_odometry(method, k):
    make = {"rgbd": cv2.rgbd.RgbdOdometry_create, "rgbd_icp": cv2.rgbd.RgbdICPOdometry_create,
            "icp": cv2.rgbd.ICPOdometry_create}[method]
    odometry = make()
    odometry.setCameraMatrix(k)
    return odometry


def run_odometry(method, frames, k, start):
    odometry = make_odometry(method, k)
    poses, lost, motion = [start], 0, np.eye(4)
    previous = None
    for _, rgb, depth in frames:
        grey = cv2.cvtColor(rgb, cv2.COLOR_RGB2GRAY)
        mask = np.where(np.isfinite(depth), 255, 0).astype(np.uint8)
        now = cv2.rgbd.OdometryFrame_create(grey, depth, mask)
        if previous is not None:
            found, transform = odometry.compute2(previous, now)
            if found:
                motion = np.linalg.inv(transform)
            else:
                lost += 1
            poses.append(poses[-1] @ motion)
        previous = now
    return poses, lost


def camera_of(frames, k):
    rows, columns = frames[0][2].shape
    return o3d.camera.PinholeCameraIntrinsic(columns, rows, k[0, 0], k[1, 1], k[0, 2], k[1, 2])


def run_open3d(frames, k, start):
    camera = camera_of(frames, k)
    images = [o3d.geometry.RGBDImage.create_from_color_and_depth(
        o3d.geometry.Image(np.ascontiguousarray(rgb)), o3d.geometry.Image(np.nan_to_num(depth)),
        depth_scale=1.0, depth_trunc=FAR) for _, rgb, depth in frames]
    poses, lost, motion = [start], 0, np.eye(4)
    method = o3d.pipelines.odometry.RGBDOdometryJacobianFromHybridTerm()
    option = o3d.pipelines.odometry.OdometryOption(depth_min=NEAR, depth_max=FAR)
    for previous, now in zip(images, images[1:]):
        found, transform, _ = o3d.pipelines.odometry.compute_rgbd_odometry(
            previous, now, camera, np.eye(4), method, option)
        if found:
            motion = np.linalg.inv(transform)
        else:
            lost += 1
        poses.append(poses[-1] @ motion)
    return poses, lost


def tum_lines(frames, poses):
    """The trajectory as TUM writes it."""
    return "".join("%d.%09d %s\n" % (stamp // 10**9, stamp % 10**9, " ".join(
        "%.9g" % v for v in [*pose[:3, 3], *quaternion(pose[:3, :3])]))
        for (stamp, _, _), pose in zip(frames, poses))
