// SPDX-License-Identifier: Apache-2.0
#include "integrator/prepass/lost_light.h"

#include <algorithm>
#include <map>
#include <optional>

#include "core/sampling/sampler.h"
#include "core/sampling/warp.h"
#include "core/shading/surface.h"

namespace petzval::integrator {
namespace {

constexpr uint32_t kRays = 256;
constexpr uint32_t kMostPunctual = 512;
constexpr double kLeastShare = 0.01;  // of a lamp's light
constexpr float kLeastTransmission = 0.05f;
constexpr int kMostFaces = 64;        // that one ray passes
constexpr float kOneSpot = 0.99939f;  // cosine of 2 degrees

bool may_be_solid_and_smooth(const Material& m) {
    return m.refracts() &&
           (m.metallic_roughness_texture.present() || sqr(m.roughness) < kSmallestAlpha);
}

// Points on glass that may be solid and smooth: as many on each object, whatever its size.
class GlassPoints {
  public:
    explicit GlassPoints(const Scene& scene) : scene_(scene) {
        for (uint32_t i = 0; i < scene.instances.size(); ++i) {
            const Mesh& mesh = scene.meshes[scene.instances[i].mesh];
            if (may_be_solid_and_smooth(scene.materials[mesh.material]) && !mesh.triangles.empty())
                objects_.push_back(i);
        }
    }
    [[nodiscard]] bool empty() const { return objects_.empty(); }
    [[nodiscard]] V3f draw(const Sampler& sampler) const {
        const V2f pick = sampler.get2(Dim::Lens), u = uniform_triangle(sampler.get2(Dim::Film));
        const uint32_t object = objects_[index(pick.x, objects_.size())];
        const Mesh& mesh = scene_.meshes[scene_.instances[object].mesh];
        const auto triangle = static_cast<uint32_t>(index(pick.y, mesh.triangles.size()));
        const auto corners = triangle_corners(scene_, object, triangle);
        return corners[0] * (1 - u.x - u.y) + corners[1] * u.x + corners[2] * u.y;
    }

  private:
    static size_t index(float u, size_t count) {
        return std::min(static_cast<size_t>(double(u) * double(count)), count - 1);
    }
    const Scene& scene_;
    std::vector<uint32_t> objects_;
};

Ray ray_of(const Sampler& sampler, const V3f& origin, const V3f& direction) {
    Ray ray;
    ray.origin = origin;
    ray.direction = direction;
    ray.alpha_seed = sampler.get_bits(Dim::Coverage, 0);
    return ray;
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
        const auto is_clear = [&] {
            if (!s.material->may_be_pane() && !may_be_solid_and_smooth(*s.material)) return false;
            const BsdfInput at = read_material(scene, s, -ray.direction, Bands::rgb()).bsdf;
            return sqr(at.roughness) < kSmallestAlpha &&
                   at.transmission * (1 - at.metallic) >= kLeastTransmission;
        };
        if (!is_clear()) {
            out.lands = true;
            out.distance_m = double((s.p - start).length());
            return out;
        }
        if (s.material->has_volume && !out.first_glass) out.first_glass = s.mesh->material;
        ray.origin = offset_origin(s.p, s.p_error, s.ng, ray.direction);
    }
    return out;
}

// Names lights of a scene, one by one.
class LostLightSearch {
  public:
    LostLightSearch(const Scene& scene, const Bvh& bvh, const GlassPoints& glass)
        : scene_(scene), bvh_(bvh), glass_(glass) {}

