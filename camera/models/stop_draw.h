// SPDX-License-Identifier: Apache-2.0
// Draws of the stop for one film point: of the iris, mostly within the bounds of what rims leave.
#pragma once

#include "camera/iris/iris.h"
#include "camera/lens/stop_bounds.h"

namespace petzval::camera {

class StopDraw {
  public:
    /// Iris and bounds must outlive it. bounds: nullptr where the whole iris is drawn.
    StopDraw(const Iris& iris, const StopBounds* bounds, V2f film_mm)
        : iris_(iris), bounds_(bounds) {
        const float height = film_mm.length();
        if (height > 0.f) up_ = film_mm / height;
    }

    /// Draws a point of the stop, mm; u in [0, 1)^2.
    [[nodiscard]] V2f sample(V2f u) const {
        if (!bounds_) return iris_.sample(u);
        if (u.x < kWholeShare) return iris_.sample({u.x / kWholeShare, u.y});
        const V2f p = bounds_->sample({(u.x - kWholeShare) / (1.f - kWholeShare), u.y});
        return V2f(up_.y, -up_.x) * p.x + up_ * p.y;
    }
    /// Density of a point, 1/mm2; open: what the iris transmits there. Above 0 wherever that is,
    /// whatever the bounds left out.
    [[nodiscard]] float density(V2f p, float open) const {
        const float whole = open / static_cast<float>(iris_.area_mm2());
        if (!bounds_) return whole;
        const V2f turned(p.x * up_.y - p.y * up_.x, p.dot(up_));
        const float within = bounds_->contain(turned) ? 1.f / bounds_->area_mm2() : 0.f;
        return kWholeShare * whole + (1.f - kWholeShare) * within;
    }

  private:
    /// Part of the draws that goes to the whole iris: the bounds are found by tests between which
    /// light may pass, and what they miss has a weight of 32 at most.
    static constexpr float kWholeShare = 1.f / 32;

    const Iris& iris_;
    const StopBounds* bounds_;
    V2f up_{0.f, 1.f};
};

}  // namespace petzval::camera
