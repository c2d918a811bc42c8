"""One side of a measurement: the package bezier, asked by JSON, answers with its own CPU time."""

import json
import sys
import time

import bezier
import numpy as np


def best_of(work, count, rounds=5):
    best = float("inf")
    for _ in range(rounds):
        start = time.process_time()
        result = work()
        best = min(best, time.process_time() - start)
    return best * 1e9 / count, result


def curve(rows):
    nodes = np.asfortranarray(rows)
    return bezier.Curve(nodes, degree=nodes.shape[1] - 1)


def meetings(pair):
    try:
        return pair[0].intersect(pair[1]).tolist()
    except (NotImplementedError, ValueError):
        return [[], []]


def main():
    question = json.load(sys.stdin)
    if "pairs" in question:
        pairs = [[curve(rows) for rows in pair] for pair in question["pairs"]]
        ns, found = best_of(lambda: [meetings(pair) for pair in pairs], len(pairs), 3)
        print(json.dumps({"ns": ns, "found": found}))
    else:
        whole, parameters = curve(question["points"]), np.array(question["parameters"])
        ns, values = best_of(lambda: whole.evaluate_multi(parameters), len(parameters))
        print(json.dumps({"ns": ns, "values": values.tolist()}))


main()
