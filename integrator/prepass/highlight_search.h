// SPDX-License-Identifier: Apache-2.0
// Search for the image of a lamp in a polished surface, or behind glass, by Newton's method.
#pragma once

#include <cstdint>
#include <optional>

#include "core/math/linear2.h"
#include "core/scene/scene.h"
#include "core/shading/surface.h"
#include "core/traversal/bvh.h"

namespace petzval::integrator {

/// A rougher surface has no highlights that are small.
inline constexpr float kMostRoughness = 0.35f;

/// A lamp to look for, or a light without size.
struct Source {
    V3f centre;  ///< at infinity the unit direction to it
    bool at_infinity;
    float reach_m;  ///< at infinity: radians
    double light;   ///< nits; of a light without size: its illuminance at 1 m, or in lux
    double strength;

    [[nodiscard]] bool has_size() const { return reach_m > 0; }
};

/// How a ray gets to a lamp: by one reflection, or through clear glass, bent where it enters, where
/// it leaves, and reflected within where it must be.
enum class Way : uint8_t { Mirrored, Through };

/// Where a ray from the lens is turned towards a lamp.
struct Met {
    Way way;
    V3f first;        ///< point where the ray meets the object
    Surface surface;  ///< that mirrors; or the last one of the glass
    V3f aim;  ///< unit: the shaded normal, on the ray's side; or the direction behind the glass
    float alpha;
    double share;  ///< of light that goes this way

    [[nodiscard]] V3f to(const Source& lamp) const {
        return lamp.at_infinity ? lamp.centre : unit(lamp.centre - surface.p);
    }
    [[nodiscard]] float distance_m(const Source& lamp) const {
        return (lamp.centre - surface.p).length();
    }
    /// Half-width of what a lamp makes of `aim`, slopes: its own, and the roughness's.
    [[nodiscard]] float half_width(const Source&) const;
    [[nodiscard]] float own_half_width(const Source& lamp) const {
        const float halved = way == Way::Mirrored ? 2 : 1;
        return lamp.reach_m / (lamp.at_infinity ? halved : halved * distance_m(lamp));
    }
};

/// A lamp as one point of the lens sees it.
struct LampImage {
    V3f eye, direction;
    Met met;
    float angle;  ///< largest half-width, radians
    /// Distance from the middle of the lamp, in its half-widths, for a change of the direction,
    /// radians, along the axes of Frame::about(direction).
    Linear2f in_half_widths;
};

struct Shaded {
    Surface surface;
    ShadingInput at;
};

/// Looks for images of lamps with at most so many rays, or a few more.
class HighlightSearch {
  public:
    HighlightSearch(const Scene& scene, const Bvh& bvh, int64_t most_rays)
        : scene_(scene), bvh_(bvh), rays_left_(most_rays) {}

    [[nodiscard]] bool may_go_on() const { return rays_left_ > 0; }
    void allow(int64_t more_rays) { rays_left_ += more_rays; }

    /// What a ray meets first that can be seen.
    [[nodiscard]] std::optional<Shaded> first(Ray);
    /// How a ray of that direction goes on there; nothing where that is not polished, or not glass.
    [[nodiscard]] std::optional<Met> met(const Shaded&, const V3f& direction, Way);
    /// Both in one.
    [[nodiscard]] std::optional<Met> meet(const V3f& eye, const V3f& direction, Way);
    /// The image of a lamp that a point of the lens sees near a direction, by Newton's method: for
    /// the direction, until the surface mirrors the lamp, or the ray behind the glass meets it.
    /// beside: the same image as a point of the lens nearby sees it, whose slopes will do.
    [[nodiscard]] std::optional<LampImage> image(const V3f& eye, V3f direction, const Source&, Way,
                                                 const LampImage* beside = nullptr);
    /// Whether something stands between a surface and a lamp.
    [[nodiscard]] bool is_hidden(const LampImage&, const Source&);

  private:
    [[nodiscard]] std::optional<Met> behind_glass(Shaded, V3f direction);

    const Scene& scene_;
    const Bvh& bvh_;
    int64_t rays_left_;
};

}  // namespace petzval::integrator
