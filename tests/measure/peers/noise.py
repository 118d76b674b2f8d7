# SPDX-License-Identifier: Apache-2.0
"""Noise of pictures: from their variance over seeds, with intervals, and against pictures of other seeds."""
import math

import numpy

DARK_SHARE, TRIMMED_SHARE = .01, .001
SKY_ERROR = 1e-5  # what is noisier than 0.3 % shows the scene: pixels of mere sky are at 1e-6 and below
# 97.5 % points of Student's t by degrees of freedom.
STUDENT = (12.706, 4.303, 3.182, 2.776, 2.571, 2.447, 2.365, 2.306, 2.262, 2.228, 2.201, 2.179, 2.160, 2.145, 2.131)
MEASURES = ("plain", "trimmed", "typical")


def pixel_errors(pictures):
    """Relative variance of each pixel: the unbiased variance over seeds of r, g, b, summed, over the squared mean
    over seeds, summed, plus a hundredth of the picture's squared mean. `pictures` is (seeds, pixels, 3)."""
    mean = pictures.mean(0, dtype=float)
    dark = DARK_SHARE * (mean.mean(0) ** 2).sum()
    return pictures.var(0, ddof=1, dtype=float).sum(-1) / ((mean ** 2).sum(-1) + dark)


def summaries(errors):
    """Mean of the pixels' errors; the same without the largest 0.1 %; and the median of those above SKY_ERROR."""
    ordered = numpy.sort(errors)
    kept = ordered[:len(ordered) - math.ceil(TRIMMED_SHARE * len(ordered))]
    shown = ordered[numpy.searchsorted(ordered, SKY_ERROR):]
    return {"plain": ordered.mean(), "trimmed": kept.mean(), "typical": numpy.median(shown if len(shown) else ordered)}


def with_each_left_out(measure, pictures):
    """What `measure` says of the pictures of all seeds, and with each seed left out."""
    pictures = numpy.asarray(pictures)
    out = {"all": measure(pictures), "without": []}
    if len(pictures) > 2:
        out["without"] = [measure(numpy.delete(pictures, i, 0)) for i in range(len(pictures))]
    return out


def noise(pictures):
    """Errors of one program by their variance: of all seeds, and with each seed left out."""
    return with_each_left_out(lambda some: summaries(pixel_errors(some)), pictures)


def error_against(pictures, reference):
    """Mean over seeds of the relative squared error against a converged picture; weights as in pixel_errors()."""
    dark = DARK_SHARE * (reference.mean(0) ** 2).sum()
    squares = ((numpy.asarray(pictures, float) - reference) ** 2).mean(0).sum(-1)
    return summaries(squares / ((reference ** 2).sum(-1) + dark))


def surroundings(picture):
    """Mean of the 7 x 7 pixels about each pixel of (height, width, 3), as far as they lie in the picture."""
    def windows(values):
        sums = numpy.pad(values.cumsum(0).cumsum(1), ((1, 0), (1, 0), (0, 0)))
        rows, columns = (numpy.arange(n) for n in values.shape[:2])
        y0, y1 = (rows - 3).clip(0), (rows + 4).clip(None, values.shape[0])
        x0, x1 = (columns - 3).clip(0), (columns + 4).clip(None, values.shape[1])
        return sums[y1][:, x1] - sums[y0][:, x1] - sums[y1][:, x0] + sums[y0][:, x0]
    return windows(picture) / windows(numpy.ones_like(picture))


def floor_of(picture):
    """A quarter of the mid-grey: of the log-average of the luminance, weighted by its cube root."""
    light = (picture @ (.2126, .7152, .0722)).ravel()
    light = light[light > 0]
    if not len(light):
        return 0.
    return .25 * math.exp((numpy.cbrt(light) * numpy.log(light)).sum() / numpy.cbrt(light).sum())


def scale_of(truth):
    """What squared errors are divided by: m^2 + f^2 of `petzval render --denoise`, (height, width, 3)."""
    return numpy.maximum(surroundings(truth) ** 2 + floor_of(truth) ** 2, 1e-30)


def roots(squares):
    """Root of the mean of (height, width) squares, and without the 0.1 % of the pixels that are farthest from 0, with
    the standard error of the mean, from blocks of 16 x 16. What is below it counts as large as it."""
    rows, columns = (n // 16 * 16 for n in squares.shape)
    blocks = squares[:rows, :columns].reshape(rows // 16, 16, columns // 16, 16).mean((1, 3)).ravel()
    deviation = blocks.std(ddof=1) / math.sqrt(len(blocks))
    flat = squares.ravel()
    kept = flat[numpy.argsort(abs(flat))][:len(flat) - math.ceil(TRIMMED_SHARE * len(flat))]
    return {"all": math.sqrt(max(flat.mean(), deviation)), "trimmed": math.sqrt(max(kept.mean(), 0)),
            "deviation_of_square": deviation}


def true_error(pictures, first, second):
    """roots() of the errors of pictures, without the noise of the two others that they are held against."""
    scale = scale_of((first + second) / 2)
    return roots(numpy.mean([((p - first) * (p - second) / scale).mean(-1) for p in pictures], 0))


def error_of_each(first, second):
    """roots() of the error of either of two pictures of the same samples, by their difference."""
    return roots(((first - second) ** 2 / 2 / scale_of((first + second) / 2)).mean(-1))


def student(freedom):
    """The 97.5 % point of Student's t; beyond the table, its last value."""
    return STUDENT[min(max(int(freedom), 1), len(STUDENT)) - 1]


def interval(value, error, freedom):
    """The ratio with its 95 % interval, from the standard error of its logarithm."""
    reach = math.exp(student(freedom) * error)
    return {"ratio": value, "low": value / reach, "high": value * reach, "log_error": error, "freedom": freedom}


def jackknife(value, without):
    """The ratio with its 95 % interval: the jackknife of its logarithm (Efron and Stein 1981), Student's t."""
    n = len(without)
    if n < 3:
        return {"ratio": value, "low": None, "high": None, "log_error": None}
    logs = numpy.log(without)
    return interval(value, math.sqrt((n - 1) / n * ((logs - logs.mean()) ** 2).sum()), n - 1)


def geometric_mean(ratios):
    """The geometric mean of jackknife() results of independent rows, with its 95 % interval.

    Degrees of freedom of a sum of variances: Welch 1947, Satterthwaite 1946."""
    value = math.exp(sum(math.log(r["ratio"]) for r in ratios) / len(ratios))
    if any(not r["log_error"] for r in ratios):
        return {"ratio": value, "low": None, "high": None, "log_error": None}
    squares = [r["log_error"] ** 2 for r in ratios]
    freedom = sum(squares) ** 2 / sum(s ** 2 / r["freedom"] for s, r in zip(squares, ratios))
    return interval(value, math.sqrt(sum(squares)) / len(ratios), freedom)
