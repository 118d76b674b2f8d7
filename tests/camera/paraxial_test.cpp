// SPDX-License-Identifier: Apache-2.0
#include "camera/lens/paraxial.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <stdexcept>

#include "tests/support/lens_json.h"

namespace petzval::camera {
namespace {

using test::kOracleLenses;
using test::read_lens;
using test::read_oracle;

void expect_relative(double value, double wanted, double tolerance, const std::string& what) {
    EXPECT_NEAR(value, wanted, tolerance * std::fabs(wanted)) << what;
}

class OracleFirstOrder : public ::testing::TestWithParam<const char*> {
  protected:
    const nlohmann::json oracle = read_oracle(GetParam());
    const Lens lens{read_lens(GetParam())};
};
INSTANTIATE_TEST_SUITE_P(Lenses, OracleFirstOrder, ::testing::ValuesIn(kOracleLenses));

TEST_P(OracleFirstOrder, FirstOrderDataInBothSections) {
    int compared = 0;
    for (const auto& [key, wanted] : oracle.at("first_order").items()) {
        const auto section = key.find('x') == std::string::npos ? Section::Y : Section::X;
        const FirstOrder data = first_order(lens, std::stod(key), section);
        for (const auto& [name, value] : {std::pair{"efl", data.focal_length_mm},
                                          {"bfd", data.back_focus_mm},
                                          {"ffd", data.front_focus_mm},
                                          {"front_principal", data.front_principal_mm},
                                          {"rear_principal", data.rear_principal_mm},
                                          {"enp_z", data.entrance_pupil_mm},
                                          {"exp_z", data.exit_pupil_mm},
                                          {"epd", data.entrance_pupil_diameter_mm},
                                          {"xpd", data.exit_pupil_diameter_mm},
                                          {"fno", data.fnumber}}) {
            expect_relative(value, wanted.at(name), 1e-11, key + ' ' + name);
            ++compared;
        }
    }
    EXPECT_GE(compared, 30);
}

TEST_P(OracleFirstOrder, SectionsAreAlikeWithoutCylinders) {
    bool cylinders = false;
    for (const auto& surface : lens.prescription().surfaces)
        cylinders = cylinders || surface.profile != Profile::Rotational;
    const double x_mm = first_order(lens, kLineD_nm, Section::X).focal_length_mm;
    EXPECT_EQ(x_mm != first_order(lens, kLineD_nm).focal_length_mm, cylinders);
}

TEST_P(OracleFirstOrder, Conjugates) {
    for (const auto& row : oracle.at("conjugates_d")) {
        const ParaxialImage image = image_of(lens, row[0], kLineD_nm);
        expect_relative(image.from_last_vertex_mm, row[1], 1e-11, row.dump());
        expect_relative(image.magnification, row[2], 1e-11, row.dump());
    }
}

TEST_P(OracleFirstOrder, SeidelSumsOfEachSurface) {
    if (!oracle.contains("seidel")) {
        EXPECT_THROW((void)seidel(lens, 0.1), std::invalid_argument);
        return;
    }
    const auto& wanted = oracle.at("seidel");
    const Seidel sums = seidel(lens, wanted.at("field_tan"));
    ASSERT_EQ(sums.of_surface.size(), wanted.at("per_surface").size());
    for (size_t k = 0; k < 7; ++k) {
        const std::string column = wanted.at("columns").at(k);
        // What cancels between surfaces is known to the digits of the largest.
        double largest = 0;
        for (size_t i = 0; i < sums.of_surface.size(); ++i) {
            const double of_surface = wanted.at("per_surface")[i][k];
            largest = std::max(largest, std::fabs(of_surface));
            EXPECT_NEAR(sums.of_surface[i][k], of_surface, 1e-10 * largest + 1e-12)
                << column << " of " << i;
        }
        EXPECT_NEAR(sums.total[k], double(wanted.at("total")[k]), 1e-10 * largest) << column;
    }
}

// A textbook's Cooke triplet in another program, OpticStudio 2026 R1: its figures stand in the
// issue tracker of HarrisonKramer/optiland, number 710. Stop on the fourth surface; SK16 is
// Hikari's and F2 Schott's, by the formulas in refractiveindex.info: of 35 pairs of such glasses
// the only one that gives all digits. The image is the textbook's, 42.20778 mm behind the last
// vertex.
TEST(Paraxial, CookeTripletIsThatOfAnOpticsProgram) {
    const Glass sk16{"SK16", PowerSeries{{{2.592001, 0},
                                          {-0.01540969, 2},
                                          {0.0102268, -2},
                                          {0.001581559, -4},
                                          {-0.0001877149, -6},
                                          {1.012515e-05, -8}}}};
    const Glass f2{"F2", Sellmeier{{{1.34533359, 0.00997743871},
                                    {0.209073176, 0.0470450767},
                                    {0.937357162, 111.886764}}}};
    Prescription file;
    const auto add = [&](double radius_mm, double thickness_mm, const Glass* glass, bool stop) {
        LensSurface surface;
        surface.curvature_1_mm = radius_mm == 0 ? 0 : 1 / radius_mm;
        surface.thickness_mm = thickness_mm;
        surface.semi_diameter_mm = stop ? 3.8364 : 10;
        surface.stop = stop;
        if (glass) surface.glass = *glass;
        file.surfaces.push_back(surface);
    };
    add(22.01359, 3.25896, &sk16, false);
    add(-435.76044, 6.00755, nullptr, false);
    add(-22.21328, 0.99997, &f2, false);
    add(20.29192, 0, nullptr, false);
    add(0, 4.75041, nullptr, true);
    add(79.68360, 2.95208, &sk16, false);
    add(-18.39533, 42.20778, nullptr, false);
    const double nm = 550;
    const FirstOrder first = first_order(Lens(file), nm);
    EXPECT_NEAR(first.focal_length_mm, 49.9997831, 5e-7);
    EXPECT_NEAR(first.entrance_pupil_mm, 11.5121587, 5e-7);
    EXPECT_NEAR(first.exit_pupil_mm - file.surfaces.back().thickness_mm, -50.9613480, 5e-7);
    // Its f-number is that of an entrance pupil of 10 mm.
    EXPECT_NEAR(first.focal_length_mm / 10, 4.9999783, 5e-8);
}

}  // namespace
}  // namespace petzval::camera