    void add(const PointLight& light, uint32_t index) {
        add_where_lost({LostLight::Kind::Point, index}, 0, never,
                       [&](const Sampler& s) { return towards_glass(s, light.position); });
    }
    void add(const SpotLight& light, uint32_t index) {
        // The glass may be small in the cone, or the cone on the glass.
        add_where_lost({LostLight::Kind::Spot, index}, 0, never,
                       [&](const Sampler& s) -> std::optional<Ray> {
                           if (s.get_bits(Dim::LightPoint, 0) % 2 == 0) return within(s, light);
                           const Ray ray = towards_glass(s, light.position);
                           if (ray.direction.dot(light.direction) < light.cos_outer) return {};
                           return ray;
                       });
    }
    void add(const ProfileLight& light, uint32_t index) {
        add_where_lost({LostLight::Kind::Point, index}, 0, never,
                       [&](const Sampler& s) -> std::optional<Ray> {
                           const Ray ray = towards_glass(s, light.position);
                           const V3f& d = ray.direction;
                           const V3f local(d.dot(light.x), d.dot(light.y), d.dot(light.f));
                           if (!(scene_.profiles[light.profile].intensity(local) > 0)) return {};
                           return ray;
                       });
    }
    void add(const SunLight& light, uint32_t index) {
        if (light.has_disc()) return;  // it is a thing
        add_where_lost({LostLight::Kind::Sun, index}, 0, never,
                       [&](const Sampler& s) { return along_to_glass(s, light.direction); });
    }
    void add(const TriangleLight&, uint32_t) {}  // its lamp is a thing
    void add(const SkyLight&, uint32_t) {}       // its bright spots are things

    void add(const SmallFeature& lamp) {
        const double size = 2 * double(lamp.reach_m);
        if (!lamp.at_infinity) {
            // Share of the directions about a surface, by their cosine, that lead to the lamp.
            const auto chance = [&](double squared_distance_m2) {
                return lamp.area_m2 / (double(kPi) * squared_distance_m2);
            };
            add_where_lost(
                {LostLight::Kind::Lamp, 0, size}, kLeastShare, chance, [&](const Sampler& s) {
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
            {LostLight::Kind::SkySpot, 0, size}, 0,
            [&](double) { return lamp.area_m2 / double(kPi); },
            [&](const Sampler& s) { return along_to_glass(s, -lamp.centre); });
    }

    std::vector<LostLight> out;

  private:
    static double never(double) { return 0; }

    [[nodiscard]] Ray towards_glass(const Sampler& sampler, const V3f& p) const {
        return ray_of(sampler, p, unit(glass_.draw(sampler) - p));
    }
    [[nodiscard]] Ray along_to_glass(const Sampler& sampler, const V3f& direction) const {
        const float back_m = 1.01f * scene_.bounds.size().length();
        return ray_of(sampler, glass_.draw(sampler) - direction * back_m, direction);
    }
    [[nodiscard]] static Ray within(const Sampler& sampler, const SpotLight& light) {
        const V2f u = sampler.get2(Dim::Film);
        const float cosine = 1 - u.x * (1 - light.cos_outer), sine = safe_sqrt(1 - sqr(cosine));
        const float phi = 2 * kPi * u.y;
        const Frame frame = Frame::about(light.direction);
        return ray_of(sampler, light.position,
                      frame.to_world(V3f(sine * std::cos(phi), sine * std::sin(phi), cosine)));
    }

    // chance: of a path that leaves a surface at that squared distance. ray: one that the light
    // sends, or none.
    template <class Chance, class MakeRay>
    void add_where_lost(LostLight found, double least_share, const Chance& chance,
                        const MakeRay& ray) {
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
        if (lost == 0 || lost < least_share * landed) return;
        if (!(chance(squares_m2 / lost) < kHardlyAnyPath)) return;
        found.share = double(lost) / landed;
        found.glass = std::max_element(through.begin(), through.end(), [](auto& a, auto& b) {
                          return a.second < b.second;
                      })->first;
        out.push_back(found);
    }

    const Scene& scene_;
    const Bvh& bvh_;
    const GlassPoints& glass_;
    std::vector<V3f> sky_spots_;  // directions
};

}  // namespace

std::vector<LostLight> lost_light(const Scene& scene, const Bvh& bvh) {
    const GlassPoints glass(scene);
    if (glass.empty()) return {};
    LostLightSearch search(scene, bvh, glass);
    uint32_t punctual = 0;
    for (uint32_t i = 0; i < scene.lights.size(); ++i) {
        if (std::holds_alternative<TriangleLight>(scene.lights[i])) break;  // the file's come first
        if (++punctual > kMostPunctual) break;
        std::visit([&](const auto& light) { search.add(light, i); }, scene.lights[i]);
    }
    for (const SmallFeature& feature : small_features_of(scene))
        if (feature.is_lamp()) search.add(feature);
    return search.out;
}

}  // namespace petzval::integrator
