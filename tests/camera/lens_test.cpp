// SPDX-License-Identifier: Apache-2.0
#include "camera/lens/lens.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <stdexcept>
#include <vector>

#include "tests/support/lens_rays.h"

namespace petzval::camera {
namespace {

using test::lens_of;
using test::surface_of;

TEST(Lens, CountsEachGlassOnceAndAirIsOne) {
    auto surfaces = std::vector{surface_of(0.01, 5, 1.5), surface_of(-0.01, 5, 1.7),
                                surface_of(0, 5, 1.5), surface_of(0, 20, 1)};
    surfaces[2].stop = true;
    const Lens lens = lens_of(surfaces);
    EXPECT_EQ(lens.media().size(), 3u);
    EXPECT_EQ(lens.stop(), 2);
    EXPECT_EQ(lens.last(), 3);
    EXPECT_EQ(lens.vertex_mm(3), 15);
    EXPECT_EQ(lens.film_mm(), 35);
    EXPECT_EQ(lens.exact_indices(d4{} + 500).of_medium[0][2], 1);
    EXPECT_EQ(lens.indices(splat(431.7f)).of_medium[0][1], 1);
    EXPECT_EQ(lens.indices(splat(431.7f)).of_medium[2][1], 1.7f);
    EXPECT_EQ(lens.surfaces<float>()[1].medium_before, 1);
    EXPECT_EQ(lens.surfaces<float>()[3].medium_before, 1);
    EXPECT_EQ(lens.surfaces<float>()[3].medium_after, 0);
}

TEST(Lens, SurfacesAreSmall) {
    EXPECT_LE(sizeof(SurfaceFacts<float>), 32u);
    EXPECT_LE(sizeof(SurfaceFacts<double>), 64u);
}

TEST(Lens, RefusesWhatIsNoLens) {
    const auto good = surface_of(0.01, 5, 1.5);
    const auto refused = [](std::vector<LensSurface> surfaces) {
        Prescription prescription;
        prescription.surfaces = std::move(surfaces);
        EXPECT_THROW((void)Lens(prescription), std::invalid_argument);
    };
    refused({});
    refused({good});
    auto stop = good;
    stop.stop = true;
    refused({stop, stop});
    const auto with = [&stop](auto change) {
        auto surface = stop;
        change(surface);
        return std::vector{surface};
    };
    const double nan = std::nan("");
    refused(with([&](auto& s) { s.curvature_1_mm = nan; }));
    refused(with([&](auto& s) { s.thickness_mm = std::numeric_limits<double>::infinity(); }));
    refused(with([&](auto& s) { s.asphere = {{4, nan}}; }));
    for (const double power : {1., 0., -2., 4.5, 41., nan})
        refused(with([&](auto& s) { s.asphere = {{power, 1e-6}}; }));
    std::vector<LensSurface> many{stop};
    for (int i = 0; i < kMaxMedia; ++i) many.push_back(surface_of(0, 1, 1.5 + 1e-3 * i));
    refused(many);
    many.resize(kMaxMedia);
    EXPECT_EQ(lens_of(many).media().size(), size_t(kMaxMedia));
}

}  // namespace
}  // namespace petzval::camera
