// SPDX-License-Identifier: Apache-2.0
// Analyses of lenses against figures that an independent program worked, and against theory.
#include "camera/bench/analysis.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "camera/bench/aimed_bundle.h"
#include "camera/bench/spot.h"
#include "camera/lens/focus.h"
#include "camera/lens/profile.h"
#include "camera/lens/traced_ray.h"
#include "tests/support/lens_json.h"

namespace petzval::camera {
namespace {

using test::kOracleLenses;
using test::read_lens;
using test::read_oracle;

constexpr double kDegree = std::numbers::pi / 180;

AimedBundle aimed(const Lens& lens, const ObjectPoint& object, double nm = kLineD_nm) {
    auto bundle = AimedBundle::aim(lens, object, nm);
    if (!bundle) throw std::runtime_error("no chief ray");
    return *std::move(bundle);
}

class OracleAnalysis : public ::testing::TestWithParam<const char*> {
  protected:
    const nlohmann::json oracle = read_oracle(GetParam());
    const Prescription file = read_lens(GetParam());
    const Lens lens{file};
    const double film_mm = oracle.at("image_plane_z");
};
INSTANTIATE_TEST_SUITE_P(Lenses, OracleAnalysis, ::testing::ValuesIn(kOracleLenses));

// The oracle's rays are those within the ray of line d to the stop's rim, at each wavelength: the
// outermost rays of a fast lens weigh heavily.
TEST_P(OracleAnalysis, SpotOnTheAxisAndItsBestFocus) {
    const bool round = oracle.contains("seidel");
    double rim_mm = INFINITY;
    if (round) {
        const AimedBundle d = aimed(lens, {});
        std::vector<PupilPoint> line;
        for (int i = 0; i < 20000; ++i) line.push_back({0, d.most()[1] * (0.9 + 5e-6 * i)});
        rim_mm = d.trace(line, film_mm).back().pupil_point[1];
    }
    for (const auto& [line, wanted] : oracle.at("axial_spot").items()) {
        const AimedBundle bundle = aimed(lens, {}, std::stod(line));
        auto rays = bundle.trace(bundle.grid(400), film_mm);
        std::erase_if(rays, [&](const BundleRay& ray) {
            return std::hypot(ray.pupil_point[0], ray.pupil_point[1]) > rim_mm;
        });
        const double rms = wanted[0], best = wanted[1], rms_at_best = wanted[2];
        EXPECT_NEAR(spot_size(rays).rms_mm, rms, 0.005 * rms) << line;
        EXPECT_NEAR(best_shift_mm(rays), best, 0.005 * std::fabs(best)) << line;
        EXPECT_NEAR(spot_size(rays, best).rms_mm, rms_at_best, 0.005 * rms_at_best) << line;
    }
}

TEST_P(OracleAnalysis, BundlesFillTheStop) {
    const double radius_mm = file.surfaces[size_t(lens.stop())].semi_diameter_mm;
    const double widest = std::string(GetParam()).find("fisheye") == std::string::npos ? 18 : 90;
    for (const Section section : {Section::X, Section::Y})
        for (const double deg : {0., 0.6 * widest, widest}) {
            const AimedBundle bundle =
                aimed(lens, {.field_deg = deg, .section = section}, kLineF_nm);
            const PupilPoint chief = bundle.chief();
            const auto middle = bundle.trace({&chief, 1}, film_mm, Clip::No);
            ASSERT_EQ(middle.size(), 1u);
            EXPECT_NEAR(std::hypot(middle[0].stop_mm[0], middle[0].stop_mm[1]), 0,
                        1e-8 * radius_mm);
            const size_t along = section == Section::X ? 0 : 1;
            EXPECT_NEAR(middle[0].film_mm[1 - along], 0, 1e-9);
            EXPECT_GE(middle[0].film_mm[along], -1e-9);
            double least = 1, most = 0;
            for (const BundleRay& ray : bundle.trace(bundle.grid(60), film_mm, Clip::No)) {
                const double r = std::hypot(ray.stop_mm[0], ray.stop_mm[1]) / radius_mm;
                least = std::min(least, r);
                most = std::max(most, r);
            }
            EXPECT_LT(least, 0.05);
            EXPECT_GT(most, 1);
        }
}

TEST_P(OracleAnalysis, SagsAreWhereRaysMeetSurfaces) {
    int compared = 0;
    for (const double height : {0., 0.3, 1.})
        for (const Section section : {Section::X, Section::Y}) {
            const double h = height * first_order(lens, kLineD_nm).entrance_pupil_diameter_mm / 2;
            const bool x = section == Section::X;
            const TracedRay ray = trace_ray(lens, x ? V3d(h, 0, -9) : V3d(0, h, -9), V3d(0, 0, 3),
                                            kLineD_nm, Towards::Film, Clip::No);
            for (size_t i = 0; i < ray.points.size(); ++i, ++compared) {
                const V3d& p = ray.points[i];
                EXPECT_NEAR(
                    p.z, lens.vertex_mm(int(i)) + sag_mm(file.surfaces[i], x ? p.x : p.y, section),
                    1e-9)
                    << i << ' ' << height;
            }
        }
    EXPECT_GE(compared, 5 * lens.size());
}

TEST_P(OracleAnalysis, FocusMovesTheFilmToTheImage) {
    // Filed to a nanometre.
    EXPECT_NEAR(Lens(*focused(lens, -INFINITY)).film_mm(), lens.film_mm(), 1e-6);
    for (const auto& row : oracle.at("conjugates_d")) {
        const double object_mm = row[0], image_mm = row[1];
        EXPECT_NEAR(focused(lens, object_mm)->prescription().surfaces.back().thickness_mm, image_mm,
                    2e-6);
    }
    const FirstOrder first = first_order(lens, kLineD_nm);
    EXPECT_FALSE(focused(lens, std::min(first.front_focus_mm, 0.) + 0.1));
    EXPECT_FALSE(focused(lens, first.entrance_pupil_mm * 0.5));
}

TEST_P(OracleAnalysis, LightOnTheFilm) {
    std::vector<double> heights, wanted;
    for (const auto& row : oracle.at("irradiance")) {
        heights.push_back(row[0]);
        wanted.push_back(row[1]);
    }
    const auto light = film_irradiance(std::make_shared<Lens>(file), film_mm, heights);
    ASSERT_EQ(light.size(), wanted.size());
    for (size_t i = 0; i < wanted.size(); ++i)
        EXPECT_NEAR(light[i], wanted[i], 0.004 * wanted[i]) << heights[i];
}

TEST_P(OracleAnalysis, DistortionIsSeidelsNearTheAxis) {
    if (!oracle.contains("seidel")) return;
    for (const double deg : {1., 2.}) {
        const double tangent = std::tan(deg * kDegree);
        const double invariant =
            tangent * first_order(lens, kLineD_nm).entrance_pupil_diameter_mm / 2;
        const double third_order = seidel(lens, tangent).total[4] / (2 * invariant);
        const auto found = distortion(lens, deg, film_mm, INFINITY);
        ASSERT_TRUE(found);
        EXPECT_NEAR(found->relative(), -third_order, 0.05 * std::fabs(third_order) + 1e-7) << deg;
        EXPECT_NEAR(*field_of_height_deg(lens, found->height_mm, film_mm), deg, 1e-6);
        // A distant plane is nearly an object at infinity.
        const double far_mm = 1e7;
        const Lens near(*focused(lens, -far_mm));
        const auto far = distortion(near, deg, near.film_mm(), far_mm);
        EXPECT_NEAR(far->relative(), found->relative(), 1e-5) << deg;
    }
}

TEST(LensAnalysis, BestFilmShiftHasTheLeastSpot) {
    const Lens lens(read_lens("double-gauss-100mm-f2"));
    const double best = *best_film_shift_mm(lens, lens.film_mm(), -INFINITY);
    const auto rms = [&](double shift_mm) {
        std::vector<BundleRay> all;
        for (const double nm : {kLineF_nm, kLineD_nm, kLineC_nm}) {
            const AimedBundle bundle = aimed(lens, {}, nm);
            const auto rays = bundle.trace(bundle.grid(101), lens.film_mm() + shift_mm);
            all.insert(all.end(), rays.begin(), rays.end());
        }
        return spot_size(all).rms_mm;
    };
    EXPECT_LT(rms(best), rms(best - 0.01));
    EXPECT_LT(rms(best), rms(best + 0.01));
    EXPECT_NEAR(best, -0.38, 0.04);  // between those of the lines
}

TEST(LensAnalysis, MtfOfADiskIsBessels) {
    constexpr double radius_mm = 0.02;
    std::vector<BundleRay> rays;
    for (int i = -200; i <= 200; ++i)
        for (int j = -200; j <= 200; ++j)
            if (i * i + j * j <= 200 * 200)
                rays.push_back({{}, {}, {3 + radius_mm * i / 200., radius_mm * j / 200.}, {}});
    for (const double cycles : {1., 10., 30., 45.}) {
        const double a = 2 * std::numbers::pi * radius_mm * cycles;
        const double wanted = std::fabs(2 * std::cyl_bessel_j(1., a) / a);
        for (const Section section : {Section::X, Section::Y})
            EXPECT_NEAR(geometric_mtf(rays, cycles, section), wanted, 2e-3) << cycles;
    }
    EXPECT_NEAR(spot_size(rays).rms_mm, radius_mm / std::numbers::sqrt2, 1e-4);
    EXPECT_NEAR(spot_size(rays).centroid_mm[0], 3, 1e-9);
}

TEST(LensAnalysis, FansCrossTheWholeStopAndAgreeWithSymmetry) {
    const Lens lens(read_lens("cooke-triplet-50mm-f5"));
    const AimedBundle bundle = aimed(lens, {});
    const auto tangential = ray_fan(lens, bundle, Section::Y, lens.film_mm(), {});
    const auto sagittal = ray_fan(lens, bundle, Section::X, lens.film_mm(), {});
    ASSERT_EQ(tangential.size(), sagittal.size());
    EXPECT_GT(tangential.back().stop, 0.95);
    for (size_t i = 0; i < tangential.size(); ++i) {
        EXPECT_NEAR(tangential[i].stop, sagittal[i].stop, 1e-12);
        EXPECT_NEAR(tangential[i].from_mm[1], sagittal[i].from_mm[0], 1e-12);
        EXPECT_NEAR(tangential[i].from_mm[0], 0, 1e-12);
    }
}

TEST(LensAnalysis, ComparesWhatTheFileStates) {
    Prescription file = read_lens("schneider-anamorphic-31mm");
    file.stated_focal_length_mm = 31;
    file.stated_fnumber = 2;
    const auto figures = stated_figures(Lens(file));
    ASSERT_EQ(figures.size(), 3u);
    // The section that is nearer to what is stated.
    EXPECT_NEAR(figures[0].computed, first_order(Lens(file), kLineD_nm, Section::X).focal_length_mm,
                1e-12);
    EXPECT_EQ(figures[1].stated, 2);
    EXPECT_NEAR(figures[1].relative(), figures[1].computed / 2 - 1, 1e-12);

    Prescription wide = read_lens("canon-14mm-f2.8-asph");
    EXPECT_FALSE(field_half_deg(wide));
    wide.image_circle_mm = 2 * 14.279379632613914;
    EXPECT_NEAR(*field_half_deg(wide), 45, 1e-9);
    wide.stated_field_half_deg = 57;
    EXPECT_EQ(*field_half_deg(wide), 57);
}

// Each figure with its counterpart; f tan(field) up to the distortion, which is 1 % here.
TEST(LensAnalysis, TheStatedFieldIsNotMeasuredByTheCircle) {
    Prescription file = read_lens("takumar-50mm-f1.2");
    file.stated_focal_length_mm = 50;
    file.stated_fnumber = 1.2;
    file.stated_field_half_deg = 21;
    file.image_circle_mm = 43.27;
    const FieldAndCircle takumar = field_and_circle(Lens(file));
    EXPECT_EQ(*takumar.half_field_deg, 21);
    EXPECT_NEAR(*takumar.circle_of_half_field_mm, 2 * 50 * std::tan(21 * kDegree), 0.8);
    EXPECT_EQ(*takumar.image_circle_mm, 43.27);
    EXPECT_NEAR(*takumar.half_field_of_image_circle_deg, std::atan(43.27 / 100) / kDegree, 0.5);
    for (const StatedFigure& figure : stated_figures(Lens(file)))
        EXPECT_LT(std::fabs(figure.relative()), 0.005) << figure.name;

    // In the y-z section, to whose focal length the file's belongs.
    file = read_lens("schneider-anamorphic-31mm");
    file.stated_field_half_deg = 14;
    file.stated_focal_length_mm = 60.55;
    EXPECT_NEAR(*field_and_circle(Lens(file)).circle_of_half_field_mm, 29.9, 0.05);
    file.stated_focal_length_mm = 31;
    file.image_circle_mm = 27.5;
    EXPECT_NEAR(*field_and_circle(Lens(file)).half_field_of_image_circle_deg, 27.0, 0.05);

    file.stated_field_half_deg = std::nullopt;
    file.image_circle_mm = 0;
    const FieldAndCircle none = field_and_circle(Lens(file));
    EXPECT_FALSE(none.half_field_deg || none.circle_of_half_field_mm || none.image_circle_mm ||
                 none.half_field_of_image_circle_deg);
}

// Each section of an anamorphic lens has its own field, there and back.
TEST(LensAnalysis, FieldsOfHeightsAreThoseOfTheirSection) {
    const Lens lens(read_lens("schneider-anamorphic-31mm"));
    for (const Section section : {Section::X, Section::Y}) {
        const ObjectPoint object{.field_deg = 11, .section = section};
        const auto height_mm = chief_height_mm(lens, object, lens.film_mm());
        ASSERT_TRUE(height_mm);
        EXPECT_NEAR(*field_of_height_deg(lens, *height_mm, lens.film_mm(), section), 11, 1e-6);
    }
}

TEST(LensAnalysis, SaysWhereNoRayGetsThrough) {
    const Lens lens(read_lens("kodak-petzval-100mm-f2"));
    EXPECT_FALSE(AimedBundle::aim(lens, {.field_deg = 100}, kLineD_nm));
    EXPECT_FALSE(field_of_height_deg(lens, 500, lens.film_mm()));
    EXPECT_FALSE(distortion(lens, 89, lens.film_mm(), INFINITY));
}

}  // namespace
}  // namespace petzval::camera
