// SPDX-License-Identifier: Apache-2.0
#include "core/scene/studio.h"

#include <array>

#include "core/math/trig.h"

namespace petzval {
namespace {

constexpr int kWidth = 512, kHeight = 256;
constexpr float kGround = 0.12f, kTop = 0.40f;  ///< radiance of the grey, nits
constexpr float kSoftEdge = 0.25f;              ///< share of a box's half side over which it fades

// Cubic step from 0 to 1.
float smooth_step(float x) {
    const float t = clamp_unit(x);
    return t * t * (3.f - 2.f * t);
}

/// Rectangle of light that faces the middle of the scene.
class SoftBox {
  public:
    /// towards: the box's middle. half_sides: across and upright, at distance 1.
    SoftBox(const V3f& towards, V2f half_sides, float radiance_nits)
        : middle_(unit(towards)),
          across_(unit(V3f(0, 1, 0).cross(middle_))),
          upright_(middle_.cross(across_)),
          half_sides_(half_sides),
          radiance_nits_(radiance_nits) {}
    [[nodiscard]] float radiance_nits(const V3f& direction) const {
        const float along = direction.dot(middle_);
        if (!(along > 0.f)) return 0.f;
        const auto edge = [&](const V3f& axis, float half_side) {
            const float at = std::fabs(direction.dot(axis)) / along;
            return smooth_step((1.f - at / half_side) / kSoftEdge);
        };
        return radiance_nits_ * edge(across_, half_sides_.x) * edge(upright_, half_sides_.y);
    }

  private:
    V3f middle_, across_, upright_;
    V2f half_sides_;
    float radiance_nits_;
};

}  // namespace

Sky studio_sky(float rotate_deg, float strength) {
    const std::array<SoftBox, 3> boxes{{{{-0.7f, 0.6f, 0.8f}, {0.5f, 0.5f}, 3.5f},
                                        {{1.f, 0.2f, 0.5f}, {0.4f, 0.6f}, 0.6f},
                                        {{0.6f, 0.45f, -0.9f}, {0.25f, 0.6f}, 4.f}}};
    std::vector<float> rgb;
    rgb.reserve(size_t{3} * kWidth * kHeight);
    for (int y = 0; y < kHeight; ++y) {
        const SinCos polar = sincos_turns((static_cast<float>(y) + 0.5f) / kHeight / 2.f);
        for (int x = 0; x < kWidth; ++x) {
            const SinCos azimuth = sincos_turns((static_cast<float>(x) + 0.5f) / kWidth - 0.5f);
            const V3f direction(polar.sine * azimuth.cosine, polar.cosine,
                                polar.sine * azimuth.sine);
            float light = lerp(kGround, kTop, smooth_step((direction.y + 1.f) / 2.f));
            for (const SoftBox& box : boxes) light += box.radiance_nits(direction);
            rgb.insert(rgb.end(), 3, light);
        }
    }
    return Sky::picture(std::move(rgb), kWidth, kHeight, rotate_deg, strength);
}

}  // namespace petzval
