"""How far does a scan deviate from its model?

    python3 deviation.py MODEL.ptree [POINTS.npy]

Without points it makes some: points of the model, moved by up to 1 % of its size.
"""

import sys

import numpy as np

import planetree


def some_points(model, count=100_000):
    """Points near the surface of a model."""
    low, high = model.info["core"]
    random = np.random.default_rng(1)
    on_surface = model.closest_points(random.uniform(low, high, (count, 3)), fields="points").points
    return on_surface + random.normal(0, 0.002, (count, 3)) * (high - low).max()


def main():
    with planetree.open(sys.argv[1], memory="256M") as model:
        points = np.load(sys.argv[2]) if len(sys.argv) > 2 else some_points(model)
        deviation = model.deviation(points)
    low, high = deviation.greatest
    print(f"{len(points):,} points")
    print(f"mean {deviation.mean:+.6g}, root mean square {deviation.rms:.6g}")
    print(f"the greatest deviation is certainly between {low:.6g} and {high:.6g}")
    for share, at in zip((5, 50, 95), deviation.percentiles((5, 50, 95))):
        print(f"{share:3} % of the points deviate by less than {at:+.6g}")


if __name__ == "__main__":
    main()
