// SPDX-License-Identifier: Apache-2.0
// Light of ghosts pair by pair, two ways: drawn from the film as a camera draws, and walked from
// the scene through the lens. For tests and for measurements.
#pragma once

#include <cmath>
#include <map>

#include "camera/bench/light_walk.h"
#include "camera/ghosts/ghost_camera.h"
#include "camera/ghosts/lens_face.h"
#include "tests/support/lens_cameras.h"

namespace petzval::test {

/// A lens with its stop wide open, at line d, that looks along -z.
[[nodiscard]] inline std::shared_ptr<const camera::LensCamera> ghostly(const std::string& name,
                                                                       camera::Coating coating) {
    camera::LensCameraInput in = input_of(name, camera::DispersionMode::Shared);
    in.to_world = M44f();
    in.coating = coating;
    return std::make_shared<camera::LensCamera>(std::move(in));
}

/// A disc of the sky of radiance 1, so many degrees above the axis.
[[nodiscard]] inline SmallFeature sun_at(double deg, float radius_rad) {
    const double a = deg * M_PI / 180;
    SmallFeature out{};
    out.kind = SmallFeature::Kind::Lamp;
    out.centre = V3f(0, float(std::sin(a)), -float(std::cos(a)));
    out.at_infinity = true;
    out.radius_m = out.reach_m = radius_rad;
    out.area_m2 = 2 * M_PI * (1 - std::cos(double(radius_rad)));
    out.radiance = 1;
    return out;
}

[[nodiscard]] inline bool hits(const Ray& ray, const SmallFeature& sun) {
    return double(ray.direction.dot(sun.centre)) >= std::cos(double(sun.reach_m));
}

/// Light of a pair on the film. Squares: sum of those of each ray; drawn squares: what a draw's
/// square is on average, by the walked rays, which know all places that draws may miss.
struct PairLight {
    double walked = 0, walked_squares = 0, drawn = 0, drawn_squares = 0;
    double blind_squares = 0;  ///< likewise of draws that know nothing of the lamp
    int unseen = 0;            ///< walked rays that do not come back the same way

    /// Square of the standard error of the difference, for so many rays each.
    [[nodiscard]] double error2(uint32_t walks, uint32_t draws) const {
        return walked_squares / walks / walks + drawn_squares / walks / draws;
    }
};
using PairLights = std::map<std::pair<int, int>, PairLight>;

/// Ghosts of a sun in a lens.
class GhostLight {
  public:
    GhostLight(const std::shared_ptr<const camera::LensCamera>& camera, const SmallFeature& sun)
        : sun_(sun),
          optics_(camera),
          draws_(optics_, camera::GhostRegions(optics_, {&sun_, 1})),
          pupils_(optics_),
          nm_(splat(float(kLineD_nm))),
          indices_(optics_.lens().exact_indices(nm_)) {}

    /// Adds rays from the middle of the sun over the front surface.
    void walk(uint32_t count, PairLights&) const;
    /// Adds samples.
    void draw(uint32_t count, PairLights&) const;

  private:
    [[nodiscard]] double film_mm2() const {
        const camera::LensCameraInput& in = optics_.camera().input();
        return in.film_width_mm * in.film_height_mm;
    }
    /// Light of the sun along the ray of a draw, for 1 mm^2 of the last surface; 0 where it misses.
    [[nodiscard]] double light(V2f film_mm, const camera::GhostDraw& draw) const {
        const auto found = optics_.ray(optics_.pairs()[draw.pair], film_mm, draw.rear_mm, indices_,
                                       nm_, m4{-1, 0, 0, 0});
        if (!found || !hits(optics_.camera().in_world(camera::lane_of(found->ray, 0)), sun_))
            return 0;
        return double(found->share[0] * found->sr_per_mm2);
    }
    [[nodiscard]] double density(V2f film_mm, const camera::GhostDraw& draw) const {
        constexpr float kLineD = 0;
        return double(draws_.density(film_mm, {&kLineD, 1}, draw));
    }
    void add(V2f film_mm, const camera::GhostDraw&, PairLights&) const;
    void end(const camera::LightEnd&, PairLights&) const;

