#!/usr/bin/python3
"""The parts of bench/demonstration that need neither the program nor COLMAP, against known answers."""
import os
import pathlib
import subprocess
import sys
import tempfile
import threading

import numpy as np

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent.parent.parent / "bench" / "demonstration"))
import carriers  # noqa: E402
import flights  # noqa: E402
import matches  # noqa: E402
import plan  # noqa: E402
import records  # noqa: E402
import work  # noqa: E402

K = np.array([[500, 0, 320], [0, 500, 240], [0, 0, 1.0]])


def seen(points, pose):
    r, t = pose
    p = (points @ r.T + t) @ K.T
    return p[:, :2] / p[:, 2:]


def check_true_matches():
    """Of points seen from two places all agree with the true motion, few with another, and none that were mixed up."""
    random = np.random.default_rng(1)
    points = random.uniform([-2, -1.5, 3], [2, 1.5, 8], (400, 3))
    angle = 0.1
    turn = np.array([[np.cos(angle), 0, np.sin(angle)], [0, 1, 0], [-np.sin(angle), 0, np.cos(angle)]])
    first, second, other = (np.eye(3), np.zeros(3)), (turn, np.array([0.3, 0.05, 0.1])), (turn.T, np.array([0.3, 0.05, 0.1]))
    a, b = seen(points, first), seen(points, second)
    assert matches.agree(a, b, first, second, K) == 400
    assert matches.agree(a, b + [0, 1.0], first, second, K) > 390  # within two pixels of its line
    assert matches.agree(a, b, first, other, K) < 40
    assert matches.agree(a, b[random.permutation(400)], first, second, K) < 40


def check_carriers():
    random = np.random.default_rng(2)
    for q in random.normal(size=(50, 4)):
        q /= np.linalg.norm(q)
        back = carriers.quaternion(carriers.matrix(q))
        assert min(abs(back - q).max(), abs(back + q).max()) < 1e-9
    with tempfile.TemporaryDirectory() as folder:
        planned = pathlib.Path(folder)
        (planned / "flight.json").write_text('{"voids": [{}, {"way_in_m": 4.0}]}')
        times = np.arange(0, 20.001, 0.05)  # 10 m in and 10 m out at 1 m/s: 6 m before the void
        (planned / "groundtruth.txt").write_text("".join("%.2f %.3f 0 1 0 0 0 1\n" % (t, 10 - abs(10 - t)) for t in times))
        still, held = (np.array([line.split() for line in carriers.move(None, planned, who).splitlines()], float)
                       for who in ("spline", "hand_held"))
    assert abs(still[0, 0]) < 1e-9 and abs(still[-1, 0] - 12) < 0.1  # from two metres before the void
    assert abs(still[0, 1] - 4) < 0.05 and abs(still[:, 1].max() - 10) < 0.05 and np.allclose(abs(still[:, 7]), 1)
    into = carriers.metres_into(still[:, 1:4], 4.0)
    assert abs(into[0] + 2) < 0.05 and abs(into.max() - 4) < 0.05 and abs(into[-1] + 2) < 0.05
    apart = np.linalg.norm(held[:, 1:4] - still[:, 1:4], axis=1)
    assert 0.01 < apart.mean() < 0.06 and apart.max() < 0.1, apart.max()
    step = np.linalg.norm(np.diff(held[:, 1:4], axis=0), axis=1)
    assert step.max() < 0.03  # it does not jump


def check_stages():
    with tempfile.TemporaryDirectory() as folder:
        made = []
        jobs = work.Work(folder, __file__, hours=1)
        first = jobs.stage("x", {"a": 1}, made.append, "one")
        assert jobs.stage("x", {"a": 1}, made.append, "one") == first and len(made) == 1
        assert jobs.stage("x", {"a": 2}, made.append, "two") != first and len(made) == 2
        late = work.Work(folder, __file__, hours=-1)
        assert late.stage("x", {"a": 1}, made.append, "one") == first  # what is there is there
        try:
            late.stage("x", {"a": 3}, made.append, "three")
            raise AssertionError("a stage began after the time")
        except work.OutOfTime:
            assert len(made) == 2


