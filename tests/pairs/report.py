"""Counts of pairs and failures, in words and as the tables of a document."""
import os
import subprocess
import sys

import covering_array
import known_failures
import rules
from factors import FACTORS

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "..", "tools"))
import document_marks  # noqa: E402


def count(array, answers, full=True):
    """covered: pairs that are in a mission which ran to its end, whatever the judges say."""
    refused, meaningless = rules.expand(rules.REFUSED), rules.expand(rules.MEANINGLESS)
    covered, red, known, checked = set(), [], {}, 0
    for answer in answers:
        row = answer.get("levels", {})
        failed = False
        for judge, text in answer["findings"]:
            name = known_failures.find(row, judge, text)
            failed = failed or judge == "run"
            if name:
                known[name] = known.get(name, 0) + 1
            else:
                red.append((answer.get("row", " and ".join(answer.get("refused", []))), judge, text))
        if row and not failed:
            covered |= {tuple(tuple(item) for item in pair) for pair in covering_array.pairs_of(row)}
        checked += "refused" in answer and not answer["findings"]
    total = covering_array.count_pairs(FACTORS)
    implied = len(array["implied"])
    return {"total": total, "refused": len(refused), "checked": checked, "meaningless": len(meaningless), "implied": implied,
            "allowed": total - len(refused) - len(meaningless) - implied, "covered": len(covered), "red": len(red),
            "reds": red, "known": known, "missions": len(array["rows"]), "cpu": sum(answer["cpu"] for answer in answers),
            "done": sum("levels" in answer for answer in answers),
            "left": max(0, len(array["rows"]) + len(refused) - len(answers)) if full else 0}


def in_words(s):
    lines = ["%d pairs: %d allowed, of which %d are covered (%.1f %%); %d refused (%d tried and refused as they must be); "
             "%d without a meaning; %d excluded by these" % (s["total"], s["allowed"], s["covered"], 100 * s["covered"] / s["allowed"],
                                                            s["refused"], s["checked"], s["meaningless"], s["implied"]),
             "%d of %d missions are done, %d left; %d failures that are not known; %.1f minutes of processor time" %
             (s["done"], s["missions"], s["left"], s["red"], s["cpu"] / 60)]
    lines += ["known: %s in %d missions" % item for item in sorted(s["known"].items())]
    lines += ["RED %s: %s: %s" % item for item in s["reds"]]
    return "\n".join(lines)


def write(path, summary, answers, program, date):
    """Replaces what stands between the markers of the document."""
    version = subprocess.run([program, "--version"], capture_output=True, text=True, check=False).stdout.strip()
    commit = next((answer["commit"] for answer in answers if answer.get("commit")), "unknown")  # as manifests say
    s = summary
    lines = ["", "`make pairs`, %s, %s, commit %s." % (date, version, commit), "",
             "| pairs of levels | number |", "|---|---|",
             "| all | %d |" % s["total"],
             "| refused with a reason | %d |" % s["refused"],
             "| without a meaning | %d |" % s["meaningless"],
             "| excluded because of these | %d |" % s["implied"],
             "| allowed | %d |" % s["allowed"],
             "| covered by a mission that ran | %d |" % s["covered"], "",
             "%d of %d missions were run, in %.1f minutes of processor time; %d failures are not known." %
             (s["done"], s["missions"], s["cpu"] / 60, s["red"]), "",
             "### What is refused", "", "| one | other | the message says |", "|---|---|---|"]
    lines += ["| %s | %s | %s |" % (named(a, x), named(b, y), words) for a, x, b, y, words in rules.REFUSED]
    lines += ["", "### What has no meaning", "", "| one | other | why |", "|---|---|---|"]
    lines += ["| %s | %s | %s |" % (named(a, x), named(b, y), why) for a, x, b, y, why in rules.MEANINGLESS]
    if known_failures.KNOWN:
        lines += ["", "### Known failures", "", "| name | missions | cause |", "|---|---|---|"]
    lines += ["| `%s` | %d | %s |" % (name, s["known"].get(name, 0), cause) for name, _, _, _, cause in known_failures.KNOWN]
    document_marks.write_between_marks(path, "pairs", "\n".join(lines[1:]) + "\n")


def named(factor, levels):
    every = list(FACTORS[factor])
    if len(levels) > 2 and len(levels) == len(every) - 1:
        left = next(level for level in every if level not in levels)
        return "`%s`: all but `%s`" % (factor, left)
    return "`%s`: %s" % (factor, ", ".join("`%s`" % level for level in levels))
