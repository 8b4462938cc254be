"""The tables of baselines in docs/explanation/rubble50.md: what stands there between `<!-- begin NAME -->` and `<!-- end NAME -->`
is made from results; the text around it is written by people."""
import statistics

from document_marks import write_between_marks


def median(values, digits):
    return "%.*f" % (digits, statistics.median(values)) if values else "-"


def finished(found):
    return found["lost"] == 0 and found["trajectory"] is not None


def ate(found):
    """After a rigid alignment, of what knows no scale after one with scale."""
    return found["trajectory"]["ate_rmse_sim3_m" if found.get("scaled") else "ate_rmse_se3_m"]


def row(cells):
    return "| " + " | ".join(cells) + " |"


def method_table(found, methods):
    lines = [row(["method", "missions run", "finished", "ATE, m", "RPE, m", "RPE, °"]), "|" + "---|" * 6]
    for method, title in methods.items():
        all_of = [result for (_, m), result in found.items() if m == method]
        finishers = [result for result in all_of if finished(result)]
        good = [result["trajectory"] for result in finishers if not result.get("scaled")]  # RPE needs a scale
        lines.append(row([title, "%d of 50" % len(all_of), str(len(finishers)),
                          median([ate(result) for result in finishers], 3),
                          median([t["rpe_trans_rmse_m"] for t in good], 4),
                          median([t["rpe_rot_rmse_deg"] for t in good], 3)]))
    return lines


def mission_table(found, methods):
    lines = [row(["mission", "frames", "depth, %", *methods.values()]), "|" + "---|" * (3 + len(methods))]
    for number in sorted({number for number, _ in found}):
        results = [found.get((number, method)) for method in methods]
        first = next(result for result in results if result)
        cells = ["" if result is None else "%.3f" % ate(result) if finished(result)
                 else "lost in %d" % result["lost"] for result in results]
        lines.append(row([str(number), str(first["frames"]), "%.0f" % (100 * first["depth_share"]), *cells]))
    return lines


def write(page, found, methods):
    for name, lines in (("methods", method_table(found, methods)), ("missions", mission_table(found, methods))):
        write_between_marks(page, name, "\n".join(lines) + "\n")
