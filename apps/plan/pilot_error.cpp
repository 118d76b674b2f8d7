// SPDX-License-Identifier: Apache-2.0
#include "apps/plan/pilot_error.h"

#include <algorithm>
#include <cmath>

#include "core/spectrum/bands.h"
#include "io/image/symmetric_mse.h"

namespace petzval::apps {
namespace {

constexpr size_t kChannels = 3;

/// Pair of replicates, and the two that are left for the scale.
struct Pair {
    size_t i, j, k, l;
};
constexpr std::array<Pair, 6> kPairs{
    {{0, 1, 2, 3}, {2, 3, 0, 1}, {0, 2, 1, 3}, {1, 3, 0, 2}, {0, 3, 1, 2}, {1, 2, 0, 3}}};

double component(const V3d& v, size_t channel) {
    return v[static_cast<int>(channel)];
}

/// 1 / (mean square of the two pictures + floor^2) in a pixel, from two replicates. Noise makes the
/// mean of squares too large, and the mean of its inverse larger still: both to second order.
double inverse_scale(const PilotValues& a, const PilotValues& b, const Pair& pair, size_t channel,
                     double least, double floor) {
    const double ak = component(a[pair.k], channel), al = component(a[pair.l], channel);
    const double bk = component(b[pair.k], channel), bl = component(b[pair.l], channel);
    double mean_a = (ak + al) / 2, mean_b = (bk + bl) / 2;
    double off_a = (ak - al) / 2, off_b = (bk - bl) / 2;
    if (mean_a < least) mean_a = least, off_a = 0;
    if (mean_b < least) mean_b = least, off_b = 0;
    const double scale = (mean_a * mean_a + mean_b * mean_b) / 2 + floor * floor;
    if (!(scale > 0)) return 0;
    const double too_large = (off_a * off_a + off_b * off_b) / 2;
    const double slope = mean_a * off_a + mean_b * off_b;
    return 1 / std::max(scale + slope * slope / scale - too_large, scale / 2);
}

/// Symmetric square from which on a pixel's own brightness is doubted: light that few replicates
/// met makes the others look dark.
constexpr double kDoubtful = 8;
/// Pilot pixels of a neighbourhood, on average.
constexpr double kNeighbours = 64;

/// Mean of each pilot pixel's neighbourhood: the other pilot pixels in the same cell of a grid. Its
/// own would hide that the others are dark.
std::vector<V3d> neighbourhoods(const Pilot& pilot, const PilotModel& model) {
    const V2i size = pilot.size_px();
    const double cells = static_cast<double>(pilot.pixels()) / kNeighbours;
    const auto across = static_cast<int>(std::sqrt(cells * size.x / size.y));
    FilmMap grid{{std::clamp(across, 1, size.x), 1}, {}};
    grid.cells.y = std::clamp(static_cast<int>(cells / grid.cells.x), 1, size.y);
    std::vector<V3d> own;
    std::vector<size_t> cell_of;
    const size_t count = static_cast<size_t>(grid.cells.x) * static_cast<size_t>(grid.cells.y);
    std::vector<V3d> sums(count, V3d(0.));
    std::vector<double> weights(count, 0.);
    for (size_t p = 0; p < pilot.pixels(); ++p) {
        const PilotPixel& pixel = pilot.chosen().pixels[p];
        cell_of.push_back(grid.cell_at(size, pixel.pixel[0], pixel.pixel[1]));
        own.emplace_back(0.);
        for (const V3d& v : model.means(p)) own.back() += v * (pixel.weight / kPilotReplicates);
        sums[cell_of[p]] += own[p];
        weights[cell_of[p]] += pixel.weight;
    }
    std::vector<V3d> out;
    for (size_t p = 0; p < pilot.pixels(); ++p) {
        const double weight = weights[cell_of[p]] - pilot.chosen().pixels[p].weight;
        out.push_back(weight > 0 ? (sums[cell_of[p]] - own[p]) / weight : V3d(0.));
    }
    return out;
}

/// What squares are divided by, for each pilot pixel.
class Scales {
  public:
    Scales(const Pilot& pilot, const PilotScale& scale)
        : scale_(scale), around_(neighbourhoods(pilot, *scale.b)) {
        for (size_t p = 0; p < pilot.pixels(); ++p) {
            a_.push_back(scale.a->means(p));
            b_.push_back(scale.b->means(p));
            if (!scale.least.empty())
                for (int c = 0; c < 3; ++c)
                    around_[p][c] = std::max(around_[p][c], scale.least[p][c]);
        }
    }

    /// A squared deviation over the pixel's own brightness, or where that is doubtful over no less
    /// than what is around it.
    [[nodiscard]] double over(double square, size_t pixel, const Pair& pair, size_t channel) const {
        const auto with = [&](double at_least) {
            return square *
                   inverse_scale(a_[pixel], b_[pixel], pair, channel, at_least, scale_.floor);
        };
        const double own = with(0);
        return std::fabs(own) < kDoubtful ? own : with(component(around_[pixel], channel));
    }

