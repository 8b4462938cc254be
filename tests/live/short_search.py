"""short_search.py SECONDS: examples/search/agent.py, that reports two places where nobody is, and says that it is done
after so much time of the search."""
import json
import pathlib
import subprocess
import sys

AGENT = pathlib.Path(__file__).resolve().parents[2] / "examples" / "search" / "agent.py"
program = subprocess.Popen([sys.executable, str(AGENT)], stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True)
for line in sys.stdin:
    program.stdin.write(line)
    program.stdin.flush()
    seen = json.loads(line)
    if seen["type"] != "observation":
        continue
    answer = json.loads(program.stdout.readline())
    if seen["time"] in (2.0, 4.0):
        answer["report"] = [[-3.0 - seen["time"], 1.0, 0.5]]
    answer["done"] = seen["time"] >= float(sys.argv[1])
    print(json.dumps(answer), flush=True)
