// SPDX-License-Identifier: Apache-2.0
#include "core/spectrum/spectrum_table.h"

#include <gtest/gtest.h>

#include <vector>

namespace petzval {
namespace {

using Points = std::vector<std::pair<float, float>>;

TEST(SpectrumTable, IsLinearBetweenAndHeldBeyond) {
    SpectrumTable table;
    table.at_nm(kFirst_nm) = 3;
    table.at_nm(500) = 1;
    table.at_nm(501) = 5;
    table.at_nm(kLast_nm) = 7;
    EXPECT_EQ(table.at(500.f), 1);
    EXPECT_EQ(table.at(500.25f), 2);
    EXPECT_EQ(table.at(501.5f), 2.5f);
    EXPECT_EQ(table.at(499.5f), 0.5f);
    EXPECT_EQ(table.at(360.f), 3);
    EXPECT_EQ(table.at(100.f), 3);
    EXPECT_EQ(table.at(0.f), 3);
    EXPECT_EQ(table.at(830.f), 7);
    EXPECT_EQ(table.at(829.5f), 3.5f);
    EXPECT_EQ(table.at(2000.f), 7);
}

TEST(SpectrumTable, LanesAreLookedUpOneByOne) {
    SpectrumTable table;
    for (int nm = kFirst_nm; nm <= kLast_nm; ++nm) table.at_nm(nm) = float(nm);
    const f4 nm{400.5f, 360, 830, 555.25f}, value = table.at(nm);
    for (int i = 0; i < 4; ++i) EXPECT_FLOAT_EQ(value[i], nm[i]);
}

TEST(Tabulate, ZeroOrHoldBeyondTheEnds) {
    const Points points{{400, 2}, {410, 4}, {430, 0.5f}};
    const SpectrumTable zero = tabulate(points, Extrapolate::Zero);
    const SpectrumTable hold = tabulate(points, Extrapolate::Hold);
    for (const SpectrumTable* table : {&zero, &hold}) {
        EXPECT_EQ(table->at_nm(400), 2);
        EXPECT_FLOAT_EQ(table->at_nm(405), 3);
        EXPECT_EQ(table->at_nm(410), 4);
        EXPECT_FLOAT_EQ(table->at_nm(420), 2.25f);
        EXPECT_EQ(table->at_nm(430), 0.5f) << "the last point itself";
    }
    for (const int nm : {kFirst_nm, 399, 431, kLast_nm}) EXPECT_EQ(zero.at_nm(nm), 0) << nm;
    for (const int nm : {kFirst_nm, 399}) EXPECT_EQ(hold.at_nm(nm), 2) << nm;
    for (const int nm : {431, kLast_nm}) EXPECT_EQ(hold.at_nm(nm), 0.5f) << nm;
}

TEST(Tabulate, PointsBeyondTheRangeAndBetweenNanometres) {
    const SpectrumTable wide = tabulate(Points{{300, 0}, {900, 600}}, Extrapolate::Zero);
    EXPECT_FLOAT_EQ(wide.at_nm(kFirst_nm), 60);
    EXPECT_FLOAT_EQ(wide.at_nm(kLast_nm), 530);
    const SpectrumTable odd = tabulate(Points{{499.5f, 0}, {500.5f, 2}}, Extrapolate::Zero);
    EXPECT_FLOAT_EQ(odd.at_nm(500), 1);
    EXPECT_EQ(odd.at_nm(499), 0);
    EXPECT_EQ(odd.at_nm(501), 0);
}

TEST(Tabulate, OnePointIsALineOrAConstant) {
    const SpectrumTable line = tabulate(Points{{550, 3}}, Extrapolate::Zero);
    EXPECT_EQ(line.at_nm(550), 3);
    EXPECT_EQ(integral(line), 3);
    EXPECT_EQ(integral(tabulate(Points{{550, 3}}, Extrapolate::Hold)), 3 * (kLast_nm - kFirst_nm));
}

TEST(Integral, IsExactForStraightLines) {
    SpectrumTable a, b;
    for (int nm = kFirst_nm; nm <= kLast_nm; ++nm) a.at_nm(nm) = float(nm), b.at_nm(nm) = 2;
    EXPECT_DOUBLE_EQ(integral(a), 470 * 595.);
    EXPECT_DOUBLE_EQ(integral_of_product(a, b), 2 * 470 * 595.);
    const double exact = (830. * 830 * 830 - 360. * 360 * 360) / 3;
    EXPECT_NEAR(integral_of_product(a, a), exact, 1e-12 * exact);
}

}  // namespace
}  // namespace petzval