  private:
    const PilotScale& scale_;
    std::vector<V3d> around_;
    std::vector<PilotValues> a_, b_;
};

/// Weighted mean over the pilot pixels. halves: two independent estimates of each value, which tell
/// the noise of those that were not drawn.
struct Value {
    double mean;
    std::array<double, 2> halves;
};
Estimate mean_of(const std::vector<Value>& values, const std::vector<PilotPixel>& chosen) {
    double certain = 0, variance = 0, sum = 0, weights = 0, drawn = 0;
    for (size_t p = 0; p < values.size(); ++p) {
        const double weight = chosen[p].weight;
        if (chosen[p].certain) {
            const auto& [a, b] = values[p].halves;
            certain += weight * values[p].mean;
            variance += std::pow(weight * (a - b) / 2, 2);
        } else {
            sum += weight * values[p].mean;
            weights += weight;
            ++drawn;
        }
    }
    // The weights of those that were drawn hardly vary in sum: what deviates from their mean does.
    const double scale = drawn > 1 ? drawn / (drawn - 1) : 1;
    for (size_t p = 0; p < values.size() && drawn > 0; ++p)
        if (!chosen[p].certain)
            variance +=
                scale *
                std::pow(chosen[p].weight * (values[p].mean - (drawn > 1 ? sum / weights : 0)), 2);
    return {certain + sum, std::sqrt(variance)};
}

V3d mean_of(const PilotModel& model, size_t pixel) {
    V3d mean(0.);
    for (const V3d& v : model.means(pixel)) mean += v / double(kPilotReplicates);
    return mean;
}

double luminance_of(const V3d& c) {
    return double(
        luminance(Rgb(static_cast<float>(c.x), static_cast<float>(c.y), static_cast<float>(c.z))));
}

}  // namespace

double mean_luminance(const Pilot& pilot, const PilotModel& model) {
    double sum = 0, weights = 0;
    for (size_t p = 0; p < pilot.pixels(); ++p) {
        const double weight = pilot.chosen().pixels[p].weight;
        sum += weight * luminance_of(mean_of(model, p));
        weights += weight;
    }
    return sum / weights;
}

double pilot_floor(const Pilot& pilot, const PilotModel& model, const std::vector<V3d>& least) {
    io::SymmetricFloor floor;
    for (size_t p = 0; p < pilot.pixels(); ++p) {
        const bool known = !least.empty() && least[p].length2() > 0;
        floor.add(luminance_of(known ? least[p] : mean_of(model, p)),
                  pilot.chosen().pixels[p].weight);
    }
    return floor.floor();
}

Estimate square_error(const Pilot& pilot, const std::vector<PilotTerm>& terms,
                      const PilotScale& scale) {
    const Scales scales(pilot, scale);
    std::vector<Value> values;
    for (size_t p = 0; p < pilot.pixels(); ++p) {
        PilotValues d;
        d.fill(V3d(0.));
        for (const PilotTerm& term : terms) {
            const PilotValues means = term.model->means(p);
            for (size_t k = 0; k < kPilotReplicates; ++k) d[k] += means[k] * term.factor;
        }
        std::array<double, kPairs.size()> squares{};
        for (size_t n = 0; n < kPairs.size(); ++n)
            for (size_t c = 0; c < kChannels; ++c)
                squares[n] +=
                    scales.over(component(d[kPairs[n].i], c) * component(d[kPairs[n].j], c), p,
                                kPairs[n], c) /
                    kChannels;
        double sum = 0;
        for (const double s : squares) sum += s / static_cast<double>(kPairs.size());
        values.push_back({sum, {squares[0], squares[1]}});
    }
    return mean_of(values, pilot.chosen().pixels);
}

std::optional<double> typical_ratio(const PilotNoise& noise, const PilotNoise& other) {
    constexpr size_t kFewest = 8;
    std::vector<double> ratios;
    for (size_t b = 0; b < noise.blocks.size(); ++b)
        if (noise.blocks[b] > 0 && other.blocks[b] > 0)
            ratios.push_back(noise.blocks[b] / other.blocks[b]);
    if (ratios.size() < kFewest) return std::nullopt;
    const auto middle = ratios.begin() + static_cast<ptrdiff_t>(ratios.size() / 2);
    std::nth_element(ratios.begin(), middle, ratios.end());
    return *middle;
}

PilotNoise noise_of(const Pilot& pilot, const PilotModel& model, const PilotScale& scale) {
    PilotNoise out;
    const Scales scales(pilot, scale);
    for (const std::vector<PilotValues>& turn : model.turns()) {
        std::vector<Value> values;
        double sum = 0, squares = 0;
        out.blocks = {};
        for (size_t p = 0; p < pilot.pixels(); ++p) {
            std::array<double, kPairs.size()> parts{};
            for (size_t n = 0; n < kPairs.size(); ++n)
                for (size_t c = 0; c < kChannels; ++c) {
                    const double off =
                        component(turn[p][kPairs[n].i], c) - component(turn[p][kPairs[n].j], c);
                    parts[n] += scales.over(off * off / 2, p, kPairs[n], c) / kChannels;
                }
            double mean = 0;
            for (const double part : parts) mean += part / static_cast<double>(kPairs.size());
            values.push_back({mean, {parts[0], parts[1]}});
            const double v = pilot.chosen().pixels[p].weight * mean;
            sum += v;
            squares += v * v;
            out.blocks[hash32(static_cast<uint32_t>(p)) % out.blocks.size()] +=
                pilot.chosen().pixels[p].weight * std::min(mean, io::kMostSymmetricMse);
        }
        out.variances.push_back(mean_of(values, pilot.chosen().pixels));
        out.parts = squares > 0 ? sum * sum / squares : 0;
    }
    return out;
}

}  // namespace petzval::apps
