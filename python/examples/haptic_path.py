"""A tip that follows a path near the surface, at the rate of a haptic device.

    python3 haptic_path.py MODEL.ptree [TICKS]

No query waits for the disk. Where pages are missing, the answer is an interval, and the pages are
read in the background.
"""

import sys
import time

import numpy as np

import planetree
from planetree import Status


def path_of(model, ticks):
    """Points on a circle around the middle of a model, just above its surface."""
    low, high = model.info["core"]
    angle = np.linspace(0, 2 * np.pi, ticks)
    circle = np.stack([np.cos(angle), np.sin(angle), 0 * angle], axis=-1)
    rays = np.concatenate([0 * circle + (low + high) / 2, circle * (high - low).max()], axis=1)
    hits = model.first_hits(rays, fields=("points", "t"))
    return hits.points[np.isfinite(hits.t)]


def main():
    ticks = int(sys.argv[2]) if len(sys.argv) > 2 else 1000
    with planetree.open(sys.argv[1]) as model:
        path = path_of(model, ticks)
    with planetree.open(sys.argv[1], memory="64M") as model:
        probe = model.probe()
        hasty = probe.options(wait=False)
        exact, times = 0, []
        for last, tip in zip(path, path[1:]):
            start = time.perf_counter()
            probe.motion(tip, (tip - last) * 1000)
            nearest = probe.closest_point(tip, hasty)
            times.append(time.perf_counter() - start)
            assert nearest.lower <= nearest.distance <= nearest.upper
            exact += nearest.status == Status.EXACT
            time.sleep(max(0.0, 0.001 - times[-1]))
    print(f"{exact:,} of {len(times):,} ticks exact, the others within an interval")
    print(f"a tick took {1e6 * np.median(times):.0f} us (median)")


if __name__ == "__main__":
    main()
