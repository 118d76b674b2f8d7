// SPDX-License-Identifier: Apache-2.0
#include "core/spectrum/colorimetry.h"

#include <gtest/gtest.h>

namespace petzval {
namespace {

// White of IEC 61966-2-1:1999: x = 0.3127, y = 0.3290.
const V3d kWhite(0.3127 / 0.3290, 1, (1 - 0.3127 - 0.3290) / 0.3290);

void expect_near(const V3d& a, const V3d& b, double tolerance) {
    for (int i = 0; i < 3; ++i) EXPECT_NEAR(a[i], b[i], tolerance) << "component " << i;
}

void expect_near(const Matrix3& a, const Matrix3& b, double tolerance) {
    for (size_t i = 0; i < 3; ++i) {
        SCOPED_TRACE(testing::Message() << "row " << i);
        expect_near(a.row[i], b.row[i], tolerance);
    }
}

const Matrix3 kIdentity{{V3d(1, 0, 0), V3d(0, 1, 0), V3d(0, 0, 1)}};

TEST(Matrix3, MultipliesAndInverts) {
    const Matrix3 a{{V3d(1, 2, 3), V3d(0, 1, 4), V3d(5, 6, 0)}};
    EXPECT_EQ(a * V3d(1, 10, 100), V3d(321, 410, 65));
    // Worked by hand; the determinant is 1.
    expect_near(a.inverse(), {{V3d(-24, 18, 5), V3d(20, -15, -4), V3d(-5, 4, 1)}}, 1e-12);
    expect_near(a * a.inverse(), kIdentity, 1e-12);
    const Matrix3 b{{V3d(0, 1, 0), V3d(0, 0, 1), V3d(1, 0, 0)}};
    expect_near(a * b, {{V3d(3, 1, 2), V3d(4, 0, 1), V3d(0, 5, 6)}}, 0);
}

TEST(Respond, SumsUnderEachCurve) {
    std::array<SpectrumTable, 3> curves;
    for (size_t i = 0; i < 3; ++i) curves[i].at_nm(400 + 100 * int(i)) = float(i + 1);
    SpectrumTable spectrum;
    for (int nm = kFirst_nm; nm <= kLast_nm; ++nm) spectrum.at_nm(nm) = float(nm);
    EXPECT_EQ(respond(curves, spectrum), V3d(400, 1000, 1800));
}

// IEC 61966-2-1:1999, 5.2 prints four digits.
TEST(SrgbToXyz, IsTheStandardsMatrix) {
    expect_near(
        srgb_to_xyz(kWhite),
        {{V3d(0.4124, 0.3576, 0.1805), V3d(0.2126, 0.7152, 0.0722), V3d(0.0193, 0.1192, 0.9505)}},
        3e-4);
}

TEST(SrgbToXyz, GivesTheWhiteItIsAskedFor) {
    for (const V3d& white : {kWhite, V3d(1.09850, 1, 0.35585), V3d(2, 3, 4)})
        expect_near(srgb_to_xyz(white) * V3d(1, 1, 1), white, 1e-12);
}

// Chromaticities of ITU-R BT.709-6, table 1.
TEST(SrgbToXyz, KeepsThePrimaries) {
    const double xy[3][2] = {{0.64, 0.33}, {0.30, 0.60}, {0.15, 0.06}};
    for (int i = 0; i < 3; ++i) {
        V3d primary(0);
        primary[i] = 1;
        const V3d xyz = srgb_to_xyz(V3d(1.0985, 1, 0.35585)) * primary;
        EXPECT_NEAR(xyz.x / (xyz.x + xyz.y + xyz.z), xy[i][0], 1e-12);
        EXPECT_NEAR(xyz.y / (xyz.x + xyz.y + xyz.z), xy[i][1], 1e-12);
    }
}

// D65 to A as brucelindbloom.com prints it, from the whites of ASTM E308.
TEST(Bradford, MapsD65ToA) {
    const V3d d65(0.95047, 1, 1.08883), a(1.09850, 1, 0.35585);
    expect_near(bradford(d65, a),
                {{V3d(1.2164557, 0.1109905, -0.1549325), V3d(0.1533326, 0.9152313, -0.0559953),
                  V3d(-0.0239469, 0.0358984, 0.3147529)}},
                1e-6);
    expect_near(bradford(d65, a) * d65, a, 1e-12);
    expect_near(bradford(d65, d65), kIdentity, 1e-12);
    expect_near(bradford(a, d65) * bradford(d65, a), kIdentity, 1e-12);
}

TEST(Lab, WhiteBlackAndTheStraightPart) {
    expect_near(xyz_to_lab(kWhite, kWhite), V3d(100, 0, 0), 1e-12);
    expect_near(xyz_to_lab(kWhite * 3., kWhite * 3.), V3d(100, 0, 0), 1e-12);
    expect_near(xyz_to_lab(V3d(0), kWhite), V3d(0), 1e-12);
    // L* = 903.2963 Y/Yn where Y/Yn is at most (24/116)^3 = 0.008856.
    expect_near(xyz_to_lab(kWhite * 0.005, kWhite), V3d(4.5164815, 0, 0), 1e-6);
    expect_near(xyz_to_lab(kWhite * 0.184186519, kWhite), V3d(50, 0, 0), 1e-6);
}

// Red, green and blue of sRGB under D65, as colour tables print them.
TEST(Lab, PrimariesOfSrgb) {
    const Matrix3 to_xyz = srgb_to_xyz(kWhite);
    expect_near(xyz_to_lab(to_xyz * V3d(1, 0, 0), kWhite), V3d(53.24, 80.09, 67.20), 0.02);
    expect_near(xyz_to_lab(to_xyz * V3d(0, 1, 0), kWhite), V3d(87.73, -86.18, 83.18), 0.02);
    expect_near(xyz_to_lab(to_xyz * V3d(0, 0, 1), kWhite), V3d(32.30, 79.19, -107.86), 0.02);
}

// Sharma, Wu and Dalal 2005, table 1: all 34 pairs. 7 to 16 are those where the mean hue is apt to
// fall on the wrong side.
TEST(DeltaE2000, AgreesWithThePublishedPairs) {
    struct Pair {
        V3d a, b;
        double delta;
    };
    const Pair pairs[] = {{{50, 2.6772, -79.7751}, {50, 0, -82.7485}, 2.0425},
                          {{50, 3.1571, -77.2803}, {50, 0, -82.7485}, 2.8615},
                          {{50, 2.8361, -74.0200}, {50, 0, -82.7485}, 3.4412},
                          {{50, -1.3802, -84.2814}, {50, 0, -82.7485}, 1.0000},
                          {{50, -1.1848, -84.8006}, {50, 0, -82.7485}, 1.0000},
                          {{50, -0.9009, -85.5211}, {50, 0, -82.7485}, 1.0000},
                          {{50, 0, 0}, {50, -1, 2}, 2.3669},
                          {{50, -1, 2}, {50, 0, 0}, 2.3669},
                          {{50, 2.4900, -0.0010}, {50, -2.4900, 0.0009}, 7.1792},
                          {{50, 2.4900, -0.0010}, {50, -2.4900, 0.0010}, 7.1792},
                          {{50, 2.4900, -0.0010}, {50, -2.4900, 0.0011}, 7.2195},
                          {{50, 2.4900, -0.0010}, {50, -2.4900, 0.0012}, 7.2195},
                          {{50, -0.0010, 2.4900}, {50, 0.0009, -2.4900}, 4.8045},
                          {{50, -0.0010, 2.4900}, {50, 0.0010, -2.4900}, 4.8045},
                          {{50, -0.0010, 2.4900}, {50, 0.0011, -2.4900}, 4.7461},
                          {{50, 2.5, 0}, {50, 0, -2.5}, 4.3065},
                          {{50, 2.5, 0}, {73, 25, -18}, 27.1492},
                          {{50, 2.5, 0}, {61, -5, 29}, 22.8977},
                          {{50, 2.5, 0}, {56, -27, -3}, 31.9030},
                          {{50, 2.5, 0}, {58, 24, 15}, 19.4535},
                          {{50, 2.5, 0}, {50, 3.1736, 0.5854}, 1.0000},
                          {{50, 2.5, 0}, {50, 3.2972, 0}, 1.0000},
                          {{50, 2.5, 0}, {50, 1.8634, 0.5757}, 1.0000},
                          {{50, 2.5, 0}, {50, 3.2592, 0.3350}, 1.0000},
                          {{60.2574, -34.0099, 36.2677}, {60.4626, -34.1751, 39.4387}, 1.2644},
                          {{63.0109, -31.0961, -5.8663}, {62.8187, -29.7946, -4.0864}, 1.2630},
                          {{61.2901, 3.7196, -5.3901}, {61.4292, 2.2480, -4.9620}, 1.8731},
                          {{35.0831, -44.1164, 3.7933}, {35.0232, -40.0716, 1.5901}, 1.8645},
                          {{22.7233, 20.0904, -46.6940}, {23.0331, 14.9730, -42.5619}, 2.0373},
                          {{36.4612, 47.8580, 18.3852}, {36.2715, 50.5065, 21.2231}, 1.4146},
                          {{90.8027, -2.0831, 1.4410}, {91.1528, -1.6435, 0.0447}, 1.4441},
                          {{90.9257, -0.5406, -0.9208}, {88.6381, -0.8985, -0.7239}, 1.5381},
                          {{6.7747, -0.2908, -2.4247}, {5.8714, -0.0985, -2.2286}, 0.6377},
                          {{2.0776, 0.0795, -1.1350}, {0.9033, -0.0636, -0.5514}, 0.9082}};
    int number = 0;
    for (const auto& [a, b, delta] : pairs) {
        SCOPED_TRACE(testing::Message() << "pair " << ++number);
        EXPECT_NEAR(delta_e_2000(a, b), delta, 6e-5);
        EXPECT_EQ(delta_e_2000(a, a), 0);
        // Pairs whose hues lie 180 degrees apart to the last bit may fall on either side.
        if (number != 10 && number != 14) {
            EXPECT_NEAR(delta_e_2000(b, a), delta, 6e-5);
        }
    }
}

}  // namespace
}  // namespace petzval
