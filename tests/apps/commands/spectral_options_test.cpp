// SPDX-License-Identifier: Apache-2.0
// petzval render with wavelengths: what it decides, what light reads as, and what a spectral file
// holds.
#include <deque>
#include <functional>
#include <sstream>

#include "core/spectrum/colorimetry.h"
#include "core/spectrum/colour.h"
#include "io/image/picture_files.h"
#include "io/image/spectral_layout.h"
#include "io/spectra/spectra.h"
#include "tests/support/cli_spectral.h"
#include "tests/support/statistics.h"

namespace petzval::apps {
namespace {

/// What a plain run says where there is nothing but the decision.
struct Decision {
    json material;
    Words words;
    std::string expected;
};

TEST_F(CliSpectral, SaysWhatItDecidesAndWhy) {
    json dispersive = glass();
    dispersive["name"] = "prism";
    dispersive["emissiveFactor"] = {1, 1, 1};
    json named = dispersive;
    dispersive["extensions"]["KHR_materials_dispersion"] = {{"dispersion", 0.3}};
    named.update(extras("glass", "schott:N-BK7"));
    json bulb = extras("illuminant", "f11"), gold = metal("au");
    for (json* m : {&bulb, &gold}) (*m)["emissiveFactor"] = {1, 1, 1};
    const json plain = {{"emissiveFactor", {1, 1, 1}}};
    const std::string rgb = "spectral: rgb, as ", wavelengths = "spectral: wavelengths, as ",
                      glass_range = "warning: glass schott:N-BK7 is known from 300 to 2500 nm: ";
    const std::vector<Decision> cases = {
        {plain, {}, rgb + "nothing here depends on wavelength\n"},
        {plain, {"--illuminant", "D65", "--response", "cie1931"}, rgb + "nothing here depends"},
        {dispersive, {}, wavelengths + "material \"prism\" disperses (KHR_materials_dispersion)\n"},
        {named, {}, wavelengths + "material \"prism\" disperses (schott:N-BK7)\n"},
        {gold, {}, wavelengths + "a material without a name is a measured metal (au)\n"},
        {bulb, {}, wavelengths + "a material without a name shines as illuminant f11\n"},
        {plain, {"--bins", "380:730:10", "--spp", "8"}, wavelengths + "--bins asks for spectra\n"},
        {plain, {"--illuminant", "a"}, wavelengths + "--illuminant is a\n"},
        {plain, {"--spectral", "wavelengths"}, wavelengths + "--spectral says\n"},
        {plain, {"--spectral", "rgb"}, rgb + "--spectral says\n"},
        {gold,
         {"--spectral", "rgb", "--illuminant", "a"},
         rgb + "--spectral says\npetzval: warning: --spectral rgb cannot show that --illuminant "
               "is a; a material without a name is a measured metal (au)\n"}};
    std::deque<Process> runs;
    for (size_t i = 0; i < cases.size(); ++i) {
        const std::string n = std::to_string(i);
        const TinyGltf file = big_wall(cases[i].material);
        Words words = {"-o", path(n + ".exr"), "--progress", "none"};
        words.insert(words.end(), cases[i].words.begin(), cases[i].words.end());
        runs.emplace_back(render_words(words, file.save_glb(folder_.path / (n + ".glb")).string()));
    }
    for (size_t i = 0; i < cases.size(); ++i) {
        const Finished run = runs[i].wait();
        EXPECT_EQ(run.exit_code, 0);
        EXPECT_NE(run.err.find("petzval: " + cases[i].expected), std::string::npos) << run.err;
        const io::Picture p = io::read_picture(path(std::to_string(i) + ".exr"));
        const bool spectral = cases[i].expected.starts_with(wavelengths);
        EXPECT_EQ(metadata_of(p, "petzval:spectral"), spectral ? "wavelengths" : "rgb") << i;
    }
}

TEST_F(CliSpectral, LightsAndResponsesAreReasonsToo) {
    TinyGltf file = lamp();
    file.json["extensions"]["KHR_lights_punctual"]["lights"] = {
        {{"type", "point"}, {"extras", {{"petzval", {{"illuminant", "a"}}}}}}};
    file.add_root({{"extensions", {{"KHR_lights_punctual", {{"light", 0}}}}}});
    use(file);
    EXPECT_EQ(said({}), "petzval: spectral: wavelengths, as a light shines as illuminant a\n");
    use(lamp());
    const std::string eye = mixed_eye();
    EXPECT_EQ(said({"--response", eye}),
              "petzval: response " + eye +
                  ": matrix fitted to 24 reflectances, residual CIEDE2000 0.00 mean, 0.00 "
                  "worst\npetzval: spectral: wavelengths, as --response is " +
                  eye + "\n");
}

TEST_F(CliSpectral, AnEmitterOfOneReadsBackOne) {
    use(lamp());
    const io::Picture rgb = render({"--spectral", "rgb"});
    for (const char* c : {"R", "G", "B"}) EXPECT_NEAR(mean_of(rgb, c), 1, 1e-6) << c;
    const std::string eye = mixed_eye();
    const std::string uneven =
        csv("uneven.csv", [](int nm) -> std::vector<double> { return {nm % 100 < 50 ? 1. : 0.}; });
    const Words balanced = {"--method", "white-balance=illuminant", "--illuminant"};
    const auto with = [](Words words, const Words& more) {
        words.insert(words.end(), more.begin(), more.end());
        return words;
    };
    for (const Words& words : std::vector<Words>{{"--spectral", "wavelengths"},
                                                 with(balanced, {"a"}),
                                                 with(balanced, {uneven}),
                                                 {"--response", eye},
                                                 with(balanced, {"a", "--response", eye}),
                                                 {"--bins", "400:700:20"}}) {
        const io::Picture p = render(with(words, {"--spp", "256"}));
        for (const char* c : {"R", "G", "B"})
            EXPECT_NEAR(mean_of(p, c), 1, 0.005) << c << " with " << words.back();
    }
    // Without white balance it is warm, and still of 1 nit.
    const io::Picture warm = render({"--illuminant", "a", "--spp", "256"});
    const Rgb mean(float(mean_of(warm, "R")), float(mean_of(warm, "G")), float(mean_of(warm, "B")));
    EXPECT_GT(mean[0], 1.5f);
    EXPECT_LT(mean[2], 0.5f);
    EXPECT_NEAR(luminance(mean), 1, 0.005);
}

/// Mean of a table over a band, as straight lines between its nanometres; whole edges.
double band_mean(const SpectrumTable& table, int first_nm, int last_nm) {
    double sum = (table.at_nm(first_nm) + double(table.at_nm(last_nm))) / 2;
    for (int nm = first_nm + 1; nm < last_nm; ++nm) sum += table.at_nm(nm);
    return sum / (last_nm - first_nm);
}

/// Mean of a channel with its error: pixels are independent.
test::Moments moments_of(const io::Picture& p, const std::string& channel) {
    test::Moments moments;
    for (int y = 0; y < p.height; ++y)
        for (int x = 0; x < p.width; ++x) moments.add(value_at(p, x, y, channel));
    return moments;
}

TEST_F(CliSpectral, BinsAreBandAveragesOfTheLight) {
    use(lamp());
    // Far from 1, as units do not matter.
    const std::string flat = csv("flat.csv", [](int) -> std::vector<double> { return {1e308}; });
    SpectrumTable even;
    even.value.fill(static_cast<float>(
        1 / (kLuminousEfficacy_lm_per_w * integral(io::standard_observer()[1]))));
    const std::pair<std::string, SpectrumTable> lights[] = {
        {"d65", io::find_light_spectrum("d65")->per_nit},
        {"f11", io::find_light_spectrum("f11")->per_nit},
        {flat, even}};
    for (const auto& [name, per_nit] : lights) {
        const io::Picture p = render({"--illuminant", name, "--bins", "380:730:10", "--spp", "256",
                                      "--method", "filter=box"});
        EXPECT_EQ(io::spectral_channels(p).size(), 35u);
        double sum = 0, expected_sum = 0;
        for (int nm = 380; nm < 730; nm += 10) {
            const test::Moments bin = moments_of(p, io::spectral_channel(nm + 5));
            const double expected = band_mean(per_nit, nm, nm + 10);
            EXPECT_TRUE(test::agrees(bin, expected))
                << name << " " << nm << ": " << bin.mean() / expected << " +- "
                << bin.standard_error() / expected;
            EXPECT_LT(bin.standard_error(), 0.02 * expected);
            sum += 10 * bin.mean();
            expected_sum += 10 * expected;
        }
        EXPECT_NEAR(sum, expected_sum, 0.002 * expected_sum) << name;
    }
}

// In bins of w nm, light L and curve c are their averages: what the sum over bins misses of the
// integral is their covariance within each bin, about w^3 / 12 times the slopes of both.
TEST_F(CliSpectral, TheBinsIntegralIsXyzAndXyzIsRgb) {
    use(lamp());
    const auto eye = io::standard_observer();
    const SpectrumTable d65 = io::find_illuminant("d65");
    const V3d white = respond(eye, d65);
    const Matrix3 to_rgb = srgb_to_xyz(white / white.y).inverse();
    constexpr int width_nm = 10;
    const char* xyz[] = {"XYZ.X", "XYZ.Y", "XYZ.Z"};
    const char* rgb[] = {"R", "G", "B"};
    for (const std::string name : {"d65", "a"}) {
        const SpectrumTable light = io::find_light_spectrum(name)->per_nit;
        const io::Picture p =
            render({"--illuminant", name, "--bins", "360:830:10", "--spp", "256"});
        for (size_t c = 0; c < 3; ++c) {
            double bound = 0;
            for (int nm = kFirst_nm; nm < kLast_nm; ++nm)
                bound += width_nm * width_nm / 12. * kLuminousEfficacy_lm_per_w *
                         std::fabs((eye[c].at_nm(nm + 1) - eye[c].at_nm(nm)) *
                                   (light.at_nm(nm + 1) - light.at_nm(nm)));
            EXPECT_LT(bound, 0.01);  // of 1 nit
            std::vector<double> weight;
            for (int nm = kFirst_nm; nm < kLast_nm; nm += width_nm)
                weight.push_back(kLuminousEfficacy_lm_per_w * width_nm *
                                 band_mean(eye[c], nm, nm + width_nm));
            test::Moments off;
            for (int y = 0; y < p.height; ++y)
                for (int x = 0; x < p.width; ++x) {
                    double sum = 0;
                    for (size_t i = 0; i < weight.size(); ++i)
                        sum += weight[i] *
                               value_at(p, x, y, io::spectral_channel(365. + 10. * double(i)));
                    off.add(sum - value_at(p, x, y, xyz[c]));
                }
            EXPECT_TRUE(test::agrees(off, 0, bound)) << name << " " << xyz[c];
            EXPECT_LT(off.standard_error(), 1e-3);
        }
        for (int i = 0; i < p.width * p.height; ++i) {
            const int x = i % p.width, y = i / p.width;
            const V3d seen = to_rgb * V3d(value_at(p, x, y, xyz[0]), value_at(p, x, y, xyz[1]),
                                          value_at(p, x, y, xyz[2]));
            for (int c = 0; c < 3; ++c)
                ASSERT_NEAR(value_at(p, x, y, rgb[c]), seen[c], 2e-5) << name << rgb[c];
        }
    }
}

TEST_F(CliSpectral, EqualRendersAreEqualFiles) {
    use(mixed());
    // Six tiles.
    const Words words = {"--size", "40x24", "--bins", "400:700:50",
                         "--spp",  "11",    "--aov",  "normal,depth"};
    const auto with = [&](const Words& more) {
        Words all = words;
        all.insert(all.end(), more.begin(), more.end());
        return all;
    };
    const io::Picture whole = render(words, "two.exr");
    const std::string two = file_bytes(path("two.exr"));
    EXPECT_TRUE(two == render_bytes(with({"--threads", "1"})));
    EXPECT_TRUE(two == render_bytes(with({"--threads", "4"})));
    EXPECT_FALSE(two == render_bytes(with({"--seed", "1"})));

    const io::Picture part = render(with({"--crop", "13,5,20,12"}));
    ASSERT_EQ(part.channels, whole.channels);
    for (int y = 0; y < 12; ++y)
        for (int x = 0; x < 20; ++x)
            for (const std::string& c : part.channels)
                ASSERT_EQ(value_at(part, x, y, c), value_at(whole, x + 13, y + 5, c)) << c;
}

TEST_F(CliSpectral, AFileIsNamedWithoutItsFolder) {
    std::filesystem::create_directory(path("folder"));
    const auto flat = [](int) -> std::vector<double> { return {1}; };
    const std::string here = csv("flat.csv", flat), there = csv("folder/flat.csv", flat);
    const std::string a = render_bytes({"--illuminant", here});
    EXPECT_TRUE(a == render_bytes({"--illuminant", there}));
    EXPECT_EQ(metadata_of(io::read_picture(path("out.exr")), "petzval:illuminant").substr(0, 10),
              "flat.csv (");
}

// The difference of two seeds against what each says of its own error.
TEST_F(CliSpectral, StandardErrorsAreHonest) {
    use(lamp());  // no rare bright paths, whose errors are not normal
    const auto of_seed = [&](const char* seed) {
        return render({"--bins", "400:700:100", "--spp", "36", "--size", "40x40", "--seed", seed},
                      std::string(seed) + ".exr");
    };
    const io::Picture a = of_seed("1"), b = of_seed("2");
    for (const std::string c : {"R", "G", "B"}) {
        test::Moments excess;
        int near = 0, far = 0;
        for (int i = 0; i < 1600; ++i) {
            const int x = i % 40, y = i / 40;
            const double d = value_at(a, x, y, c) - double(value_at(b, x, y, c)),
                         e = std::hypot(value_at(a, x, y, "stderr." + c),
                                        value_at(b, x, y, "stderr." + c));
            // In units of the pixel's light, so that bright pixels do not speak for all.
            const double light = value_at(a, x, y, c) + double(value_at(b, x, y, c)) + 1e-3;
            excess.add((d * d - e * e) / (light * light));
            near += std::fabs(d) <= e;
            far += std::fabs(d) > 3 * e;
        }
        EXPECT_TRUE(test::agrees(excess, 0)) << c;
        // Two errors from 8 replicates each: Student's t with 14 degrees of freedom, which is
        // within 1 for 0.666 and beyond 3 for 0.0096 of the pixels, if they are near to normal.
        EXPECT_NEAR(near / 1600., 0.666, 0.06) << c;
        EXPECT_LT(far, 1600 * 3 / 100) << c;
    }
}

TEST_F(CliSpectral, TheFileSaysHowItWasMade) {
    use(lamp());
    const io::Picture p = render({"--bins", "380:730:10", "--spp", "64", "--method",
                                  "white-balance=illuminant", "--illuminant", "f11"});
    const std::pair<const char*, const char*> expected[] = {{"petzval:bins", "380:730:10"},
                                                            {"petzval:spectral", "wavelengths"},
                                                            {"petzval:illuminant", "f11"},
                                                            {"petzval:response", "cie1931"},
                                                            {"petzval:whiteBalance", "illuminant"},
                                                            {"petzval:replicates", "8"},
                                                            {"petzval:samples", "0:64"},
                                                            {"spectralLayoutVersion", "1.0"},
                                                            {"emissiveUnits", "W.m^-2.sr^-1"}};
    for (const auto& [key, value] : expected) EXPECT_EQ(metadata_of(p, key), value) << key;
    // The mean of the luminance's errors is between those of the channels.
    const double error = std::stod(metadata_of(p, "petzval:meanRelativeError"));
    EXPECT_GT(error, 1e-4);
    EXPECT_LT(error,
              std::max({mean_of(p, "stderr.R"), mean_of(p, "stderr.G"), mean_of(p, "stderr.B")}));
    EXPECT_EQ(p.channels.size(), 4u + 35 + 3 + 3);

    const Words layers{"--bins", "380:730:10", "--aov", "depth", "--transparent"};
    const auto layers_with = [&](const std::string& option, const std::string& value) {
        Words words = layers;
        words.insert(words.end(), {option, value});
        return render(words);
    };
    const io::Picture timed = layers_with("--time-limit", "0.01s");
    EXPECT_GE(std::stoi(metadata_of(timed, "petzval:samples").substr(2)), 8);
    EXPECT_EQ(timed.channels.size(), 4u + 35 + 3 + 3 + 1);
    EXPECT_LT(mean_of(layers_with("--spp", "8"), "stderr.G"), 1);

    const io::Picture plain = render({});
    EXPECT_EQ(metadata_of(plain, "petzval:spectral"), "rgb");
    EXPECT_EQ(metadata_of(plain, "petzval:bins"), "(none)");
}

TEST_F(CliSpectral, AStoppedRenderKeepsItsSpectra) {
    use(mixed());
    Process render(render_words(
        {"-o", path("out.exr"), "--spp", "100000000", "--bins", "400:700:50", "--progress", "json"},
        scene_));
    // The first pass is over: 8 samples of 16 x 16 pixels, one by each replicate.
    ASSERT_TRUE(wait_for_samples(render, 8 * 16 * 16));
    render.signal(SIGINT);
    EXPECT_EQ(render.wait().exit_code, 130);
    const io::Picture partial = io::read_picture(path("out.partial.exr"));
    EXPECT_EQ(io::spectral_channels(partial).size(), 6u);
    EXPECT_GT(mean_of(partial, io::spectral_channel(525)), 0);
    EXPECT_FALSE(std::filesystem::exists(path("out.exr")));
}

}  // namespace
}  // namespace petzval::apps
