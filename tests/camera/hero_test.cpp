// SPDX-License-Identifier: Apache-2.0
// One ray for all lanes: every lane keeps its mean over the pixel.
#include "camera/dispersion/hero.h"

#include <gtest/gtest.h>

#include <map>

#include "camera/models/aberrated_lens.h"
#include "camera/models/lens_camera.h"
#include "core/spectrum/observer.h"
#include "tests/support/observers.h"
#include "tests/support/statistics.h"

namespace petzval::camera {
namespace {

using test::least_p;

const V2f kFilter_px(48, 32);

Bands drawn_wavelengths(float u) {
    static const Observer observer = test::plain_observer();
    return observer.draw(u);
}

/// One lens of 100 mm at f/4 in front of pixels of 0.2 mm. Its stop lies before the glass or
/// behind it, its rim cuts the bundle off the axis.
LensCameraInput singlet(DispersionMode dispersion, double blue, double red, bool stop_first) {
    Prescription p;
    const auto add = [&p](double curvature, double thickness, double semi_diameter) -> auto& {
        LensSurface s;
        s.curvature_1_mm = curvature;
        s.thickness_mm = thickness;
        s.semi_diameter_mm = semi_diameter;
        return p.surfaces.emplace_back(std::move(s));
    };
    if (stop_first) add(0, 8, 13).stop = true;
    add(0.0077, 4, 12.8).glass = Glass{"as given", IndexTable{{{400, blue}, {700, red}}}};
    add(-0.0077, stop_first ? 98 : 40, 12.8);
    if (!stop_first) add(0, 58, 13).stop = true;
    const auto lens = std::make_shared<const Lens>(p);
    LensCameraInput in{
        .lens = lens, .iris = Iris(regular_polygon(5), stop_first ? 12 : 6), .to_world = M44f()};
    in.film_mm = lens->film_mm();
    in.film_width_mm = 9.6;
    in.film_height_mm = 6.4;
    in.dispersion = dispersion;
    return in;
}

AberratedLensCamera thin(DispersionMode dispersion, double blue, double red) {
    const Glass glass{"as given", IndexTable{{{360, blue}, {830, red}}}};
    AberratedLens lens{.to_world = M44f(),
                       .singlet = {glass, 129, -129},
                       .iris = Iris(regular_polygon(5), 12),
                       .focus_m = 1e6,
                       .yfov_rad = 0.064f};
    lens.dispersion = dispersion;
    return AberratedLensCamera(lens);
}

/// Light of each lane in a pixel right and below of the middle, from beyond an edge aslant through
/// what it sees, at infinity.
std::array<test::Moments, 4> in_pixel(const Camera& camera, const Filter& filter, uint32_t seed) {
    const V2f centre(34.5f, 24.5f);
    Bands bands = drawn_wavelengths(0.3f);
    std::array<test::Moments, 4> out;
    for (uint32_t i = 0; i < 1 << 16; ++i) {
        bands.hero = int(hash32(i) % 4);
        const Sampler sampler(SamplerKind::Independent, seed, {0, 0, i});
        const V2f offset = filter.sample(sampler.get2(Dim::Film));
        const CameraSample seen = camera.sample(
            {(centre + offset) / kFilter_px, sampler, {&filter, offset, kFilter_px}}, bands);
        f4 sum{};
        for (size_t k = 0; k < seen.size(); ++k) {
            const CameraPath& path = seen[k];
            const V3f d = path.ray.direction * (-1 / path.ray.direction.z);
            if (d.x + d.y > 0.0045f) sum += path.weight;
        }
        for (size_t lane = 0; lane < 4; ++lane) out[lane].add(double(sum[int(lane)]));
    }
    return out;
}

const std::vector<Filter>& filters() {
    static const std::vector<Filter> all{
        {FilterKind::BlackmanHarris, 1.5f}, {FilterKind::Box, 0.5f}, {FilterKind::Gauss, 12.f}};
    return all;
}

// From a tenth of a pixel apart to many.
TEST(Hero, EachLaneHasTheMeanOfSplitPaths) {
    for (const auto& [blue, red] : {std::pair{1.6605, 1.6595}, {1.662, 1.658}, {1.68, 1.64}})
        for (const bool stop_first : {true, false})
            for (const Coating coating : {Coating::Ideal, Coating::Uncoated})
                for (const Filter& filter : filters()) {
                    const auto camera = [&, b = blue, r = red](DispersionMode dispersion) {
                        LensCameraInput in = singlet(dispersion, b, r, stop_first);
                        in.coating = coating;
                        return LensCamera(in);
                    };
                    EXPECT_GE(least_p(in_pixel(camera(DispersionMode::Hero), filter, 1),
                                      in_pixel(camera(DispersionMode::Split), filter, 2)),
                              test::sidak())
                        << blue << ' ' << stop_first << ' ' << int(coating) << ' '
                        << filter.radius_px();
                }
}

// A mask whose lower half is nearly shut, behind glass that parts the lanes there.
TEST(Hero, EachLaneHasItsMeanThroughAGreyIris) {
    Mask mask;
    mask.width = mask.height = 16;
    for (int i = 0; i < 256; ++i) mask.texels.push_back(i < 128 ? 1.f : 0.1f);
    const auto camera = [&](DispersionMode dispersion) {
        LensCameraInput in = singlet(dispersion, 1.68, 1.64, false);
        in.iris = Iris(mask, 6);
        return LensCamera(in);
    };
    const Filter wide(FilterKind::Gauss, 12.f);
    EXPECT_GE(least_p(in_pixel(camera(DispersionMode::Hero), wide, 1),
                      in_pixel(camera(DispersionMode::Split), wide, 2)),
              test::sidak());
}

TEST(Hero, SharedRaysHaveAnotherMean) {
    const auto mean = [](DispersionMode dispersion, uint32_t seed) {
        return in_pixel(LensCamera(singlet(dispersion, 1.70, 1.62, true)), filters()[0], seed);
    };
    EXPECT_LT(least_p(mean(DispersionMode::Shared, 1), mean(DispersionMode::Split, 2)), 1e-12);
}

TEST(Hero, EachLaneOfAThinLensHasTheMeanOfSplitPaths) {
    for (const auto& [blue, red] : {std::pair{1.6605, 1.6595}, {1.70, 1.62}})
        for (const Filter& filter : filters())
            EXPECT_GE(least_p(in_pixel(thin(DispersionMode::Hero, blue, red), filter, 1),
                              in_pixel(thin(DispersionMode::Split, blue, red), filter, 2)),
                      test::sidak())
                << blue << ' ' << filter.radius_px();
}

TEST(Hero, RaysInDoublesAreThoseInFloats) {
    LensCameraInput in = singlet(DispersionMode::Hero, 1.662, 1.658, true);
    const LensCamera floats(in);
    in.precision = Precision::Double;
    const LensCamera doubles(in);
    const Bands bands = drawn_wavelengths(0.7f);
    int compared = 0;
    for (uint32_t i = 0; i < 1000; ++i) {
        const FilmPoint at{V2f(0.4f, 0.6f),
                           Sampler(SamplerKind::Owen, 1, {0, 0, i}),
                           {&filters()[0], V2f(0.2f), kFilter_px}};
        const CameraSample a = floats.sample(at, bands), b = doubles.sample(at, bands);
        ASSERT_LE(a.size(), 1u);
        if (a.empty() || b.empty()) continue;
        ASSERT_LT((a[0].ray.direction - b[0].ray.direction).length(), 1e-5f);
        ASSERT_LT(hmax(a[0].weight - b[0].weight), 2e-3f);
        ++compared;
    }
    EXPECT_GT(compared, 900);
}

// The lanes' weights of a ray that all of them let through add up to what they are without
// dispersion, where the stop is drawn in proportion to what it lets through.
TEST(Hero, SharesAddUpToTheNumberOfLanes) {
    const PixelFilter pixel{&filters()[0], V2f(0.3f, -0.2f), kFilter_px};
    const m4 all{-1, -1, -1, -1}, three{-1, 0, -1, -1};
    const auto shares = [&](f4 dx_px, f4 dy_px, m4 on, f4 open) {
        return hero_shares(pixel, {dx_px, dy_px, open, open, splat(1)}, 0, on);
    };
    const f4 same = shares(f4{}, f4{}, all, splat(1));
    for (int i = 0; i < 4; ++i) EXPECT_FLOAT_EQ(same[i], 1);
    const f4 apart = shares(f4{0, 0.5f, -0.4f, 9}, f4{0, 0.1f, 0.2f, 0}, three, splat(1));
    EXPECT_FLOAT_EQ(hsum(apart), 3);
    EXPECT_EQ(apart[1], 0) << "is off";
    EXPECT_EQ(apart[3], 0) << "lands beyond the filter";
    const auto value = [](float x, float y) { return filters()[0].value({x, y}); };
    EXPECT_NEAR(apart[2] / apart[0], value(-0.1f, 0) / value(0.3f, -0.2f), 1e-5);
    const f4 blocked = shares(f4{}, f4{}, all, f4{1, 0, 1, 1});
    EXPECT_EQ(blocked[1], 0);
    EXPECT_FLOAT_EQ(blocked[0], 4.f / 3);
    EXPECT_EQ(hsum(shares(splat(9), f4{}, all, splat(1))), 0);
    // A lane that draws the ray twice as often counts twice among those that might have drawn it.
    const f4 drawn = hero_shares(pixel, {f4{}, f4{}, splat(1), f4{2, 1, 1, 0}, splat(1)}, 0, all);
    for (int i = 0; i < 4; ++i) EXPECT_FLOAT_EQ(drawn[i], 2);
}

TEST(Hero, WithoutAFilterLanesAreSplit) {
    const LensCamera hero(singlet(DispersionMode::Hero, 1.70, 1.62, true)),
        split(singlet(DispersionMode::Split, 1.70, 1.62, true));
    int parted = 0;
    for (uint32_t i = 0; i < 100; ++i) {
        const FilmPoint at{V2f(0.5f, 0.6f), Sampler(SamplerKind::Owen, 1, {3, 2, i})};
        const CameraSample a = hero.sample(at, drawn_wavelengths(0.2f)),
                           b = split.sample(at, drawn_wavelengths(0.2f));
        ASSERT_EQ(a.size(), b.size());
        for (size_t k = 0; k < a.size(); ++k) EXPECT_EQ(a[k].ray.direction, b[k].ray.direction);
        parted += a.size() == 4;
    }
    EXPECT_GT(parted, 50);
}

}  // namespace
}  // namespace petzval::camera
