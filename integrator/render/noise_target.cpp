// SPDX-License-Identifier: Apache-2.0
#include "integrator/render/noise_target.h"

#include <algorithm>
#include <bit>
#include <cmath>

namespace petzval {
namespace {

/// Variance that may be there where an estimate hangs on few paths: with half of those that make it
/// known twice as much.
double may_be(double variance, double paths) {
    return variance > 0 ? variance * std::max(1., kKnownPaths / paths) : 0;
}

/// 1 / (mean^2 + floor^2) from the means of two parts, which count alike: a bright sample in one of
/// them must not hide the error that it makes.
double inverse_scale(double a, double b, double floor2) {
    const auto one = [&](double mean) {
        const double scale = mean * mean + floor2;
        return scale > 0 ? 1 / scale : 0;
    };
    return (one(a) + one(b)) / 2;
}

/// Relative squares of a pixel, R, G and B: as SetNoise has them, and of its brightest path.
struct PixelNoise {
    double late = 0, early = 0, largest = 0;
};

PixelNoise pixel_noise(const FilmBlocks::Parts& parts, uint32_t taken, double floor2) {
    PixelNoise out;
    const auto& m = parts.means;
    const double n = std::bit_floor(taken);
    for (int c = 0; c < 3; ++c) {
        const double all = double(m[0][c]), half = double(m[1][c]), rest = 2 * all - half,
                     quarter = double(m[2][c]), scale = inverse_scale(half, rest, floor2) / 3,
                     path = std::max(0., double(parts.largest) - all) / n;
        out.late += (all - half) * (all - half) * scale;
        out.early += (half - quarter) * (half - quarter) * scale;
        out.largest += path * path * scale;
    }
    return out;
}

/// Cell of a pixel along a side: edges lie at side * i / cells.
int cell_at(int px, int side_px, int cells) {
    return static_cast<int>((int64_t{px} * cells + cells - 1) / side_px);
}

}  // namespace

V2i NoiseTarget::cells() const {
    return {std::max(1, frame_px.x / kCell_px), std::max(1, frame_px.y / kCell_px)};
}

Rect NoiseTarget::cell(int i, int j) const {
    const V2i n = cells();
    return {frame_px.x * i / n.x, frame_px.y * j / n.y, frame_px.x * (i + 1) / n.x,
            frame_px.y * (j + 1) / n.y};
}

Rect NoiseTarget::cells_of(const Rect& crop) const {
    const V2i n = cells();
    Rect out{cell_at(crop.x0, frame_px.x, n.x), cell_at(crop.y0, frame_px.y, n.y), 0, 0};
    // A cell holds a pixel if it begins at it or before.
    while (out.x0 > 0 && cell(out.x0, 0).x0 > crop.x0) --out.x0;
    while (out.y0 > 0 && cell(0, out.y0).y0 > crop.y0) --out.y0;
    out.x1 = out.x0 + 1, out.y1 = out.y0 + 1;
    while (out.x1 < n.x && cell(out.x1, 0).x0 < crop.x1) ++out.x1;
    while (out.y1 < n.y && cell(0, out.y1).y0 < crop.y1) ++out.y1;
    return out;
}

Rect NoiseTarget::whole_cells(const Rect& crop) const {
    const Rect n = cells_of(crop), first = cell(n.x0, n.y0), last = cell(n.x1 - 1, n.y1 - 1);
    return {first.x0, first.y0, last.x1, last.y1};
}

// With errors that fall as n^-p the squared difference of a half and all is 2^p - 1 times the
// variance of all: (Owen 1997) p is 1 for independent samples, and more for well spread ones.
namespace {

/// 2^p, from the squares of differences after n and after n / 2 samples.
double growth(double early, double late) {
    return late > 0 ? std::clamp(early / late, 2., 4.) : 2.;
}

/// Variance after n = P or 1.5 P samples over that after P: a set of P and one of P / 2, together.
double after(double growth, uint32_t samples) {
    return std::has_single_bit(samples) ? 1 : (4 + growth) / 9;
}

/// Share of what few pixels say of the growth that is believed: too small a variance stops too
/// early.
constexpr double kBelieved = 0.7;

}  // namespace

double SetNoise::variance(uint32_t samples) const {
    if (taken < kLeastOfCell) return HUGE_VAL;
    const double g = growth(kBelieved * early, late), power = std::log2(g),
                 from = std::bit_floor(taken), to = std::bit_floor(samples);
    return late / (g - 1) * std::pow(from / to, power) * after(g, samples);
}

uint32_t CellNoise::next_count(size_t set, const NoiseTarget& target, uint32_t least) const {
    const uint32_t taken = sets[set].taken;
    if (taken < kLeastOfCell) return kLeastOfCell;
    const SetNoise& other = sets[1 - set];
    const double most = target.noise * target.noise;
    const auto is_enough = [&](uint32_t samples) {
        return samples >= least && may_be(other.variance(samples), other.paths) <= most;
    };
    const uint32_t power = std::bit_floor(taken), between = power + power / 2;
    if (is_enough(taken)) return taken;
    return taken == power && is_enough(between) ? between : 2 * power;
}

bool CellNoise::is_done(const NoiseTarget& target, uint32_t least) const {
    return next_count(0, target, least) == sets[0].taken &&
           next_count(1, target, least) == sets[1].taken;
}

double CellNoise::variance() const {
    return (sets[1].variance(sets[0].taken) + sets[0].variance(sets[1].taken)) / 2;
}

bool CellNoise::is_at_least(const NoiseTarget& target) const {
    const double most = target.noise * target.noise;
    return std::any_of(sets.begin(), sets.end(), [&](const SetNoise& s) {
        return s.taken < kLeastOfCell ||
               (s.paths < kKnownPaths && may_be(s.variance(s.taken), s.paths) > most);
    });
}

CellNoise cell_noise(const Film& film, const Rect& cell, double floor_nits) {
    CellNoise out;
    const double floor2 = floor_nits * floor_nits;
    std::array<double, 2> pixels{}, squares{};
    for (int y = cell.y0; y < cell.y1; ++y)
        for (int x = cell.x0; x < cell.x1; ++x) {
            const auto k = static_cast<size_t>(set_of(x, y));
            SetNoise& set = out.sets[k];
            ++pixels[k];
            set.taken = film.taken_count(x, y);
            if (set.taken < kLeastOfCell) continue;
            const PixelNoise p = pixel_noise(film.parts(x, y), set.taken, floor2);
            set.late += p.late, set.early += p.early;
            // As many paths as the largest fits into the variance, each of its size.
            squares[k] += p.late * std::min(p.late, p.largest);
        }
    for (size_t k = 0; k < 2; ++k) {
        SetNoise& set = out.sets[k];
        set.paths = squares[k] > 0 ? set.late * set.late / squares[k] : 0;
        set.late /= std::max(1., pixels[k]), set.early /= std::max(1., pixels[k]);
    }
    // A cell of one pixel has one set.
    for (size_t k = 0; k < 2; ++k)
        if (pixels[k] == 0) out.sets[k] = out.sets[1 - k];
    return out;
}

NoiseReport noise_report(const Film& film, const NoiseTarget& target, uint32_t most_samples) {
    NoiseReport out;
    out.floor_nits = target.floor_nits;
    double variances = 0, pixels = 0, samples = 0;
    bool known = true;
    const Rect cells = target.cells_of(film.crop());
    for (int j = cells.y0; j < cells.y1; ++j)
        for (int i = cells.x0; i < cells.x1; ++i) {
            const Rect rect = target.cell(i, j);
            const CellNoise cell = cell_noise(film, rect, target.floor_nits);
            const double of_set = double(rect.width()) * double(rect.height()) / 2,
                         noise = std::sqrt(cell.variance());
            variances += 2 * of_set * cell.variance();
            samples += 2 * of_set * cell.samples();
            pixels += 2 * of_set;
            ++out.cells;
            out.worst_cell = std::max(out.worst_cell, noise);
            out.expected_samples += 2 * of_set * cell.samples();
            const uint32_t least = target.least_of(i, j);
            if (cell.is_done(target, least)) continue;
            ++out.left;
            out.open += std::any_of(cell.sets.begin(), cell.sets.end(), [&](const SetNoise& s) {
                const auto set = static_cast<size_t>(&s - cell.sets.data());
                return s.taken < std::min(most_samples, cell.next_count(set, target, least));
            });
            const bool at_least = cell.is_at_least(target);
            out.at_least += at_least;
            known = known && !at_least;
            const double more = noise / target.noise,
                         needed = std::isfinite(more)
                                      ? std::max(more * more * cell.samples(), double(least))
                                      : double(most_samples);
            out.samples_for_all = std::max(out.samples_for_all, needed);
            out.expected_samples +=
                2 * of_set * std::max(0., std::min(needed, double(most_samples)) - cell.samples());
        }
    out.noise = std::sqrt(variances / pixels);
    out.mean_samples = samples / pixels;
    if (!known) out.samples_for_all = 0;
    return out;
}

}  // namespace petzval
