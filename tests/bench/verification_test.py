"""verification_test.py BENCH PAGE: one record of verification_bench is whole, and page.py finds a figure that differs."""
import json
import math
import random
import subprocess
import sys
import tempfile

bench, page = sys.argv[1:]
assert "ruin: a building" in subprocess.run([bench, "--help"], stdout=subprocess.PIPE, text=True, check=True).stdout
run = subprocess.run([bench, "--one", "--work", "robot", "--seeds", "3"], stdout=subprocess.PIPE, text=True, check=True)
record = json.loads(run.stdout)
assert record["work"] == "robot@240x4" and record["path_m"] >= record["distance_m"] > 0, record
unknown = subprocess.run([bench, "--one", "--work", "nonsense"], stderr=subprocess.PIPE, text=True)
assert unknown.returncode == 1 and "--work: unknown work" in unknown.stderr, unknown.stderr

# The time to rest falls by a tenth at the finest step; nothing else depends on the variant.
draw = random.Random(5)
with tempfile.NamedTemporaryFile("w", suffix=".jsonl") as file:
    for seed in range(20):
        for hz, sweeps in [(60, 16), (120, 16), (240, 16), (480, 16), (960, 16), (60, 4), (60, 8), (60, 32), (60, 64)]:
            rest = (9 if hz == 960 else 10) + 0.1 * draw.gauss(0, 1)
            file.write(json.dumps({"work": "loose@%dx%d" % (hz, sweeps), "seed": seed, "of": "loose", "step_hz": hz, "substeps": sweeps,
                                   "settled": True, "drift_m": 0, "cpu_s": 1, "rest_s": rest, "top_m": 2 + 0.1 * draw.gauss(0, 1)}) + "\n")
    file.flush()
    text = subprocess.run([page, file.name, "--print"], stdout=subprocess.PIPE, text=True, check=True).stdout
rows = [line for line in text.splitlines() if line.startswith("| loose")]
assert len(rows) >= 1 and rows[0].startswith("| loose | time to rest, s | 10") and "(-10 %)" in rows[0] and "1/960 s" in rows[0], text
assert "180 runs of 20 seeds" in text and "Of 4 comparisons" in text, text

# Student's t: t(0.975, 9) = 2.262, t(0.975, 38) = 2.024.
sys.path.insert(0, page.rsplit("/", 1)[0])
import page as of_page  # noqa: E402
assert math.isclose(of_page.t_975(9), 2.262157, rel_tol=1e-3) and math.isclose(of_page.t_975(38), 2.024394, rel_tol=1e-4)
