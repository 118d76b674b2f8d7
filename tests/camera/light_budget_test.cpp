// SPDX-License-Identifier: Apache-2.0
// Where the light goes, against closed forms for plates and against other sums over the same ways.
#include "camera/bench/light_budget.h"

#include <gtest/gtest.h>

#include <cmath>

#include "camera/bench/light_walk.h"
#include "tests/support/lens_json.h"

namespace petzval::camera {
namespace {

Glass glass_of(double n, double absorption_per_mm = 0) {
    Glass glass{"test", IndexSeries{{{n, 0}}}};
    if (absorption_per_mm > 0) glass.absorption_per_mm = {{550, absorption_per_mm}};
    return glass;
}

// A plane-parallel plate in front of a wide stop.
Prescription glass_plate(const Glass& glass, double thickness_mm) {
    Prescription file;
    file.name = "plate";
    file.image_circle_mm = 1000;
    file.surfaces.resize(3);
    for (LensSurface& s : file.surfaces) s.thickness_mm = 1, s.semi_diameter_mm = 50;
    file.surfaces[0].thickness_mm = thickness_mm;
    file.surfaces[0].glass = glass;
    file.surfaces[2].stop = true;
    return file;
}

DistantLight light_on(const Lens& lens, double field_deg = 0, double nm = 550) {
    return {field_deg, Section::Y, nm, lens.film_mm(), INFINITY};
}

// The two faces reflect to and fro: a geometric series.
TEST(LightBudget, OfAPlateIsAGeometricSeries) {
    const double n = 1.8, r = std::pow((n - 1) / (n + 1), 2), per_mm = 0.05, mm = 4;
    const Lens lens(glass_plate(glass_of(n, per_mm), mm));
    const LensCoats coats(lens, Coating::Uncoated);
    const auto b = light_budget(lens, coats, light_on(lens), 16);
    ASSERT_TRUE(b);
    const double a = std::exp(-per_mm * mm), order = (1 - r) * (1 - r) * a, round = r * r * a * a;
    EXPECT_NEAR(b->in_order, order, 1e-9);
    EXPECT_NEAR(b->two, order * round, 1e-9);
    EXPECT_NEAR(b->more, order * round * round / (1 - round), 2e-5);
    EXPECT_NEAR(b->returned, r + (1 - r) * (1 - r) * r * a * a / (1 - round), 2e-5);
    EXPECT_NEAR(b->stopped, 0, 1e-12);
    EXPECT_NEAR(b->sum(), 1, 1e-5);
    // Of an ideal coating nothing is left but the glass.
    const auto ideal = light_budget(lens, LensCoats(lens, Coating::Ideal), light_on(lens), 16);
    EXPECT_NEAR(ideal->in_order, a, 1e-12);
    EXPECT_NEAR(ideal->absorbed, 1 - a, 1e-12);
}

// Seen from the film's middle, a thin plate's glare comes from where its light in order comes from.
TEST(VeilingGlare, OfAPlateIsTheShareThatIsReflectedTwice) {
    Prescription file = glass_plate(glass_of(1.8), 0.01);
    for (LensSurface& s : file.surfaces) s.semi_diameter_mm = 1;
    file.surfaces[2].thickness_mm = 100;
    const Lens lens(file);
    const double r = std::pow(0.8 / 2.8, 2);
    const auto glare = veiling_glare(lens, LensCoats(lens, Coating::Uncoated), lens.film_mm());
    ASSERT_TRUE(glare);
    EXPECT_NEAR(*glare, r * r, 2e-3 * r * r + 2e-6);
    EXPECT_EQ(veiling_glare(lens, LensCoats(lens, Coating::Ideal), lens.film_mm()), 0);
}

// A ghost of a plate that stands square to the axis has the image's light, R^2 of it, and is as far
// away as light goes twice more through the plate: 2 t / n. The lens in front is ideal.
TEST(Ghosts, OfAPlateAreAsFarAndAsBrightAsTheyShould) {
    Prescription file = test::read_lens("double-gauss-100mm-f2");
    for (LensSurface& s : file.surfaces) s.coat = Coating::Ideal;
    const double n = 1.5, thickness_mm = 6, behind_mm = 20;
    LensSurface front, back;
    front.thickness_mm = thickness_mm, front.glass = glass_of(n);
    back.thickness_mm = file.surfaces.back().thickness_mm - behind_mm - thickness_mm / n;
    front.semi_diameter_mm = back.semi_diameter_mm = 40;
    file.surfaces.back().thickness_mm = behind_mm;
    file.surfaces.push_back(front), file.surfaces.push_back(back);
    file.surfaces[5].semi_diameter_mm = 2;  // the stop, for a focus near that of paraxial rays
    const Lens lens(file);
    ASSERT_EQ(lens.stop(), 5);
    const LensCoats coats(lens, Coating::Filed);
    const auto found = ghosts(lens, coats, light_on(lens), 200);
    ASSERT_EQ(found.size(), 1u);
    EXPECT_EQ(found[0].first, lens.last());
    EXPECT_EQ(found[0].second, lens.last() - 1);
    EXPECT_NEAR(found[0].light, 0.04 * 0.04, 1e-5);
    EXPECT_NEAR(found[0].focus_mm, -2 * thickness_mm / n, 0.05);
    const auto worst = worst_surface(found);
    ASSERT_TRUE(worst);
    EXPECT_NEAR(worst->second, 1, 1e-12);
    const auto paths = ghost_paths(lens, coats, light_on(lens), found[0], 3);
    ASSERT_EQ(paths.size(), 3u);
    // Through all surfaces, back through the plate and out again, to the film.
    EXPECT_EQ(paths[0].size(), size_t(lens.size()) + 2 + 2);
    EXPECT_NEAR(paths[1].back()[0], lens.film_mm(), 1e-9);
}

class BudgetOf : public testing::TestWithParam<const char*> {};
INSTANTIATE_TEST_SUITE_P(Lenses, BudgetOf, testing::ValuesIn(test::kLensKinds));

// All light is somewhere; what ghosts send to the film is what the budget has after two
// reflections; rays of a bundle lose what the walk in order loses.
TEST_P(BudgetOf, AddsUpForEveryCoating) {
    const Prescription file = test::read_lens(GetParam());
    const Lens lens(file);
    for (const auto& [name, coating] : kCoatingNames)
        for (const double share : {0., 0.7, 1.}) {
            const DistantLight light{share * file.stated_field_half_deg.value_or(14), Section::Y,
                                     share < 1 ? 450. : 650., lens.film_mm(), lit_radius_mm(lens)};
            const LensCoats coats(lens, coating);
            const auto b = light_budget(lens, coats, light, 10);
            ASSERT_TRUE(b) << name;
            EXPECT_NEAR(b->sum(), 1, 1e-5) << name << share;
            for (const auto& [part, member] : kBudgetParts) EXPECT_GE((*b).*member, 0) << part;
            double ghost_light = 0;
            for (const Ghost& g : ghosts(lens, coats, light, 10)) ghost_light += g.light;
            EXPECT_NEAR(ghost_light * b->in_order, b->in_order > 0 ? b->two : 0, 1e-12) << name;
            const auto bundle = AimedBundle::aim(lens, {light.field_deg}, light.nm);
            ASSERT_TRUE(bundle);
            const auto t = transmittance(lens, coats, *bundle, lens.film_mm(), 8);
            ASSERT_TRUE(t);
            EXPECT_TRUE(*t > 0.15 && *t <= 1) << name << *t;
            if (coating == Coating::Ideal) {
                EXPECT_EQ(*t, 1);
            }
        }
}

TEST(LightBudget, OfALensOfOneSurfaceAndOfOneThatIsDarkIsSane) {
    Prescription one;
    one.surfaces.resize(1);
    one.surfaces[0].thickness_mm = 10, one.surfaces[0].semi_diameter_mm = 2;
    one.surfaces[0].stop = true;
    const Lens hole(one);
    const LensCoats coats(hole, Coating::Broadband);
    const auto b = light_budget(hole, coats, light_on(hole, 10));
    ASSERT_TRUE(b);
    EXPECT_NEAR(b->in_order, 1, 1e-12);
    EXPECT_TRUE(ghosts(hole, coats, light_on(hole)).empty());
    EXPECT_FALSE(worst_surface({}));
    EXPECT_EQ(veiling_glare(hole, coats, 10), 0);
    // Light from behind meets no front.
    EXPECT_FALSE(light_budget(hole, coats, light_on(hole, 120)));
}

}  // namespace
}  // namespace petzval::camera
