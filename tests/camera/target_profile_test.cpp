// SPDX-License-Identifier: Apache-2.0
// Profiles of discs of confusion by rays to targets, against light that is traced the other way:
// from the lamp through the lens to the film, in doubles.
#include <gtest/gtest.h>

#include <numbers>

#include "camera/lens/traced_ray.h"
#include "camera/targets/make_target_camera.h"
#include "core/sampling/warp.h"
#include "core/spectrum/glass.h"
#include "tests/support/lens_cameras.h"
#include "tests/support/targets.h"

namespace petzval::camera {
namespace {

using test::Mean;
using test::Moments;
using test::random2;

/// A round lamp of radiance 1 that faces the camera of a lens, in its space. Metres.
struct Lamp {
    V3d centre;
    double radius_m;
};

constexpr int kBins = 6;
/// Square bins of the film about a point, mm.
struct ProfileBins {
    V2d middle_mm;
    double side_mm;  ///< of all together

    [[nodiscard]] double area_mm2() const { return side_mm * side_mm / (kBins * kBins); }
    [[nodiscard]] int bin(double x_mm, double y_mm) const {
        const auto i = static_cast<int>(std::floor(((x_mm - middle_mm.x) / side_mm + 0.5) * kBins));
        const auto j = static_cast<int>(std::floor(((y_mm - middle_mm.y) / side_mm + 0.5) * kBins));
        return i < 0 || j < 0 || i >= kBins || j >= kBins ? -1 : j * kBins + i;
    }
};

/// Light from even points of the lamp to even points of a disc at the first vertex, which is wider
/// than the lens.
class LightTracer {
  public:
    LightTracer(const LensCameraInput& in, const Lamp& lamp) : in_(in), lamp_(lamp) {
        front_mm_ = in.lens->prescription().surfaces.front().semi_diameter_mm * 1.3;
    }
    /// Where light number i reaches the film, and the flux that it carries, mm^2 sr; nothing where
    /// the lens stops it.
    struct Arrival {
        double x_mm, y_mm, flux;
    };
    [[nodiscard]] std::optional<Arrival> light(uint32_t i) const {
        const V2d on = V2d(uniform_disk(random2(i, 1))) * (1e3 * lamp_.radius_m),
                  through = V2d(uniform_disk(random2(i, 2))) * front_mm_;
        const V3d centre = 1e3 * lamp_.centre + V3d(0, 0, in_.entrance_pupil_mm);
        const V3d from = centre + V3d(on.x, on.y, 0), to = V3d(through.x, through.y, 0) - from;
        const double cosine2 = to.z * to.z / to.length2();  // at the lamp and at the disc
        const TracedRay ray = trace_ray(*in_.lens, from, to, kLineD_nm, Towards::Film, Clip::Yes);
        if (ray.status != RayStatus::Passed) return std::nullopt;
        const auto film = ray.at_plane(in_.film_mm);
        if (!film) return std::nullopt;
        const double areas = std::numbers::pi * std::numbers::pi * front_mm_ * front_mm_ * 1e6 *
                             lamp_.radius_m * lamp_.radius_m;
        return Arrival{(*film)[0], (*film)[1], areas * cosine2 / to.length2()};
    }

  private:
    const LensCameraInput& in_;
    Lamp lamp_;
    double front_mm_;
};

void expect_same_profile(const char* name, const Lamp& lamp) {
    LensCameraInput in = test::input_of(name, DispersionMode::Shared);
    in.to_world = M44f();
    const auto aims = target_camera(std::make_shared<LensCamera>(in));
    TargetCamera& camera = *aims;
    const LightTracer tracer(in, lamp);
    // The first light that arrives tells where the disc is, the next how large.
    V2d low(INFINITY, INFINITY), high(-INFINITY, -INFINITY);
    for (uint32_t i = 0; i < 4000; ++i)
        if (const auto at = tracer.light(i)) {
            low = {std::min(low.x, at->x_mm), std::min(low.y, at->y_mm)};
            high = {std::max(high.x, at->x_mm), std::max(high.y, at->y_mm)};
        }
    const ProfileBins bins{(low + high) / 2, 1.1 * std::max(high.x - low.x, high.y - low.y)};

    constexpr uint32_t kLights = 250'000;
    std::array<Moments, kBins * kBins> traced{}, found{};
    for (uint32_t i = 0; i < kLights; ++i) {
        const auto at = tracer.light(i + 5000);
        const int bin = at ? bins.bin(at->x_mm, at->y_mm) : -1;
        for (int b = 0; b < kBins * kBins; ++b)
            traced[size_t(b)].add(b == bin ? at->flux / bins.area_mm2() : 0);
    }

    const V3f centre(lamp.centre);
    const Bands bands = Bands::rgb();
    // A bin is a pixel.
    const V2f frame_px(V2d(in.film_width_mm, in.film_height_mm) * (kBins / bins.side_mm));
    const Filter filter(FilterKind::Box, 0.5f);
    for (int b = 0; b < kBins * kBins; ++b) {
        const V2d mm = bins.middle_mm +
                       bins.side_mm * (V2d((b % kBins + 0.5) / kBins, (b / kBins + 0.5) / kBins) -
                                       V2d(0.5, 0.5));
        const test::Pixel pixel{
            &filter, frame_px,
            V2f(V2d(0.5 - mm.x / in.film_width_mm, 0.5 + mm.y / in.film_height_mm))};
        const V2f half = V2f(0.5f) / frame_px;
        camera.set_targets(test::grid_of(
            test::listed_in(camera, {pixel.middle - half, pixel.middle + half}, V2i(frame_px),
                            {{centre, static_cast<float>(lamp.radius_m)}})));
        for (uint32_t i = 0; i < 2048; ++i) {
            const FilmPoint at = pixel.draw(Sampler(SamplerKind::Independent, 8, {b, 0, i}));
            double sum = 0;
            for (const CameraPath& path : camera.sample(at, bands)) {
                const V3f& o = path.ray.origin;
                const float t = (centre.z - o.z) / path.ray.direction.z;
                const V3f p = o + t * path.ray.direction - centre;
                if (t > 0 && double(p.length()) <= lamp.radius_m)
                    sum += double(path.weight[0]) * double(path.mis_weight);
            }
            found[size_t(b)].add(sum);
        }
    }
    double lit = 0, error = 0;
    for (size_t b = 0; b < found.size(); ++b) {
        EXPECT_TRUE(test::agrees(Mean(found[b]) - Mean(traced[b]), 0))
            << name << " bin " << b << ": " << Mean(found[b]) << ", " << Mean(traced[b]);
        lit += traced[b].mean();
        error += sqr(found[b].standard_error());
    }
    EXPECT_GT(lit, 0);
    EXPECT_LT(std::sqrt(error), 0.02 * lit) << "it is rays to targets that find the light";
}

TEST(TargetProfiles, AreThoseOfALightTracer) {
    expect_same_profile("takumar-50mm-f1.2", {V3d(0.2, 0.1, -3), 0.002});
    expect_same_profile("takumar-50mm-f1.2", {V3d(0.9, -0.5, -3), 0.002});  // a cat's eye
    expect_same_profile("double-gauss-100mm-f2", {V3d(0.3, 0.2, -2.5), 0.001});
}

}  // namespace
}  // namespace petzval::camera
