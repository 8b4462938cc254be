"""Baselines of Rubble-50 that outlive the machine: one line each in records.jsonl, as those of the demonstration
(bench/demonstration/records.py). One whose golden hashes, mission or method are not those of the sources counts as missing."""
import json
import pathlib
import shutil
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent.parent / "demonstration"))
import records  # noqa: E402
import work  # noqa: E402

HERE = pathlib.Path(__file__).resolve().parent
FILE = HERE / "records.jsonl"
MISSIONS = work.ROOT / "scripts" / "rubble50"
FOLLOWERS = {"colmap": ("slam.py", "structure.py")}  # others: slam.py alone


class BaselineRecords(records.Records):
    def __init__(self, path=FILE):
        super().__init__(path)

    def recording(self, name):
        """What the recording of a mission follows from."""
        return super().depends(*(work.digest_file(MISSIONS / file) for file in (name + ".lua", "fifty.lua")))

    def depends(self, name, method):
        sources = [work.digest_file(HERE / file) for file in FOLLOWERS.get(method, ("slam.py",))]
        return super().depends(self.recording(name), *sources)

    def find(self, name, method):
        """The result, or None."""
        record = super().find((name, method), self.depends(name, method))
        return record and record["result"]

    def add(self, name, method, run, result):
        """run: the folder of the recording."""
        super().add((name, method), self.depends(name, method), records.commit_of(run), {"result": result})


def is_made_from(folder, depends):
    """Whether the recording in the folder is of these sources. One that somebody put there is taken as it is."""
    stamp = folder / "made_from.json"
    if not stamp.exists():
        print("%s: nothing says what this recording was made from; it is taken as it is" % folder, flush=True)
        return True
    return json.loads(stamp.read_text()) == depends


def begin(folder, depends):
    """An empty folder that says what its recording is made from. An older recording of ours is removed."""
    if (folder / "made_from.json").exists():
        shutil.rmtree(folder)
    folder.mkdir(parents=True, exist_ok=True)
    part = folder / "made_from.part"
    part.write_text(json.dumps(depends) + "\n")
    part.replace(folder / "made_from.json")
