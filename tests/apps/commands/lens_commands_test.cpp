// SPDX-License-Identifier: Apache-2.0
// petzval lens.
#include <fmt/format.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <numbers>

#include "io/file/csv.h"
#include "tests/support/cli.h"
#include "tests/support/lens_json.h"

namespace petzval::apps {
namespace {

using nlohmann::json;
using test::read_json;
using test::read_oracle;

constexpr const char* kLens = "double-gauss-100mm-f2";

class LensCli : public CliTest {
  protected:
    /// What a run that must succeed prints.
    std::string output_of(Words words) {
        words.insert(words.begin(), "lens");
        const Finished run = run_petzval(words);
        EXPECT_EQ(run.exit_code, 0) << run.err;
        EXPECT_EQ(run.err, "");
        return run.out;
    }
    void expect_error(Words words, int exit_code, const std::string& part) {
        words.insert(words.begin(), "lens");
        const std::string error = error_of(words, exit_code);
        EXPECT_NE(error.find(part), std::string::npos) << error;
    }
};

bool holds(const std::string& text, const std::string& part) {
    return text.find(part) != std::string::npos;
}

size_t count_of(const std::string& text, const std::string& part) {
    size_t count = 0;
    for (size_t at = text.find(part); at != text.npos; at = text.find(part, at + 1)) ++count;
    return count;
}

TEST_F(LensCli, ListsTheLensesThatShip) {
    const std::string list = output_of({"list"});
    EXPECT_EQ(count_of(list, "\n"), 2u + 18u);
    EXPECT_TRUE(list.starts_with(
        "lens                               focal  f-number    angle  design (patent)\n"
        "                                      mm    stated  degrees\n"))
        << list;
    EXPECT_TRUE(holds(list, "double-gauss-100mm-f2                100       f/2       28  Double"))
        << list;
}

TEST_F(LensCli, ShowsSurfacesAndGlasses) {
    const std::string shown = output_of({"show", "Schneider-Anamorphic-31mm"});
    for (const char* part : {"focal length 60.55 mm", "f/2.2, as the file states", "US 6,310,731",
                             "cylinder along y", " stop", "-101.3", "image circle 27.5 mm"})
        EXPECT_TRUE(holds(shown, part)) << part << '\n' << shown;
    EXPECT_TRUE(holds(output_of({"show", "canon-14mm-f2.8-asph"}), " A4 = "));
}

TEST_F(LensCli, ChecksFirstOrderDataAndSeidelSums) {
    const json check = json::parse(output_of({"check", kLens, "--json"}));
    const json oracle = read_oracle(kLens);
    const json wanted = oracle.at("first_order").at("587.5618");
    const json data = check.at("first_order").at("d 587.5618 nm");
    for (const auto& [ours, theirs] : {std::pair{"focal_length_mm", "efl"},
                                       {"back_focus_mm", "bfd"},
                                       {"fnumber", "fno"},
                                       {"entrance_pupil_mm", "enp_z"},
                                       {"exit_pupil_mm", "exp_z"}})
        EXPECT_NEAR(double(data.at(ours)), double(wanted.at(theirs)), 1e-6) << ours;
    EXPECT_EQ(double(check.at("seidel").at("half_field_deg")), 14);
    for (size_t k = 0; k < 7; ++k)
        EXPECT_NEAR(double(check.at("seidel").at("total")[k]),
                    double(oracle.at("seidel").at("total")[k]), 1e-6)
            << k;
    EXPECT_NEAR(double(check.at("fnumber_by_real_rays")), 1.9762, 5e-5);  // the oracle's
    const json stated = check.at("stated");
    ASSERT_EQ(stated.size(), 3u);
    EXPECT_EQ(stated[0].at("figure"), "focal length (mm)");
    EXPECT_NEAR(double(stated[0].at("relative_difference")), 3.72e-5, 1e-6);

    EXPECT_EQ(double(check.at("field").at("half_field_deg")), 14);
    EXPECT_NEAR(double(check.at("field").at("half_field_of_image_circle_deg")), 14.156, 1e-3);

    const std::string text = output_of({"check", kLens});
    for (const char* part :
         {"100.003720", "fnumber above is paraxial: focal length / diameter of the entrance pupil",
          "smallest f-number by real rays, that of --fstop: 1.9762\n  1 / (2 sin u') of the ray",
          "f-number (paraxial)                          2 ",
          "Seidel sums (mm), wide open, half field 14°",
          "focal length (mm)                          100      100.004    0.004 %",
          "half field 14°, as the file states: a circle of 49.34 mm on the film",
          "image circle 49.9 mm, as the file states: a half field of 14.16° before the lens"})
        EXPECT_TRUE(holds(text, part)) << text;
    const std::string cylinders = output_of({"check", "schneider-anamorphic-31mm"});
    EXPECT_TRUE(holds(cylinders, "d 587.5618 nm, x")) << cylinders;
    EXPECT_FALSE(holds(cylinders, "Seidel"));
}

TEST_F(LensCli, CheckFailsWhereTheFileIsWrong) {
    json file = read_json(PETZVAL_ASSETS "/lenses/" + std::string(kLens) + ".json");
    file["focal_length"] = 103;
    text_file("wrong.json", file.dump());
    const Finished run = run_petzval({"lens", "check", path("wrong.json"), "--fail-above", "2"});
    EXPECT_EQ(run.exit_code, 1);
    EXPECT_TRUE(holds(run.out, "-2.909 %")) << run.out;
    EXPECT_TRUE(holds(run.err, "focal length (mm): 103 is stated and 100.004 comes out"))
        << run.err;
    (void)output_of({"check", path("wrong.json"), "--fail-above", "3"});
    // Its field is published for a smaller film than its circle is for: not a fault.
    (void)output_of({"check", "angenieux-50mm-f1.1", "--fail-above", "1"});
}

// Rays of line d through the oracle's own indices, so that no formula of a glass stands between.
class LensTrace : public LensCli, public ::testing::WithParamInterface<const char*> {};
INSTANTIATE_TEST_SUITE_P(Lenses, LensTrace, ::testing::ValuesIn(test::kOracleLenses));

TEST_P(LensTrace, RaysAreTheOracles) {
    const json oracle = read_oracle(GetParam());
    json file = read_json(PETZVAL_ASSETS "/lenses/" + std::string(GetParam()) + ".json");
    const json indices = oracle.at("refractive_indices").at("587.5618");
    for (size_t i = 0; i < file["surfaces"].size(); ++i)
        if (json& medium = file["surfaces"][i]["medium"]; !medium.is_null())
            medium = {{"n", indices[i + 1]}};
    text_file("lens.json", file.dump());
    for (const bool reverse : {false, true})
        for (const bool unclipped : {false, true}) {
            std::vector<json> rows;
            std::string table = "nm,x,y,z,dx,dy,dz\n";
            for (const json& row : oracle.at(reverse ? "reverse" : "forward")) {
                if (row[0] != 587.5618) continue;
                rows.push_back(row);
                table += "587.5618";
                for (const int k : {1, 2})
                    for (int j = 0; j < 3; ++j)
                        table.append(",").append(row[size_t(k)][size_t(j)].dump());
                table += '\n';
            }
            text_file("in.csv", table);
            Words words{"trace", path("lens.json"), "--rays", path("in.csv"),
                        "-o",    path("out.csv")};
            if (reverse) words.push_back("--reverse");
            if (unclipped) words.push_back("--unclipped");
            EXPECT_EQ(output_of(words), "");
            const io::CsvText out = io::read_csv_text(path("out.csv"));
            ASSERT_EQ(out.rows.size(), rows.size());
            int passed = 0;
            for (size_t i = 0; i < rows.size(); ++i) {
                const json& wanted = rows[i];
                const auto& cells = out.rows[i];
                std::string status = wanted[unclipped ? 6 : 3];
                if (status == "TIR") status = "tir";
                EXPECT_EQ(cells[9], status) << i;
                if (status != "ok") {
                    EXPECT_EQ(cells[10], wanted[unclipped ? 7 : 4].dump()) << i;
                    EXPECT_EQ(cells[0], "");
                    continue;
                }
                ++passed;
                EXPECT_EQ(cells[10], "");
                if (wanted.size() <= 8) continue;
                for (size_t k = 0; k < 3; ++k) {
                    EXPECT_NEAR(std::stod(cells[k]), double(wanted[8][k]), 1e-9) << i;
                    EXPECT_NEAR(std::stod(cells[3 + k]), double(wanted[9][k]), 1e-11) << i;
                }
                EXPECT_NEAR(std::stod(cells[8]), double(wanted[10]), 1e-9) << i;
                EXPECT_EQ(cells[6].empty(), !wanted[11].is_array()) << i;
                if (!wanted[11].is_array()) continue;
                for (size_t k = 0; k < 2; ++k)
                    EXPECT_NEAR(std::stod(cells[6 + k]), double(wanted[11][k]), 2e-7) << i;
            }
            EXPECT_GT(passed, 20);
        }
}

TEST_F(LensCli, RefusesRaysThatAreNone) {
    const auto refused = [&](const std::string& table, const std::string& part) {
        text_file("in.csv", table);
        expect_error({"trace", kLens, "--rays", path("in.csv"), "-o", path("out.csv")}, 1, part);
    };
    const std::string names = "x,y,z,dx,dy,dz,nm\n";
    refused("x,y,z,dx,dy,dz\n0,0,0,0,0,1\n", "must have the columns x,y,z,dx,dy,dz,nm");
    refused(names + "0,0,0,0,0,1,550\n0,0,0,0,0,0,550\n", "line 3: dx,dy,dz has no length");
    refused(names + "0,0,0,0,0,1,5500\n", "line 2: nm is 5500; it must be from 360 to 830");
    refused(names + "0,0,nan,0,0,1,550\n", "line 2: column 3 is not a finite number");
    refused(names + "0,0,1e300,0,0,1,550\n", "line 2: z is 1e+300");
    expect_error({"trace", kLens, "--rays", path("none.csv"), "-o", path("out.csv")}, 1,
                 "none.csv");
    expect_error({"trace", kLens, "-o", path("out.csv")}, 2, "--rays");
}

TEST_F(LensCli, DrawsEachFaceAndRay) {
    (void)output_of({"draw", kLens, "-o", path("a.svg"), "--rays", "3"});
    const std::string svg = file_bytes(path("a.svg"));
    EXPECT_EQ(count_of(svg, "class=\"glass\""), 6u);
    EXPECT_EQ(count_of(svg, "class=\"face\""), 10u);
    EXPECT_EQ(count_of(svg, "class=\"stop\""), 1u);
    EXPECT_EQ(count_of(svg, "class=\"ray\""), 2u * 3 * 3);
    for (const char* colour : {"#2060d0", "#d09000", "#c02020"})
        EXPECT_EQ(count_of(svg, std::string("stroke:") + colour), 6u);
    // From the edge of the first face, 56.20238 - sqrt(56.20238^2 - 29^2) behind its vertex.
    EXPECT_TRUE(holds(svg, "<path id=\"face0\" class=\"face\" d=\"M8.0598 29.0000L"));
    EXPECT_TRUE(holds(svg, "<path id=\"film\" class=\"film\" d=\"M139.4549 24.9500L"));
    EXPECT_TRUE(holds(svg, "fields 0°, 9.8°"));
    EXPECT_TRUE(svg.ends_with("</svg>\n"));

    (void)output_of({"draw", "minolta-fisheye-16mm-f2.8", "-o", path("b.svg"), "--field", "0,90"});
    expect_error({"draw", kLens, "-o", path("a.png")}, 2, "must end in .svg");
    expect_error({"draw", kLens, "-o", path("a.svg"), "--rays", "0"}, 2, "--rays");
    expect_error({"draw", "kodak-petzval-100mm-f2", "-o", path("c.svg"), "--field", "80"}, 2,
                 "no ray at 80°");
}

TEST_F(LensCli, PrintsSpots) {
    const std::string text =
        output_of({"spot", kLens, "-o", path("a.svg"), "--field", "0", "--csv", path("a.csv")});
    // The oracle's RMS radius at line d, 0.0747596 mm.
    const size_t d = text.find(" d ");
    ASSERT_NE(d, text.npos) << text;
    double x = 1, y = 1, rms = 0;
    ASSERT_EQ(std::sscanf(text.c_str() + d, " d %lf %lf %lf", &x, &y, &rms), 3);
    EXPECT_NEAR(rms, 74.7596, 0.2);
    EXPECT_NEAR(std::hypot(x, y), 0, 1e-6);
    const io::CsvTable table = io::read_csv(path("a.csv"));
    EXPECT_EQ(table.names, (Words{"field_deg", "nm", "x_mm", "y_mm"}));
    EXPECT_GT(table.rows.size(), 1000u);
    const std::string best =
        output_of({"spot", kLens, "-o", path("b.svg"), "--field", "0", "--film-shift", "best"});
    EXPECT_TRUE(best.starts_with("film at 139.0")) << best;
    const std::string near = output_of({"spot", kLens, "-o", path("b.svg"), "--focus", "2"});
    EXPECT_TRUE(near.starts_with("film at 144.")) << near;
}

TEST_F(LensCli, FocusesAsTheRendererDoes) {
    const auto spot = [&](const char* lens, const Words& more) {
        Words words{"spot", lens, "-o", path("a.svg"), "--field", "0"};
        words.insert(words.end(), more.begin(), more.end());
        const std::string text = output_of(words);
        double film_mm = 0, rms_um = 0;
        EXPECT_EQ(std::sscanf(text.c_str(), "film at %lf", &film_mm), 1) << text;
        const size_t all = text.find("F+d+C");
        EXPECT_EQ(std::sscanf(text.c_str() + all, "F+d+C %*f %*f %lf", &rms_um), 1) << text;
        return std::pair(film_mm, rms_um);
    };
    // Without a focus group the film moves: to where --film-shift best has it.
    const auto traced = spot(kLens, {"--focus-by", "traced"});
    EXPECT_NEAR(traced.first, spot(kLens, {"--film-shift", "best"}).first, 1e-6);
    EXPECT_NEAR(traced.first, spot(kLens, {}).first - 0.3834, 0.002);
    EXPECT_EQ(spot(kLens, {"--focus", "2m"}), spot(kLens, {"--focus", "2"}));
    // With one the film stays, and the group, which takes the entrance pupil along, focuses.
    constexpr const char* tele = "nikkor-400mm-f2.8-fl";
    const auto far = spot(tele, {}), near = spot(tele, {"--focus", "8m"}),
               better = spot(tele, {"--focus", "8m", "--focus-by", "traced"});
    EXPECT_NEAR(near.first, far.first, 1e-5);
    EXPECT_NEAR(better.first, far.first, 1e-5);
    EXPECT_LT(near.second, 7);
    EXPECT_LT(better.second, 0.95 * near.second);
    const std::string out = path("a.svg");
    expect_error({"spot", tele, "-o", out, "--focus", "0.5"}, 2, "too near for the group");
    expect_error({"spot", tele, "-o", out, "--focus-by", "eye"}, 2, "none of paraxial, traced");
}

TEST_F(LensCli, PlotsEachAnalysis) {
    const auto plotted = [&](const char* analysis, const Words& more) {
        Words words{analysis, kLens, "-o", path("a.svg"), "--csv", path("a.csv")};
        words.insert(words.end(), more.begin(), more.end());
        (void)output_of(words);
        EXPECT_TRUE(holds(file_bytes(path("a.svg")), "</svg>")) << analysis;
        return io::read_csv(path("a.csv"));
    };
    const io::CsvTable fan = plotted("fan", {"--field", "5"});
    EXPECT_EQ(fan.rows.front()[0], 5);
    EXPECT_GT(fan.rows.size(), 6u * 40);

    const io::CsvTable mtf = plotted("mtf", {"--field", "0,7", "--cycles", "40"});
    EXPECT_EQ(mtf.rows.size(), 2u * 51);
    EXPECT_EQ(mtf.rows.front()[2], 1);
    EXPECT_EQ(mtf.rows.back()[1], 40);
    EXPECT_LT(mtf.rows.back()[2], 0.7);
    EXPECT_TRUE(holds(file_bytes(path("a.svg")), "geometric MTF"));

    const io::CsvTable distortion = plotted("distortion", {});
    EXPECT_EQ(distortion.rows.size(), 40u);
    EXPECT_EQ(distortion.rows.back()[0], 14);
    EXPECT_NEAR(distortion.rows.back()[2], 100.00372 * std::tan(14 * std::numbers::pi / 180), 1e-4);

    // The oracle's irradiance at 17.465 mm.
    const io::CsvTable light = plotted("vignetting", {"--image-circle", "34.93"});
    EXPECT_EQ(light.rows.front()[2], 1);
    EXPECT_NEAR(light.rows.back()[1], 0.15314484, 0.0006);
}

TEST_F(LensCli, DistortionSaysWhatItLeavesOut) {
    const auto said = [&](const Words& more, const char* lens = "minolta-fisheye-16mm-f2.8") {
        Words words{"lens", "distortion", lens, "-o", path("a.svg"), "--csv", path("a.csv")};
        words.insert(words.end(), more.begin(), more.end());
        const Finished run = run_petzval(words);
        EXPECT_EQ(run.exit_code, 0) << run.err;
        return run.err;
    };
    const std::string err = said({"--field", "0,60,90,95"});
    EXPECT_TRUE(holds(err, "left out: 90°, 95°: f tan(field)")) << err;
    EXPECT_TRUE(holds(err, "left out: 0°: the ideal height is 0")) << err;
    EXPECT_EQ(io::read_csv(path("a.csv")).rows.size(), 1u);
    EXPECT_TRUE(
        holds(said({"--field", "10,60,85"}, "takumar-50mm-f1.2"), "left out: 60°, 85°: no ray"));
    EXPECT_EQ(said({"--field", "10,60"}), "");
    EXPECT_TRUE(holds(said({}), "left out: 90°: f tan(field)"));
}

// A lens whose asphere scatters all light: each analysis says which surface, and why.
TEST_F(LensCli, ALensThatPassesNoLightIsAnError) {
    const auto lens_with = [&](size_t surface, const char* power) {
        json lens = read_json(std::string(PETZVAL_ASSETS) + "/lenses/cooke-triplet-50mm-f5.json");
        lens["surfaces"][surface]["asphere"] = {{power, 1e30}};
        return text_file("nasty.json", lens.dump());
    };
    const std::string out = path("a.svg");
    for (const auto& [surface, power] :
         {std::pair<size_t, const char*>{5, "4"}, {6, "40"}, {0, "4"}, {2, "6"}}) {
        const std::string lens = lens_with(surface, power);
        const std::string why = fmt::format("end at surface {} (the first is 0)", surface);
        for (const char* analysis : {"spot", "fan", "mtf", "distortion", "vignetting"}) {
            const Finished run = run_petzval({"lens", analysis, lens, "-o", out});
            EXPECT_EQ(run.exit_code, 2) << analysis;
            EXPECT_TRUE(holds(run.err, why)) << analysis << surface << ": " << run.err;
            EXPECT_TRUE(holds(run.err, "asphere")) << run.err;
        }
        EXPECT_TRUE(holds(run_petzval({"lens", "check", lens}).err, why));
        const Finished render = run_petzval(
            render_words({"--lens", lens, "--focus", "1", "-o", path("a.exr")}, scene_));
        EXPECT_EQ(render.exit_code, 2);
        EXPECT_TRUE(holds(render.err, why)) << render.err;
    }
    // So short a focal length that only the ray on the axis passes.
    json lens = read_json(std::string(PETZVAL_ASSETS) + "/lenses/cooke-triplet-50mm-f5.json");
    lens["surfaces"].back()["asphere"] = {{"2", -1e30}};
    const Finished render = run_petzval(render_words(
        {"--lens", text_file("short.json", lens.dump()), "--focus", "2", "-o", path("a.exr")},
        scene_));
    EXPECT_EQ(render.exit_code, 2);
    EXPECT_TRUE(holds(render.err, "lets no light through")) << render.err;
}

// A lens of a focal length of about 1 mm before a film of 36 mm.
TEST_F(LensCli, ALensThatLightsHardlyAnyOfTheFilmIsAWarning) {
    const std::string lens = text_file("tiny.json",
                                       R"({"surfaces": [
        {"radius": null, "thickness": 1, "medium": null, "semi_diameter": 0.1, "stop": true},
        {"radius": 20, "thickness": 3, "medium": {"n": 1.5}, "semi_diameter": 6},
        {"radius": -20, "thickness": 20, "medium": null, "semi_diameter": 6,
         "asphere": {"2": -1}}]})");
    const auto said = [&](const Words& more) {
        Words words = {"--lens", lens, "--focus", "2", "-o", path("a.exr")};
        words.insert(words.end(), more.begin(), more.end());
        const Finished run = run_petzval(render_words(words, scene_));
        EXPECT_EQ(run.exit_code, 0) << run.err;
        return run.err;
    };
    const std::string part = "tiny lights hardly any of the film, which is 24 x 24 mm";
    EXPECT_TRUE(holds(said({}), part)) << said({});
    EXPECT_FALSE(holds(said({"--sensor", "0.36x0.24"}), " of the film"));
}

