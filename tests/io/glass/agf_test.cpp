// SPDX-License-Identifier: Apache-2.0
#include "io/glass/agf.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <random>

#include "io/file/csv.h"
#include "tests/support/refusal.h"
#include "tests/support/temporary_folder.h"
#include "tests/support/text_mutation.h"

namespace petzval::io {
namespace {

constexpr double kLineE_nm = 546.0740;

class Agf : public testing::Test {
  protected:
    AgfCatalog read(const std::string& bytes) {
        test::write_text(folder_ / "Mine.AGF", bytes);
        return AgfCatalog(folder_ / "Mine.AGF");
    }
    std::string refused(const std::string& text, const std::string& glass = "G") {
        return refusal([&] { (void)read(text).find(glass); });
    }
    test::TemporaryFolder folder_;
};

TEST_F(Agf, GivesTheIndicesOfGlassesInUse) {
    const AgfCatalog catalog(PETZVAL_TEST_DATA "/used_glasses.agf");
    const CsvText expected = read_csv_text(PETZVAL_TEST_DATA "/used_glasses.csv");
    ASSERT_EQ(expected.rows.size(), 116u);
    ASSERT_EQ(catalog.size(), 116u);
    const double lines_nm[] = {kLineD_nm, kLineF_nm, kLineC_nm, kLineG_nm, kLineE_nm};
    for (const auto& row : expected.rows) {
        const auto glass = catalog.find(row[0]);
        ASSERT_TRUE(glass) << row[0];
        EXPECT_EQ(glass->name, "used_glasses:" + row[0]);
        for (size_t i = 0; i < 5; ++i)
            EXPECT_NEAR(glass->index(lines_nm[i]), std::stod(row[i + 1]), 1e-8) << row[0] << i;
        EXPECT_NEAR(glass->abbe(), std::stod(row[6]), 1e-4) << row[0];
    }
}

// nd, nF and nC worked with 40 digits.
TEST_F(Agf, HasTheFormulasThatGlassesUse) {
    struct Worked {
        int formula;
        const char* coefficients;
        double nd, nF, nC;
    };
    const char* const sellmeier =
        "1.03961212 0.00600069867 0.231792344 0.0200179144 1.01046945 103.560653";
    const std::string four = fmt::format("{} 0.01 0.03", sellmeier);
    const std::string five = fmt::format("{} 0.02 90", four);
    for (const auto& [formula, coefficients, nd, nF, nC] :
         {Worked{1, "2.2718929 -0.010108077 0.010592509 0.00020816965 -7.6472538e-6 4.9240991e-7",
                 1.516799695318, 1.522376988962, 1.514323051736},
          Worked{2, sellmeier, 1.516800034501, 1.522376289731, 1.514322347261},
          Worked{5, "1.5 0.0076 0.0009", 1.518723163471, 1.526869303091, 1.515511055215},
          Worked{6, four.c_str(), 1.520405878095, 1.526133540763, 1.517867211971},
          Worked{9, "1.3 1.1 0.007 0.2 0.02", 1.623288231044, 1.628516962726, 1.621083937261},
          Worked{10, "2.3 -0.01 0.0106 2e-4 -7e-6 5e-7 1e-8 -2e-9", 1.526039318504, 1.531568906056,
                 1.523584584982},
          Worked{11, five.c_str(), 1.520380551444, 1.526116289577, 1.517835532352},
          Worked{12, "2.3 -0.01 0.0106 2e-4 -7e-6 5e-7 1e-4 -2e-5", 1.526042672785, 1.531569962416,
                 1.523590029507},
          Worked{13, "2.3 -0.01 1e-4 0.0106 2e-4 -7e-6 5e-7 1e-8 -2e-9", 1.526043223476,
                 1.531570729332, 1.523590672488}}) {
        const auto glass =
            read(fmt::format("NM G {}\nCD {} 0 0\nLD 0.35 2.5\n", formula, coefficients)).find("g");
        ASSERT_TRUE(glass) << formula;
        EXPECT_EQ(glass->name, "mine:G");
        EXPECT_NEAR(glass->index(kLineD_nm), nd, 1e-11) << formula;
        EXPECT_NEAR(glass->index(kLineF_nm), nF, 1e-11) << formula;
        EXPECT_NEAR(glass->index(kLineC_nm), nC, 1e-11) << formula;
        EXPECT_DOUBLE_EQ(glass->first_nm, 350);
        EXPECT_DOUBLE_EQ(glass->last_nm, 2500);
    }
}

const char* const kTwoGlasses =
    "CC made for this test\n"
    "NM HIKARI_J-LASF08A 13 0 1.883000 40.6890 0 0 0\n"
    "ED 0 0 0 0 0\n"
    "CD 3.4408629E+00 -1.38053657E-02 -5.63338044E-05 3.5057073E-02 9.60233781E-04 "
    "-7.6596963E-06 2.57013206E-06 0 0 0\n"
    "TD 0 0 0 0 0 0 2.0E+01\n"
    "LD 3.6501E-01 2.0581E+00\n"
    "IT 3.80000E-01 9.05000E-01 1.00000E+01\n"
    "NM SCHOTT_N-BK7 2 517642.251 1.516800 64.1673 0 0 0\n"
    "CD 1.03961212E+00 6.00069867E-03 2.31792344E-01 2.00179144E-02 1.01046945E+00 "
    "1.03560653E+02 0 0 0 0\n"
    "LD 3.0000E-01 2.5000E+00\n";

// nd and nF as another program works them.
void expect_two_glasses(const AgfCatalog& catalog) {
    EXPECT_EQ(catalog.size(), 2u);
    const auto first = catalog.find("hikari_j-lasf08a"), second = catalog.find("SCHOTT_N-BK7");
    ASSERT_TRUE(first && second);
    EXPECT_NEAR(first->index(kLineD_nm), 1.88300002, 1e-8);
    EXPECT_NEAR(first->index(kLineF_nm), 1.89825623, 1e-8);
    EXPECT_NEAR(second->index(kLineD_nm), 1.51680003, 1e-8);
    EXPECT_NEAR(second->index(kLineF_nm), 1.52237629, 1e-8);
    EXPECT_NEAR(first->first_nm, 365.01, 1e-9);
}

std::string replaced(std::string text, const std::string& from, const std::string& to) {
    for (size_t at = 0; (at = text.find(from, at)) != text.npos; at += to.size())
        text.replace(at, from.size(), to);
    return text;
}

TEST_F(Agf, IsReadAsProgramsWriteIt) {
    expect_two_glasses(read(kTwoGlasses));
    const std::string crlf = replaced(kTwoGlasses, "\n", "\r\n");
    expect_two_glasses(read(crlf));
    expect_two_glasses(read("\xEF\xBB\xBF" + crlf));
    expect_two_glasses(read(replaced(replaced(kTwoGlasses, " ", "\t"), "E-0", "e-0")));
    // Lines of coefficients are broken, as those of Nikon's catalogue are.
    expect_two_glasses(read(replaced(replaced(crlf, "3.5057073E-02 ", "3.5057073E-02 \r\n"),
                                     "02 1.01046945", "02\r\n 1.01046945")));
    std::string little = "\xFF\xFE", big = "\xFE\xFF";
    for (const char c : crlf) {
        little += {c, '\0'};
        big += {'\0', c};
    }
    expect_two_glasses(read(little));
    expect_two_glasses(read(big));
}

TEST_F(Agf, HasTheAbsorptionOfItsLinesIT) {
    const auto glass = [&](const char* lines) {
        const std::string text =
            replaced(kTwoGlasses, "IT 3.80000E-01 9.05000E-01 1.00000E+01\n", lines);
        return *read(text).find("hikari_j-lasf08a");
    };
    const auto known =
        glass("IT 0.5 0.98 10\nIT 0.4 0.81 25\nIT 0.6 x 10\nIT 0.7 1.2 10\nIT 0.8\n");
    EXPECT_NEAR(std::exp(-25 * known.absorption(400)), 0.81, 1e-12);
    EXPECT_NEAR(known.absorption(450), (std::log(0.81) / -25 + std::log(0.98) / -10) / 2, 1e-12);
    EXPECT_EQ(known.absorption(300), known.absorption(400));
    EXPECT_EQ(known.absorption(830), known.absorption(500));
    EXPECT_EQ(glass("").absorption(400), 0);
    EXPECT_TRUE(std::isfinite(glass("IT 0.4 0 25\n").absorption(400)));
}

TEST_F(Agf, FindsNothingForAnotherName) {
    EXPECT_FALSE(read(kTwoGlasses).find("N-BK7"));
    EXPECT_FALSE(read(kTwoGlasses).find(""));
}

TEST_F(Agf, RefusesWhatItCannotTurnIntoAGlass) {
    EXPECT_TRUE(has(refused("CC nothing\n"), "Mine.AGF: has no line NM"));
    EXPECT_TRUE(has(refused(std::string("NM G 1\n\0\n", 9)), "line 2: is not text"));
    EXPECT_TRUE(has(refused("CC\nNM G 3 0\nCD 1 1 1 1 1 1"),
                    "line 2: the glass G has dispersion formula 3 (Herzberger), which"));
    EXPECT_TRUE(has(refused("NM G 4 0\nCD 1 1 1 1 1"), "4 (Sellmeier 2)"));
    EXPECT_TRUE(has(refused("NM G 7 0\nCD 1 1 1 1"), "7 (Handbook of Optics 1)"));
    EXPECT_TRUE(has(refused("NM G 8 0\nCD 1 1 1 1"), "8 (Handbook of Optics 2)"));
    for (const char* formula : {"0", "14", "2.5", "-1", "x", "1e300"})
        EXPECT_TRUE(has(refused(fmt::format("NM G {}\nCD 1", formula)), "is not one of 1 to 13"));
    EXPECT_TRUE(has(refused("NM G 2 0\nCD 1 1 1 1"),
                    "has 4 coefficients (CD); its formula 2 (Sellmeier 1) needs 6"));
    EXPECT_TRUE(has(refused("NM G 2 0\nNM H 2 0\nCD 1 1 1 1 1 1"), "G has 0 coefficients"));
    EXPECT_TRUE(has(refused("NM G 5 0\nCD 1.5 nan 0"), "has no number as coefficient 2"));
    EXPECT_TRUE(has(refused("NM G 5 0\nCD 0.5 0 0"), "give no index from 1 to 5"));
    EXPECT_TRUE(has(refused("NM G 2 0\nCD 1 0.3 0 0 0 0"), "give no index")) << "a pole at 548 nm";
    EXPECT_TRUE(has(refusal([&] { (void)AgfCatalog(folder_ / "no.agf"); }), "no such file"));
}

// A glass that cannot be used does no harm to the others.
TEST_F(Agf, RefusesAGlassOnlyWhenItIsUsed) {
    const AgfCatalog catalog = read(std::string("NM BAD 3\nCD x\n") + kTwoGlasses);
    EXPECT_EQ(catalog.size(), 3u);
    EXPECT_TRUE(catalog.find("SCHOTT_N-BK7"));
    EXPECT_TRUE(has(refusal([&] { (void)catalog.find("bad"); }), "Herzberger"));
}

TEST_F(Agf, MutationsAreReadOrRefused) {
    std::mt19937 random(20240203);
    int read_well = 0, refused_at_all = 0;
    for (int i = 0; i < 2000; ++i) {
        try {
            const AgfCatalog catalog(test::mutated(kTwoGlasses, random), "mine.agf");
            (void)catalog.find(catalog.name_of(size_t(i) % catalog.size()));
            ++read_well;
        } catch (const InputError& error) {
            EXPECT_EQ(std::string(error.what()).find('\n'), std::string::npos);
            ++refused_at_all;
        }
    }
    EXPECT_GT(read_well, 200);
    EXPECT_GT(refused_at_all, 100);
}

}  // namespace
}  // namespace petzval::io
