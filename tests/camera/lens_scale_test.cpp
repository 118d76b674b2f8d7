// SPDX-License-Identifier: Apache-2.0
// Lenses made larger and smaller.
#include "camera/bench/lens_scale.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "camera/bench/analysis.h"
#include "camera/lens/traced_ray.h"
#include "tests/support/lens_json.h"

namespace petzval::camera {
namespace {

constexpr double kFactor = 0.37;
const char* const kNames[] = {"takumar-50mm-f1.2", "canon-14mm-f2.8-asph", "phone-f3.5-asph",
                              "schneider-anamorphic-31mm", "noct-nikkor-58mm-f0.95"};

class LensScale : public ::testing::TestWithParam<const char*> {
  protected:
    const Prescription file = test::read_any_lens(GetParam());
    const Prescription file_scaled = scaled(file, kFactor);
    const Lens lens{file}, small{file_scaled};
};
INSTANTIATE_TEST_SUITE_P(Lenses, LensScale, ::testing::ValuesIn(kNames));

void expect_times(double small, double factor, double large, const char* what) {
    EXPECT_NEAR(small, factor * large, 1e-12 * std::fabs(factor * large)) << what;
}

TEST_P(LensScale, FirstOrderDataAndSeidelSumsScale) {
    for (const Section section : {Section::X, Section::Y}) {
        const FirstOrder a = first_order(lens, kLineF_nm, section),
                         b = first_order(small, kLineF_nm, section);
        // Foci near a vertex cancel: against the focal length.
        const double eps = 1e-12 * kFactor * a.focal_length_mm;
        for (const auto member :
             {&FirstOrder::focal_length_mm, &FirstOrder::back_focus_mm, &FirstOrder::front_focus_mm,
              &FirstOrder::front_principal_mm, &FirstOrder::rear_principal_mm,
              &FirstOrder::entrance_pupil_mm, &FirstOrder::exit_pupil_mm,
              &FirstOrder::entrance_pupil_diameter_mm, &FirstOrder::exit_pupil_diameter_mm})
            EXPECT_NEAR(b.*member, kFactor * a.*member, eps);
        expect_times(b.fnumber, 1, a.fnumber, "f-number");
    }
    expect_times(file_scaled.image_circle_mm, kFactor, file.image_circle_mm, "circle");
    expect_times(*file_scaled.stated_focal_length_mm, kFactor, *file.stated_focal_length_mm, "f");
    EXPECT_EQ(file_scaled.stated_fnumber, file.stated_fnumber);
    EXPECT_EQ(file_scaled.stated_field_half_deg, file.stated_field_half_deg);
    if (std::string(GetParam()).find("anamorphic") != std::string::npos) return;
    const Seidel a = seidel(lens, 0.3), b = seidel(small, 0.3);
    for (size_t k = 0; k < a.total.size(); ++k)
        for (size_t i = 0; i < a.of_surface.size(); ++i)
            EXPECT_NEAR(b.of_surface[i][k], kFactor * a.of_surface[i][k],
                        1e-11 * std::fabs(a.of_surface[i][k]) + 1e-16)
                << i << ' ' << k;
}

TEST_P(LensScale, RaysScale) {
    int passed = 0;
    const FirstOrder first = first_order(lens, kLineD_nm);
    const double semi_mm = 0.7 * first.entrance_pupil_diameter_mm;
    for (int i = -6; i <= 6; ++i)
        for (int j = -6; j <= 6; ++j)
            for (const double tangent : {0., 0.2}) {
                const V3d at(semi_mm * i / 6, semi_mm * j / 6, first.entrance_pupil_mm);
                const V3d along(0, tangent, 1);
                const auto a = trace_ray(lens, at, along, kLineD_nm, Towards::Film, Clip::Yes);
                const auto b =
                    trace_ray(small, at * kFactor, along, kLineD_nm, Towards::Film, Clip::Yes);
                ASSERT_EQ(a.status, b.status) << i << ' ' << j;
                ASSERT_EQ(a.points.size(), b.points.size());
                for (size_t k = 0; k < a.points.size(); ++k)
                    EXPECT_LT((b.points[k] - a.points[k] * kFactor).length(), 1e-10 * semi_mm);
                if (a.status != RayStatus::Passed) continue;
                ++passed;
                EXPECT_LT((b.direction - a.direction).length(), 1e-10);
                EXPECT_NEAR(b.path_mm, kFactor * a.path_mm, 1e-10 * a.path_mm);
            }
    EXPECT_GT(passed, 10);
}

TEST_P(LensScale, ThereAndBackIsTheSame) {
    const Prescription back = scaled(file_scaled, 1 / kFactor);
    expect_times(back.image_circle_mm, 1, file.image_circle_mm, "circle");
    for (size_t i = 0; i < file.surfaces.size(); ++i) {
        const LensSurface &a = file.surfaces[i], &b = back.surfaces[i];
        expect_times(b.curvature_1_mm, 1, a.curvature_1_mm, "curvature");
        expect_times(b.thickness_mm, 1, a.thickness_mm, "thickness");
        expect_times(b.semi_diameter_mm, 1, a.semi_diameter_mm, "semi-diameter");
        EXPECT_EQ(b.conic, a.conic);
        EXPECT_EQ(b.profile, a.profile);
        ASSERT_EQ(b.asphere.size(), a.asphere.size());
        for (size_t k = 0; k < a.asphere.size(); ++k) {
            EXPECT_EQ(b.asphere[k][0], a.asphere[k][0]);
            expect_times(b.asphere[k][1], 1, a.asphere[k][1], "asphere");
        }
    }
}

TEST(LensScaleForField, TheScaledLensHasThatField) {
    const struct {
        const char* lens;
        double half_height_mm, half_field_deg;
    } cases[] = {{"takumar-50mm-f1.2", 12, 20},
                 {"canon-14mm-f2.8-asph", 40, 55},
                 {"minolta-fisheye-16mm-f2.8", 10, 89.5},
                 {"minolta-fisheye-16mm-f2.8", 10, 90.5},
                 {"phone-f3.5-asph", 12, 30}};
    for (const auto& c : cases) {
        const Lens lens(test::read_any_lens(c.lens));
        const auto factor =
            scale_for_field(lens, c.half_height_mm, c.half_field_deg, lens.film_mm());
        ASSERT_TRUE(factor) << c.lens;
        const Lens fitted(scaled(lens.prescription(), *factor));
        const auto field = field_of_height_deg(fitted, c.half_height_mm, fitted.film_mm());
        ASSERT_TRUE(field) << c.lens;
        EXPECT_NEAR(*field, c.half_field_deg, 1e-6) << c.lens;
    }
}

TEST(LensScaleForField, NothingWhereTheLensDoesNotSee) {
    // At 28 degrees the chief ray finds glass, but rims stop all light.
    for (const auto& [name, deg] :
         {std::pair{"takumar-50mm-f1.2", 28.}, std::pair{"takumar-50mm-f1.2", 60.},
          std::pair{"kodak-petzval-100mm-f2", 80.}, std::pair{"minolta-fisheye-16mm-f2.8", 115.}}) {
        const Lens lens(test::read_any_lens(name));
        EXPECT_FALSE(scale_for_field(lens, 12, deg, lens.film_mm())) << name;
    }
}

TEST(LensScaleFactor, MustBeAboveZero) {
    const Prescription lens = test::read_any_lens("takumar-50mm-f1.2");
    for (const double factor : {0., -1., double(NAN), double(INFINITY)})
        EXPECT_THROW((void)scaled(lens, factor), std::invalid_argument);
}

}  // namespace
}  // namespace petzval::camera