def check_commands_at_once():
    """Two commands make a stage once, keep each other's records, and leave nothing that runs on when they are ended."""
    with tempfile.TemporaryDirectory() as folder:
        jobs, made, within = work.Work(folder, __file__, hours=1), [], threading.Event()

        def make(place):
            made.append(place)
            within.set()
            with work.locked(pathlib.Path(folder) / "go"):
                pass

        with work.locked(pathlib.Path(folder) / "go"):
            both = [threading.Thread(target=jobs.stage, args=("x", {"a": 1}, make, "one")) for _ in range(2)]
            for one in both:
                one.start()
            within.wait()
        for one in both:
            one.join()
        assert len(made) == 1
        path = pathlib.Path(folder) / "records.jsonl"
        first, second = records.Records(path), records.Records(path)
        first.add(["a"], first.depends(1), "0123456789ab", {"score": 1})
        second.add(["b"], second.depends(2), "0123456789ab", {"score": 2})
        assert set(records.Records(path).kept) == {("a",), ("b",)}
        fifo = pathlib.Path(folder) / "fifo"
        os.mkfifo(fifo)
        code = "import sys; sys.path.insert(0, %r); import work; work.Work(%r, %r, 1); work.run(['sh', '-c', 'exec 9>%s; read x'], %r)"
        held = subprocess.Popen([sys.executable, "-c", code % (str(pathlib.Path(work.__file__).parent), folder, __file__, fifo, folder + "/log")],
                                stdin=subprocess.PIPE)
        with open(fifo, "rb") as open_in_child:  # ends with the child
            held.terminate()
            assert open_in_child.read() == b"" and held.wait() == 143


def check_records():
    """Means over bins are those over frames; a record is found again until anything that it depends on is another."""
    into = [-0.3, 0.1, 0.2, 0.6, 1.4, 0.7, 0.4]
    frames = [{"into": x, "keypoints_mp": 10.0 * i, "model": 0 if i < 4 else None, **({"matches_mp": float(i)} if i < 6 else {})}
              for i, x in enumerate(into)]
    bins = records.bins_of(frames)
    assert [b[0] for b in bins] == [-0.5, 0, 0.5, 1, 0.5, 0], bins  # along the flight
    assert records.mean_keypoints(bins) == 30 and records.mean_matches(bins) == 2.5
    assert records.mean_keypoints(bins, 0, 1) == 10 * (1 + 2 + 3 + 5 + 6) / 5 and records.mean_matches(bins, 0.5, 1) == 4
    assert records.share_in_model(bins, 0, 0.5) == 2 / 3 and records.mean_matches(bins, 5, 9) is None
    assert records.in_model(bins)[1] == [1, 1, 1, 1, 0, 0, 0]
    assert records.bins_of([dict(f, into=None) for f in frames]) == [[None, 7, 210.0, 6, 15.0, 4]]
    row = plan.ROWS[1]
    with tempfile.TemporaryDirectory() as folder:
        path = pathlib.Path(folder) / "records.jsonl"
        kept, flown = records.MappingRecords(path), flights.Flights(work.Work(folder, __file__, 1), plan.SIZES["small"])
        depends = kept.depends(flown, row, ["judge", "1"])
        kept.add("small", 2, row, "colmap", depends, {"score": {"frames": 7}, "frames": frames}, "0123456789ab")
        kept.add("small", 1, row, "colmap", depends, {"score": {"frames": 8}, "frames": frames}, "0123456789ab")
        again = records.MappingRecords(path)
        assert again.find("small", 2, row, "colmap", depends)["score"]["frames"] == 7 and len(path.read_text().splitlines()) == 2
        assert again.find("small", 3, row, "colmap", depends) is None and again.find("full", 2, row, "colmap", depends) is None
        assert again.find("small", 2, row, "colmap", again.depends(flown, row, ["judge", "2"])) is None
        assert again.find("small", 2, row, "colmap", dict(depends, golden="of another kernel")) is None
        again.add("small", 2, row, "colmap", depends, {"score": {"frames": 9}, "frames": frames}, "0123456789ab", 2)
        runs = [records.MappingRecords(path).find("small", 2, row, "colmap", depends, run) for run in (1, 2, 3)]
        assert [r and r["score"]["frames"] for r in runs] == [7, 9, None], runs


def check_plan():
    names = [row.name for row in plan.ROWS]
    assert len(names) == len(set(names))
    order = plan.order(range(1, 6), [])
    assert [row.name for seed, row in order[:len(names)]] == names  # every row of the first seed comes first
    assert sum(seed == 5 for seed, _ in order) == sum(row.seeds == 5 for row in plan.ROWS)


if __name__ == "__main__":
    check_true_matches()
    check_carriers()
    check_stages()
    check_commands_at_once()
    check_records()
    check_plan()
