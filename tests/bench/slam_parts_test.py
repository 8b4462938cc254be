#!/usr/bin/python3
"""The parts of bench/demonstration/slam that need neither the program, nor a SLAM system, nor an index of packages, against known
answers."""
import pathlib
import subprocess
import sys
import tempfile

import numpy as np

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent.parent.parent / "bench" / "demonstration"))
import carriers  # noqa: E402
import environments  # noqa: E402
import flights  # noqa: E402
import plan  # noqa: E402
import slam_figure  # noqa: E402
import slam_judges  # noqa: E402
import slam_plan  # noqa: E402
import slam_records  # noqa: E402
import slam_score  # noqa: E402
import slam_tables  # noqa: E402
import work  # noqa: E402

RATE, SPEED = 15.0, 0.8


def turn_about_z(angle):
    return np.array([[np.cos(angle), -np.sin(angle), 0], [np.sin(angle), np.cos(angle), 0], [0, 0, 1]])


def way(count=300):
    """A way with bends: stamps, true positions and matrices."""
    stamps = 1 + np.arange(count) / RATE
    heading = 0.8 * np.sin(0.4 * (stamps - 1))
    steps = SPEED / RATE * np.stack([np.cos(heading), np.sin(heading), 0.1 * np.cos(stamps)], 1)
    return stamps, np.cumsum(steps, 0), np.array([turn_about_z(h) @ carriers.BODY_FROM_OPTICAL for h in heading])


def seen_from_elsewhere(positions, rotations, scale=1.0):
    """The same way in another frame."""
    turn, shift = turn_about_z(1.1), np.array([3, -2, 0.5])
    return positions @ turn.T / scale + shift, np.array([turn @ r for r in rotations])


def check_measures():
    stamps, positions, rotations = way()
    truth, maps = (positions, rotations), np.zeros(len(stamps), int)
    for scale, scaled in ((1.0, False), (1.0, True), (2.5, True)):
        found = slam_score.measure((stamps, maps, *seen_from_elsewhere(positions, rotations, scale)), truth, scaled)
        assert all(found["followed"]) and max(found["error"]) < 1e-6, (scale, scaled)
    # A wrong scale is seen where the scale is not free.
    found = slam_score.measure((stamps, maps, *seen_from_elsewhere(positions, rotations, 2.5)), truth, False)
    assert np.mean(found["followed"]) < 0.2
    # Half the way is found to be half as long: followed till then, lost from there.
    wrong = positions.copy()
    wrong[150:] = wrong[150] + 0.5 * (positions[150:] - positions[150])
    found = slam_score.measure((stamps, maps, wrong, rotations), truth, False)
    assert all(found["followed"][:151]) and not any(found["followed"][165:])
    assert 150 < slam_score.first_lost(stamps, found["followed"]) < 160
    # A turn that is not noticed.
    blind = np.array([rotations[0]] * len(stamps))
    assert np.mean(slam_score.measure((stamps, maps, positions, blind), truth, False)["followed"]) < 0.9


def check_maps():
    """Two maps of different frames and a gap: each is aligned on its own, and the way is lost where the first ends."""
    stamps, positions, rotations = way()
    maps = np.zeros(len(stamps), int)
    maps[120:150], maps[150:] = -1, 1
    p, r = positions.copy(), rotations.copy()
    p[150:], r[150:] = seen_from_elsewhere(positions[150:], rotations[150:])
    estimate = stamps, maps, p, r
    measured = slam_score.measure(estimate, (positions, rotations), False)
    into = carriers.metres_into(positions, 6.0)
    found = slam_score.summary(estimate, measured, into)
    assert found["maps"] == 2 and found["pose_percent"] == 90 and found["followed_percent"] == 90 and found["on_track_percent"] == 90
    assert abs(found["lost_after_m"] - measured["way"][120]) < 1e-9 and found["lost_going"] == "in"
    assert abs(found["lost_into_m"] - into[120]) < 1e-9
    assert measured["error"][130] is None and not measured["followed"][130]
    # Nothing found at all, and a pause that is too short to count.
    estimate = stamps, maps * 0 - 1, p, r
    nothing = slam_score.summary(estimate, slam_score.measure(estimate, (positions, rotations), False), into)
    assert nothing["pose_percent"] == 0 and nothing["maps"] == 0 and nothing["lost_after_m"] is None
    assert slam_score.first_lost(stamps, [True] * 100 + [False] * 7 + [True] * 193) is None
    assert slam_score.first_lost(stamps, [False] * 50 + [True] * 50 + [False] * 200) == 100


