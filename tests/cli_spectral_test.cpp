// SPDX-License-Identifier: Apache-2.0
// petzval render with wavelengths: what it decides, what light reads as, what a spectral file holds
// and what is refused.
#include <deque>
#include <functional>
#include <sstream>

#include "core/colorimetry.h"
#include "core/colour.h"
#include "io/spectra.h"
#include "io/spectral_layout.h"
#include "tests/support/cli.h"
#include "tests/support/statistics.h"

namespace petzval {
namespace {

using nlohmann::json;

/// A wall of its own colour fills the frame of "wide"; more: what its material has beside.
TinyGltf big_wall(const json& more) {
    TinyGltf file;
    add_wall(file, -9, -9, 9, 9, -2, {0, 0, 0});
    file.json["materials"][0].update(more);
    for (const char* extension : {"KHR_materials_transmission", "KHR_materials_volume",
                                  "KHR_materials_dispersion", "KHR_lights_punctual"})
        file.json["extensionsUsed"].push_back(extension);
    add_perspective(file, "wide", 1.2f);
    return file;
}

json extras(const char* key, const char* value) {
    return {{"extras", {{"petzval", {{key, value}}}}}};
}

/// A lamp of 1 nit.
TinyGltf lamp(json more = json::object()) {
    more["emissiveFactor"] = {1, 1, 1};
    return big_wall(more);
}

json glass(json more = json::object()) {
    more["pbrMetallicRoughness"] = {{"metallicFactor", 0}, {"roughnessFactor", 0}};
    more["extensions"]["KHR_materials_transmission"] = {{"transmissionFactor", 1}};
    more["extensions"]["KHR_materials_volume"] = {{"thicknessFactor", 1}};
    return more;
}

json metal(const char* name) {
    json more = extras("metal", name);
    more["pbrMetallicRoughness"] = {{"roughnessFactor", 0.3}};
    return more;
}

/// The studio with a pane of glass, gold and a lamp of illuminant A: all that needs wavelengths.
TinyGltf mixed() {
    TinyGltf file = studio();
    const auto add = [&](float x, float y, const json& more) {
        add_wall(file, x, y, x + 0.4f, y + 0.4f, -0.9f, {0.5f, 0.5f, 0.5f});
        file.json["materials"].back().update(more);
    };
    add(0, 0, glass(extras("glass", "schott:N-SF11")));
    add(-0.5f, -0.5f, metal("au"));
    json bulb = extras("illuminant", "a");
    bulb["emissiveFactor"] = {1, 1, 1};
    add(0, -0.5f, bulb);
    for (const char* extension : {"KHR_materials_transmission", "KHR_materials_volume"})
        file.json["extensionsUsed"].push_back(extension);
    return file;
}

/// What a plain run says where there is nothing but the decision.
struct Decision {
    json material;
    Words words;
    std::string expected;
};

class CliSpectral : public CliTest {
  protected:
    /// A CSV file of a column for each number that `row` gives, at every nanometre.
    std::string csv(const std::string& name, const std::function<std::vector<double>(int)>& row) {
        std::ofstream file(path(name));
        file << "nm";
        for (size_t i = 0; i < row(kFirst_nm).size(); ++i) file << ",curve" << i;
        file.precision(9);
        for (int nm = kFirst_nm; nm <= kLast_nm; ++nm) {
            file << '\n' << nm;
            for (const double value : row(nm)) file << ',' << value;
        }
        return path(name);
    }
    std::string text_file(const std::string& name, const std::string& text) {
        std::ofstream(path(name)) << text;
        return path(name);
    }
    /// A sensor whose curves are mixtures of the eye's, so that a matrix undoes them.
    std::string mixed_eye() {
        const auto eye = standard_observer();
        return csv("eye.csv", [&](int nm) -> std::vector<double> {
            const double x = eye[0].at_nm(nm), y = eye[1].at_nm(nm), z = eye[2].at_nm(nm);
            return {0.9 * x + 0.2 * y, 0.1 * x + 0.8 * y + 0.1 * z, 0.1 * y + 0.9 * z};
        });
    }
    void use(const TinyGltf& scene) {
        scene_ = scene.save_glb(folder_.path / "scene.glb").string();
    }
    /// stderr of a render that must succeed.
    std::string said(const Words& words, const std::string& name = "out.exr") {
        Words all = {"-o", path(name), "--progress", "none"};
        all.insert(all.end(), words.begin(), words.end());
        const Finished run = run_petzval(render_words(all, scene_));
        EXPECT_EQ(run.exit_code, 0) << run.err;
        return run.err;
    }
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
    const std::string rgb = "spectral: rgb, as ", hero = "spectral: hero wavelengths, as ",
                      glass_range = "warning: glass schott:N-BK7 is known from 300 to 2500 nm: ";
    const std::vector<Decision> cases = {
        {plain, {}, rgb + "nothing here depends on wavelength\n"},
        {plain, {"--illuminant", "D65", "--response", "cie1931"}, rgb + "nothing here depends"},
        {dispersive, {}, hero + "material \"prism\" disperses (KHR_materials_dispersion)\n"},
        {named, {}, hero + "material \"prism\" disperses (schott:N-BK7)\n"},
        {gold, {}, hero + "a material without a name is a measured metal (au)\n"},
        {bulb, {}, hero + "a material without a name shines as illuminant f11\n"},
        {plain, {"--bins", "380:730:10", "--spp", "8"}, hero + "--bins asks for spectra\n"},
        {plain, {"--illuminant", "a"}, hero + "--illuminant is a\n"},
        {plain, {"--spectral", "hero"}, hero + "--spectral says\n"},
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
        EXPECT_TRUE(run.err.starts_with("petzval: " + cases[i].expected)) << run.err;
        const Picture p = read_picture(path(std::to_string(i) + ".exr"));
        const bool is_hero = cases[i].expected.starts_with(hero);
        EXPECT_EQ(metadata_of(p, "petzval:spectral"), is_hero ? "hero" : "rgb") << i;
    }
}

TEST_F(CliSpectral, LightsAndResponsesAreReasonsToo) {
    TinyGltf file = lamp();
    file.json["extensions"]["KHR_lights_punctual"]["lights"] = {
        {{"type", "point"}, {"extras", {{"petzval", {{"illuminant", "a"}}}}}}};
    file.add_root({{"extensions", {{"KHR_lights_punctual", {{"light", 0}}}}}});
    use(file);
    EXPECT_EQ(said({}), "petzval: spectral: hero wavelengths, as a light shines as illuminant a\n");
    use(lamp());
    const std::string eye = mixed_eye();
    EXPECT_EQ(said({"--response", eye}),
              "petzval: spectral: hero wavelengths, as --response is " + eye +
                  "\npetzval: response " + eye +
                  ": matrix fitted to 24 reflectances, residual CIEDE2000 0.00 mean, 0.00 "
                  "worst\n");
}

TEST_F(CliSpectral, AnEmitterOfOneReadsBackOne) {
    use(lamp());
    const Picture rgb = render({"--spectral", "rgb"});
    for (const char* c : {"R", "G", "B"}) EXPECT_NEAR(mean_of(rgb, c), 1, 1e-6) << c;
    const std::string eye = mixed_eye();
    const std::string uneven =
        csv("uneven.csv", [](int nm) -> std::vector<double> { return {nm % 100 < 50 ? 1. : 0.}; });
    const Words balanced = {"--white-balance", "illuminant", "--illuminant"};
    const auto with = [](Words words, const Words& more) {
        words.insert(words.end(), more.begin(), more.end());
        return words;
    };
    for (const Words& words : std::vector<Words>{{"--spectral", "hero"},
                                                 with(balanced, {"a"}),
                                                 with(balanced, {uneven}),
                                                 {"--response", eye},
                                                 with(balanced, {"a", "--response", eye}),
                                                 {"--bins", "400:700:20"}}) {
        const Picture p = render(with(words, {"--spp", "256"}));
        for (const char* c : {"R", "G", "B"})
            EXPECT_NEAR(mean_of(p, c), 1, 0.005) << c << " with " << words.back();
    }
    // Without white balance it is warm, and still of 1 nit.
    const Picture warm = render({"--illuminant", "a", "--spp", "256"});
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
test::Moments moments_of(const Picture& p, const std::string& channel) {
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
    even.value.fill(
        static_cast<float>(1 / (kLuminousEfficacy_lm_per_w * integral(standard_observer()[1]))));
    const std::pair<std::string, SpectrumTable> lights[] = {
        {"d65", find_light_spectrum("d65")->per_nit},
        {"f11", find_light_spectrum("f11")->per_nit},
        {flat, even}};
    for (const auto& [name, per_nit] : lights) {
        const Picture p = render(
            {"--illuminant", name, "--bins", "380:730:10", "--spp", "256", "--filter", "box"});
        EXPECT_EQ(spectral_channels(p).size(), 35u);
        double sum = 0, expected_sum = 0;
        for (int nm = 380; nm < 730; nm += 10) {
            const test::Moments bin = moments_of(p, spectral_channel(nm + 5));
            const double expected = band_mean(per_nit, nm, nm + 10);
            EXPECT_TRUE(test::z_test(bin.mean(), bin.standard_error(), expected))
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
    const auto eye = standard_observer();
    const SpectrumTable d65 = find_illuminant("d65");
    const V3d white = respond(eye, d65);
    const Matrix3 to_rgb = srgb_to_xyz(white / white.y).inverse();
    constexpr int width_nm = 10;
    const char* xyz[] = {"XYZ.X", "XYZ.Y", "XYZ.Z"};
    const char* rgb[] = {"R", "G", "B"};
    for (const std::string name : {"d65", "a"}) {
        const SpectrumTable light = find_light_spectrum(name)->per_nit;
        const Picture p = render({"--illuminant", name, "--bins", "360:830:10", "--spp", "256"});
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
                        sum +=
                            weight[i] * value_at(p, x, y, spectral_channel(365. + 10. * double(i)));
                    off.add(sum - value_at(p, x, y, xyz[c]));
                }
            EXPECT_LT(std::fabs(off.mean()), bound + 4.5 * off.standard_error())
                << name << " " << xyz[c];
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
    const Picture whole = render(words, "two.exr");
    const std::string two = file_bytes(path("two.exr"));
    EXPECT_TRUE(two == render_bytes(with({"--threads", "1"})));
    EXPECT_TRUE(two == render_bytes(with({"--threads", "4"})));
    EXPECT_FALSE(two == render_bytes(with({"--seed", "1"})));

    const Picture part = render(with({"--crop", "13,5,20,12"}));
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
    EXPECT_EQ(metadata_of(read_picture(path("out.exr")), "petzval:illuminant").substr(0, 10),
              "flat.csv (");
}

// The difference of two seeds against what each says of its own error.
TEST_F(CliSpectral, StandardErrorsAreHonest) {
    use(lamp());  // no rare bright paths, whose errors are not normal
    const auto of_seed = [&](const char* seed) {
        return render({"--bins", "400:700:100", "--spp", "36", "--size", "40x40", "--seed", seed},
                      std::string(seed) + ".exr");
    };
    const Picture a = of_seed("1"), b = of_seed("2");
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
        EXPECT_TRUE(test::z_test(excess.mean(), excess.standard_error(), 0)) << c;
        // Two errors from 8 scrambles each: Student's t with 14 degrees of freedom, which is within
        // 1 for 0.666 and beyond 3 for 0.0096 of the pixels, if they are near to normal.
        EXPECT_NEAR(near / 1600., 0.666, 0.06) << c;
        EXPECT_LT(far, 1600 * 3 / 100) << c;
    }
}

TEST_F(CliSpectral, TheFileSaysHowItWasMade) {
    use(lamp());
    const Picture p = render({"--bins", "380:730:10", "--spp", "64", "--white-balance",
                              "illuminant", "--illuminant", "f11"});
    const std::pair<const char*, const char*> expected[] = {{"petzval:bins", "380:730:10"},
                                                            {"petzval:spectral", "hero"},
                                                            {"petzval:illuminant", "f11"},
                                                            {"petzval:response", "cie1931"},
                                                            {"petzval:whiteBalance", "illuminant"},
                                                            {"petzval:scrambles", "8"},
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

    const Picture timed =
        render({"--bins", "380:730:10", "--time", "0.01s", "--aov", "depth", "--transparent"});
    EXPECT_GE(std::stoi(metadata_of(timed, "petzval:samples").substr(2)), 8);
    EXPECT_EQ(timed.channels.size(), 4u + 35 + 3 + 3 + 1);
    EXPECT_LT(mean_of(timed, "stderr.G"), 1);

    const Picture plain = render({});
    EXPECT_EQ(metadata_of(plain, "petzval:spectral"), "rgb");
    EXPECT_EQ(metadata_of(plain, "petzval:bins"), "(none)");
}

TEST_F(CliSpectral, AStoppedRenderKeepsItsSpectra) {
    use(mixed());
    Process render(render_words(
        {"-o", path("out.exr"), "--spp", "100000000", "--bins", "400:700:50", "--progress", "bar"},
        scene_));
    ASSERT_TRUE(render.wait_for_stderr("] "));
    render.signal(SIGINT);
    EXPECT_EQ(render.wait().exit_code, 130);
    const Picture partial = read_picture(path("out.partial.exr"));
    EXPECT_EQ(spectral_channels(partial).size(), 6u);
    EXPECT_GT(mean_of(partial, spectral_channel(525)), 0);
    EXPECT_FALSE(std::filesystem::exists(path("out.exr")));
}

class CliSpectralErrors : public CliSpectral {
  protected:
    struct Case {
        Words words;
        std::string part;  ///< of the error
    };
    /// All at once; the last line of each is the error.
    void expect_refused(int exit_code, const std::vector<Case>& cases) {
        const auto before = listing();
        std::deque<Process> runs;
        for (const Case& c : cases) {
            Words words = c.words;
            words.emplace_back("--quiet");
            if (std::find(words.begin(), words.end(), "-o") == words.end())
                words.insert(words.end(), {"-o", path("out.exr")});
            if (words.front() != "render") words = render_words(words, scene_);
            runs.emplace_back(words);
        }
        for (size_t i = 0; i < cases.size(); ++i) {
            const Finished run = runs[i].wait();
            EXPECT_EQ(run.exit_code, exit_code) << run.err;
            EXPECT_TRUE(run.err.starts_with("petzval: error: ")) << run.err;
            EXPECT_EQ(run.err.find('\n'), run.err.size() - 1) << run.err;
            EXPECT_NE(run.err.find(cases[i].part), std::string::npos)
                << run.err << "without: " << cases[i].part;
        }
        EXPECT_EQ(listing(), before);
    }
};

TEST_F(CliSpectralErrors, BinsThatAreNone) {
    use(lamp());
    const std::string inside = "inside 360 to 830 nm", whole = "a whole number of bins",
                      rising = "FIRST must be below LAST", form = "FIRST:LAST:WIDTH in nm",
                      wide = "1 to 1024 bins of at least 0.1 nm";
    std::vector<Case> cases;
    for (const auto& [bins, part] :
         std::vector<std::pair<std::string, std::string>>{{"350:730:10", inside},
                                                          {"730:380:10", rising},
                                                          {"380:730:11", whole},
                                                          {"500:501:0.01", wide},
                                                          {"380:730:nan", form},
                                                          {"", "--bins: is empty"}})
        cases.push_back({{"--bins", bins, "--spp", "8"}, part});
    expect_refused(2, cases);
}

TEST_F(CliSpectralErrors, OptionsThatDoNotGoTogether) {
    use(mixed());
    const Words bins = {"--bins", "380:730:10"};
    const auto with = [&](const Words& more) {
        Words words = bins;
        words.insert(words.end(), more.begin(), more.end());
        return words;
    };
    expect_refused(
        2, {{with({"--spp", "7"}), "--spp: the standard errors of --bins need at least 8"},
            {with({"--spectral", "rgb", "--spp", "8"}), "--bins: needs wavelengths"},
            {with({"--spp", "8", "-o", path("out.png")}), "--bins: needs an output"},
            {{"--bins", "360:830:10", "--spp", "8"}, "glass schott:N-SF11 is known from 370 to"},
            {{"--spectral", "full"}, "auto, rgb, hero"},
            {{"--white-balance", "a"}, "none, illuminant"},
            {{"--illuminant", path("none.csv")}, "none.csv: is neither a file nor a name; the"},
            {{"--illuminant", "d50"}, "the names are d65, a, f11"},
            {{"--illuminant", ""}, "--illuminant: is empty"},
            {{"--response", "canon"}, "the names are cie1931"},
            {{"--response", ""}, "--response: is empty"}});
}

TEST_F(CliSpectralErrors, FilesThatAreNotAsTheyShouldBe) {
    use(lamp());
    const auto gauss = [](int nm, double centre) {
        return std::exp(-std::pow((nm - centre) / 30, 2));
    };
    const std::string equal = csv("equal.csv", [&](int nm) -> std::vector<double> {
        return {gauss(nm, 600), gauss(nm, 450), gauss(nm, 450)};
    });
    const std::string blank = csv("blank.csv", [&](int nm) -> std::vector<double> {
        return {gauss(nm, 600), 0, gauss(nm, 450)};
    });
    const auto light = [&](const std::string& name, const std::string& text,
                           const std::string& part) {
        return Case{{"--illuminant", text_file(name, text)}, name + ": " + part};
    };
    expect_refused(
        1, {light("empty.csv", "", "line 1: ends without a row"),
            light("unsorted.csv", "nm,v\n500,1\n490,1\n", "line 3: wavelength 490 nm must be"),
            light("missing.csv", "nm,v\n500\n", "line 2: number of columns is 1, and 2"),
            light("dark.csv", "nm,v\n400,0\n700,0\n", "line 2: column v is 0 at every"),
            {{"--illuminant", folder_.path.string()}, "is a folder"},
            {{"--illuminant", equal}, "number of columns is 4 and must be 2"},
            {{"--response", equal}, "the three curves do not tell three colours apart"},
            {{"--response", blank}, "column curve1 is 0 at every"}});
    std::vector<Case> scenes;
    for (const auto& [key, name, part] : std::vector<std::array<const char*, 3>>{
             {"glass", "schott:BK77", "there is no glass \"schott:BK77\"; near it are schott:"},
             {"metal", "fe", "there is no metal \"fe\"; there are ag, al, au, cu"},
             {"illuminant", "d50", "there is no illuminant \"d50\"; there are d65, a, f11"}}) {
        const auto file =
            lamp(extras(key, name)).save_glb(folder_.path / (key + std::string("s.glb")));
        scenes.push_back({{"render", file.string(), "--size", "4x4"}, part});
    }
    expect_refused(1, scenes);
}

TEST_F(CliSpectralErrors, ASpectralFileAgainstAnRgbOne) {
    use(lamp());
    (void)render({}, "rgb.exr");
    (void)render({"--bins", "400:700:100", "--spp", "8"}, "bins.exr");
    const Finished run = run_petzval({"image", "diff", path("bins.exr"), path("rgb.exr")});
    EXPECT_EQ(run.exit_code, 1);
    EXPECT_NE(run.err.find("the former is spectral, the latter is not"), std::string::npos)
        << run.err;
}

}  // namespace
}  // namespace petzval
