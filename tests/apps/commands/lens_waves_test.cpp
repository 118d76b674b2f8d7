// SPDX-License-Identifier: Apache-2.0
// petzval lens wavefront, psf, mtf --wave, through-focus, field-curvature, focal-shift and
// lateral-colour.
#include <cmath>
#include <numbers>
#include <sstream>

#include "io/file/csv.h"
#include "tests/support/cli.h"

namespace petzval::apps {
namespace {

constexpr const char* kTriplet = "cooke-triplet-50mm-f5";

class LensWaves : public CliTest {
  protected:
    Finished analysed(const char* analysis, const Words& more) {
        Words words{"lens", analysis, kTriplet, "-o", path("a.svg"), "--csv", path("a.csv")};
        words.insert(words.end(), more.begin(), more.end());
        const Finished run = run_petzval(words);
        EXPECT_EQ(run.exit_code, 0) << run.err;
        EXPECT_NE(file_bytes(path("a.svg")).find("</svg>"), std::string::npos) << analysis;
        return run;
    }
    io::CsvTable table(const char* analysis, const Words& more) {
        EXPECT_EQ(analysed(analysis, more).err, "");
        return io::read_csv(path("a.csv"));
    }
    std::string refused(const char* analysis, const Words& more, const char* lens = kTriplet) {
        Words words{"lens", analysis, lens, "-o", path("a.svg")};
        words.insert(words.end(), more.begin(), more.end());
        return error_of(words, 2);
    }
};

// The numbers of the first line of a text that begins with these words.
std::vector<double> numbers_after(const std::string& text, const std::string& begin) {
    std::istringstream lines(text);
    for (std::string line; std::getline(lines, line);) {
        const size_t first = line.find_first_not_of(' ');
        if (first == line.npos || line.compare(first, begin.size(), begin) != 0) continue;
        std::istringstream words(line.substr(first + begin.size()));
        std::vector<double> out;
        for (double number; words >> number;) out.push_back(number);
        return out;
    }
    ADD_FAILURE() << begin << " is not in\n" << text;
    return std::vector<double>(20);
}

TEST_F(LensWaves, WavefrontHasFansMapsFiguresAndZernikes) {
    const Finished run =
        analysed("wavefront", {"--fstop", "f/8", "--field", "0,14", "--map", path("map.png")});
    EXPECT_EQ(run.err, "");
    EXPECT_GT(file_bytes(path("map.png")).size(), 1000u);
    // x, y, RMS, P-V, Strehl, f-number.
    const auto axis = numbers_after(run.out, "0        d");
    ASSERT_EQ(axis.size(), 6u) << run.out;
    EXPECT_NEAR(axis[5], 8, 0.03);
    EXPECT_NEAR(axis[4], std::exp(-std::pow(2 * std::numbers::pi * axis[2], 2)), 0.01);
    // Coefficients: 0 degrees F, d, C, then 14 degrees. RMS from all but piston and tilt.
    double sum = 0;
    for (int j = 4; j <= 22; ++j) {
        const auto row = numbers_after(run.out, "Z" + std::to_string(j) + " ");
        ASSERT_EQ(row.size(), 6u) << j;
        sum += row[1] * row[1];
    }
    EXPECT_NEAR(std::sqrt(sum), axis[2], 0.01 * axis[2]);
    const io::CsvTable fans = io::read_csv(path("a.csv"));
    EXPECT_EQ(fans.names[4], "opd_mm");
    EXPECT_GT(fans.rows.size(), 2u * 3 * 2 * 50);
    double most = 0;
    for (const auto& row : fans.rows)
        if (row[0] == 0 && std::fabs(row[1] - 587.5618) < 1e-3)
            most = std::max(most, std::fabs(row[4]) / 587.5618e-6);
    EXPECT_NEAR(most, axis[3], 0.15 * axis[3]);  // fans end within the rim
}

TEST_F(LensWaves, PointSpreadHoldsTheLight) {
    const io::CsvTable psf = table("psf", {"--fstop", "11", "--field", "0", "--light", "550"});
    double light = 0;
    const double cell = psf.rows[1][1] - psf.rows[0][1];
    double peak = 0;
    for (const auto& row : psf.rows) {
        light += row[3] * cell * cell;
        peak = std::max(peak, row[3]);
    }
    EXPECT_GT(light, 0.93);  // the rest is in far rings
    EXPECT_LT(light, 1.001);
    // Peak of an ideal lens: pi / (4 N^2 wavelength^2).
    const double ideal = std::numbers::pi / 4 / std::pow(11 * 550e-6, 2);
    EXPECT_LT(peak, 1.01 * ideal);
    EXPECT_GT(peak, 0.5 * ideal);
}

TEST_F(LensWaves, MtfByWavesIsThatOfAnIdealLensWhenStoppedDown) {
    const io::CsvTable mtf = table(
        "mtf", {"--wave", "--fstop", "32", "--field", "0", "--light", "550", "--cycles", "60"});
    double worst = 0;
    for (const auto& row : mtf.rows) {
        const double s = row[1] * 32 * 550e-6;
        const double wanted =
            s < 1 ? 2 / std::numbers::pi * (std::acos(s) - s * std::sqrt(1 - s * s)) : 0;
        worst = std::max(worst, std::fabs(row[2] - wanted));
        EXPECT_NEAR(row[2], row[3], 1e-3);
    }
    EXPECT_LT(worst, 0.01);
    // Weights are shares.
    const io::CsvTable usual = table("mtf", {"--wave", "--field", "0"});
    const io::CsvTable same =
        table("mtf", {"--wave", "--field", "0", "--light", "486.1327nm:2,587.5618:2,656.2725:2"});
    const io::CsvTable blue = table("mtf", {"--wave", "--field", "0", "--light", "486.1327"});
    for (size_t i = 0; i < usual.rows.size(); ++i)
        EXPECT_NEAR(usual.rows[i][2], same.rows[i][2], 1e-9);
    EXPECT_GT(std::fabs(usual.rows[20][2] - blue.rows[20][2]), 0.02);
}

TEST_F(LensWaves, SpotAndMtfSayWhereRaysAreTooSharp) {
    const std::string at_16 = analysed("spot", {"--fstop", "16", "--field", "0"}).out;
    EXPECT_NE(at_16.find("rays alone are "), std::string::npos) << at_16;
    EXPECT_NE(at_16.find(" times too sharp; Airy's disc has a radius of 11.4"), std::string::npos)
        << at_16;
    const std::string open = analysed("spot", {"--field", "0"}).out;
    EXPECT_NE(open.find("rays alone are enough"), std::string::npos) << open;
    const std::string mtf = analysed("mtf", {"--fstop", "22", "--field", "0"}).out;
    EXPECT_NE(mtf.find("contrast at 50 cycles per mm"), std::string::npos) << mtf;
    EXPECT_NE(mtf.find("rays alone are too sharp by 0."), std::string::npos) << mtf;
    const Finished bent =
        run_petzval({"lens", "mtf", "takumar-50mm-f1.2", "--field", "21", "-o", path("a.svg")});
    EXPECT_NE(bent.out.find("rays are near the truth"), std::string::npos) << bent.out << bent.err;
}

TEST_F(LensWaves, FociOverFilmFieldAndColour) {
    const io::CsvTable through = table("through-focus", {"--field", "0,14"});
    EXPECT_EQ(through.rows.size(), 2u * 41);
    double least = 1e9, at = 0;
    for (const auto& row : through.rows)
        if (row[0] == 0 && row[4] < least) least = row[4], at = row[1];
    EXPECT_NEAR(at, numbers_after(analysed("through-focus", {"--field", "0"}).out, "0 ")[0],
                (through.rows[1][1] - through.rows[0][1]) * 0.6);
    const io::CsvTable waves =
        table("through-focus", {"--field", "0", "--wave", "--fstop", "11", "--light", "550"});
    double most = 0;
    for (const auto& row : waves.rows) most = std::max(most, row[2]);
    const double s = 30 * 11 * 550e-6;  // no lens is better than an ideal one
    EXPECT_LT(most, 2 / std::numbers::pi * (std::acos(s) - s * std::sqrt(1 - s * s)) + 0.005);
    EXPECT_GT(most, 0.7);

    const io::CsvTable field = table("field-curvature", {});
    EXPECT_EQ(field.rows.size(), 41u);
    EXPECT_NEAR(field.rows[0][1], field.rows[0][2], 1e-6);
    EXPECT_GT(std::fabs(field.rows[40][1] - field.rows[40][2]), 0.1);

    const io::CsvTable colour = table("focal-shift", {});
    EXPECT_EQ(colour.rows.size(), 61u);
    double d = 1;
    for (const auto& row : colour.rows)
        if (row[0] == 590) d = row[1];
    EXPECT_NEAR(d, 0, 0.03);
    const io::CsvTable near = table("focal-shift", {"--focus", "1m"});
    for (const auto& row : near.rows) {
        if (row[0] == 590) EXPECT_NEAR(row[1], 0, 0.03);
    }

    const io::CsvTable lateral = table("lateral-colour", {"--fstop", "8"});
    EXPECT_EQ(lateral.rows.size(), 41u);
    EXPECT_NEAR(lateral.rows[0][1], 0, 1e-9);
    EXPECT_NEAR(lateral.rows[40][3], 1.21967 * 587.5618e-6 * 8, 1e-6);
    EXPECT_LT(std::fabs(lateral.rows[40][1]), 0.05);
    EXPECT_GT(std::fabs(lateral.rows[40][1]), 1e-4);
}

TEST_F(LensWaves, RefusesWhatItCannotDo) {
    const auto expect_part = [](const std::string& text, const char* part) {
        EXPECT_NE(text.find(part), std::string::npos) << text;
    };
    expect_part(refused("psf", {"--field", "21"}, "takumar-50mm-f1.2"), "give a higher --fstop");
    expect_part(refused("mtf", {"--field", "21", "--wave"}, "takumar-50mm-f1.2"),
                "give a higher --fstop");
    expect_part(refused("wavefront", {"--field", "70"}), "smaller --field");
    expect_part(refused("wavefront", {"--light", "blue"}), "--light");
    expect_part(refused("wavefront", {"--light", "550:0"}), "--light");
    expect_part(refused("wavefront", {"--light", "550:1:1"}), "is not like 450:0.3");
    expect_part(refused("wavefront", {"--light", "30000"}), "100 to 20000");
    expect_part(refused("wavefront", {"--fstop", "round"}), "--fstop");
    expect_part(refused("wavefront", {"--map", path("a.svg")}), "would overwrite");
    expect_part(refused("wavefront", {"--map", path("a.pdf")}), ".svg or .png");
    // What can be done, with a word about it.
    expect_part(analysed("wavefront", {"--field", "0", "--light", "250"}).err,
                "250 nm is beyond 310 to 2500 nm");
    expect_part(analysed("wavefront", {"--field", "0", "--fstop", "1"}).err,
                "opens to f/5.01 at most");
    // An iris of half a micrometre.
    const auto tiny = numbers_after(
        analysed("wavefront", {"--field", "0", "--fstop", "100000"}).out, "0        d");
    EXPECT_NEAR(tiny[4], 1, 1e-4);
    EXPECT_NEAR(tiny[5], 1e5, 500);
}

}  // namespace
}  // namespace petzval::apps
