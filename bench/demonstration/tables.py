"""The tables of docs/explanation/sfm.md, from all records of the sources as they are now."""
import statistics
import sys

import flights
import judges
import plan
import records
import work as stages

sys.path.insert(0, str(stages.ROOT / "tools"))
import document_marks  # noqa: E402

PAGE = stages.ROOT / "docs/explanation/sfm.md"
FIGURE = stages.ROOT / "docs/pictures/demonstration.png"
WAY = stages.ROOT / "docs/pictures/demonstration_way.jpg"
COLUMNS = [("frames", 0), ("segments", 1), ("on_track_percent", 1), ("points", 0), ("ate_rmse_m", 2)]
BASE = "lamp_15"  # the row that the others differ from by one thing
INTO = (-3.0, 0.0, 2.0, 4.0, 6.0, 8.0, 99.0)  # borders of the figure's bins: metres into the void


def collect(work, kept, size):
    """{(row, judge): {seed: record}}"""
    flown, judging = flights.Flights(work, plan.SIZES[size]), judges.Judges(work)
    found = {}
    for seed, row in plan.order(range(1, 6), []):
        for judge in plan.JUDGES:
            record = kept.find(size, seed, row, judge, kept.depends(flown, row, judging.identity(judge)))
            if record:
                found.setdefault((row.name, judge), {})[seed] = record
    return found


def cell(values, digits):
    """The mean, and the least and the most where there are several; a dash for what could not be determined."""
    values = [v for v in values if v is not None]
    if not values:
        return "-"
    number = "{:,.%df}" % digits
    mean = number.format(statistics.mean(values))
    return mean if len(values) == 1 else "%s (%s to %s)" % (mean, number.format(min(values)), number.format(max(values)))


def cells(results):
    """As the published table, and the position error; then what the frames deep inside offered."""
    scores = [r["score"] for r in results.values()]
    row = [cell([s[key] for s in scores], digits) for key, digits in COLUMNS]
    for mean in (records.mean_keypoints, records.mean_matches):
        row.append(cell([mean(r["bins"]) for r in results.values()], 0))
    return row


def all_bins(results):
    return [b for r in results.values() for b in r["bins"]]


HEADINGS = ["images", "segments", "on track, %", "points", "ATE, m", "keypoints / MP", "true matches / MP"]


def markdown(headings, rows):
    lines = ["| " + " | ".join(headings) + " |", "|" + "---|" * len(headings)]
    return "\n".join(lines + ["| " + " | ".join(row) + " |" for row in rows]) + "\n"


def paper_table(found, sizes):
    rows = []
    for name, (images, segments, percent, points) in plan.PUBLISHED.items():
        title = next(r.title for r in plan.ROWS if r.name == name)
        rows.append([title, "published", "", str(images), str(segments), "%.1f" % percent, format(points, ",")] + ["", "", ""])
        for size in sizes:
            for judge in plan.JUDGES:
                results = found[size].get((name, judge))
                if results:
                    rows.append(["", "%s, %s" % (size, judge), ", ".join(map(str, sorted(results)))] + cells(results))
    return markdown(["flight", "", "seeds"] + HEADINGS, rows)


def factor_table(found):
    rows = []
    for row in plan.ROWS:
        for judge in plan.JUDGES:
            results = found.get((row.name, judge))
            if results:
                rows.append([row.group, row.title, judge, ", ".join(map(str, sorted(results)))] + cells(results))
    return markdown(["factor", "flight", "judge", "seeds"] + HEADINGS, rows)


def common_seeds(found, rows):
    """Those that all of these rows have by COLMAP, as far as they have any: another seed is another ruin."""
    return sorted(set.intersection(*[set(results) for row in rows if (results := found.get((row, "colmap")))] or [set()]))


