// SPDX-License-Identifier: Apache-2.0
#include "tests/measure/plan_truth.h"

#include <algorithm>
#include <cmath>
#include <set>

#include "integrator/path.h"
#include "integrator/render.h"
#include "io/image/symmetric_mse.h"

namespace petzval {
namespace {

constexpr uint32_t kFirstSeed = 77'000'000;  ///< far from those of the pilot
constexpr double kOneSided95 = 1.645;
/// Beyond so many samples noise counts as falling in proportion.
constexpr uint64_t kMostNoiseSamples = 2048;
constexpr size_t kOtherPixels = 256;

/// A sum of independent values, and its variance.
struct Sum {
    double mean = 0, variance = 0;
    [[nodiscard]] double low() const { return mean - kOneSided95 * std::sqrt(variance); }
    [[nodiscard]] double high() const { return mean + kOneSided95 * std::sqrt(variance); }
};

using PixelReplicates = std::array<V3d, kTruthReplicates>;
using Chosen = std::array<bool, kTruthReplicates>;  ///< replicates that count

V3d mean_of(const PixelReplicates& of, const Chosen& chosen) {
    V3d sum(0.);
    int count = 0;
    for (size_t k = 0; k < kTruthReplicates; ++k) {
        if (!chosen[k]) continue;
        sum += of[k];
        ++count;
    }
    return sum / double(count);
}

/// Square of the difference without noise: the mean product of two different replicates.
V3d square_of(const PixelReplicates& a, const PixelReplicates& b, const Chosen& chosen) {
    V3d sum(0.), squares(0.);
    int count = 0;
    for (size_t k = 0; k < kTruthReplicates; ++k) {
        if (!chosen[k]) continue;
        const V3d d = a[k] - b[k];
        sum += d;
        squares += d * d;
        ++count;
    }
    return (sum * sum - squares) / double(count * (count - 1));
}

double over_scale(V3d square, V3d a, V3d b, double floor) {
    double sum = 0;
    for (int c = 0; c < 3; ++c) {
        const double scale = (a[c] * a[c] + b[c] * b[c]) / 2 + floor * floor;
        if (scale > 0) sum += square[c] / scale / 3;
    }
    return sum;
}

Chosen half_of(const Chosen& all, bool second) {
    Chosen out = all;
    for (size_t k = 0; k < kTruthReplicates; ++k)
        if ((k < kTruthReplicates / 2) == second) out[k] = false;
    return out;
}

/// Bias of a pixel by the replicates that are left; crossed: denominators of the other half.
double pixel_bias(const PixelReplicates& a, const PixelReplicates& b, const Chosen& left,
                  double floor, bool crossed) {
    if (!crossed)
        return over_scale(square_of(a, b, left), mean_of(a, left), mean_of(b, left), floor);
    double sum = 0;
    for (const bool second : {false, true}) {
        const Chosen above = half_of(left, second), below = half_of(left, !second);
        sum += over_scale(square_of(a, b, above), mean_of(a, below), mean_of(b, below), floor);
    }
    return sum / 2;
}

Sum bias_of(const Replicates& a, const Replicates& b, const std::vector<TruthPixel>& pixels,
            double floor, bool matters, bool crossed) {
    Chosen all;
    all.fill(true);
    Sum out;
    double frame = 0;
    for (size_t p = 0; p < pixels.size(); ++p) {
        frame += pixels[p].stands_for;
        if (pixels[p].matters != matters) continue;
        out.mean += pixels[p].stands_for * pixel_bias(a[p], b[p], all, floor, crossed);
        double sum = 0, squares = 0;
        for (size_t k = 0; k < kTruthReplicates; ++k) {
            Chosen left = all;
            left[k] = false;
            const double v = pixel_bias(a[p], b[p], left, floor, crossed);
            sum += v;
            squares += v * v;
        }
        constexpr double kCount = kTruthReplicates;
        const double spread = std::max(squares - sum * sum / kCount, 0.);
        out.variance += std::pow(pixels[p].stands_for, 2) * spread * (kCount - 1) / kCount;
    }
    return {out.mean / frame, out.variance / (frame * frame)};
}

/// Error of each replicate of a pixel against all that is known but itself, as a mean; reference:
/// the sum of samples from elsewhere, and how many.
Sum pixel_noise(const PixelReplicates& of, double samples, V3d elsewhere, double elsewhere_samples,
                double floor) {
    V3d all = elsewhere;
    for (const V3d& r : of) all += r * samples;
    const double others = elsewhere_samples + double(kTruthReplicates - 1) * samples;
    double sum = 0, squares = 0;
    for (const V3d& r : of) {
        const V3d reference = (all - r * samples) / others;
        double v = 0;
        for (int c = 0; c < 3; ++c) v += symmetric_square(r[c], reference[c], floor) / 3;
        v /= 1 + samples / others;  // the reference's own noise
        sum += v;
        squares += v * v;
    }
    constexpr double kCount = kTruthReplicates;
    return {sum / kCount, std::max(squares - sum * sum / kCount, 0.) / (kCount * (kCount - 1))};
}

}  // namespace

std::vector<TruthPixel> truth_pixels(const test::PlanScene& scene) {
    const V2i size = scene.request.size;
    std::set<std::array<int, 2>> inside;
    for (const Rect& r : scene.matters)
        for (int y = r.y0; y < r.y1; ++y)
            for (int x = r.x0; x < r.x1; ++x) inside.insert({y, x});
    std::vector<TruthPixel> out;
    for (const auto& [y, x] : inside) out.push_back({x, y, 1, true});
    const size_t others = size_t(size.x) * size_t(size.y) - inside.size();
    std::set<std::array<int, 2>> drawn;
    for (uint32_t i = 0; drawn.size() < std::min(others, kOtherPixels); ++i) {
        const uint32_t at = hash32(i) % uint32_t(size.x * size.y);
        const std::array<int, 2> yx{int(at) / size.x, int(at) % size.x};
        if (!inside.contains(yx)) drawn.insert(yx);
    }
    for (const auto& [y, x] : drawn)
        out.push_back({x, y, double(others) / double(drawn.size()), false});
    return out;
}

Replicates render_replicates(const RenderSetup& setup, const PlanRequest& request,
                             const std::vector<TruthPixel>& pixels, uint32_t samples, uint32_t turn,
                             TbbExecutor& executor) {
    PathOptions options = request.path;
    options.visible_background = setup.view.visible_background;
    const PathTracer<Bvh> tracer(*setup.prepared.scene, *setup.prepared.bvh, *setup.prepared.lights,
                                 options);
    Replicates out(pixels.size());
    executor.run(static_cast<int>(pixels.size()), [&](int task, int) {
        const TruthPixel& at = pixels[static_cast<size_t>(task)];
        RenderJob job = request.job;
        job.observer = setup.view.observer;
        PathStats stats;
        for (uint32_t k = 0; k < kTruthReplicates; ++k) {
            job.seed = hash32(kFirstSeed + turn, k);
            Film film(request.scene.size, {at.x, at.y, at.x + 1, at.y + 1}, {});
            render_samples(tracer, *setup.view.camera, job, {at.x, at.y}, 0, samples, film, stats);
            const V4f c = film.colour(at.x, at.y);
            out[static_cast<size_t>(task)][k] = V3d(c.x, c.y, c.z);
        }
    });
    return out;
}

double floor_of(const Replicates& of, const std::vector<TruthPixel>& pixels) {
    Chosen all;
    all.fill(true);
    SymmetricFloor floor;
    for (size_t p = 0; p < pixels.size(); ++p) {
        const V3f mean(mean_of(of[p], all));
        floor.add(double(luminance(Rgb(mean.x, mean.y, mean.z))), pixels[p].stands_for);
    }
    return floor.floor();
}

Bounded square_bias(const Replicates& a, const Replicates& b, const std::vector<TruthPixel>& pixels,
                    double floor, bool matters) {
    const Sum crossed = bias_of(a, b, pixels, floor, matters, true);
    const Sum all = bias_of(a, b, pixels, floor, matters, false);
    return {std::max(crossed.mean, 0.), std::max(std::min(crossed.low(), all.low()), 0.),
            std::max({crossed.high(), all.high(), 0.})};
}

Bounded square_noise(const RenderSetup& setup, const PlanRequest& request,
                     const std::vector<TruthPixel>& pixels, const Replicates& seen,
                     uint32_t seen_samples, uint64_t samples, double floor, double most,
                     TbbExecutor& executor) {
    const auto measured = uint32_t(std::min(samples, kMostNoiseSamples));
    // Where noise is, by the replicates that are there.
    std::vector<double> share;
    double frame = 0, total = 0;
    for (size_t p = 0; p < pixels.size(); ++p) {
        frame += pixels[p].stands_for;
        share.push_back(pixels[p].stands_for *
                        pixel_noise(seen[p], seen_samples, V3d(0.), 0, floor).mean);
        total += share.back();
    }
    for (size_t p = 0; p < pixels.size(); ++p) {  // a tenth of the draws goes anywhere
        const double even = pixels[p].stands_for / frame;
        share[p] = total > 0 ? 0.9 * share[p] / total + 0.1 * even : even;
    }
    const auto affordable = size_t(most / (double(measured) * kTruthReplicates));
    const bool whole = affordable >= pixels.size();
    std::vector<size_t> drawn;  // with replacement, at even steps: systematic sampling
    if (whole) {
        for (size_t p = 0; p < pixels.size(); ++p) drawn.push_back(p);
    } else {
        const size_t count = std::max<size_t>(affordable, 32);
        double passed = 0;
        size_t p = 0;
        for (size_t i = 0; i < count; ++i) {
            const double at = (double(i) + 0.5) / double(count);
            while (p + 1 < pixels.size() && passed + share[p] < at) passed += share[p++];
            drawn.push_back(p);
        }
    }
    std::vector<TruthPixel> some;
    for (const size_t p : drawn) some.push_back(pixels[p]);
    const Replicates rendered = render_replicates(setup, request, some, measured, 1, executor);
    Sum out;
    double squares = 0;
    for (size_t i = 0; i < drawn.size(); ++i) {
        const size_t p = drawn[i];
        V3d elsewhere(0.);
        for (const V3d& r : seen[p]) elsewhere += r * double(seen_samples);
        const Sum v = pixel_noise(rendered[i], measured, elsewhere,
                                  double(seen_samples) * kTruthReplicates, floor);
        const double weight = pixels[p].stands_for / frame;
        if (whole) {
            out.mean += weight * v.mean;
            out.variance += weight * weight * v.variance;
        } else {
            const double one = weight * v.mean / share[p];
            out.mean += one;
            squares += one * one;
        }
    }
    if (!whole) {
        const auto n = double(drawn.size());
        out.variance = std::max(squares - out.mean * out.mean / n, 0.) / (n * (n - 1));
        out.mean /= n;
    }
    const double rest = double(measured) / double(samples);
    return {out.mean * rest, std::max(out.low(), 0.) * rest, out.high() * rest};
}

}  // namespace petzval
