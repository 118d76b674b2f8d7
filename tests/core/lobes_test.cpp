// SPDX-License-Identifier: Apache-2.0
// Each lobe by itself: what it scatters, its density and its samples belong together.
#include "core/shading/lobes.h"

#include <gtest/gtest.h>

#include <numbers>

#include "core/shading/visible_facets.h"
#include "tests/core/bsdf_inputs.h"
#include "tests/support/statistics.h"

namespace petzval {
namespace {

using namespace test;

const f4 kCarried{0.2f, 0.5f, 0.3f, 0.f};
const f4 kWeight{0.3f, 0.6f, 0.2f, 0.f};

SeenFacets facets(float alpha) {
    return {from_cosine(0.7f, 0.4f), alpha};
}

MirrorLobe mirror() {
    MirrorLobe out{};
    out.f0 = kWeight;
    out.f90 = f4{0.9f, 0.8f, 1.f, 0.f};
    out.chance = 0.4f;
    return out;
}

GlassLobe glass_of(float eta) {
    return {{0.4f, splat(0.5f)}, kWeight, splat(eta), 1.f, false, 0,
            Bands::rgb().on,     f4{},    kCarried,   0.f, {}};
}

/// Integrates a lobe over uniform directions, which know nothing of it, and compares with its own
/// samples. Returns what it scatters of the second lane.
template <class Lobe>
Mean scattered(const Lobe& lobe, const SeenFacets& seen, const char* name) {
    Random random(17);
    Moments value, pdf, weight, drawn;
    for (int i = 0; i < 300000; ++i) {
        const BsdfValue at = lobe.value(seen, random.direction());
        value.add(4 * std::numbers::pi * double(at.f_cos[1]));
        pdf.add(4 * std::numbers::pi * double(at.pdf));
        const float u_lobe = random.next() * lobe.chance;
        const auto s = lobe.draw(seen, {u_lobe, random.next2(), true});
        drawn.add(s ? double(lobe.chance) : 0);
        const BsdfValue there = s ? lobe.value(seen, s->wi) : BsdfValue{};
        weight.add(s ? double(lobe.chance * there.f_cos[1] / there.pdf) : 0);
    }
    EXPECT_TRUE(agrees(Mean(value) - Mean(weight), 0, 0.001)) << name << weight.mean();
    EXPECT_TRUE(agrees(Mean(pdf) - Mean(drawn), 0, 0.001)) << name << drawn.mean();
    return Mean(weight);
}

TEST(Lobes, AloneScatterTheirAlbedo) {
    const auto check = [](const auto& lobe, const SeenFacets& seen, const char* name) {
        const double albedo = double(lobe.albedo(seen)[1]);
        EXPECT_TRUE(agrees(scattered(lobe, seen, name), albedo, 0.004)) << name;
    };
    DiffuseLobe<false> diffuse;
    DiffuseLobe<true> behind;
    SheenLobe sheen;
    ThinLobe thin;
    sheen.white = Sheen(0.6f, 0.7f);
    for (Lobe* const lobe : {static_cast<Lobe*>(&diffuse), static_cast<Lobe*>(&behind),
                             static_cast<Lobe*>(&sheen), static_cast<Lobe*>(&thin)}) {
        lobe->set(kWeight, kCarried);
        EXPECT_FLOAT_EQ(lobe->chance, 0.42f);
    }
    SeenFacets seen = facets(0.4f);
    check(diffuse, seen, "diffuse ");
    check(behind, seen, "behind ");
    check(sheen, seen, "sheen ");
    check(mirror(), seen, "mirror ");
    seen.even = true;
    check(mirror(), seen, "even mirror ");
    check(thin, seen, "thin ");
}

// What single scattering loses, the other lobe has: of white glass all is there.
void expect_whole(GlassLobe glass, const GgxWidth& alpha) {
    SeenFacets seen{from_cosine(0.3f, 0.4f), alpha};
    seen.even = true;
    glass.tint = splat(1.f);
    LostLobe lost;
    lost.split_from(glass, seen);
    EXPECT_FLOAT_EQ(glass.chance + lost.chance, 0.4f);
    const Mean single = scattered(glass, seen, "glass "), more = scattered(lost, seen, "lost ");
    const f4 albedo = glass.albedo(seen) + lost.albedo(seen);
    const Mean missing{double(albedo[1]) - more.value, more.error};
    EXPECT_TRUE(agrees(single - missing, 0, 0.005))
        << single << " and " << more << ", index " << glass.eta[0] << ", specular "
        << glass.specular << ", width " << alpha.y;
    EXPECT_GT(more.value, 0.01);
}

TEST(Lobes, GlassAndWhatItLosesShareItsLight) {
    for (const float eta : {1.5f, 1 / 1.5f})
        for (const float specular : {0.2f, 1.f}) {
            GlassLobe glass = glass_of(eta);
            glass.specular = specular;
            expect_whole(glass, 0.5f);
            expect_whole(glass, {0.8f, 0.3f});
            if (eta < 1) continue;
            glass.film_share = 1;
            glass.film = ThinFilm(1.8f, 300.f, Bands::rgb());
            expect_whole(glass, 0.5f);
        }
}

TEST(Lobes, EachLaneLosesByItsOwnIndex) {
    const SeenFacets seen{from_cosine(0.4f, 0.3f), {0.7f, 0.2f}};
    GlassLobe glass = glass_of(1.5f);
    glass.eta = f4{1.2f, 1.5f, 2.2f, 1.f};
    glass.disperses = true;
    LostLobe lost;
    lost.split_from(glass, seen);
    for (int i = 0; i < 3; ++i)
        EXPECT_FLOAT_EQ(lost.weight[i],
                        0.5f * visible_glass_loss(seen.wo, seen.alpha, glass.eta[i], 1.f));
    EXPECT_GT(lost.weight[0], 1.1f * lost.weight[2]);
}

TEST(Lobes, OfSmoothFacetsAreDeltas) {
    const SeenFacets seen = facets(0.f);
    const auto check = [&](const auto& lobe, const V3f& to, float weight) {
        EXPECT_EQ(lobe.value(seen, to).pdf, 0.f);
        const auto s = lobe.draw(seen, {0.f, {0.3f, 0.6f}, true});
        ASSERT_TRUE(s && s->delta);
        EXPECT_LT((s->wi - to).length(), 1e-6f);
        EXPECT_EQ(s->transmitted, to.z < 0.f);
        EXPECT_NEAR(s->weight[1] * lobe.chance, weight, 1e-6f);
    };
    ThinLobe thin;
    thin.set(kWeight, kCarried);
    const V3f image = mirror_below(-seen.wo);
    check(mirror(), image, mirror().albedo(seen)[1]);
    check(thin, -seen.wo, kWeight[1]);
    check(glass_of(1.5f), image, glass_of(1.5f).albedo(seen)[1]);
}

}  // namespace
}  // namespace petzval
