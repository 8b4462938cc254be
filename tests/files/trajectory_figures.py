"""What evo says of an estimate and its truth: pairs, length, absolute and relative errors."""
import copy
from pathlib import Path

from evo.core import metrics, sync
from evo.tools import file_interface

MOST_DIFFERENCE = 0.01  # of the stamps of a pair; unit: s


def read(path):
    """TUM, or EuRoC's CSV by its name."""
    if Path(path).suffix == ".csv":
        return file_interface.read_euroc_csv_trajectory(str(path))
    return file_interface.read_tum_trajectory_file(str(path))


def find_pairs(folder):
    """Estimates with the truth that lies beside them: by names of rpg_trajectory_evaluation, of evo's tests and
    of OpenVINS, which has each truth as EuRoC's CSV and as text."""
    pairs = [(text, text.with_suffix(".csv")) for text in sorted(folder.rglob("ov_data/**/*.txt"))
             if text.with_suffix(".csv").is_file()]
    for truth in sorted(folder.rglob("*roundtruth*")):
        if truth.suffix not in (".txt", ".csv") or not truth.is_file():
            continue
        stem = truth.name.split("groundtruth")[0].rstrip("-_")
        for estimate in sorted(truth.parent.iterdir()):
            if estimate.suffix not in (".txt", ".csv") or "groundtruth" in estimate.name:
                continue
            if estimate.name.startswith("stamped_traj_estimate" if stem == "stamped" else stem or "none"):
                pairs.append((estimate, truth))
    return pairs


def trajectory_figures(pair):
    estimate, truth = read(pair[0]), read(pair[1])
    figures = {"poses": estimate.num_poses, "length_m": float(f"{estimate.path_length:.9g}")}
    truth, estimate = sync.associate_trajectories(truth, estimate, max_diff=MOST_DIFFERENCE)
    figures["pairs"] = estimate.num_poses
    if estimate.num_poses < 3:
        raise ValueError("fewer than 3 pairs")

    def error(metric, of):
        metric.process_data((truth, of))
        return float(f"{metric.get_statistic(metrics.StatisticsType.rmse):.9g}")

    for name, scale in (("se3", False), ("sim3", True)):
        aligned = copy.deepcopy(estimate)
        aligned.align(truth, correct_scale=scale)
        figures[f"ate_rmse_{name}_m"] = error(metrics.APE(metrics.PoseRelation.translation_part), aligned)
    for name, relation in (("rpe_trans_rmse_m", metrics.PoseRelation.translation_part),
                           ("rpe_rot_rmse_deg", metrics.PoseRelation.rotation_angle_deg)):
        figures[name] = error(metrics.RPE(relation, delta=1, delta_unit=metrics.Unit.frames, all_pairs=False), estimate)
    return figures
