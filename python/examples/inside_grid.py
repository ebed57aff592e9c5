"""Which cells of a grid are inside of a model?

    python3 inside_grid.py MODEL.ptree [CELLS_ALONG_EACH_AXIS]

Prints the volume, and the middle slice as text.
"""

import sys

import numpy as np

import planetree
from planetree import Side


def main():
    cells = int(sys.argv[2]) if len(sys.argv) > 2 else 64
    with planetree.open(sys.argv[1], memory="256M") as model:
        grid = model.grid((cells, cells, cells), fields="side")
    inside = grid.side == Side.INSIDE
    spacing = [axis[1] - axis[0] for axis in grid.axes]
    print(f"{inside.sum():,} of {inside.size:,} cells are inside")
    print(f"volume about {inside.sum() * np.prod(spacing):.4g}")
    for row in inside[:, :, cells // 2].T[::-2]:
        print("".join("#" if cell else "." for cell in row))


if __name__ == "__main__":
    main()
