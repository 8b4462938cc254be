"""Writes the figures of docs/explanation/sfm.md and docs/explanation/map_score.md: what stands there between `<!-- begin NAME -->` and
`<!-- end NAME -->` is made from the results in --out; the text around it is written by people."""
import json
import re
import statistics

import conditions
import map_picture
import maps
import pictures
import stages

DOCUMENT, MAP_SCORE = stages.ROOT / "docs/explanation/sfm.md", stages.ROOT / "docs/explanation/map_score.md"
FIGURES = stages.ROOT / "docs" / "pictures"


def collect(work):
    """{(size, condition name): {seed: score}} of every reconstruction that is finished."""
    found = {}
    for size in conditions.SIZES:
        for condition in conditions.CONDITIONS:
            for folder in sorted(work.out.glob("seed*")):
                seed = int(folder.name[4:])
                if (work.sfm(seed, size, condition) / "map.json").exists():
                    score = work.evaluate(seed, size, condition)
                    found.setdefault((size, condition.name), {})[seed] = score
    return found


def text(values, digits=0):
    """A mean and, where they differ, the standard deviation; a dash for what could not be determined."""
    values = [v for v in values if v is not None]
    if not values:
        return "-"
    mean = format(statistics.mean(values), ",.%df" % digits)
    return mean if len(set(values)) == 1 else "%s ± %s" % (mean, format(statistics.stdev(values), ",.%df" % digits))


COLUMNS = [  # heading, key, digits
    ("images", "frames", 0), ("segments", "segments", 1), ("registered", "registered", 0),
    ("on track, %", "on_track_percent", 1), ("points", "points", 0), ("ATE, m", "ate_rmse_m", 3),
    ("RPE, °", "rpe_rot_rmse_deg", 3),
    ("≤ 5 cm, %", "within_5cm_percent", 0), ("covered, %", "completeness_5cm_percent", 1),
]


def markdown(headings, rows):
    lines = ["| " + " | ".join(headings) + " |", "|" + "---|" * len(headings)]
    return "\n".join(lines + ["| " + " | ".join(row) + " |" for row in rows])


def paper_table(found):
    rows = []
    for name, (images, segments, percent, points) in conditions.PAPER.items():
        rows.append([name, "published", "", str(images), str(segments), "%.1f" % percent, "%s" % format(points, ",")])
        for size in conditions.SIZES:
            scores = found.get((size, name))
            if scores:
                rows.append([name, "ours, " + size, ", ".join(map(str, sorted(scores)))] +
                            [text([s[key] for s in scores.values()], digits) for key, digits in
                             [("frames", 0), ("segments", 1), ("on_track_percent", 1), ("points", 0)]])
    return markdown(["trajectory", "", "seeds", "images", "segments", "on track, %", "points"], rows)


def condition_table(found, size):
    rows = []
    for condition in conditions.CONDITIONS:
        scores = found.get((size, condition.name))
        if scores:
            cells = [text([s[key] for s in scores.values()], digits) for _, key, digits in COLUMNS]
            rows.append([condition.title] + cells)
    return markdown(["condition"] + [heading for heading, _, _ in COLUMNS], rows)


def surface_table(work):
    rows = []
    paths = [path for stem in SURFACES for path in sorted(work.out.glob("seed*/meshes/%s.score.json" % stem))]
    for path in paths:
        score = json.loads(path.read_text())["datasets"][0]
        rows.append([json.loads((path.parent / (path.name[:-11] + ".title.json")).read_text()),
                     format(score["triangles"], ",") if score["triangles"] else "-"] +
                    [text([score[key]], digits) for key, digits in
                     [("within_1cm_percent", 1), ("within_2cm_percent", 1), ("within_5cm_percent", 1),
                      ("median_distance_m", 4), ("completeness_5cm_percent", 1)]])
    return markdown(["surface", "triangles", "≤ 1 cm, %", "≤ 2 cm, %", "≤ 5 cm, %", "median, m", "covered, %"], rows)