def check_files():
    stamps, positions, rotations = way(60)
    with tempfile.TemporaryDirectory() as folder:
        folder = pathlib.Path(folder)
        rows = [[t, *p, *carriers.quaternion(r)] for t, p, r in zip(stamps, positions, rotations)]
        (folder / "true.txt").write_text("".join(" ".join("%.9f" % v for v in row) + "\n" for row in rows))
        # Poses of a LiDAR above the camera become those of the optical frame.
        offset = np.array([0.1, -0.02, 0.08])
        bodies = np.array([r @ carriers.BODY_FROM_OPTICAL.T for r in rotations])
        of_lidar = np.array([[t, *(p + b @ offset), *carriers.quaternion(b)] for t, p, b in zip(stamps, positions, bodies)])
        slam_judges.write_estimate(folder / "estimate.csv", slam_judges.optical_rows(of_lidar, offset))
        with open(folder / "estimate.csv", "a") as file:
            file.write("%.9f,,,,,,,,\n" % (stamps[-1] + 1))
        estimate = slam_score.read_estimate(folder / "estimate.csv")
        assert list(estimate[1]) == [0] * 60 + [-1]
        assert abs(estimate[2][:60] - positions).max() < 1e-8 and abs(estimate[3][:60] - rotations).max() < 1e-7
        between = stamps[:-1] + 0.5 / RATE
        p, r = slam_score.true_poses(folder / "true.txt", between)
        assert abs(p - (positions[1:] + positions[:-1]) / 2).max() < 1e-8
        assert abs(np.linalg.det(r) - 1).max() < 1e-9
    text = "APE w.r.t. translation part (m)\n(with SE(3) Umeyama alignment)\n\n       max\t0.2\n      rmse\t0.054321\n       std\t0.1\n"
    assert slam_judges.read_ape(text) == 0.054321
    try:
        slam_judges.read_ape("no such file")
        raise AssertionError("an error of evo was read as a result")
    except SystemExit:
        pass


