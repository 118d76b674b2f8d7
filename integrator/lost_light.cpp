// SPDX-License-Identifier: Apache-2.0
#include "integrator/lost_light.h"

#include <algorithm>
#include <map>
#include <optional>

#include "core/sampling/sampler.h"
#include "core/sampling/warp.h"
#include "core/shading/surface.h"

namespace petzval {
namespace {

constexpr uint32_t kRays = 1024;
constexpr double kLeastShare = 1e-3;
constexpr int kMostFaces = 64;        // that one ray passes
constexpr float kOneSpot = 0.99939f;  // cosine of 2 degrees

// Glass that sends on in one direction. Where a texture may make it rough, light samples find it.
bool is_solid_and_smooth(const Material& m) {
    return m.refracts() && !m.metallic_roughness_texture.present() &&
           sqr(m.roughness) < kSmallestAlpha;
}

// Where rays of a light begin; nothing outside of a spot's cone.
class Emitter {
  public:
    Emitter(const Scene& scene, const PointLight& light) : scene_(scene), centre_(light.position) {}
    Emitter(const Scene& scene, const SpotLight& light)
        : scene_(scene),
          centre_(light.position),
          axis_(light.direction),
          cos_cone_(std::max(light.cos_outer, -1.f)) {}
    Emitter(const Scene& scene, const V3f& towards_light)
        : scene_(scene), axis_(-towards_light), is_parallel_(true) {}
    Emitter(const Scene& scene, const Thing& lamp)
        : scene_(scene), centre_(lamp.centre), radius_m_(1.01f * lamp.reach_m) {}

    [[nodiscard]] Ray ray(const Sampler& sampler) const {
        const V2f u = sampler.get2(Dim::Film);
        Ray ray;
        ray.alpha_seed = sampler.get_bits(Dim::Coverage, 0);
        if (is_parallel_) {
            const Box3f& b = scene_.bounds;
            const float radius = b.size().length() / 2;
            const V2f disk = uniform_disk(u) * radius;
            const Frame frame = Frame::about(axis_);
            ray.origin = b.center() + frame.to_world(V3f(disk.x, disk.y, -1.01f * radius));
            ray.direction = axis_;
        } else {
            const float cosine = 1 - u.x * (1 - cos_cone_), sine = safe_sqrt(1 - sqr(cosine));
            const float phi = 2 * kPi * u.y;
            ray.direction = Frame::about(axis_).to_world(
                V3f(sine * std::cos(phi), sine * std::sin(phi), cosine));
            ray.origin = centre_ + ray.direction * radius_m_;
        }
        return ray;
    }

  private:
    const Scene& scene_;
    V3f centre_{0.f}, axis_{0, 0, 1};
    float cos_cone_ = -1, radius_m_ = 0;
    bool is_parallel_ = false;
};

// What a ray of a light meets on its straight way.
struct Arrival {
    bool lands = false;                   // on a surface that scatters
    std::optional<uint32_t> first_glass;  // that is solid and smooth
    double distance_m = 0;
};

Arrival follow(const Scene& scene, const Bvh& bvh, Ray ray) {
    Arrival out;
    const V3f start = ray.origin;
    for (int face = 0; face < kMostFaces; ++face) {
        const auto hit = bvh.intersect(ray);
        if (!hit) return out;
        const Surface s = make_surface(scene, ray.direction, *hit);
        const bool solid = is_solid_and_smooth(*s.material);
        if (!solid && !s.material->may_be_pane()) {
            out.lands = true;
            out.distance_m = double((s.p - start).length());
            return out;
        }
        if (solid && !out.first_glass) out.first_glass = s.mesh->material;
        ray.origin = offset_origin(s.p, s.p_error, s.ng, ray.direction);
    }
    return out;
}

// Adds a light where it is lost. chance: of a path that leaves a surface at that squared distance.
template <class Chance>
void add_where_lost(std::vector<LostLight>& out, const Scene& scene, const Bvh& bvh,
                    const Emitter& emitter, LostLight found, const Chance& chance) {
    std::map<uint32_t, int> through;
    int landed = 0, lost = 0;
    double squares_m2 = 0;
    for (uint32_t i = 0; i < kRays; ++i) {
        const Sampler sampler(SamplerKind::Owen, 1, {0, 0, i});
        const Arrival arrival = follow(scene, bvh, emitter.ray(sampler));
        landed += arrival.lands;
        if (!arrival.lands || !arrival.first_glass) continue;
        ++lost;
        ++through[*arrival.first_glass];
        squares_m2 += sqr(arrival.distance_m);
    }
    if (lost == 0 || lost < kLeastShare * landed) return;
    if (!(chance(squares_m2 / lost) < kHardlyAnyPath)) return;
    found.share = double(lost) / landed;
    found.glass = std::max_element(through.begin(), through.end(), [](auto& a, auto& b) {
                      return a.second < b.second;
                  })->first;
    out.push_back(found);
}

}  // namespace

std::vector<LostLight> lost_light(const Scene& scene, const Bvh& bvh) {
    std::vector<LostLight> out;
    if (std::none_of(scene.materials.begin(), scene.materials.end(), is_solid_and_smooth))
        return out;
    using Kind = LostLight::Kind;
    const auto never = [](double) { return 0.; };
    for (uint32_t i = 0; i < scene.lights.size(); ++i) {
        const Light& light = scene.lights[i];
        if (const auto* point = std::get_if<PointLight>(&light))
            add_where_lost(out, scene, bvh, {scene, *point}, {Kind::Point, i}, never);
        else if (const auto* spot = std::get_if<SpotLight>(&light))
            add_where_lost(out, scene, bvh, {scene, *spot}, {Kind::Spot, i}, never);
        else if (const auto* sun = std::get_if<SunLight>(&light))
            add_where_lost(out, scene, bvh, {scene, -sun->direction}, {Kind::Sun, i}, never);
    }
    std::vector<V3f> sky_spots;  // directions
    for (const Thing& thing : things_of(scene)) {
        if (!thing.is_lamp()) continue;
        const double size = 2 * double(thing.radius_m);
        // Share of the directions about a surface, by their cosine, that lead to the lamp.
        const auto chance = [&](double squared_distance_m2) {
            return thing.area_m2 / (double(kPi) * squared_distance_m2);
        };
        const auto chance_of_sky = [&](double) { return thing.area_m2 / double(kPi); };
        // The texels of a sun are things of their own.
        const auto is_near = [&](const V3f& d) { return d.dot(thing.centre) > kOneSpot; };
        if (thing.at_infinity) {
            if (std::any_of(sky_spots.begin(), sky_spots.end(), is_near)) continue;
            sky_spots.push_back(thing.centre);
            add_where_lost(out, scene, bvh, {scene, thing.centre}, {Kind::SkySpot, 0, size},
                           chance_of_sky);
        } else {
            add_where_lost(out, scene, bvh, {scene, thing}, {Kind::Lamp, 0, size}, chance);
        }
    }
    return out;
}

}  // namespace petzval
