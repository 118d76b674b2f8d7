// SPDX-License-Identifier: Apache-2.0
#include "io/gltf/animation/thinning.h"

#include <algorithm>
#include <cmath>

namespace petzval::io {
namespace {

/// Share of a body's extent that points may be off between time steps.
constexpr double kTolerance = 1e-3;

double most_second_difference(const std::vector<std::vector<V3d>>& at) {
    double most = 0;
    for (size_t i = 1; i + 1 < at.size(); ++i)
        for (size_t k = 0; k < at[i].size(); ++k)
            most = std::max(most, (at[i - 1][k] - at[i][k] * 2. + at[i + 1][k]).length());
    return most;
}

/// Coarsest stride at which off(step, before, after, share) stays within a bound.
template <class Off>
Thinning coarsest(size_t steps, double bound, Off off) {
    Thinning out;
    for (size_t stride = steps - 1; stride >= 1; stride /= 2) {
        double most = 0;
        for (size_t i = 0; i < steps; ++i) {
            const size_t before = std::min(i / stride * stride, steps - 1 - stride);
            most = std::max(most,
                            off(i, before, before + stride, double(i - before) / double(stride)));
            if (most > bound) break;
        }
        out.stride = stride;
        out.off_m = most;
        if (most <= bound) break;
    }
    return out;
}

}  // namespace

Thinning Thinning::operator|(const Thinning& o) const {
    return {std::min(stride, o.stride), std::max(off_m, o.off_m), std::max(size_m, o.size_m)};
}

Thinning thin(std::span<const M44d> to_world, std::span<const V3d> points) {
    std::vector<std::vector<V3d>> at(to_world.size());
    for (size_t i = 0; i < at.size(); ++i)
        for (const V3d& p : points) at[i].push_back(p * to_world[i]);
    Imath::Box<V3d> box;
    for (const V3d& p : at[at.size() / 2]) box.extendBy(p);
    const double size_m = box.isEmpty() ? 0 : box.size().length();
    Thinning out = coarsest(
        at.size(), kTolerance * size_m, [&](size_t i, size_t before, size_t after, double share) {
            double most = 0;
            for (size_t k = 0; k < points.size(); ++k)
                most = std::max(
                    most, (at[i][k] - at[before][k] * (1 - share) - at[after][k] * share).length());
            return most;
        });
    out.off_m += most_second_difference(at);
    out.size_m = size_m;
    return out;
}

Thinning thin(std::span<const std::vector<double>> weights, std::span<const double> sizes_m,
              double size_m) {
    const size_t count = std::min(sizes_m.size(), weights[0].size());
    const auto off = [&](size_t i, size_t before, size_t after, double share) {
        double sum = 0;
        for (size_t k = 0; k < count; ++k)
            sum += sizes_m[k] * std::fabs(weights[i][k] - weights[before][k] * (1 - share) -
                                          weights[after][k] * share);
        return sum;
    };
    Thinning out = coarsest(weights.size(), kTolerance * size_m, off);
    double bend = 0;
    for (size_t i = 1; i + 1 < weights.size(); ++i)
        bend = std::max(bend, 2 * off(i, i - 1, i + 1, 0.5));
    out.off_m += bend;
    out.size_m = size_m;
    return out;
}

}  // namespace petzval::io
