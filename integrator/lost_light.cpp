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

constexpr uint32_t kRays = 256;
constexpr double kLeastShare = 0.01;
constexpr int kMostFaces = 64;        // that one ray passes
constexpr float kOneSpot = 0.99939f;  // cosine of 2 degrees

// Glass that sends on in one direction. Where a texture may make it rough, light samples find it.
bool is_solid_and_smooth(const Material& m) {
    return m.refracts() && !m.metallic_roughness_texture.present() &&
           sqr(m.roughness) < kSmallestAlpha;
}

struct Ball {
    V3f centre;
    float radius_m;
};

// About all solid, smooth glass; nothing where there is none.
std::optional<Ball> ball_of_glass(const Scene& scene) {
    Box3f box;
    for (uint32_t i = 0; i < scene.instances.size(); ++i) {
        const Mesh& mesh = scene.meshes[scene.instances[i].mesh];
        if (!is_solid_and_smooth(scene.materials[mesh.material])) continue;
        for (uint32_t triangle = 0; triangle < mesh.triangles.size(); ++triangle)
            for (const V3f& corner : triangle_corners(scene, i, triangle)) box.extendBy(corner);
    }
    if (box.isEmpty()) return std::nullopt;
    return Ball{box.center(), box.size().length() / 2};
}

Ray ray_of(const Sampler& sampler, const V3f& origin, const V3f& direction) {
    Ray ray;
    ray.origin = origin;
    ray.direction = direction;
    ray.alpha_seed = sampler.get_bits(Dim::Coverage, 0);
    return ray;
}

// A ray from a point into the cone about the glass, or anywhere from within it.
Ray ray_from(const Sampler& sampler, const V3f& p, const Ball& glass) {
    const V3f way = glass.centre - p;
    const float distance_m = way.length();
    if (!(distance_m > glass.radius_m))
        return ray_of(sampler, p, uniform_sphere(sampler.get2(Dim::Film)));
    const float cos_cone = safe_sqrt(1 - sqr(glass.radius_m / distance_m));
    const V2f u = sampler.get2(Dim::Film);
    const float cosine = 1 - u.x * (1 - cos_cone), sine = safe_sqrt(1 - sqr(cosine));
    const float phi = 2 * kPi * u.y;
    return ray_of(sampler, p,
                  Frame::about(way / distance_m)
                      .to_world(V3f(sine * std::cos(phi), sine * std::sin(phi), cosine)));
}

// A ray from infinity that would cross the ball of glass.
Ray ray_along(const Sampler& sampler, const Scene& scene, const V3f& direction, const Ball& glass) {
    const V2f disk = uniform_disk(sampler.get2(Dim::Film)) * glass.radius_m;
    const float back_m = 1.01f * scene.bounds.size().length();
    return ray_of(sampler,
                  glass.centre + Frame::about(direction).to_world(V3f(disk.x, disk.y, -back_m)),
                  direction);
}

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

// Names lights of a scene, one by one.
class Search {
  public:
    Search(const Scene& scene, const Bvh& bvh, const Ball& glass)
        : scene_(scene), bvh_(bvh), glass_(glass) {}

    void add(const PointLight& light, uint32_t index) {
        add_where_lost({LostLight::Kind::Point, index}, never,
                       [&](const Sampler& s) { return ray_from(s, light.position, glass_); });
    }
    void add(const SpotLight& light, uint32_t index) {
        add_where_lost({LostLight::Kind::Spot, index}, never,
                       [&](const Sampler& s) -> std::optional<Ray> {
                           const Ray ray = ray_from(s, light.position, glass_);
                           if (ray.direction.dot(light.direction) < light.cos_outer) return {};
                           return ray;
                       });
    }
    void add(const SunLight& light, uint32_t index) {
        add_where_lost({LostLight::Kind::Sun, index}, never, [&](const Sampler& s) {
            return ray_along(s, scene_, light.direction, glass_);
        });
    }
    void add(const TriangleLight&, uint32_t) {}  // its lamp is a thing
    void add(const SkyLight&, uint32_t) {}       // its bright spots are things

    void add(const Thing& lamp) {
        const double size = 2 * double(lamp.radius_m);
        if (!lamp.at_infinity) {
            // Share of the directions about a surface, by their cosine, that lead to the lamp.
            const auto chance = [&](double squared_distance_m2) {
                return lamp.area_m2 / (double(kPi) * squared_distance_m2);
            };
            add_where_lost({LostLight::Kind::Lamp, 0, size}, chance, [&](const Sampler& s) {
                const V3f direction = uniform_sphere(s.get2(Dim::Film));
                return ray_of(s, lamp.centre + direction * (1.01f * lamp.reach_m), direction);
            });
            return;
        }
        // The texels of a sun are things of their own.
        const auto is_near = [&](const V3f& d) { return d.dot(lamp.centre) > kOneSpot; };
        if (std::any_of(sky_spots_.begin(), sky_spots_.end(), is_near)) return;
        sky_spots_.push_back(lamp.centre);
        add_where_lost(
            {LostLight::Kind::SkySpot, 0, size}, [&](double) { return lamp.area_m2 / double(kPi); },
            [&](const Sampler& s) { return ray_along(s, scene_, -lamp.centre, glass_); });
    }

    std::vector<LostLight> out;

  private:
    static double never(double) { return 0; }

    // chance: of a path that leaves a surface at that squared distance. ray: one that the light
    // sends, or none.
    template <class Chance, class MakeRay>
    void add_where_lost(LostLight found, const Chance& chance, const MakeRay& ray) {
        std::map<uint32_t, int> through;
        int landed = 0, lost = 0;
        double squares_m2 = 0;
        for (uint32_t i = 0; i < kRays; ++i) {
            const std::optional<Ray> sent = ray(Sampler(SamplerKind::Owen, 1, {0, 0, i}));
            if (!sent) continue;
            const Arrival arrival = follow(scene_, bvh_, *sent);
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

    const Scene& scene_;
    const Bvh& bvh_;
    const Ball glass_;
    std::vector<V3f> sky_spots_;  // directions
};

}  // namespace

std::vector<LostLight> lost_light(const Scene& scene, const Bvh& bvh) {
    const std::optional<Ball> glass = ball_of_glass(scene);
    if (!glass) return {};
    Search search(scene, bvh, *glass);
    for (uint32_t i = 0; i < scene.lights.size(); ++i)
        std::visit([&](const auto& light) { search.add(light, i); }, scene.lights[i]);
    for (const Thing& thing : things_of(scene))
        if (thing.is_lamp()) search.add(thing);
    return search.out;
}

}  // namespace petzval
