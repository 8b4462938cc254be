"""rubble.batch on local clusters of two workers, and on a server of S3 on this machine: PYTHON -m unittest, in an environment of
requirements-clusters.txt with the wheel (wheel_nightly.py)."""
import logging
import os
import tempfile
import unittest

import rubble

os.environ.update(AWS_DEFAULT_REGION="us-east-1", RAY_AUTH_MODE="disabled")
logging.getLogger("werkzeug").setLevel(logging.WARNING)

MISSION = "return rubble.mission { pile = { layers = 1, pieces_per_layer = 3 } }"
SEEDS = "1..4"


def read(path):
    with open(path, "rb") as file:
        return file.read()


class Counting:
    """A client of Dask, and the names of the runs that it was given."""

    def __init__(self, client):
        self.client, self.begun = client, []

    def submit(self, work, job):
        self.begun.append(job["name"])
        return self.executor.submit(work, job)

    def get_executor(self, **options):
        self.executor = self.client.get_executor(**options)
        return self


class Clusters(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = cls.enterClassContext(tempfile.TemporaryDirectory())
        rubble.batch(MISSION, SEEDS, os.path.join(cls.folder, "alone"), settle=True).result()
        cls.table = read(os.path.join(cls.folder, "alone", "index.csv"))

    def check(self, name, executor):
        out = os.path.join(self.folder, name)
        with rubble.batch(MISSION, SEEDS, out, settle=True, executor=executor) as batch:
            self.assertEqual([future.result() for future in batch.futures.values()], ["done"] * 4)
        self.assertEqual(read(os.path.join(out, "index.csv")), self.table)

    def test_dask(self):
        from distributed import Client, LocalCluster
        with LocalCluster(n_workers=2, threads_per_worker=1, host="127.0.0.1", dashboard_address=None) as cluster, Client(cluster) as client:
            self.check("dask", client)
            self.to_s3(client)

    def test_ray(self):
        import ray
        ray.init(num_cpus=2, include_dashboard=False, log_to_driver=False)
        try:
            self.check("ray", rubble.RayExecutor())
        finally:
            ray.shutdown()

    def to_s3(self, client):
        """A batch whose results go to a bucket; of one that has lost a run, that run alone starts again."""
        import fsspec
        from moto.server import ThreadedMotoServer
        server = ThreadedMotoServer(ip_address="127.0.0.1", port=0)
        server.start()
        try:
            host, port = server.get_host_and_port()
            storage = {"key": "test", "secret": "test", "client_kwargs": {"endpoint_url": f"http://{host}:{port}"}}
            files = fsspec.filesystem("s3", **storage)
            files.mkdir("results")
            for lost in (None, "seed_3/manifest.json"):
                if lost:
                    files.rm_file("results/batch/" + lost)
                    files.invalidate_cache()
                counting = Counting(client)
                batch = rubble.batch(MISSION, SEEDS, "s3://results/batch", settle=True, executor=counting, storage_options=storage)
                self.assertEqual(counting.begun, ["seed_3"] if lost else [f"seed_{seed}" for seed in range(1, 5)])
                self.assertEqual([row["status"] for row in batch.result()], ["done"] * 4)
                files.invalidate_cache()
                self.assertEqual(files.cat_file("results/batch/index.csv"), self.table)
                self.assertEqual(files.cat_file("results/batch/seed_3/pile.bin"),
                                 read(os.path.join(self.folder, "alone", "seed_3", "pile.bin")))
        finally:
            server.stop()


if __name__ == "__main__":
    unittest.main()
