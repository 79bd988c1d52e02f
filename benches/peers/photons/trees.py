"""kd-trees of Python's packages over photons: answers commands, one JSON document a line, with the seconds that they took.

    python trees.py {ckdtree|pykdtree}
"""

import json
import sys
import time

import numpy as np
from threadpoolctl import threadpool_limits


def seconds(threads, work):
    """Seconds of some work and its result: by the thread's own clock where there is one, else by the wall's."""
    clock = time.thread_time if threads == 1 else time.perf_counter
    begun = clock()
    result = work()
    return clock() - begun, result


class Ckdtree:
    """scipy.spatial.cKDTree, in doubles: counts photons within a radius, lists the nearest. The settings are the fastest of those tried, to
    build and to search."""

    def __init__(self, points):
        from scipy.spatial import cKDTree

        self.kind, self.points = cKDTree, points.astype(np.float64)

    def build(self):
        self.tree = None
        self.tree = self.kind(self.points, balanced_tree=False, compact_nodes=False)

    def queries(self, points):
        return points.astype(np.float64)

    def within(self, points, radius, threads):
        return self.tree.query_ball_point(points, radius, return_length=True, workers=threads)

    def nearest(self, points, k, radius, threads):
        return self.tree.query(points, k, distance_upper_bound=radius, workers=threads)[0]


class Pykdtree:
    """pykdtree.kdtree.KDTree, in floats: lists the nearest; it has no search by radius alone. Of 8, 16 and
    32 photons a leaf 32 is the fastest."""

    def __init__(self, points):
        from pykdtree.kdtree import KDTree

        self.kind, self.points = KDTree, points

    def build(self):
        self.tree = None
        self.tree = self.kind(self.points, leafsize=32)

    def queries(self, points):
        return points

    def within(self, points, radius, threads):
        return None

    def nearest(self, points, k, radius, threads):
        with threadpool_limits(limits=threads, user_api="openmp"):
            return self.tree.query(points, k, distance_upper_bound=radius)[0]


def read(path):
    return np.fromfile(path, dtype=np.float32).reshape(-1, 3)


def main():
    kind = {"ckdtree": Ckdtree, "pykdtree": Pykdtree}[sys.argv[1]]
    engine = None
    for line in sys.stdin:
        command = json.loads(line)
        if command["do"] == "load":
            engine = kind(read(command["points"]))
            reply = {"seconds": 0.0}
        elif command["do"] == "build":
            reply = {"seconds": seconds(command["threads"], engine.build)[0]}
        else:
            points, threads, radius = engine.queries(read(command["queries"])), command["threads"], command["radius"]
            if command["do"] == "within":
                took, counts = seconds(threads, lambda: engine.within(points, radius, threads))
                farthest = np.zeros(len(points), dtype=np.float32)
            else:
                k = command["k"]
                took, distances = seconds(threads, lambda: engine.nearest(points, k, radius, threads))
                found = np.isfinite(distances)
                counts = found.sum(axis=1)
                farthest = np.where(found, distances, 0).max(axis=1).astype(np.float32)
            if counts is None:
                reply = {"unknown": True}
            else:
                with open(command["answers"], "wb") as file:
                    counts.astype(np.uint32).tofile(file)
                    farthest.tofile(file)
                reply = {"seconds": took}
        print(json.dumps(reply), flush=True)


main()