def slam_table(work):
    rows = []
    for path in sorted(work.out.glob("seed*/slam_*/slam/*.track.json")):
        method = path.name[:-len(".track.json")]
        track = json.loads(path.read_text())
        run = json.loads((path.parent / (method + ".json")).read_text())
        surface = json.loads((path.parent / (method + ".surface.json")).read_text())["datasets"][0]
        rows.append([path.parent.parent.name[5:], METHODS[method], str(run["frames"]), str(run["lost"]),
                     "%.3f" % track["ate_rmse_se3_m"], "%.4f" % track["rpe_trans_rmse_m"],
                     "%.3f" % track["rpe_rot_rmse_deg"], "%.1f" % surface["within_5cm_percent"],
                     "%.1f" % surface["completeness_5cm_percent"]])
    return markdown(["flight", "odometry", "frames", "lost", "ATE, m", "RPE, m", "RPE, °",
                     "fused model ≤ 5 cm, %", "covered, %"], rows)


SURFACES = ["fused_tsdf", "fused_poisson", "mrpt_points", "sparse_delaunay"]
METHODS = {"rgbd": "OpenCV `RgbdOdometry`", "rgbd_icp": "OpenCV `RgbdICPOdometry`",
           "icp": "OpenCV `ICPOdometry`", "open3d": "Open3D, hybrid term",
           "mrpt_icp": "MRPT `icp-slam`, in the plane"}


def map_table(scores):
    rows = [[title] + [text([scores[name][key]], digits) for key, digits in
                       [("within_5cm_percent", 1), ("median_distance_m", 4), ("complete_2cm_percent", 1),
                        ("complete_5cm_percent", 1), ("void_found_percent", 1), ("r300_found_percent", 1)]]
            for name, title, _ in maps.MAPS if name in scores]
    best = next(iter(scores.values()))
    rows.append(["the most that could be", "", "", "", ""] +
                [text([best[key]], 1) for key in ("void_visible_percent", "r300_visible_percent")])
    return markdown(["map", "within 5 cm, %", "median, m", "visible surface within 2 cm, %", "within 5 cm, %",
                     "void found, %", "by a robot of 0.3 m, %"], rows)


def write_maps(work):
    """The table and the picture of docs/explanation/map_score.md, where maps of pile 1 were scored."""
    if not (work.out / "seed1" / "maps").exists():
        return
    scores = work.map_scores(1, conditions.find(["lit"])[0])
    if not scores:
        return
    MAP_SCORE.write_text(replace(MAP_SCORE.read_text(), "maps", map_table(scores)))
    if maps.PICTURE in scores:
        title = "%s points of COLMAP" % format(scores[maps.PICTURE]["samples"], ",")
        map_picture.draw(work.out / "seed1" / "maps" / maps.PICTURE, maps.PICTURE, title, FIGURES / "map_score.png")


def replace(document, name, content):
    begin, end = "<!-- begin %s -->" % name, "<!-- end %s -->" % name
    if begin not in document or end not in document:
        raise SystemExit("the page has no place for %s: expected %s ... %s" % (name, begin, end))
    return re.sub(re.escape(begin) + ".*?" + re.escape(end),
                  lambda _: begin + "\n" + content + "\n" + end, document, flags=re.S)


def write(work):
    write_maps(work)
    found = collect(work)
    document = DOCUMENT.read_text()
    document = replace(document, "paper", paper_table(found))
    for size in conditions.SIZES:
        document = replace(document, "conditions " + size, condition_table(found, size))
    document = replace(document, "surfaces", surface_table(work))
    document = replace(document, "slam", slam_table(work))
    DOCUMENT.write_text(document)
    for size in conditions.SIZES:
        for names, end in ((list(conditions.PAPER), ""), (conditions.HARD, "_hard")):
            shown = [n for n in names if found.get((size, n), {}).get(1, {}).get("points")]
            if shown:
                pictures.draw(work, size, shown, found, FIGURES / ("sfm_%s%s.png" % (size, end)))