def depth_table(found):
    rows, inside = [], [row.name for row in plan.ROWS if "flight=inside" in row.settings]
    seeds = common_seeds(found, inside)
    for row in plan.ROWS:
        results = {seed: r for seed, r in found.get((row.name, "colmap"), {}).items() if seed in seeds}
        if not results or row.name not in inside:
            continue
        means = [[mean(all_bins(results), low, high) for low, high in zip(INTO, INTO[1:])]
                 for mean in (records.mean_keypoints, records.mean_matches)]
        rows.append([row.title] + ["-" if k is None else "%.0f / %s" % (k, "-" if m is None else "%.0f" % m) for k, m in zip(*means)])
    names = ["outside"] + ["%g to %g m" % pair for pair in zip(INTO[1:], INTO[2:-1])] + ["deeper than %g m" % INTO[-2]]
    return "Seeds that all flights have: %s.\n\n" % ", ".join(map(str, seeds)) + markdown(["flight"] + names, rows)


def ratio_table(found, sizes):
    """Of every flight inside, by COLMAP: true matches relative to those of the base, and frames on track, a column for each ruin."""
    inside = [row for row in plan.ROWS if "flight=inside" in row.settings]
    ruins = [(size, seed) for size in sizes for seed in common_seeds(found[size], [row.name for row in inside])]
    results = {(row.name, *ruin): found[ruin[0]].get((row.name, "colmap"), {}).get(ruin[1]) for row in inside for ruin in ruins}
    matches = {key: records.mean_matches(r["bins"]) for key, r in results.items() if r}

    def cells_of(name):
        ratios = ["%.2f" % (matches[name, *r] / matches[BASE, *r]) if (name, *r) in matches else "-" for r in ruins]
        shares = ["%.0f" % results[name, *r]["score"]["on_track_percent"] if results[name, *r] else "-" for r in ruins]
        return ratios + shares

    names = ["%s, seed %d" % ruin for ruin in ruins]
    return markdown(["flight"] + ["matches: " + n for n in names] + ["on track, %: " + n for n in names],
                    [[row.title] + cells_of(row.name) for row in inside if any(results[row.name, *r] for r in ruins)])


def repeats_table(work, kept, sizes):
    """Every judge that saw the same pictures more than once: what each run found."""
    rows, last = [], max((key[4] for key in kept.kept if len(key) > 4), default=1)
    for size in sizes:
        flown, judging = flights.Flights(work, plan.SIZES[size]), judges.Judges(work)
        for seed, row in plan.order(range(1, 6), []):
            for judge in plan.JUDGES:
                depends = kept.depends(flown, row, judging.identity(judge))
                runs = [r for n in range(1, last + 1) if (r := kept.find(size, seed, row, judge, depends, n))]
                if len(runs) < 2:
                    continue
                scores = [r["score"] for r in runs]
                rows.append(["%s, %s, seed %d" % (row.title, size, seed), judge, "%d" % scores[0]["frames"]] + [
                    ", ".join("%d" % s[key] for s in scores) for key in ("on_track", "segments", "points")] + [
                    ", ".join("%.0f" % mean(r["bins"]) for r in runs) for mean in (records.mean_keypoints, records.mean_matches)])
    return markdown(["flight", "judge", "images", "on track", "segments", "points", "keypoints / MP", "true matches / MP"], rows)


def show(work, kept, size):
    print(factor_table(collect(work, kept, size)))


def commits(found):
    """Of the records, as a sentence."""
    names = sorted({r["commit"][:8] for results in found.values() for r in results.values()})
    return "Program%s of commit%s %s.\n" % (("s", "s", ", ".join(names)) if len(names) > 1 else ("", "", names[0]))


def write(work, kept):
    found = {size: collect(work, kept, size) for size in plan.SIZES}
    sizes = [size for size in plan.SIZES if found[size]]
    if not sizes:
        raise SystemExit("%s has no record of these sources" % kept.path)
    parts = {"paper": paper_table(found, sizes), "ratios": ratio_table(found, sizes), "repeats": repeats_table(work, kept, sizes), "factors": "",
             "depths": ""}
    for size in sizes:
        title = "%s: %s. %s\n" % (size, plan.SIZES[size].title, commits(found[size]))
        parts["factors"] += title + factor_table(found[size]) + "\n"
        parts["depths"] += title + depth_table(found[size]) + "\n"
    for name, text in parts.items():
        document_marks.write_between_marks(PAGE, name, text)
    import figure
    figure.draw(found[sizes[0]], plan.SIZES[sizes[0]].title, FIGURE)
    any(figure.draw_way(flights.Flights(work, plan.SIZES[size]), WAY) for size in sizes)
