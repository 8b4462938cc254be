#!/usr/bin/env python3
"""The files of scripts/ros2 against a recording of its mission: ros2_examples.py PROGRAM FOLDER. Topics, frames and fields that
they name are there, and keys are those of the programs' own parameter files."""
import re
import subprocess
import sys
from pathlib import Path

import yaml

PROGRAM, FOLDER = sys.argv[1], Path(sys.argv[2])
EXAMPLES = Path(__file__).resolve().parents[2] / "scripts" / "ros2"
# Parameters that the programs read (LIO-SAM's branch ros2, FAST_LIO_ROS2).
LIO_SAM = """pointCloudTopic imuTopic odomTopic gpsTopic lidarFrame baselinkFrame odometryFrame mapFrame useImuHeadingInitialization
useGpsElevation gpsCovThreshold poseCovThreshold savePCD savePCDDirectory sensor N_SCAN Horizon_SCAN downsampleRate lidarMinRange
lidarMaxRange imuAccNoise imuGyrNoise imuAccBiasN imuGyrBiasN imuGravity imuRPYWeight extrinsicTrans extrinsicRot extrinsicRPY edgeThreshold
surfThreshold edgeFeatureMinValidNum surfFeatureMinValidNum odometrySurfLeafSize mappingCornerLeafSize mappingSurfLeafSize z_tollerance
rotation_tollerance numberOfCores mappingProcessInterval surroundingkeyframeAddingDistThreshold surroundingkeyframeAddingAngleThreshold
surroundingKeyframeDensity surroundingKeyframeSearchRadius loopClosureEnableFlag loopClosureFrequency surroundingKeyframeSize
historyKeyframeSearchRadius historyKeyframeSearchTimeDiff historyKeyframeSearchNum historyKeyframeFitnessScore
globalMapVisualizationSearchRadius globalMapVisualizationPoseDensity globalMapVisualizationLeafSize use_sim_time""".split()
FAST_LIO = {"": """use_sim_time feature_extract_enable point_filter_num max_iteration filter_size_surf filter_size_map cube_side_length
runtime_pos_log_enable map_file_path common preprocess mapping publish pcd_save""",
            "common": "lid_topic imu_topic time_sync_en time_offset_lidar_to_imu",
            "preprocess": "lidar_type scan_line scan_rate timestamp_unit blind",
            "mapping": "acc_cov gyr_cov b_acc_cov b_gyr_cov fov_degree det_range extrinsic_est_en extrinsic_T extrinsic_R",
            "publish": "path_en scan_publish_en dense_publish_en scan_bodyframe_pub_en", "pcd_save": "pcd_save_en interval"}


def need(condition, text, *values):
    if not condition:
        raise AssertionError(text % values if values else text)


def load(name):
    return yaml.safe_load((EXAMPLES / name).read_text(encoding="utf-8"))


def topics_of(driver):
    subprocess.run([PROGRAM, "run", EXAMPLES / "yard.lua", "--out", FOLDER / driver, "--force", "--quiet", "--set", "driver=" + driver, "--set",
                    "pieces=1", "--set", "robot_run.duration=0.2", "--set", "camera.width=32", "--set", "camera.height=24"], check=True)
    bag = yaml.safe_load((FOLDER / driver / "metadata.yaml").read_text(encoding="utf-8"))["rosbag2_bagfile_information"]
    return {entry["topic_metadata"]["name"]: entry["topic_metadata"]["type"] for entry in bag["topics_with_message_count"]}


def main():
    FOLDER.mkdir(parents=True, exist_ok=True)
    topics = {driver: topics_of(driver) for driver in ("velodyne", "livox")}
    topics["ouster"] = topics["velodyne"]
    need(topics["livox"]["/points"].endswith("CustomMsg") and topics["velodyne"]["/points"].endswith("PointCloud2"), "%s", topics)
    lio_sam = load("lio_sam.yaml")["/**"]["ros__parameters"]
    need(set(lio_sam) == set(LIO_SAM), "LIO-SAM: %s", set(lio_sam) ^ set(LIO_SAM))
    need({lio_sam["pointCloudTopic"], "/imu", "/ahrs"} <= set(topics["velodyne"]), "LIO-SAM's topics")
    for driver in topics:
        fast_lio = load(f"fast_lio_{driver}.yaml")["/**"]["ros__parameters"]
        for group, keys in FAST_LIO.items():
            found = set(fast_lio[group] if group else fast_lio)
            need(found == set(keys.split()), "FAST-LIO %s %s: %s", driver, group, found ^ set(keys.split()))
        need({fast_lio["common"]["lid_topic"], fast_lio["common"]["imu_topic"]} <= set(topics[driver]), "FAST-LIO's topics")
    nav2 = load("nav2.yaml")
    costmap = nav2["global_costmap"]["global_costmap"]["ros__parameters"]
    need({costmap["obstacle_layer"]["scan"]["topic"], nav2["bt_navigator"]["ros__parameters"]["odom_topic"]} <= set(topics["velodyne"]), "Nav2's topics")
    need(costmap["rolling_window"] and costmap["global_frame"] == "odom" and costmap["width"] == 30, "the global costmap")
    for script in ("rtabmap.launch.py", "imu_with_attitude.py"):
        text = (EXAMPLES / script).read_text(encoding="utf-8")
        compile(text, script, "exec")
        for topic in set(re.findall(r'"(/[a-z_/]+)"', text)) - {"/imu/data"}:
            need(topic in topics["velodyne"], "%s: %s", script, topic)


if __name__ == "__main__":
    main()
