"""The clock and the options that all drivers share: processor seconds of this process and its children since its start."""

import argparse
import json
import os


def arguments(variants):
    """Options of a driver: what to render, by which method, in how much time, and where to."""
    parser = argparse.ArgumentParser()
    parser.add_argument("--scene", required=True, help="folder with the scene in every engine's format")
    parser.add_argument("--variant", required=True, choices=variants)
    parser.add_argument("--budget", type=float, required=True, help="processor seconds from the start of this process")
    parser.add_argument("--seed", type=int, required=True)
    parser.add_argument("--out", required=True, help="the picture, linear EXR")
    parser.add_argument("--costs", help="JSON file of costs for engines that must choose their samples beforehand")
    parser.add_argument("--calibrate", action="store_true", help="measure those costs and write the file; no picture")
    return parser.parse_args()


def spent():
    """Processor seconds, user and system, of this process and of its children that have ended."""
    times = os.times()
    return times.user + times.system + times.children_user + times.children_system


def affordable(costs, budget, least=1):
    """Whole samples that come nearest to the budget where a picture takes costs = {fixed, each} seconds."""
    return max(least, round((budget - costs["fixed"]) / costs["each"]))


def linear(few, few_seconds, many, many_seconds):
    """The costs {fixed, each} on the line through two measurements."""
    each = (many_seconds - few_seconds) / (many - few)
    return {"fixed": max(0.0, few_seconds - few * each), "each": max(each, 1e-6)}


def report(**facts):
    """The driver's last line, read by the bench: what was done, as one JSON document."""
    print(json.dumps(facts))
