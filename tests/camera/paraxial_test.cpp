// SPDX-License-Identifier: Apache-2.0
#include "camera/lens/paraxial.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <stdexcept>

#include "tests/support/lens_json.h"

namespace petzval {
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

}  // namespace
}  // namespace petzval
