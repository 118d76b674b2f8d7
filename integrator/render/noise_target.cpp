// SPDX-License-Identifier: Apache-2.0
#include "integrator/render/noise_target.h"

#include <algorithm>
#include <bit>
#include <cmath>

namespace petzval::integrator {
namespace {

/// Variance that may be there where an estimate hangs on few paths: on one four times as much.
/// Where that is so, only one path is met in 9 cells of 100, and 8 or fewer of 11 in 20 (Poisson).
double may_be(double variance, double paths) {
    return variance > 0 ? variance * std::sqrt(std::max(1., kKnownPaths / paths)) : 0;
}

double square(double a) {
    return a * a;
}

/// Relative squares of a pixel, R, G and B: as SetNoise has them, and of its brightest path.
struct PixelNoise {
    double early = 0, late = 0, last = 0, largest = 0;
};

/// Mean of the samples but the brightest one, over that of all: a bright sample must not hide the
/// error that it makes.
double share_of_others(const FilmBlocks::Parts& parts, double taken) {
    const double mean = std::max({parts.all.x, parts.all.y, parts.all.z}), sum = mean * taken;
    if (!(sum > 0)) return 1;
    return std::clamp((1 - double(parts.largest) / sum) * taken / (taken - 1), 0., 1.);
}

PixelNoise pixel_noise(const FilmBlocks::Parts& parts, uint32_t taken, double floor2) {
    PixelNoise out;
    const auto& m = parts.means;
    const double n = std::bit_floor(taken), others = share_of_others(parts, taken);
    for (int c = 0; c < 3; ++c) {
        const double all = double(parts.all[c]), power = double(m[0][c]), half = double(m[1][c]),
                     quarter = double(m[2][c]), scale2 = square(all * others) + floor2,
                     scale = scale2 > 0 ? 1 / scale2 / 3 : 0,
                     path = std::max(0., double(parts.largest) - all) / n;
        out.early += square(half - quarter) * scale;
        out.late += square(power - half) * scale;
        out.last += square(all - power) * scale;
        out.largest += path * path * scale;
    }
    return out;
}

// With errors that fall as n^-p the squared difference of a half and all is 2^p - 1 times the
// variance of all: p is 1 for independent samples, and more for well spread ones (Owen 1997,
// "Scrambled net variance for integrals of smooth functions").

/// 2^p, from the squares of differences after n and after n / 2 samples; p is at most 3, which
/// smooth light has.
double growth_of(double early, double late) {
    return late > 0 ? std::clamp(early / late, 2., 8.) : 2.;
}

/// Variance of a mean of blocks of samples over that of a block of `power`: each bit of `bits` is a
/// block of so many samples, which count as they are many among `samples`.
double of_blocks(double growth, uint32_t bits, uint32_t samples, uint32_t power) {
    double sum = 0;
    for (; bits != 0; bits -= std::bit_floor(bits)) {
        const double block = std::bit_floor(bits), share = block / samples;
        sum += share * share * std::pow(growth, std::log2(power / block));
    }
    return sum;
}

/// Share of what so many pixels say of the growth that is believed: a growth that seems larger than
/// it is stops too early. A sum of squares that hangs on n pixels is off by a share of 1 / sqrt(n),
/// and the ratio of two by sqrt(2) times as much; sqrt(2) of that is allowed for.
double believed(double pixels) {
    return pixels > 0 ? std::exp(-2 / std::sqrt(pixels)) : 0;
}

}  // namespace

double SetNoise::growth() const {
    return growth_of(believed(pixels) * early, late);
}

double SetNoise::variance(uint32_t samples, double g) const {
    if (taken < kLeastOfCell) return HUGE_VAL;
    const uint32_t power = std::bit_floor(taken), rest = taken - power;
    const double more = double(rest) / taken,
                 of_last = more * more + of_blocks(g, rest, taken, power),
                 of_power = (late + last) / (g - 1 + of_last);
    return of_power * of_blocks(g, samples, samples, power);
}

double SetNoise::needed(double most_variance) const {
    const double more = may_be(variance(taken), paths) / most_variance;
    if (!(more > 1)) return taken;
    // With more samples more paths are met too, as many as there are samples.
    const double falls = std::log2(growth()) + (paths < kKnownPaths ? 0.5 : 0);
    return taken * std::pow(more, 1 / falls);
}

uint32_t CellNoise::next_count(size_t set, const NoiseTarget& target, uint32_t least) const {
    const uint32_t taken = sets[set].taken;
    if (taken < kLeastOfCell) return kLeastOfCell;
    const SetNoise& other = sets[1 - set];
    const double most = target.noise * target.noise;
    const auto is_enough = [&](uint32_t samples) {
        return samples >= least && may_be(other.variance(samples), other.paths) <= most;
    };
    const uint32_t power = std::bit_floor(taken);
    uint32_t count = taken;
    while (count < 2 * power && !is_enough(count))
        count = std::min(2 * power, count + power / kStepsOfCell);
    return count;
}

CellStep CellNoise::next_step(const NoiseTarget& target, uint32_t least, uint32_t most) const {
    for (const int set : {0, 1})
        if (const SetNoise& s = sets[static_cast<size_t>(set)]; s.begun > s.taken)
            return {set, s.begun};
    const int first = sets[1].taken < sets[0].taken ? 1 : 0;
    for (const int set : {first, 1 - first}) {
        const auto k = static_cast<size_t>(set);
        const uint32_t end = std::min(most, next_count(k, target, least));
        if (end > sets[k].taken) return {set, end};
    }
    return {};
}

bool CellNoise::is_done(const NoiseTarget& target, uint32_t least) const {
    return next_count(0, target, least) == sets[0].taken &&
           next_count(1, target, least) == sets[1].taken;
}

double CellNoise::decided_variance() const {
    return (sets[1].variance(sets[0].taken) + sets[0].variance(sets[1].taken)) / 2;
}

bool CellNoise::is_at_least(const NoiseTarget& target, bool done) const {
    const double most = target.noise * target.noise;
    if (done) {
        double sum = 0, squares = 0;
        for (const SetNoise& s : sets) {
            const double variance = s.variance(s.taken);
            sum += variance;
            if (s.paths > 0) squares += variance * variance / s.paths;
        }
        return sum / 2 > most && sum * sum < kKnownPaths * squares;
    }
    return std::any_of(sets.begin(), sets.end(), [&](const SetNoise& s) {
        return s.taken < kLeastOfCell ||
               (s.paths < kKnownPaths && may_be(s.variance(s.taken), s.paths) > most);
    });
}

CellNoise cell_noise(const Film& film, const Rect& cell, double floor_nits) {
    CellNoise out;
    const double floor2 = floor_nits * floor_nits;
    std::array<double, 2> pixels{}, squares{}, path_squares{};
    for (int y = cell.y0; y < cell.y1; ++y)
        for (int x = cell.x0; x < cell.x1; ++x) {
            const auto k = static_cast<size_t>(set_of(x, y));
            SetNoise& set = out.sets[k];
            ++pixels[k];
            const uint32_t taken = film.taken_count(x, y);
            set.taken = pixels[k] == 1 ? taken : std::min(set.taken, taken);
            set.begun = std::max(set.begun, taken);
            if (taken < kLeastOfCell) continue;
            const PixelNoise p = pixel_noise(film.parts(x, y), taken, floor2);
            set.early += p.early, set.late += p.late, set.last += p.last;
            // As many paths as the largest fits into the variance, each of its size.
            const double both = p.late + p.last;
            path_squares[k] += both * std::min(both, p.largest);
            squares[k] += both * both;
        }
    for (size_t k = 0; k < 2; ++k) {
        SetNoise& set = out.sets[k];
        const double both = set.late + set.last;
        const auto kish = [&](double sum) { return sum > 0 ? both * both / sum : 0; };
        set.paths = kish(path_squares[k]), set.pixels = kish(squares[k]);
        for (double* sum : {&set.early, &set.late, &set.last}) *sum /= std::max(1., pixels[k]);
    }
    // A cell of one pixel has one set.
    for (size_t k = 0; k < 2; ++k)
        if (pixels[k] == 0) out.sets[k] = out.sets[1 - k];
    return out;
}

NoiseReport noise_report(const Film& film, const NoiseTarget& target, uint32_t most_samples) {
    const Rect cells = target.cells_of(film.crop());
    std::vector<CellNoise> found;
    for (int j = cells.y0; j < cells.y1; ++j)
        for (int i = cells.x0; i < cells.x1; ++i)
            found.push_back(cell_noise(film, target.cell(i, j), target.floor_nits));
    return noise_report(found, cells, target, most_samples);
}

namespace {

/// Growths of a picture by the number of samples, from all its sets together. What a single set may
/// believe would make a picture noisier than it is.
class Growths {
  public:
    explicit Growths(const std::vector<CellNoise>& cells) {
        for (const CellNoise& cell : cells)
            for (const SetNoise& set : cell.sets) {
                if (set.taken < kLeastOfCell || !(set.pixels > 0)) continue;
                Level& level = levels_[level_of(set)];
                level.early += set.early, level.late += set.late;
                level.squares += set.late * set.late / set.pixels;
            }
    }
    [[nodiscard]] double of(const SetNoise& set) const {
        const Level& level = levels_[level_of(set)];
        const double pixels = level.squares > 0 ? level.late * level.late / level.squares : 0;
        return growth_of(believed(pixels) * level.early, level.late);
    }
    /// As of(), but for what 4, 8 and 16 samples say: it tells little of how errors fall later.
    [[nodiscard]] double cautious(const SetNoise& set) const {
        return set.taken < 2 * kLeastOfCell ? std::min(kMostAtFirst, of(set)) : of(set);
    }

