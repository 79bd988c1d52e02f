"""Says whether a small picture agrees with the reference: its brightness, and whether it lies pixel on pixel."""

import argparse
import json

import numpy as np

import pixels

# Sides of the blocks whose brightness is compared. The median over blocks forgives noise, fireflies and black spheres.
BLOCK = 8


def shrink(image, factor):
    height, width = image.shape[0] // factor, image.shape[1] // factor
    cut = image[: height * factor, : width * factor]
    return cut.reshape(height, factor, width, factor, -1).mean(axis=(1, 3))


def brightness(picture, reference, counted):
    """Median over whole counted blocks of the ratio of their means."""
    whole = shrink(counted[..., None].astype(np.float64), BLOCK)[..., 0] == 1.0
    ours, theirs = (shrink(image, BLOCK).mean(axis=-1)[whole] for image in (picture, reference))
    lit = theirs > 0.005
    return float(np.median(ours[lit] / theirs[lit]))


def offset(picture, reference, counted):
    """The shift (right, down), -1 to 1 each, at which the picture fits the reference best."""
    # Logarithms keep lamps and fireflies from deciding.
    ours, theirs = (np.log(0.01 + np.maximum(image, 0.0)) for image in (picture, reference))
    inside = counted[1:-1, 1:-1]
    best = None
    for down in (-1, 0, 1):
        for right in (-1, 0, 1):
            moved = np.roll(ours, (-down, -right), axis=(0, 1))
            error = np.median(np.abs(moved - theirs).mean(axis=-1)[1:-1, 1:-1][inside & edges(theirs)])
            if best is None or error < best[0]:
                best = (error, right, down)
    return [best[1], best[2]]


def edges(image):
    """The tenth of the inner pixels at which the picture changes most: there a shift shows."""
    flat = image.mean(axis=-1)
    change = np.abs(np.gradient(flat)[0]) + np.abs(np.gradient(flat)[1])
    inner = change[1:-1, 1:-1]
    return inner >= np.quantile(inner, 0.9)


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("--picture", required=True)
    parser.add_argument("--reference", required=True)
    parser.add_argument("--counted", required=True)
    options = parser.parse_args()
    picture = pixels.read_exr(options.picture).astype(np.float64)
    reference = pixels.read_exr(options.reference).astype(np.float64)
    factor = reference.shape[0] // picture.shape[0]
    mask = pixels.read_mask(options.counted)[..., None].astype(np.float64)
    counted = shrink(mask, factor)[..., 0] == 1.0
    reference = shrink(reference, factor)
    print(
        json.dumps(
            {
                "brightness": brightness(picture, reference, counted),
                "offset": offset(picture, reference, counted),
            }
        )
    )


main()
