#!/usr/bin/env python3
"""Reads the settings of `rubble pack` by readers of others and compares them with the scenario.

usage: settings_reader.py FOLDER SCENARIO.json      # prints each difference; exit code 1 if there is one
"""
import configparser
import json
import sys

import yaml

wrong = []


def expect(name, found, wanted):
    same = abs(found - wanted) < 1e-9 if isinstance(wanted, float) else found == wanted
    if not same:
        wrong.append(f"{name}: {found!r} instead of {wanted!r}")


def read(path, opencv=False):
    with open(path, encoding="utf-8") as file:
        text = file.read()
    if text.startswith("%YAML:1.0"):  # OpenCV's head is none of YAML's
        text = text.split("\n", 1)[1]
    elif opencv:
        wrong.append(f"{path}: OpenCV's reader wants %YAML:1.0 first")
    return yaml.load(text.replace("!!opencv-matrix", ""), Loader=yaml.SafeLoader)


def main():
    folder, scenario = sys.argv[1], json.load(open(sys.argv[2], encoding="utf-8"))
    camera, imu = scenario["camera"], scenario["imu"]
    width, height, rate = camera["width"], camera["height"], scenario["trajectory"]["rate_hz"]
    f = width / 2.0  # 90 degrees
    c = [(width - 1) / 2.0, (height - 1) / 2.0]

    orb = read(folder + "/orbslam3.yaml", True)
    expect("version", orb["File.version"], "1.0")
    expect("type", orb["Camera.type"], "PinHole")
    for key, wanted in [("Camera1.fx", f), ("Camera1.fy", f), ("Camera1.cx", c[0]), ("Camera1.cy", c[1]),
                        ("Camera2.fx", f), ("Camera.width", width), ("Camera.height", height),
                        ("Camera.fps", int(rate)), ("RGBD.DepthMapFactor", 5000.0),
                        ("Stereo.b", camera["stereo_baseline"]),
                        ("IMU.NoiseGyro", imu["gyroscope_noise"]), ("IMU.AccWalk", imu["accelerometer_walk"]),
                        ("IMU.Frequency", float(imu["rate_hz"])), ("ORBextractor.nLevels", 8)]:
        expect("orbslam3 " + key, orb[key], wanted)
        if isinstance(wanted, float) and not isinstance(orb[key], float):
            wrong.append(f"orbslam3 {key} must be written as a real number")
    # The columns of body_from_camera: right, down and forward of the camera in the body.
    expect("T_b_c1", orb["IMU.T_b_c1"]["data"], [0, 0, 1, 0, -1, 0, 0, 0, 0, -1, 0, 0, 0, 0, 0, 1])
    expect("T_c1_c2", orb["Stereo.T_c1_c2"]["data"][3], camera["stereo_baseline"])

    for path in ("kalibr/camchain.yaml", "openvins/kalibr_imucam_chain.yaml"):
        chain = read(folder + "/" + path, "openvins" in path)
        expect(path, sorted(chain), ["cam0", "cam1"])
        cam0 = chain["cam0"]
        expect(path + " model", (cam0["camera_model"], cam0["distortion_model"]), ("pinhole", "radtan"))
        expect(path + " intrinsics", cam0["intrinsics"], [f, f, *c])
        expect(path + " coefficients", len(cam0["distortion_coeffs"]), 4)
        expect(path + " resolution", cam0["resolution"], [width, height])
        expect(path + " topic", cam0["rostopic"], "/camera/rgb/image_raw")
        # What lies ahead of the body lies along Z of the optical frame; its left along -X.
        columns = list(zip(*[row[:3] for row in cam0["T_cam_imu"]]))
        expect(path + " T_cam_imu", columns[:3], [(0, 0, 1, 0), (-1, 0, 0, 0), (0, -1, 0, 0)])
        expect(path + " T_cn_cnm1", chain["cam1"]["T_cn_cnm1"][0][3], -camera["stereo_baseline"])

    for path, unit in [("kalibr/imu.yaml", read(folder + "/kalibr/imu.yaml")),
                       ("openvins", read(folder + "/openvins/kalibr_imu_chain.yaml", True)["imu0"])]:
        expect(path, unit["gyroscope_noise_density"], imu["gyroscope_noise"])
        expect(path, unit["gyroscope_random_walk"], imu["gyroscope_walk"])
        expect(path, unit["accelerometer_noise_density"], imu["accelerometer_noise"])
        expect(path, unit["accelerometer_random_walk"], imu["accelerometer_walk"])
        expect(path, (unit["rostopic"], unit["update_rate"]), ("/imu", float(imu["rate_hz"])))
    estimator = read(folder + "/openvins/estimator_config.yaml", True)
    expect("estimator", estimator["relative_config_imucam"], "kalibr_imucam_chain.yaml")
    expect("estimator", (estimator["max_cameras"], estimator["use_stereo"]), (2, True))
    expect("estimator", estimator["gravity_mag"], float(scenario["settle"]["gravity"]))

    info = read(folder + "/camera.yaml", True)
    expect("camera.yaml", (info["image_width"], info["image_height"]), (width, height))
    expect("camera.yaml", info["camera_matrix"]["data"], [f, 0, c[0], 0, f, c[1], 0, 0, 1])
    expect("camera.yaml", len(info["projection_matrix"]["data"]), 12)
    ini = configparser.ConfigParser()
    ini.optionxform = str
    ini.read(folder + "/rtabmap.ini")
    expect("rtabmap", ini["Core"]["RGBD\\Enabled"], "true")
    evo = json.load(open(folder + "/evo.json", encoding="utf-8"))
    expect("evo", (evo["correct_scale"], evo["pose_relation"]), (False, "trans_part"))
    print("\n".join(wrong))
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main())
