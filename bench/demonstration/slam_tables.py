"""The table and the figure of docs/explanation/slam_judges.md, from all records of the sources as they are now."""
import sys

import flights
import records
import slam_judges
import slam_plan
import tables
import work as stages

sys.path.insert(0, str(stages.ROOT / "tools"))
import document_marks  # noqa: E402

PAGE = stages.ROOT / "docs/explanation/slam_judges.md"
FIGURE = stages.ROOT / "docs/pictures/slam_judges.png"
TITLES = {"exterior": "outside, by day", "street": "outside, in a street", "dark": "void, no lamp, day outside",
          "night_15": "void, night, lamp of 15 cd", "night_200": "void, night, lamp of 200 cd", "smoke": "void, smoke of 0.3 / m"}
SEEDS = range(1, 6)
HEADINGS = ["flight", "judge", "seeds", "runs", "pictures or scans", "with a pose, %", "motion followed, %", "on track, %", "maps",
            "ATE, m", "first lost", "where, m into the void"]


def collect(work, kept):
    """{(flight, judge): {(seed, run): record}}"""
    judging, found = slam_judges.SlamJudges(work), {}
    for seed, row, kind, judges in slam_plan.order(SEEDS, [], []):
        flown = flights.Flights(work, slam_plan.KINDS[kind].recording)
        for judge in judges:
            for number in range(judge.runs):
                record = kept.find(row, judge, seed, number, kept.depends(judging, flown, row, judge, number))
                if record:
                    found.setdefault((row.name, judge.name), {})[seed, number] = record
    return found


def cell(values, digits):
    """As tables.cell(), without a range where all are alike."""
    values = [v for v in values if v is not None]
    alike = len({"%.*f" % (digits, v) for v in values}) == 1
    return tables.cell(values[:1] if alike else values, digits)


def places(summaries):
    """Where the way was lost: on the way in, or on the way out again."""
    parts = []
    for going in ("in", "out"):
        values = [s["lost_into_m"] for s in summaries if s["lost_going"] == going]
        if values:
            parts.append("%s, way %s (%d)" % (cell(values, 1), going, len(values)))
    return "; ".join(parts) or "-"


def cells(results):
    summaries = [r["summary"] for r in results.values()]
    columns = [("frames", 0), ("pose_percent", 0), ("followed_percent", 0), ("on_track_percent", 0), ("maps", 1), ("ate_rmse_m", 2)]
    row = [", ".join(str(s) for s in sorted({seed for seed, _ in results})), str(len(results))]
    row += [cell([s[key] for s in summaries], digits) for key, digits in columns]
    lost = sum(s["lost_after_m"] is not None for s in summaries)
    return row + ["%d of %d" % (lost, len(summaries)), places(summaries)]


def table(found):
    rows = []
    for flight, title in TITLES.items():
        for judge in slam_plan.JUDGES:
            if (flight, judge.name) in found:
                rows.append([title, judge.title] + cells(found[flight, judge.name]))
                title = ""
    return tables.markdown(HEADINGS, rows)


def show(work, kept):
    print(table(collect(work, kept)))


def notes(found):
    return ["%s, seed %d, %s, run %d: %s" % (flight, seed, judge, run, result["summary"]["note"])
            for (flight, judge), results in found.items() for (seed, run), result in results.items() if result["summary"]["note"]]


def write(work, kept):
    found = collect(work, kept)
    if not found:
        raise SystemExit("%s has no record of these sources" % kept.path)
    document_marks.write_between_marks(PAGE, "judges", table(found) + "\n" + tables.commits(found))
    import slam_figure
    slam_figure.draw(found, tables.collect(work, records.MappingRecords(), "small"), FIGURE)
    for note in notes(found):
        print(note)
