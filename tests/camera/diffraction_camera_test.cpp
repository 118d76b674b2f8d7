// SPDX-License-Identifier: Apache-2.0
// The camera that diffracts: its rays against Airy's light within circles, its light in all, and
// stars with draws towards lamps and without.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "camera/diffraction/diffraction_camera.h"
#include "camera/targets/make_target_camera.h"
#include "core/sampling/warp.h"
#include "tests/support/lens_cameras.h"

namespace petzval::camera {
namespace {

using test::input_of;

Bands lines_of(f4 nm) {
    Bands out;
    out.nm = nm, out.on = m4{-1, -1, -1, -1}, out.spectral = true;
    out.pdf = splat(1.f);
    return out;
}
const Bands kFourLines = lines_of(f4{440, 520, 590, 660});

constexpr float kFov_rad = 0.6f, kAspect = 1.5f, kThinStop_mm = 1.5f;

std::shared_ptr<const ThinLensCamera> thin_lens(const ApertureShape& shape = Disk{}) {
    return std::make_shared<ThinLensCamera>(
        ThinLens{M44f(), kFov_rad, kAspect, Iris(shape, double(kThinStop_mm)), 1e9f});
}

/// By default pixels are so fine that lanes share no displacement unweighed.
DiffractionCamera diffracting(std::shared_ptr<const Camera> rays, LampImages lamps = {},
                              V2i frame_px = V2i(1 << 20)) {
    FilmSpread spread(*stop_camera(rays));
    const float shared = shared_frequency(spread, frame_px);
    return {rays, rays,
            std::make_shared<const Diffraction>(
                Diffraction{std::move(spread), std::move(lamps), shared})};
}

Sampler sampler_of(uint32_t i, SamplerKind kind = SamplerKind::Owen) {
    return {kind, 9, {0, 0, i}};
}

// A distant point's light: within an angle of r wavelength / diameter lies what Rayleigh's formula
// says, for each of the lanes that share a ray.
TEST(DiffractionCamera, LightOfEachWavelengthLiesWithinRadiiAsAirysDoes) {
    const DiffractionCamera camera = diffracting(thin_lens());
    constexpr uint32_t count = 1 << 17;
    constexpr std::array radii{0.6, 1.2197, 3.0, 10.0, 60.0};
    std::array<std::array<double, 4>, radii.size()> within{};
    for (uint32_t i = 0; i < count; ++i) {
        Bands bands = kFourLines;
        bands.hero = int(i % 4);
        for (const CameraPath& path : camera.sample({V2f(0.5f), sampler_of(i)}, bands)) {
            const V3f d = path.ray.direction;
            const double slope = std::hypot(double(d.x), double(d.y)) / -double(d.z);
            for (int lane = 0; lane < 4; ++lane) {
                const double unit = double(kFourLines.nm[lane]) * 1e-6 / (2 * double(kThinStop_mm));
                for (size_t k = 0; k < radii.size(); ++k)
                    if (slope < radii[k] * unit)
                        within[k][size_t(lane)] +=
                            double(path.weight[lane] * path.mis_weight) / count;
            }
        }
    }
    for (size_t k = 0; k < radii.size(); ++k) {
        const double x = std::numbers::pi * radii[k];
        const double exact =
            1 - std::pow(std::cyl_bessel_j(0, x), 2) - std::pow(std::cyl_bessel_j(1, x), 2);
        for (size_t lane = 0; lane < 4; ++lane)
            EXPECT_NEAR(within[k][lane], exact, 0.006) << radii[k] << ' ' << lane;
    }
}

// Of an even scene each film point gets what it gets without diffraction.
TEST(DiffractionCamera, KeepsTheLightOfAnEvenScene) {
    LensCameraInput in = input_of("double-gauss-100mm-f2");
    in.iris = Iris(regular_polygon(6), 3);
    const std::array<std::shared_ptr<const Camera>, 3> cameras{
        thin_lens(), thin_lens(Mask{2, 2, {1, 0, 0.3f, 1}}), std::make_shared<LensCamera>(in)};
    constexpr uint32_t count = 1 << 18;
    for (const auto& rays : cameras) {
        const DiffractionCamera camera = diffracting(rays);
        for (const V2f& film : {V2f(0.5f), V2f(0.02f, 0.97f), V2f(0.3f, 0.6f)}) {
            f4 plain{}, spread{};
            for (uint32_t i = 0; i < count; ++i) {
                Bands bands = kFourLines;
                bands.hero = int(i % 4);
                const FilmPoint at{film, sampler_of(i)};
                for (const CameraPath& path : rays->sample(at, bands)) plain += path.weight;
                for (const CameraPath& path : camera.sample(at, bands))
                    spread += path.weight * path.mis_weight;
            }
            // Some of what is aimed beyond the reach of a lens would have come here. Lanes share
            // rays, and so their light; each by itself is less sure.
            EXPECT_NEAR(hsum(spread) / hsum(plain), 1, 2e-3f) << film;
            for (int lane = 0; lane < 4; ++lane)
                EXPECT_NEAR(spread[lane] / plain[lane], 1, 5e-3f) << film << lane;
        }
    }
}

// Of coarse pixels most displacements are far below one, and no lane is weighed.
TEST(DiffractionCamera, EvenScenesHaveLittleNoiseOfColourInCoarsePixels) {
    const DiffractionCamera coarse = diffracting(thin_lens(), {}, {120, 80}),
                            fine = diffracting(thin_lens());
    const auto variance = [](const DiffractionCamera& camera) {
        constexpr uint32_t count = 1 << 14;
        double sum = 0;
        for (uint32_t i = 0; i < count; ++i)
            for (const CameraPath& path : camera.sample({V2f(0.4f), sampler_of(i)}, kFourLines))
                sum += double(sqr(path.weight[0] - 1)) / count;
        return sum;
    };
    EXPECT_LT(variance(coarse), 0.05);
    EXPECT_GT(variance(fine), 0.1);
    EXPECT_LT(variance(fine), 0.5);
}

// An iris that falls between the points of its raster sends rays as they are.
TEST(DiffractionCamera, AnIrisTooThinForItsRasterDiffractsNothing) {
    const Polygon sliver{{{V2d(0, 0.1), V2d(1e5, 0.1), V2d(1e5, 0.2), V2d(0, 0.2)}}};
    const auto rays = thin_lens(sliver);
    const DiffractionCamera camera = diffracting(rays);
    for (uint32_t i = 0; i < 64; ++i) {
        const FilmPoint at{V2f(0.3f), sampler_of(i)};
        const CameraSample plain = rays->sample(at, kFourLines),
                           found = camera.sample(at, kFourLines);
        ASSERT_EQ(found.size(), 1u);
        EXPECT_EQ(found[0].ray.direction, plain[0].ray.direction);
        EXPECT_EQ(found[0].weight[0], plain[0].weight[0]);
    }
}

// On the axis of a lens a unit of the stop's frequencies is one of its f-number: sin u' = 1 / 2N.
TEST(DiffractionCamera, SpreadOfALensIsThatOfItsFNumber) {
    for (const char* name :
         {"double-gauss-100mm-f2", "takumar-50mm-f1.2", "canon-14mm-f2.8-asph"}) {
        LensCameraInput in = input_of(name);
        const double radius = 0.2 * double(in.iris.bounding_radius_mm());
        in.iris = Iris(Disk{}, radius);
        const auto lens = std::make_shared<LensCamera>(in);
        const double sine = std::sqrt(lens->irradiance(V2f(0.f), 4096) / std::numbers::pi);
        const FilmSpread spread{StopCamera(lens)};
        const V2f middle = spread.cosines(V2f(0.5f)).cosines;
        const auto mm_of_unit = [&](V2f unit, double film_mm) {
            return double((*spread.film_of(middle, unit, 500) - V2f(0.5f)).length()) * film_mm /
                   500;
        };
        const double wanted = 1e-6 * radius / sine, x = mm_of_unit({20, 0}, in.film_width_mm) / 20;
        EXPECT_NEAR(x / wanted, 1, 0.005) << name;
        EXPECT_NEAR(mm_of_unit({0, 20}, in.film_height_mm) / 20 / x, 1, 0.002) << name;
        // And back.
        const V2f corner(0.03f, 0.98f);
        const auto found = spread.film_of(spread.cosines(corner).cosines, V2f(0.f), 500);
        ASSERT_TRUE(found) << name;
        EXPECT_LT((*found - corner).length(), 1e-5f) << name;
    }
}

/// A sun straight ahead, tangent of its radius 0.003.
SmallFeature sun() {
    SmallFeature out{SmallFeature::Kind::Lamp, V3f(0, 0, -1)};
    out.radius_m = out.reach_m = 0.003f;
    out.at_infinity = true, out.area_m2 = 3e-5, out.radiance = 1e9;
    return out;
}

struct LightEstimate {
    double mean = 0, variance = 0;
};
LightEstimate light_at(const Camera& camera, V2f film, uint32_t count) {
    double sum = 0, squares = 0;
    for (uint32_t i = 0; i < count; ++i) {
        double light = 0;
        Bands bands = kFourLines;
        bands.hero = int(i % 4);
        for (const CameraPath& path :
             camera.sample({film, sampler_of(i, SamplerKind::Independent)}, bands))
            if (path.ray.direction.z < -std::cos(0.003f))
                light += double(hsum(path.weight) * path.mis_weight);
        sum += light, squares += light * light;
    }
    return {sum / count, (squares - sum * sum / count) / count / count};
}

// All light that a sun sends to a part of a coarse picture is there once: within it and beside it.
TEST(DiffractionCamera, StarsOfCoarsePixelsHaveTheirLightOnce) {
    const auto rays = thin_lens(regular_polygon(5));
    const FilmSpread spread(*stop_camera(rays));
    const std::array lamps{sun()};
    const LampImages images(*target_camera(rays), {48, 32}, lamps, spread);
    const auto light = [&](const DiffractionCamera& camera) {
        constexpr uint32_t count = 1 << 18;
        double sum = 0;
        for (uint32_t i = 0; i < count; ++i) {
            const Sampler sampler = sampler_of(i);
            const V2f film = V2f(0.5f) + (sampler.get2(Dim::Film) - V2f(0.5f)) * V2f(0.1f, 0.15f);
            for (const CameraPath& path : camera.sample({film, sampler}, kFourLines))
                if (path.ray.direction.z < -std::cos(0.003f))
                    sum += double(hsum(path.weight) * path.mis_weight) / count;
        }
        return sum;
    };
    const double plain = light(diffracting(rays, {}, {48, 32})),
                 aimed = light(diffracting(rays, images, {48, 32})),
                 weighed = light(diffracting(rays, images));
    EXPECT_NEAR(aimed / plain, 1, 0.02);
    EXPECT_NEAR(weighed / plain, 1, 0.02);
}

// Against the pattern's own density, summed over the sun's disc.
TEST(DiffractionCamera, StarsHaveTheirLightWithDrawsTowardsLampsAndLoseTheirNoise) {
    const auto rays = thin_lens(regular_polygon(5));
    const FilmSpread spread(*stop_camera(rays));
    const std::array lamps{sun()};
    const LampImages images(*target_camera(rays), {600, 400}, lamps, spread);
    ASSERT_FALSE(images.empty());
    const DiffractionCamera plain = diffracting(rays, {}, {600, 400}),
                            aimed = diffracting(rays, images, {600, 400});
    const float high = 2 * std::tan(kFov_rad / 2);
    const V2f disc = V2f(0.003f / kAspect, 0.003f) / high;
    // In the sun, beside it, in a spike near and far, and between two.
    for (const V2f& film : {V2f(0.5f), V2f(0.506f, 0.5f), V2f(0.5f, 0.55f), V2f(0.5f, 0.8f),
                            V2f(0.5f, 1.f), V2f(0.7f, 0.5f)}) {
        double exact = 0;
        constexpr uint32_t points = 1 << 19;
        for (uint32_t i = 0; i < points; ++i) {
            const V2f at = V2f(0.5f) + uniform_disk(sampler_of(i).get2(Dim::Lens)) * disc;
            float pick = 0.5f;
            const auto [pattern, here] = spread.at(film, pick);
            for (int lane = 0; lane < 4; ++lane) {
                const float nm = kFourLines.nm[lane];
                const V2f v = FilmSpread::frequency(here.cosines, spread.cosines(at).cosines, nm);
                exact += double(pattern->density(v) * FilmSpread::per_film(here, nm)) / points;
            }
        }
        exact *= std::numbers::pi * double(disc.x * disc.y);
        constexpr uint32_t count = 1 << 16;
        const LightEstimate with = light_at(aimed, film, count),
                            without = light_at(plain, film, 4 * count);
        EXPECT_NEAR(with.mean, exact, 4.5 * std::sqrt(with.variance) + 0.01 * exact) << film;
        // The rare draws that meet the sun bring the light of four lanes each.
        const double rare = std::sqrt(4 * exact / (4. * count));
        EXPECT_NEAR(without.mean, exact, 5 * rare + 0.01 * exact + 20. / count * (rare > exact))
            << film;
        if ((film - V2f(0.5f)).length() > 0.01f)
            EXPECT_LT(with.variance * count * 10, 4 * exact) << film;
    }
}

}  // namespace
}  // namespace petzval::camera
