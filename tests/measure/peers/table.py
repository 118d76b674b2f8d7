# SPDX-License-Identifier: Apache-2.0
"""The tables of bench.py and until.py, Petzval over each peer, the worst row first, and of efficiency.py."""
import math

import numpy

import noise

HEAD = ("scene", "speed", "error", "efficiency", "error, trimmed", "efficiency, trimmed", "error, typical pixel",
        "efficiency from start to file", "brightness")


def average(values):
    return sum(values) / len(values)


def efficiency(ours, theirs, cost, measure):
    """Efficiency of ours over theirs, 1 / (error x CPU time), with the interval that leaving seeds out gives."""
    def of_seed(i):
        def one(p):
            # Seeds without a cost of their own keep the average of all.
            spent = p[cost] if i is None or i >= len(p[cost]) or len(p[cost]) == 1 else p[cost][:i] + p[cost][i + 1:]
            return average(spent) * (p["all"] if i is None else p["without"][i])[measure]
        return one(theirs) / one(ours)
    return noise.jackknife(of_seed(None), [of_seed(i) for i in range(len(ours["without"]))])


def ratios(ours, theirs):
    """All ratios of one row; above 1 Petzval is better."""
    out = {"speed": average(theirs["sample_cpu_s"]) / average(ours["sample_cpu_s"]),
           "brightness": ours["mean"] / theirs["mean"]}
    for measure in noise.MEASURES:
        out["error " + measure] = theirs["all"][measure] / ours["all"][measure]
        out["efficiency " + measure] = efficiency(ours, theirs, "sample_cpu_s", measure)
    out["efficiency whole"] = efficiency(ours, theirs, "whole_cpu_s", "plain")
    return out


def new_over_old(old, new):
    """Ratios of two programs over the same number of seeds, with intervals: CPU time and errors (below 1 the new one
    is better), efficiency (above 1), and brightness."""
    def cost(i):
        return sum(numpy.delete(new["cpu_s"], i)) / sum(numpy.delete(old["cpu_s"], i))
    without = range(len(new["without"]))
    out = {"CPU time": noise.jackknife(cost([]), [cost(i) for i in without]), "brightness": new["mean"] / old["mean"]}
    for measure in noise.MEASURES:
        out["error " + measure] = noise.jackknife(new["all"][measure] / old["all"][measure], [
            new["without"][i][measure] / old["without"][i][measure] for i in without])
        out["efficiency " + measure] = efficiency(new, old, "cpu_s", measure)
    return out


def shown(ratio):
    if ratio["low"] is None:
        return "%.3g" % ratio["ratio"]
    return "%.3g (%.3g to %.3g)" % (ratio["ratio"], ratio["low"], ratio["high"])


def line(name, r):
    return "| %s |" % " | ".join((
        name, "%.3g" % r["speed"], "%.3g" % r["error plain"], shown(r["efficiency plain"]), "%.3g" % r["error trimmed"],
        shown(r["efficiency trimmed"]), "%.3g" % r["error typical"], shown(r["efficiency whole"]),
        "%.3f" % r["brightness"] if "brightness" in r else ""))


def mean_of(rows):
    """The geometric mean of every column over the rows; brightness has none."""
    out = {}
    for key, value in rows[0].items():
        if isinstance(value, dict):
            out[key] = noise.geometric_mean([r[key] for r in rows])
        elif key != "brightness":
            out[key] = noise.geometric_mean([{"ratio": r[key], "log_error": None} for r in rows])["ratio"]
    return out


def converged(done, name):
    """Errors by variance over errors against the program's own converged picture, where that was rendered."""
    found = ["%s %.2f" % (row, programs[name]["all"]["trimmed"] / programs[name]["against_reference"]["trimmed"])
             for row, programs in done.items() if "against_reference" in programs[name]]
    return "Trimmed error by variance over that against its converged picture, %s: %s\n" % (
        name, ", ".join(found)) if found else ""


def markdown(done, names):
    """One table for each peer."""
    ours, peers = names[0], names[1:]
    text = ""
    for peer in peers:
        rows = {name: ratios(p[ours], p[peer]) for name, p in done.items()}
        order = sorted(rows, key=lambda name: rows[name]["efficiency plain"]["ratio"])
        text += "Petzval over %s\n\n| %s |\n|%s\n" % (peer, " | ".join(HEAD), "---|" * len(HEAD))
        text += "".join(line(name, rows[name]) + "\n" for name in order)
        text += line("geometric mean", mean_of(list(rows.values()))) + "\n"
        text += line("worst row: " + order[0], rows[order[0]]) + "\n\n"
    return text + "".join(converged(done, name) for name in names)


def cpu_s_at(wanted, points, which):
    """CPU time at that error, on the line through the points about it in logarithms, and whether it is known. Where no
    point reached it, it is as if the error went on to fall as 1 / sqrt(time); where all did, it is at most that."""
    after = next((i for i, p in enumerate(points) if p[which] <= wanted), None)
    if after is None:
        return points[-1]["cpu_s"] * (points[-1][which] / wanted) ** 2, "about "
    if after == 0:
        return points[0]["cpu_s"], "at most "
    a, b = points[after - 1], points[after]
    share = math.log(a[which] / wanted) / math.log(a[which] / max(b[which], wanted / 8))
    return a["cpu_s"] * (b["cpu_s"] / a["cpu_s"]) ** share, ""


def until(rows, wanted):
    """The table of until.py: CPU times to the error, the worst row first. Without denoising each program has its way to
    a noise, or equal samples where they are quicker."""
    def times(numbers, which):
        found = {}
        for name, p in numbers.items():
            def is_known(point):  # to a fifth: single pixels may hold the error
                return which == "trimmed" or point["deviation_of_square"] < .4 * point["all"] ** 2
            ways = [cpu_s_at(wanted, p["points"], which)] if is_known(p["points"][-1]) else []
            if name != "petzval denoised" and is_known(p["even"]):
                ways.append((p["even"]["cpu_s"] * (p["even"][which] / wanted) ** 2, "about "))
            found[name] = min(ways, default=(math.nan, ""))
        return found["petzval denoised"], found["petzval"], found["cycles"]

    lines = []
    for name, numbers in rows.items():
        cells, ratios = ["%s%.3g s" % (known, cpu_s) for cpu_s, known in times(numbers, "all")], []
        for which in ("all", "trimmed"):
            (denoised, _), (plain, _), (cycles, _) = times(numbers, which)
            ratios.append(cycles / denoised)
            cells.append("%.2g, %.2g" % (cycles / plain, cycles / denoised))
        lines.append((ratios[0] if ratios[0] > 0 else 0, "| %s | %s |" % (name, " | ".join(cells))))
    head = ("| view | Petzval denoised | Petzval | Cycles, not denoised | Cycles over Petzval, and over it denoised | "
            "without the worst 0.1 % of the pixels |\n|" + "---|" * 6 + "\n")
    return (head + "\n".join(line for _, line in sorted(lines)) + "\n").replace("nan s", "?").replace("nan", "?")