def check_plan_and_table():
    flights = {row.name for row in plan.ROWS}
    for kind in slam_plan.KINDS.values():
        assert set(kind.flights) <= flights and set(kind.flights) <= set(slam_tables.TITLES) and kind.recording.heavy
    assert len({j.name for j in slam_plan.JUDGES}) == len(slam_plan.JUDGES)
    order = slam_plan.order([1, 2], [], [])
    assert [seed for seed, *_ in order] == sorted(seed for seed, *_ in order)
    assert {j.name for _, _, _, judges in order for j in judges} == {j.name for j in slam_plan.JUDGES}
    assert slam_plan.order([1], ["smoke"], ["kiss_icp"])[0][3][0].name == "kiss_icp"
    assert not slam_plan.order([1], ["smoke"], ["orbslam3_rgbd"])
    base = {"frames": 100, "maps": 1, "on_track_percent": 50.0, "followed_percent": 60.0, "ate_rmse_m": 0.1, "note": ""}
    runs = [dict(base, pose_percent=p, lost_after_m=a, lost_into_m=i, lost_going=g)
            for p, a, i, g in ((70, 6.0, 4.0, "in"), (80, 8.0, 6.0, "in"), (90, 14.0, 5.0, "out"), (100, None, None, None))]
    cells = slam_tables.cells({(1 + n // 2, n % 2): {"summary": s} for n, s in enumerate(runs)})
    assert cells == ["1, 2", "4", "100", "85 (70 to 100)", "60", "50", "1.0", "0.10", "3 of 4",
                     "5.0 (4.0 to 6.0), way in (2); 5.0, way out (1)"], cells


def check_figure():
    """A flight of which the way in was followed and the way out was not: the second half is mirrored behind the deepest place."""
    into = [-0.5, 0.5, 1.5, 2.5, 1.4, 0.4, -0.6]
    places, shares = slam_figure.binned(*slam_figure.joined([(into, [1, 1, 1, 1, 0, 0, 0])]), 3.0)
    assert places == [-0.5, 0.5, 1.5, 2.5, 4.5, 5.5, 6.5] and shares == [100] * 4 + [0] * 3, (places, shares)


def check_records():
    """A record is found again until anything that it depends on is another, and has what the table and the figure show."""
    row, judge = plan.ROWS[1], slam_plan.JUDGES[0]
    with tempfile.TemporaryDirectory() as folder:
        path = pathlib.Path(folder) / "records.jsonl"
        kept, made = slam_records.SlamRecords(path), work.Work(folder, __file__, 1)
        judging, flown = slam_judges.SlamJudges(made), flights.Flights(made, slam_plan.KINDS[judge.kind].recording)
        depends = kept.depends(judging, flown, row, judge, 0)
        result = {"summary": {"frames": 4}, "frames": {"into": [-0.5, 0.2, 0.7, 1.5], "followed": [True, True, False, True]}}
        kept.add(row, judge, 2, 0, depends, "0123456789ab", result)
        kept.add(row, judge, 2, 1, depends, "0123456789ab", {"summary": {}, "frames": {"into": None, "followed": [True, False]}})
        again = slam_records.SlamRecords(path)
        found = again.find(row, judge, 2, 0, depends)
        assert found["summary"]["frames"] == 4 and found["commit"] == "0123456789ab"
        assert slam_figure.records.shares(found["bins"], slam_records.WIDTH, 2) == [[-0.5, 0.5, 0.5, 1.5], [1, 0.5, 0.5, 1]]
        assert again.find(row, judge, 2, 1, depends)["bins"] == [[None, 2, 1]] and again.find(row, judge, 1, 0, depends) is None
        others = [(row, slam_plan.JUDGES[1], 0), (plan.ROWS[2], judge, 0), (row, judge, 1)]
        assert all(again.depends(judging, flown, r, j, n) != depends for r, j, n in others)
        again.golden = "another"
        assert again.find(row, judge, 2, 0, again.depends(judging, flown, row, judge, 0)) is None


def check_no_index():
    """Where no package can be had the command says so, and does not leave half an environment."""
    with tempfile.TemporaryDirectory() as folder:
        folder = pathlib.Path(folder)
        (folder / "list.txt").write_text("no-such-package==1.0 --hash=sha256:%s\n" % ("0" * 64))
        real, calls = subprocess.run, []

        def fails(command, **options):
            calls.append(command)
            return subprocess.CompletedProcess(command, 1 if "pip" in command else 0, stderr="no index")

        environments.subprocess.run = fails
        try:
            environments.environment(folder / "made", folder / "list.txt")
            raise AssertionError("an environment without its packages was taken")
        except environments.NoIndex as reason:
            assert "no index" in str(reason)
        finally:
            environments.subprocess.run = real
        assert "--require-hashes" in calls[-1] and not (folder / "made").exists()
    for name in ("requirements.txt", "requirements-slam.txt"):
        lines = [line for line in (slam_judges.HERE / name).read_text().splitlines() if not line.startswith("#")]
        assert lines and all("==" in line and " --hash=sha256:" in line for line in lines)


if __name__ == "__main__":
    check_measures()
    check_maps()
    check_files()
    check_plan_and_table()
    check_figure()
    check_records()
    check_no_index()
