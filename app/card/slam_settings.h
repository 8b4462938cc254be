// Settings by which other programs run on a dataset: what a person would else copy out of the manifest.
#pragma once

#include <map>
#include <string>

#include "scripting/scenario/scenario.h"

namespace rubble {

// Name of a robot to that of its first link, which rides need not name.
using FirstLinks = std::map<std::string, std::string>;

// Name of a file, relative to the folder of settings, to its text:
//
//   orbslam3.yaml               ORB-SLAM3 1.0, RGB-D, stereo or with the inertial unit, as recorded
//   openvins/*.yaml             OpenVINS: estimator_config, kalibr_imu_chain, kalibr_imucam_chain
//   kalibr/camchain.yaml, imu.yaml
//   rtabmap.ini, camera.yaml    RTAB-Map's parameters; its and ROS's calibration
//   evo.json                    of evo_ape and evo_rpe: no alignment of scale, metres
//
// They are of the first camera that an inertial unit moves with; where none has one, of the first camera, without what needs a
// unit. Numbers are those that the frames were made with.
std::map<std::string, std::string> make_slam_settings(const Scenario& scenario, const FirstLinks& first_links = {});

}  // namespace rubble
