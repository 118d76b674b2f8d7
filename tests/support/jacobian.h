// SPDX-License-Identifier: Apache-2.0
// A sampling routine stretches the unit square; where it stretches more, its density is lower. The
// stretch by finite differences against the density that the routine claims.
#pragma once

#include <gtest/gtest.h>

#include <functional>
#include <optional>

#include "tests/support/statistics.h"

namespace petzval::test {

/// draw: from [0, 1)^2 to a direction (or a point of any surface); nothing where sampling fails.
/// pdf: density at what was drawn, per solid angle (or area). Points where the stretch differs
/// between two step sizes straddle an edge of a piecewise map and are left out; at least
/// `least_compared` of the points must remain.
[[nodiscard]] inline ::testing::AssertionResult jacobian_matches(
    const std::function<std::optional<V3f>(V2f)>& draw, const std::function<double(V3f)>& pdf,
    uint32_t seed, double tolerance = 0.01, double step = 1e-3, double least_compared = 0.8) {
    constexpr int kPoints = 2000;
    Random random(seed);
    int compared = 0, failed = 0;
    const auto area = [&](V2f u, float h) -> std::optional<double> {
        const auto left = draw({u.x - h, u.y}), right = draw({u.x + h, u.y});
        const auto below = draw({u.x, u.y - h}), above = draw({u.x, u.y + h});
        if (!left || !right || !below || !above) return std::nullopt;
        const V3d dx = V3d(*right) - V3d(*left), dy = V3d(*above) - V3d(*below);
        return dx.cross(dy).length() / (4.0 * h * h);
    };
    for (int i = 0; i < kPoints; ++i) {
        const auto margin = static_cast<float>(2 * step);
        const V2f u = V2f(margin) + random.next2() * (1 - 2 * margin);
        const auto at = draw(u);
        const auto coarse = area(u, static_cast<float>(step));
        const auto fine = area(u, static_cast<float>(step / 2));
        if (!at || !coarse || !fine) {
            failed += !at;
            continue;
        }
        if (std::fabs(*coarse - *fine) > 0.5 * tolerance * *coarse) continue;
        ++compared;
        const double product = *fine * pdf(*at);
        if (std::fabs(product - 1) > tolerance)
            return ::testing::AssertionFailure()
                   << "at u = (" << u.x << ", " << u.y << "): stretch " << *fine << " times pdf "
                   << pdf(*at) << " is " << product << ", not 1";
    }
    if (compared < least_compared * (kPoints - failed))
        return ::testing::AssertionFailure()
               << "only " << compared << " of " << kPoints - failed << " points compare";
    return ::testing::AssertionSuccess();
}

}  // namespace petzval::test