    SmallFeature sun_;
    camera::GhostOptics optics_;
    camera::GhostDraws draws_;
    camera::GhostPupils pupils_;
    f4 nm_;
    camera::LensIndices<f4> indices_;
};

inline void GhostLight::walk(uint32_t count, PairLights& out) const {
    const camera::Lens& lens = optics_.lens();
    const camera::LensCoats coats(lens, optics_.camera().input().coating);
    camera::LightWalk walk(lens, coats, kLineD_nm);
    const double reach = lens.prescription().surfaces[0].semi_diameter_mm;
    const V3d d = -V3d(sun_.centre);
    for (uint32_t i = 0; i < count; ++i) {
        const Sampler sampler(SamplerKind::Owen, 3, {0, 0, i});
        const V2d at = (V2d(sampler.get2(Dim::Lens)) * 2.0 - V2d(1)) * reach;
        const auto face = at.length() <= reach ? camera::face_point(lens, 0, at) : std::nullopt;
        if (!face || !(d.dot(face->normal) > 0)) continue;
        camera::LightRay ray;
        ray.direction = d;
        ray.origin_mm = face->point_mm - d;
        ray.share = d.dot(face->normal) / face->normal.z * 4 * reach * reach * sun_.area_m2;
        walk.follow(
            ray, [&](const camera::LightEnd& e) { end(e, out); }, false);
    }
}

inline void GhostLight::end(const camera::LightEnd& end, PairLights& out) const {
    if (end.fate != camera::LightFate::BehindLens || end.ray.reflections != 2) return;
    const camera::LensCameraInput& in = optics_.camera().input();
    const V3d from = end.ray.origin_mm, way = end.ray.direction;
    const V3d film = from + way * ((in.film_mm - from.z) / way.z);
    if (std::fabs(film.x) > in.film_width_mm / 2 || std::fabs(film.y) > in.film_height_mm / 2)
        return;
    const camera::GhostPair pair{end.ray.mirrors[0], end.ray.mirrors[1]};
    PairLight& light_of = out[{pair.first, pair.second}];
    light_of.walked += end.ray.share;
    light_of.walked_squares += end.ray.share * end.ray.share;
    const auto number = std::ranges::find(optics_.pairs(), pair) - optics_.pairs().begin();
    const V2f film_mm(float(film.x), float(film.y));
    const camera::GhostDraw draw{uint32_t(number), V2f(float(from.x), float(from.y))};
    const double value = light(film_mm, draw) * film_mm2();
    light_of.unseen += !(value > 0);
    light_of.drawn_squares += end.ray.share * value / density(film_mm, draw);
    light_of.blind_squares +=
        end.ray.share * value / double(pupils_.chance(draw.pair) * pupils_.density(film_mm, draw));
}

inline void GhostLight::add(V2f film_mm, const camera::GhostDraw& draw, PairLights& out) const {
    if (draw.rear_mm.length() > float(optics_.rear_mm())) return;
    const double value = light(film_mm, draw) * film_mm2();
    const camera::GhostPair pair = optics_.pairs()[draw.pair];
    if (value > 0) out[{pair.first, pair.second}].drawn += value / density(film_mm, draw);
}

inline void GhostLight::draw(uint32_t count, PairLights& out) const {
    for (uint32_t i = 0; i < count; ++i) {
        const Sampler sampler(SamplerKind::Owen, 4, {0, 0, i});
        const V2f film = optics_.camera().film_mm(sampler.get2(Dim::Film));
        const auto drawn = draws_.draw(film, 0, sampler);
        if (drawn.through_region) add(film, *drawn.through_region, out);
        if (drawn.over_all) add(film, *drawn.over_all, out);
    }
}

}  // namespace petzval::test