TEST_F(LensCli, SaysWhereTheLightGoes) {
    const std::string coat = text_file("coat.json", R"({"layers": [
        {"thickness_nm": 99.6377, "index": 1.38}]})");
    // A file of one quarter wave is mgf2.
    const auto transmittances = [&](const std::string& coating) {
        const std::string out = output_of({"transmittance", kLens, "--coating", coating});
        return out.substr(out.find('\n'));
    };
    EXPECT_EQ(transmittances(coat), transmittances("mgf2"));
    EXPECT_NE(transmittances("filed"), transmittances("mgf2"));
    EXPECT_TRUE(holds(transmittances("uncoated"), "     560   0.62"));
    const std::string csv = path("a.csv");
    const std::string budget = output_of({"budget", kLens, "--coating", "V-Coat", "--field", "0,10",
                                          "--csv", csv, "-o", path("a.svg")});
    EXPECT_EQ(count_of(budget, " 100.000\n"), 6u) << budget;
    const io::CsvTable table = io::read_csv(csv);
    ASSERT_EQ(table.rows.size(), 6u);
    for (const auto& row : table.rows) {
        double sum = 0;
        for (size_t i = 2; i < row.size(); ++i) sum += row[i];
        EXPECT_NEAR(sum, 1, 1e-3);
    }
    EXPECT_TRUE(holds(file_bytes(path("a.svg")), "share of the light"));
    const std::string ghosts = output_of({"ghosts", kLens, "-o", path("b.svg")});
    EXPECT_TRUE(holds(ghosts, "A better coating of surface 8 would help most")) << ghosts;
    EXPECT_TRUE(holds(ghosts, "veiling glare of a black hole in a white field: 3.9")) << ghosts;
    EXPECT_EQ(count_of(file_bytes(path("b.svg")), "class=\"ray\""), 9u);
    expect_error({"budget", kLens, "--coating", "brodband"}, 2, "did you mean broadband?");
    expect_error({"budget", kLens, "--coating", coat, "--csv", coat}, 2, "would overwrite");
    expect_error({"ghosts", kLens, "-o", path("b.png")}, 2, ".svg");
    expect_error({"ghosts", kLens, "--coating", "ideal", "-o", path("b.svg")}, 2, "no ghost");
    expect_error({"transmittance", kLens, "--field", "70"}, 2, "smaller --field");
}