  private:
    /// 2^1.5. Twelve scenes of others had at most 2^1.4 there; in boxes lit by spectra it looked
    /// like 2^3 where it was 2^1.3.
    static constexpr double kMostAtFirst = 2.83;
    struct Level {
        double early = 0, late = 0, squares = 0;
    };
    [[nodiscard]] static size_t level_of(const SetNoise& set) {
        return static_cast<size_t>(std::bit_width(set.taken));
    }
    std::array<Level, 33> levels_{};
};

}  // namespace

NoiseReport noise_report(const std::vector<CellNoise>& found, const Rect& cells,
                         const NoiseTarget& target, uint32_t most_samples) {
    NoiseReport out;
    const Growths growths(found);
    out.floor_nits = target.floor_nits;
    double variances = 0, cautious = 0, pixels = 0, samples = 0;
    bool known = true;
    auto next = found.begin();
    for (int j = cells.y0; j < cells.y1; ++j)
        for (int i = cells.x0; i < cells.x1; ++i) {
            const Rect rect = target.cell(i, j);
            const CellNoise& cell = *next++;
            const double of_set = double(rect.width()) * double(rect.height()) / 2,
                         noise = std::sqrt(cell.decided_variance());
            for (const SetNoise& set : cell.sets) {
                const double plain = set.variance(set.taken, growths.of(set));
                variances += of_set * plain;
                // Between two powers of two slower growth may mean less variance.
                cautious +=
                    of_set * std::max(plain, set.variance(set.taken, growths.cautious(set)));
            }
            samples += 2 * of_set * cell.samples();
            pixels += 2 * of_set;
            ++out.cells;
            out.worst_cell = std::max(out.worst_cell, noise);
            out.expected_samples += 2 * of_set * cell.samples();
            const uint32_t least = target.least_of(i, j);
            const bool done = cell.is_done(target, least),
                       at_least = cell.is_at_least(target, done);
            if (done && !at_least) continue;
            ++out.left;
            out.open += cell.next_step(target, least, most_samples).end > 0;
            out.at_least += at_least;
            known = known && !at_least;
            if (done) continue;
            for (size_t k = 0; k < 2; ++k) {
                const double needed =
                    std::max(cell.sets[1 - k].needed(target.noise * target.noise), double(least));
                out.samples_for_all = std::max(out.samples_for_all, needed);
                out.expected_samples +=
                    of_set *
                    std::max(0., std::min(needed, double(most_samples)) - cell.sets[k].taken);
            }
        }
    // Caution alone does not lift a picture above a target that all its cells have reached.
    const double most = pixels * target.noise * target.noise;
    if (out.left == 0) cautious = std::min(cautious, std::max(variances, most));
    out.noise = std::sqrt(cautious / pixels);
    out.worst_cell = std::max(out.worst_cell, out.noise);
    out.mean_samples = samples / pixels;
    if (!known || !std::isfinite(out.samples_for_all)) out.samples_for_all = 0;
    return out;
}

}  // namespace petzval::integrator
