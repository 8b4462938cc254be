#!/usr/bin/python3
"""Random draws whose order a compiler may choose: two arguments of a call that draw, or two sides of an operator. g++ and clang++
choose differently, so piles and pictures would depend on the compiler (docs/explanation/determinism.md). Elements of a braced
list, declarations after each other and the parts of a condition come in order.

usage: draws_test.py ROOT
"""
import pathlib
import re
import sys

FOLDERS = ("kernel", "render", "assets", "scripting", "app", "io")
DRAWS = "uniform|normal|below|next|direction|exponential"


def without_comments(text):
    text = re.sub(r'"(?:\\.|[^"\\\n])*"', lambda m: '"' + " " * (len(m[0]) - 2) + '"', text)
    return re.sub(r"//[^\n]*", lambda m: " " * len(m[0]), text)


def names_of_streams(texts):
    found = {"random", "random_"}
    for text in texts:
        found.update(re.findall(r"\bRandomStream&?\s+(\w+)\s*[;,)({=]", text))
    return found


def end_of_call(text, opened):
    depth = 0
    for i in range(opened, len(text)):
        depth += text[i] in "([{"
        depth -= text[i] in ")]}"
        if depth == 0:
            return i + 1
    return len(text)


def find_draws(text, streams):
    """Where a call draws: (from, to) of each, sorted."""
    names = "|".join(sorted(streams))
    spans = [(m.start(), end_of_call(text, m.end() - 1))
             for m in re.finditer(r"\b(?:%s)\.(?:%s)\(" % (names, DRAWS), text)]
    for m in re.finditer(r"\b(?!if|for|while|switch|return|sizeof)[A-Za-z_]\w*\(", text):  # a stream is handed over
        end = end_of_call(text, m.end() - 1)
        if re.search(r"[(,]\s*(?:%s)\s*[,)]" % names, text[m.end() - 1:end]) and ";" not in text[m.start():end]:
            spans.append((m.start(), end))
    return sorted(set(spans))


def arguments(text, opened):
    """Of the list that opens there: (from, to) of each; none where it has statements."""
    end = end_of_call(text, opened)
    parts, depth, begin = [], 0, opened + 1
    for i in range(opened, end):
        if text[i] == ";":
            return []
        depth += text[i] in "([{"
        depth -= text[i] in ")]}"
        if (text[i] == "," and depth == 1) or i == end - 1:
            parts.append((begin, i))
            begin = i + 1
    return parts


def outermost(spans):
    kept = []
    for span in spans:
        if not kept or span[0] >= kept[-1][1]:
            kept.append(span)
    return kept


def find_unordered(text, streams):
    """Lines of statements with draws in no order."""
    text = without_comments(text)
    draws = find_draws(text, streams)
    bad = set()
    for m in re.finditer(r"[\w>\]]\(", text):
        drawing = [a for a in arguments(text, m.end() - 1) if any(a[0] <= d[0] < a[1] for d in draws)]
        if len(drawing) > 1:
            bad.add(m.start())
    ended = re.sub(r"\) (?=[A-Za-z_])", ");", text)  # what stands behind `if (...)`
    for piece in re.finditer(r"(?:[^,;{}?:&|]|::)+", ended):  # operands of one expression
        if len(outermost([d for d in draws if piece.start() <= d[0] < piece.end()])) > 1:
            bad.add(piece.start() + len(piece[0]) - len(piece[0].lstrip()))
    return sorted({text.count("\n", 0, at) + 1 for at in bad})


def check_itself():
    streams = {"random"}
    for wrong in ("f(random.uniform(), random.uniform());", "out.box({x, random.uniform(0, 1)}, {x, random.uniform(0, 1)});",
                  "v = random.direction() * random.uniform(0, 1);", "y = 2 * double(random.below(4)) + random.normal();",
                  "f(draw(random), random.next());"):
        assert find_unordered(wrong, streams) == [1], wrong
    for right in ("double a = random.uniform(), b = random.uniform();", "Vec3 v{random.uniform(), random.uniform(), 0};",
                  "x = random.uniform() < 0.5 ? random.below(2) : random.below(3);", "m[random.below(random.uniform() < 1 ? 8 : 12)];",
                  "f(random.uniform(), random);", "f(2, random);", "f(); g(random.uniform());  // f(random.next(), random.next())",
                  "if (random.uniform() < 1) f(2, random);", "run(2, [&](int i) { a = random.next(); b = random.next(); });"):
        assert find_unordered(right, streams) == [], right


def main():
    check_itself()
    root = pathlib.Path(sys.argv[1])
    files = [p for folder in FOLDERS for p in sorted((root / folder).rglob("*")) if p.suffix in (".h", ".cpp")]
    texts = {p: p.read_text(errors="replace") for p in files}
    streams = names_of_streams(texts.values())
    assert len(files) > 500 and sum(bool(find_draws(t, streams)) for t in texts.values()) > 40
    bad = ["%s:%d" % (p.relative_to(root), line) for p, t in texts.items() for line in find_unordered(t, streams)]
    for place in bad:
        print("%s: draws in no order; name each in a statement of its own" % place)
    return 1 if bad else 0


if __name__ == "__main__":
    sys.exit(main())