TEST_F(LensCli, RefusesBadRequests) {
    const std::string out = path("a.svg");
    expect_error({"show", "no-such-lens"}, 2, "cooke-triplet-50mm-f5");
    expect_error({"check", scene_}, 2, "must be .json, .dat or .zmx");
    expect_error({"spot", kLens}, 2, "--output");
    expect_error({"spot", kLens, "-o", path("a.pdf")}, 2, ".svg or .png");
    expect_error({"spot", kLens, "-o", out, "--field", "0,x"}, 2, "\"x\" is not a number");
    expect_error({"spot", kLens, "-o", out, "--field", "-3"}, 2, "--field");
    expect_error({"spot", kLens, "-o", out, "--focus", "0.05"}, 2, "too near");
    expect_error({"spot", kLens, "-o", out, "--focus", "2", "--field", "88"}, 2, "88");
    expect_error({"spot", kLens, "-o", out, "--film-shift", "nearly"}, 2, "--film-shift");
    expect_error({"spot", kLens, "-o", out, "--section", "z"}, 2, "none of y, x");
    expect_error({"mtf", kLens, "-o", out, "--cycles", "0"}, 2, "--cycles");
    expect_error({"fan", kLens, "-o", out, "--glasses", path("none.agf")}, 1, "none.agf");

    text_file("bare.dat", "20 3 1.5 10\n-20 5 1 10\n0 20 1 4\n");
    for (const Words& words :
         {Words{"spot", "give --field"}, {"vignetting", "give --image-circle"}}) {
        const Finished run = run_petzval({"lens", words[0], path("bare.dat"), "-o", out});
        EXPECT_EQ(run.exit_code, 2);
        EXPECT_TRUE(holds(run.err, words[1])) << run.err;
        EXPECT_TRUE(holds(run.err, "petzval: ")) << run.err;
    }
}

}  // namespace
}  // namespace petzval::apps
