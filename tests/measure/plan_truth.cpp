// SPDX-License-Identifier: Apache-2.0
#include "tests/measure/plan_truth.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include "integrator/path/path.h"
#include "integrator/render/render.h"
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

/// Bias of a pixel, and the variance of that.
Sum pixel_bias(const PixelReplicates& a, const PixelReplicates& b, double floor, bool crossed) {
    Chosen all;
    all.fill(true);
    double sum = 0, squares = 0;
    for (size_t k = 0; k < kTruthReplicates; ++k) {
        Chosen left = all;
        left[k] = false;
        const double v = pixel_bias(a, b, left, floor, crossed);
        sum += v;
        squares += v * v;
    }
    constexpr double kCount = kTruthReplicates;
    const double spread = std::max(squares - sum * sum / kCount, 0.);
    return {pixel_bias(a, b, all, floor, crossed), spread * (kCount - 1) / kCount};
}

Sum bias_of(const TruthPictures& of, size_t model, bool matters, bool crossed) {
    Sum out;
    double frame = 0;
    for (size_t p = 0; p < of.pixels.size(); ++p) {
        const double weight = of.pixels[p].stands_for;
        frame += weight;
        if (of.pixels[p].matters != matters) continue;
        const Sum one = pixel_bias(of.shown[model][p], of.shown.back()[p], of.floor, crossed);
        out.mean += weight * one.mean;
        out.variance += weight * weight * one.variance;
    }
    return {out.mean / frame, out.variance / (frame * frame)};
}

double floor_of(const Replicates& of, const std::vector<TruthPixel>& pixels) {
    Chosen all;
    all.fill(true);
    io::SymmetricFloor floor;
    for (size_t p = 0; p < pixels.size(); ++p) {
        const V3f mean(mean_of(of[p], all));
        floor.add(double(luminance(Rgb(mean.x, mean.y, mean.z))), pixels[p].stands_for);
    }
    return floor.floor();
}

uint32_t power_of_two_below(double samples) {
    return uint32_t(std::exp2(std::floor(std::log2(std::clamp(samples, 1., 65536.)))));
}

/// Mean of the values of the pixels about each. own: with its own value.
std::vector<double> smooth(const std::vector<double>& values, const std::vector<TruthPixel>& pixels,
                           bool own) {
    constexpr int kRadius = 3;
    std::map<std::array<int, 2>, size_t> index;
    for (size_t p = 0; p < pixels.size(); ++p) index[{pixels[p].x, pixels[p].y}] = p;
    std::vector<double> out;
    for (size_t p = 0; p < pixels.size(); ++p) {
        double sum = 0;
        int count = 0;
        for (int dy = -kRadius; dy <= kRadius; ++dy) {
            for (int dx = -kRadius; dx <= kRadius; ++dx) {
                if (!own && dx == 0 && dy == 0) continue;
                const auto found = index.find({pixels[p].x + dx, pixels[p].y + dy});
                if (found == index.end() || pixels[found->second].matters != pixels[p].matters)
                    continue;
                sum += values[found->second];
                ++count;
            }
        }
        out.push_back(count > 0 ? sum / count : own ? values[p] : 0);
    }
    return out;
}

