// SPDX-License-Identifier: Apache-2.0
// Very many samples: do errors keep falling?
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <numbers>

#include "core/film/film.h"
#include "tests/stability/sweeps.h"

namespace petzval::stability {
namespace {

constexpr uint32_t kMostSamples = 1u << 22;
constexpr int kSeeds = 4;
constexpr std::array<SamplerKind, 3> kKinds{SamplerKind::Owen, SamplerKind::Sobol,
                                            SamplerKind::Independent};

// Root mean square over seeds of the error of a quarter disk's area, at powers of four from 2^8.
std::vector<double> errors_of(SamplerKind kind) {
    std::vector<double> squares;
    for (uint32_t seed = 0; seed < kSeeds; ++seed) {
        uint32_t inside = 0;
        size_t at = 0;
        uint32_t next = 256;
        for (uint32_t i = 0; i < kMostSamples; ++i) {
            const V2f u = Sampler(kind, seed, {0, 0, i}).get2(Dim::Film);
            inside += u.x * u.x + u.y * u.y < 1.f;
            if (i + 1 != next) continue;
            if (squares.size() <= at) squares.push_back(0);
            squares[at++] += std::pow(double(inside) / next - std::numbers::pi / 4, 2) / kSeeds;
            next *= 4;
        }
    }
    for (double& s : squares) s = std::sqrt(s);
    return squares;
}

// Cells of 256 x 256 without a point, of the 65536 points from an index on.
uint32_t empty_cells(SamplerKind kind, uint32_t first) {
    std::vector<bool> taken(1u << 16);
    for (uint32_t i = 0; i < 1u << 16; ++i) {
        const V2f u = Sampler(kind, 1, {0, 0, first + i}).get2(Dim::Film);
        taken[static_cast<size_t>(u.y * 256) * 256 + static_cast<size_t>(u.x * 256)] = true;
    }
    return static_cast<uint32_t>(std::count(taken.begin(), taken.end(), false));
}

}  // namespace

Finding many_samples() {
    Finding f{.method = "Sample counts"};
    f.sweep = fmt::format(
        "Root mean square error of a quarter disk's area, 0.785, over {} seeds, from 2^8 to 2^22 "
        "samples of one dimension; and how many cells of 256 x 256 the 65536 points from an index "
        "on leave empty, up to the last index, 2^32 - 1.",
        kSeeds);
    f.table.columns = {
        "samples or first index", "Owen", "Sobol", "independent", "empty by Owen", "empty by Sobol",
        "empty by independent"};
    std::array<std::vector<double>, 3> errors;
    for (size_t k = 0; k < 3; ++k) errors[k] = errors_of(kKinds[k]);
    for (size_t i = 0; i < errors[0].size(); ++i) {
        const uint32_t n = 256u << (2 * i);
        std::vector<std::string> cells =
            row(fmt::format("2^{}", 8 + 2 * i), errors[0][i], errors[1][i], errors[2][i]);
        for (const SamplerKind kind : kKinds)
            cells.push_back(n < 65536 ? "" : std::to_string(empty_cells(kind, n)));
        f.table.rows.push_back(cells);
    }
    uint32_t empty = 0;
    for (const uint32_t first : {1u << 24, 1u << 31, 0xffff0000u}) {
        std::vector<std::string> cells = row(first == 0xffff0000u ? "2^32 - 2^16"
                                             : first == 1u << 31  ? "2^31"
                                                                  : "2^24",
                                             "", "", "");
        for (const SamplerKind kind : kKinds)
            cells.push_back(std::to_string(empty_cells(kind, first)));
        empty += empty_cells(SamplerKind::Owen, first);
        f.table.rows.push_back(cells);
    }
    // Exponent of the error in the samples, from 2^16 to 2^22.
    const auto slope = [&](size_t k) {
        return std::log(errors[k].back() / errors[k][4]) / std::log(64.);
    };
    const bool falls = slope(0) < -0.55 && slope(1) < -0.5 && empty == 0;
    f.fails = falls ? "nothing" : "error stops falling";
    f.where = fmt::format(
        "From 2^16 to 2^22 samples errors go as n to the power {:.2f} (Owen), {:.2f} (Sobol), "
        "{:.2f} (independent); no cell stays empty up to 2^32 samples",
        slope(0), slope(1), slope(2));
    if (empty > 0) f.where += " but for " + std::to_string(empty);
    f.instead =
        "Indices are 32 bits, and so are the points before they become floats of 24: from "
        "2^24 samples on a dimension repeats its numbers, to 6e-8.";
    return f;
}

namespace {

constexpr Rect kOnePixel{0, 0, 1, 1};

FilmSample grey(float a) {
    FilmSample s;
    s.colour = Rgb(a);
    s.alpha = 1;
    return s;
}

}  // namespace

Finding film_sums() {
    Finding f{.method = "Sums of films"};
    f.sweep =
        "One pixel of a spectral film that gets n samples of 1 plus an even random number from "
        "-0.1 to 0.1: error of its mean against exact sums, and the standard error that it states, "
        "from its eight replicates, over the one of exact sums.";
    f.table.columns = {"n", "error of the mean", "stated / exact standard error"};
    Film film({1, 1}, kOnePixel, {}, Bins{380, 50, 7});
    Bands bands = Bands::rgb();
    bands.nm = f4{450, 550, 650, 700};
    std::array<double, kReplicates> exact{};
    double worst_mean = 0, worst_error = 1;
    std::string worst_at = "none";
    Draws draws(23);
    uint32_t next = 256;
    for (uint32_t i = 0; i < 1u << 24; ++i) {
        const float a = 0.9f + 0.2f * draws.next();
        film.add(0, 0, i, grey(a), {i % kReplicates, splat(a), V3f(a)}, bands);
        exact[i % kReplicates] += double(a);
        if (i + 1 != next) continue;
        double sum = 0, squares = 0;
        for (const double s : exact) sum += s;
        for (const double s : exact) squares += std::pow(s / (next / kReplicates) - sum / next, 2);
        const double error = std::sqrt(squares / (kReplicates * (kReplicates - 1)));
        const double off = std::fabs(double(film.colour(0, 0).x) - sum / next);
        const double ratio = double(film.spectral()->standard_error(0, {0, next}).x) / error;
        add_row(f, fmt::format("2^{}", std::lround(std::log2(next))), off, ratio);
        worst_mean = std::fmax(worst_mean, off);
        if (std::fabs(ratio - 1) > std::fabs(worst_error - 1))
            worst_error = ratio, worst_at = f.table.rows.back()[0];
        next *= 4;
    }
    const bool holds = std::fabs(worst_error - 1) < 0.1;
    f.fails = holds ? "nothing" : "bias of the stated error";
    f.where = fmt::format(
        "The mean is within {} up to 2^24 samples; the stated standard error is at worst {} times "
        "the exact one, at n = {}",
        number(worst_mean), number(worst_error), worst_at);
    f.instead =
        "Sums are exact: each sample is rounded once, to a multiple of 2^-48, and integers are "
        "added.";
    return f;
}

}  // namespace petzval::stability
