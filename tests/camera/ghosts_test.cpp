// SPDX-License-Identifier: Apache-2.0
// Ghosts, drawn from the film, against walks of light from the scene through the lens, which know
// neither cameras nor regions; and against matrices of paraxial optics.
#include <gtest/gtest.h>

#include <cmath>
#include <map>

#include "camera/bench/light_walk.h"
#include "camera/ghosts/ghost_camera.h"
#include "camera/ghosts/lens_face.h"
#include "tests/support/lens_cameras.h"

namespace petzval {
namespace {

using test::input_of;

const Bands kRgb = Bands::rgb();

std::shared_ptr<const LensCamera> ghostly(const std::string& name, Coating coating) {
    LensCameraInput in = input_of(name, DispersionMode::Shared);
    in.to_world = M44f();
    in.coating = coating;
    return std::make_shared<LensCamera>(std::move(in));
}

/// A disc of the sky of radiance 1, so many degrees above the axis.
SmallFeature sun_at(double deg, float radius_rad) {
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

bool hits(const Ray& ray, const SmallFeature& sun) {
    return double(ray.direction.dot(sun.centre)) >= std::cos(double(sun.reach_m));
}

struct Sums {
    double sum = 0, squares = 0;
    int count = 0;
    void add(double a) { sum += a, squares += a * a, ++count; }
    [[nodiscard]] double variance(double of) const {
        return std::max(0., squares - sum * sum / of);
    }
};

/// Light of a disc that each sample of the camera brings.
Sums light_of(const Camera& camera, const SmallFeature& sun, uint32_t count) {
    Sums out;
    for (uint32_t i = 0; i < count; ++i) {
        const Sampler sampler(SamplerKind::Independent, 5, {0, 0, i});
        double light = 0;
        for (const CameraPath& path : camera.sample({sampler.get2(Dim::Film), sampler}, kRgb))
            if (hits(path.ray, sun)) light += double(path.weight[0] * path.mis_weight);
        out.add(light);
    }
    return out;
}

using PairLight = std::map<std::pair<int, int>, Sums>;

/// Light on the film by pair, of rays from a disc over the front surface, at random.
PairLight walked(const LensCamera& camera, const SmallFeature& sun, uint32_t count) {
    const Lens& lens = *camera.input().lens;
    const LensCoats coats(lens, camera.input().coating);
    LightWalk walk(lens, coats, kLineD_nm);
    const double reach = lens.prescription().surfaces[0].semi_diameter_mm;
    const V3d d = -V3d(sun.centre);
    PairLight out;
    for (uint32_t i = 0; i < count; ++i) {
        const Sampler sampler(SamplerKind::Owen, 3, {0, 0, i});
        const V2d at = (V2d(sampler.get2(Dim::Lens)) * 2.0 - V2d(1)) * reach;
        const auto face = at.length() <= reach ? face_point(lens, 0, at) : std::nullopt;
        if (!face || !(d.dot(face->normal) > 0)) continue;
        LightRay ray;
        ray.direction = d;
        ray.origin_mm = face->point_mm - d;
        ray.share = d.dot(face->normal) / face->normal.z * 4 * reach * reach * sun.area_m2;
        walk.follow(
            ray,
            [&](const LightEnd& end) {
                if (end.fate != LightFate::BehindLens || end.ray.reflections != 2) return;
                const V3d from = end.ray.origin_mm, way = end.ray.direction;
                const V3d film = from + way * ((camera.input().film_mm - from.z) / way.z);
                if (std::fabs(film.x) <= camera.input().film_width_mm / 2 &&
                    std::fabs(film.y) <= camera.input().film_height_mm / 2)
                    out[{end.ray.mirrors[0], end.ray.mirrors[1]}].add(end.ray.share);
            },
            false);
    }
    return out;
}

/// Light on the film by pair, of points that regions draw.
PairLight drawn(const GhostOptics& optics, const SmallFeature& sun, uint32_t count) {
    const GhostRegions regions(optics, {&sun, 1});
    const LensCamera& camera = optics.camera();
    const auto film_mm2 = camera.input().film_width_mm * camera.input().film_height_mm;
    const f4 nm = splat(float(kLineD_nm));
    const LensIndices<f4> indices = optics.lens().exact_indices(nm);
    PairLight out;
    for (uint32_t i = 0; i < count; ++i) {
        const Sampler sampler(SamplerKind::Owen, 4, {0, 0, i});
        const V2f film = camera.film_mm(sampler.get2(Dim::Film));
        const auto at =
            regions.draw(film, 0, sampler.get1(Dim::GhostPick), sampler.get2(Dim::GhostPoint));
        if (!at || at->rear_mm.length() > float(optics.rear_mm())) continue;
        const GhostPair pair = optics.pairs()[at->pair];
        const auto found = optics.ray(pair, film, at->rear_mm, indices, nm, m4{-1, 0, 0, 0});
        if (!found || !hits(camera.in_world(lane_of(found->ray, 0)), sun)) continue;
        out[{pair.first, pair.second}].add(double(found->share[0] * found->sr_per_mm2) /
                                           double(regions.density(film, 0, *at)) * film_mm2);
    }
    return out;
}

TEST(Ghosts, HaveTheLightOfAWalkThroughTheLensPairByPair) {
    struct Case {
        const char* lens;
        double deg;
    };
    constexpr uint32_t kWalks = 40000, kDraws = 200000;
    for (const auto& [name, deg] : {Case{"takumar-50mm-f1.2", 10}, Case{"canon-14mm-f2.8-asph", 30},
                                    Case{"schneider-anamorphic-31mm", 8}}) {
        SCOPED_TRACE(name);
        const auto camera = ghostly(name, Coating::Uncoated);
        const GhostOptics optics(camera);
        const SmallFeature sun = sun_at(deg, 0.00465f);
        PairLight from_scene = walked(*camera, sun, kWalks), from_film = drawn(optics, sun, kDraws);
        double scene = 0, film = 0, variance = 0;
        for (const auto& [pair, light] : from_scene) scene += light.sum / kWalks;
        int tested = 0;
        for (const auto& [pair, light] : from_scene) {
            const double walk = light.sum / kWalks, draw = from_film[pair].sum / kDraws;
            const double error2 = light.squares / kWalks / kWalks +
                                  from_film[pair].variance(kDraws) / kDraws / kDraws;
            film += draw;
            variance += error2;
            // Too few hits say nothing of their own spread.
            if (walk < 1e-3 * scene || from_film[pair].count < 100 || light.count < 100) continue;
            ++tested;
            // About 200 pairs in all: 1 in 10^4 for all of them together.
            const double error = 5 * std::sqrt(error2) + 0.005 * walk;
            EXPECT_LT(draw, walk + error) << pair.first << "," << pair.second;
            // What the regions of a faint pair miss, the draws over all bring.
            const double missed = walk < 0.01 * scene ? 0.3 * walk : 0;
            EXPECT_GT(draw, walk - error - missed) << pair.first << "," << pair.second;
        }
        EXPECT_GT(tested, 30);
        EXPECT_NEAR(film, scene, 4 * std::sqrt(variance) + 0.01 * scene);
    }
}

// Of a lamp so wide that rays over all of the last surface find it as well.
TEST(GhostCamera, OfALampKeepTheirMeanWithRegionsAndWithout) {
    const auto camera = ghostly("takumar-50mm-f1.2", Coating::MgF2);
    const SmallFeature sun = sun_at(15, 0.12f);
    constexpr uint32_t kCount = 300000;
    const GhostOptics optics(camera);
    GhostRegions regions(optics, {&sun, 1});
    ASSERT_FALSE(regions.empty());
    const Sums with = light_of(GhostCamera(nullptr, optics, std::move(regions)), sun, kCount),
               without = light_of(GhostCamera(nullptr, optics, {}), sun, kCount);
    const double error = std::sqrt(with.variance(kCount) + without.variance(kCount));
    EXPECT_LT(error, 0.08 * without.sum);
    EXPECT_NEAR(with.sum, without.sum, 4 * error);
    EXPECT_LT(with.variance(kCount) * 4, without.variance(kCount))
        << with.sum << " " << without.sum << " " << with.variance(kCount) << " "
        << without.variance(kCount);
}

/// Height and angle, in the medium, of a ray near the axis.
struct Paraxial {
    double y = 0, u = 0;
};

// Lies where matrices put it: refraction n' u' = n u - y (n' - n) c, reflection with n' = -n.
TEST(Ghosts, OfASmallAngleLieWhereParaxialOpticsSays) {
    const auto camera = ghostly("double-gauss-100mm-f2", Coating::Uncoated);
    const GhostOptics optics(camera);
    const Lens& lens = optics.lens();
    const auto& surfaces = lens.prescription().surfaces;
    const LensIndices<d4> n = lens.exact_indices(broadcast<d4>(kLineD_nm));
    const double angle = 1e-4;
    int tested = 0;
    for (const GhostPair pair : optics.pairs()) {
        Paraxial ray{0, angle};
        double index = 1;  // of the opposite sign on the way back
        int surface = 0, step = 1;
        for (;;) {
            const auto& s = lens.surfaces<double>()[size_t(surface)];
            const bool mirrors = (step == 1 && surface == pair.first && index > 0) ||
                                 (step == -1 && surface == pair.second);
            const double into =
                mirrors ? -index
                        : std::copysign(
                              n.of_medium[step == 1 ? s.medium_after : s.medium_before][0], index);
            ray.u = (index * ray.u -
                     ray.y * (into - index) * surfaces[size_t(surface)].curvature_1_mm) /
                    into;
            index = into;
            if (mirrors) {
                if (step == -1) {
                    step = 1;
                    index = std::fabs(index);
                    surface += 1;
                    ray.y += ray.u * surfaces[size_t(surface - 1)].thickness_mm;
                    // From here on all surfaces let it through.
                    for (; surface <= lens.last(); ++surface) {
                        const auto& t = lens.surfaces<double>()[size_t(surface)];
                        const double next = n.of_medium[t.medium_after][0];
                        ray.u = (index * ray.u - ray.y * (next - index) *
                                                     surfaces[size_t(surface)].curvature_1_mm) /
                                next;
                        index = next;
                        ray.y += ray.u * (surface == lens.last()
                                              ? camera->input().film_mm - lens.vertex_mm(surface)
                                              : surfaces[size_t(surface)].thickness_mm);
                    }
                    break;
                }
                step = -1;
            }
            const int gap = step == 1 ? surface : surface - 1;
            ray.y += step * ray.u * surfaces[size_t(gap)].thickness_mm;
            surface += step;
        }
        LensRay<d4> traced;
        traced.direction = {d4{}, broadcast<d4>(std::sin(angle)), broadcast<d4>(std::cos(angle))};
        if (!trace_ghost<d4>(lens, pair, Towards::Film, Clip::No, n, traced,
                             [](const auto&, const GhostStep&) {})[0])
            continue;
        const double to_film =
            camera->input().film_mm - lens.vertex_mm(traced.counted_from) - traced.origin.z[0];
        const double y =
            traced.origin.y[0] + to_film * traced.direction.y[0] / traced.direction.z[0];
        EXPECT_NEAR(y, ray.y, 1e-3 * std::fabs(ray.y) + 1e-7) << pair.first << "," << pair.second;
        ++tested;
    }
    EXPECT_GT(tested, 20);
}

// What leaves the lens for the scene comes back the same way.
TEST(Ghosts, TakeTheSameWayBackwards) {
    const auto camera = ghostly("canon-14mm-f2.8-asph", Coating::Uncoated);
    const GhostOptics optics(camera);
    const f4 nm = splat(float(kLineD_nm));
    const LensIndices<d4> indices = optics.lens().exact_indices(broadcast<d4>(kLineD_nm));
    int tested = 0;
    for (uint32_t i = 0; i < 20000; ++i) {
        const Sampler sampler(SamplerKind::Independent, 9, {0, 0, i});
        const GhostPair pair = optics.pairs()[i % optics.pairs().size()];
        const V2f film = camera->film_mm(sampler.get2(Dim::Film));
        const V2f rear = (sampler.get2(Dim::Lens) * 2.f - V2f(1)) * float(optics.rear_mm());
        const auto found =
            optics.ray(pair, film, rear, optics.lens().exact_indices(nm), nm, m4{-1, 0, 0, 0});
        if (!found) continue;
        EXPECT_GT(found->share[0], 0.f);
        EXPECT_LT(found->share[0], 0.1f);
        LensRay<d4> back;
        const auto lanes = [](const Vec3<f4>& v) {
            return Vec3<d4>{broadcast<d4>(double(v.x[0])), broadcast<d4>(double(v.y[0])),
                            broadcast<d4>(double(v.z[0]))};
        };
        back.origin = lanes(found->ray.origin);
        back.direction = lanes(found->ray.direction) * broadcast<d4>(-1);
        back.counted_from = found->ray.counted_from;
        ASSERT_TRUE(trace_ghost<d4>(optics.lens(), pair, Towards::Film, Clip::No, indices, back,
                                    [](const auto&, const GhostStep&) {})[0]);
        const double to_film =
            camera->input().film_mm - optics.lens().vertex_mm(back.counted_from) - back.origin.z[0];
        EXPECT_NEAR(back.origin.x[0] + to_film * back.direction.x[0] / back.direction.z[0],
                    double(film.x), 0.02);
        EXPECT_NEAR(back.origin.y[0] + to_film * back.direction.y[0] / back.direction.z[0],
                    double(film.y), 0.02);
        ++tested;
    }
    EXPECT_GT(tested, 300);
}

TEST(Ghosts, AreNotThereWhereNothingReflects) {
    EXPECT_TRUE(GhostOptics(ghostly("takumar-50mm-f1.2", Coating::Ideal)).pairs().empty());
    // 10 surfaces against air or cement of the double Gauss, the stop apart.
    EXPECT_EQ(GhostOptics(ghostly("double-gauss-100mm-f2", Coating::Uncoated)).pairs().size(), 45u);
}

}  // namespace
}  // namespace petzval