/// Samples for the second half of the budget, by pixel: in proportion to the standard error that
/// the pixels about it add to the models; 0 where that is not twice what it had. A pixel's own
/// value has no say: else those that were lucky would keep it.
std::vector<uint32_t> samples_by_noise(const TruthPictures& of, double budget) {
    const size_t models = of.shown.size() - 1;
    std::vector<double> noise(of.pixels.size(), 0);
    for (size_t m = 0; m < models; ++m) {
        std::vector<double> own;
        double sum = 0;
        for (size_t p = 0; p < of.pixels.size(); ++p) {
            const Sum one = pixel_bias(of.shown[m][p], of.shown.back()[p], of.floor, true);
            own.push_back(of.pixels[p].matters ? one.variance : 0);
        }
        own = smooth(own, of.pixels, false);
        for (double& v : own) sum += v = std::sqrt(v);
        for (size_t p = 0; p < own.size(); ++p)
            if (sum > 0) noise[p] += own[p] / (sum * double(models));
    }
    std::vector<uint32_t> out;
    for (size_t p = 0; p < noise.size(); ++p) {
        const uint32_t samples =
            power_of_two_below(budget * noise[p] / double(of.shown.size() * kTruthReplicates));
        out.push_back(samples >= 2 * of.samples[p] ? samples : 0);
    }
    return out;
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
        for (int c = 0; c < 3; ++c) v += io::symmetric_square(r[c], reference[c], floor) / 3;
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

void render_replicates(const apps::RenderSetup& setup, const apps::PlanRequest& request,
                       const std::vector<TruthPixel>& pixels, const std::vector<uint32_t>& samples,
                       uint32_t turn, integrator::TbbExecutor& executor, Replicates& into) {
    integrator::PathOptions options = request.path;
    options.visible_background = setup.view.visible_background;
    const integrator::PathTracer<Bvh> tracer(*setup.prepared.scene, *setup.prepared.bvh,
                                             *setup.prepared.lights, options);
    into.resize(pixels.size());
    executor.run(static_cast<int>(pixels.size()), [&](int task, int) {
        const auto p = static_cast<size_t>(task);
        if (samples[p] == 0) return;
        const TruthPixel& at = pixels[p];
        integrator::RenderJob job = request.job;
        job.observer = setup.view.observer;
        integrator::PathStats stats;
        for (uint32_t k = 0; k < kTruthReplicates; ++k) {
            job.seed = hash32(kFirstSeed + turn, k);
            Film film(request.scene.size, {at.x, at.y, at.x + 1, at.y + 1}, {});
            integrator::render_samples(tracer, *setup.view.camera, job,
                                       {{at.x, at.y}, 0, samples[p]}, film, stats);
            const V4f c = film.colour(at.x, at.y);
            into[p][k] = V3d(c.x, c.y, c.z);
        }
    });
}

TruthPictures truth_pictures(const test::PlanScene& scene, const apps::PlanRequest& request,
                             const std::vector<const apps::RenderSetup*>& models, double budget,
                             integrator::TbbExecutor& executor) {
    constexpr uint32_t kFirstTurn = 0, kSecondTurn = 1;
    TruthPictures out;
    out.pixels = truth_pixels(scene);
    const double all = double(models.size() * out.pixels.size() * kTruthReplicates);
    out.samples.assign(out.pixels.size(), std::max(power_of_two_below(budget / 2 / all), 4u));
    out.shown.resize(models.size());
    for (size_t m = 0; m < models.size(); ++m)
        render_replicates(*models[m], request, out.pixels, out.samples, kFirstTurn, executor,
                          out.shown[m]);
    out.floor = floor_of(out.shown.back(), out.pixels);
    if (models.size() < 2) return out;
    const std::vector<uint32_t> more = samples_by_noise(out, budget / 2);
    for (size_t m = 0; m < models.size(); ++m)
        render_replicates(*models[m], request, out.pixels, more, kSecondTurn, executor,
                          out.shown[m]);
    for (size_t p = 0; p < more.size(); ++p)
        if (more[p] > 0) out.samples[p] = more[p];
    out.floor = floor_of(out.shown.back(), out.pixels);
    return out;
}

Bounded square_bias(const TruthPictures& of, size_t model, bool matters) {
    const Sum crossed = bias_of(of, model, matters, true);
    const Sum all = bias_of(of, model, matters, false);
    const auto possible = [](double v) { return std::clamp(v, 0., io::kMostSymmetricMse); };
    return {possible((crossed.mean + all.mean) / 2), possible(std::min(crossed.low(), all.low())),
            possible(std::max(crossed.high(), all.high()))};
}

Bounded square_noise(const TruthPictures& of, size_t model, const apps::RenderSetup& setup,
                     const apps::PlanRequest& request, uint64_t samples, double budget,
                     integrator::TbbExecutor& executor) {
    constexpr uint32_t kThirdTurn = 2;
    const std::vector<TruthPixel>& pixels = of.pixels;
    const Replicates& seen = of.shown[model];
    const auto measured = uint32_t(std::min(samples, kMostNoiseSamples));
    // Where noise is, by the replicates that are there.
    std::vector<double> share, each;
    double frame = 0, total = 0;
    for (size_t p = 0; p < pixels.size(); ++p) {
        frame += pixels[p].stands_for;
        each.push_back(of.samples[p] *
                       pixel_noise(seen[p], of.samples[p], V3d(0.), 0, of.floor).mean);
    }
    each = smooth(each, pixels, true);
    for (size_t p = 0; p < pixels.size(); ++p) {
        share.push_back(pixels[p].stands_for * each[p]);
        total += share.back();
    }
    for (size_t p = 0; p < pixels.size(); ++p) {  // a tenth of the draws goes anywhere
        const double even = pixels[p].stands_for / frame;
        share[p] = total > 0 ? 0.9 * share[p] / total + 0.1 * even : even;
    }
    const auto affordable = size_t(budget / (double(measured) * kTruthReplicates));
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
    Replicates rendered;
    render_replicates(setup, request, some, std::vector<uint32_t>(some.size(), measured),
                      kThirdTurn, executor, rendered);
    Sum out;
    double squares = 0;
    for (size_t i = 0; i < drawn.size(); ++i) {
        const size_t p = drawn[i];
        V3d elsewhere(0.);
        for (const V3d& r : seen[p]) elsewhere += r * double(of.samples[p]);
        const Sum v = pixel_noise(rendered[i], measured, elsewhere,
                                  double(of.samples[p]) * kTruthReplicates, of.floor);
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
