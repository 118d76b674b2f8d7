// SPDX-License-Identifier: Apache-2.0
// Ghosts, from the command line: what they add, and what they leave as it was.
#include <cmath>
#include <numbers>

#include "io/image/picture_files.h"
#include "tests/support/cli_spectral.h"

namespace petzval::apps {
namespace {

/// Small lamps, through a traced lens of its year's coating.
class CliGhosts : public CliSpectral {
  protected:
    CliGhosts() { scene_ = PETZVAL_ASSETS "/scenes/ornaments.glb"; }
    [[nodiscard]] static Words coated(const Words& more) {
        Words words = {"--lens",   "tessar-100mm-f2.8", "--focus", "1m",
                       "--method", "coating=year",      "--size",  "48x32"};
        words.insert(words.end(), more.begin(), more.end());
        return words;
    }
};

TEST_F(CliGhosts, PictureWithoutTheirLayerIsThatOfALensWithout) {
    for (const Words& more : {Words{}, Words{"--spectral", "rgb"}, Words{"--method", "clamp=50"}}) {
        const auto with = [&](Words ghosts) {
            ghosts.insert(ghosts.end(), more.begin(), more.end());
            ghosts.insert(ghosts.end(), {"--spp", "9", "--method", "dispersion=hero"});
            return coated(ghosts);
        };
        const io::Picture both = render(with({"--aov", "ghosts"})),
                          off = render(with({"--ghosts", "off"})),
                          only = render(with({"--ghosts", "only", "--aov", "ghosts"}));
        double light = 0;
        for (int y = 0; y < 32; ++y)
            for (int x = 0; x < 48; ++x)
                for (const std::string c : {"R", "G", "B"}) {
                    const float ghosts = value_at(both, x, y, "ghosts." + c);
                    const float sum = value_at(both, x, y, c);
                    ASSERT_NEAR(sum - ghosts, value_at(off, x, y, c),
                                1e-5f * (std::fabs(sum) + std::fabs(ghosts)));
                    ASSERT_EQ(value_at(only, x, y, c), value_at(only, x, y, "ghosts." + c));
                    ASSERT_EQ(value_at(only, x, y, c), ghosts);
                    light += double(ghosts);
                }
        EXPECT_GT(light, 0);
    }
}

TEST_F(CliGhosts, EqualRendersAreEqualFiles) {
    expect_equal_renders(
        [](Words more) {
            more.insert(more.end(), {"--aov", "ghosts,depth"});
            return coated(more);
        },
        {"R", "G", "B", "A", "ghosts.R", "ghosts.G", "depth.Z"});
}

// Alpha and the other layers are those of the light in order.
TEST_F(CliGhosts, AlphaAndLayersStay) {
    const Words more = {"--spp", "8", "--transparent", "--aov", "normal,depth,ghosts"};
    Words off = more;
    off.insert(off.end(), {"--ghosts", "off"});
    const io::Picture with = render(coated(more)), without = render(coated(off));
    for (int y = 0; y < 32; ++y)
        for (int x = 0; x < 48; ++x) {
            for (const char* c : {"A", "normal.X", "normal.Z", "depth.Z"})
                ASSERT_EQ(value_at(with, x, y, c), value_at(without, x, y, c));
            ASSERT_EQ(value_at(without, x, y, "ghosts.R"), 0.f);
        }
}

/// Share of light square to a surface of glass that a layer reflects, a quarter of a wave of 550 nm
/// thick: both faces of it, added with their phases (Born and Wolf 1999, 1.6.4, equation 57).
double layer_reflects(double glass, double layer, double nm) {
    const double outer = (1 - layer) / (1 + layer), inner = (layer - glass) / (layer + glass);
    const double cosine = std::cos(std::numbers::pi * 550 / nm);
    const double squares = outer * outer + inner * inner, both = 2 * outer * inner * cosine;
    return (squares + both) / (1 + outer * outer * inner * inner + both);
}

// A lens of one index, whose surfaces have one layer: the light of a white sun's only ghost comes
// in by one surface, is reflected by both, and leaves by the other. The iris is so narrow that
// light goes nearly square through the layers: at f/16 angles of 6 degrees change the colour by 1.
TEST_F(CliGhosts, HaveTheColourOfTheirCoating) {
    constexpr double kGlass = 1.75, kLayer = 1.38;
    std::ofstream(path("single.json"))
        << R"({"surfaces": [{"radius": 60, "thickness": 4, "semi_diameter": 8, "medium": {"n": 1.75}},
            {"radius": -60, "thickness": 1, "semi_diameter": 8, "medium": null},
            {"radius": null, "thickness": 39, "semi_diameter": 8, "stop": true, "medium": null}]})";
    TinyGltf file;
    add_perspective(file, "wide", 0.5f);
    file.json["extensionsUsed"] = {"KHR_lights_punctual"};
    file.json["extensions"]["KHR_lights_punctual"]["lights"] = {
        {{"type", "directional"},
         {"intensity", 1000},
         {"extras", {{"petzval", {{"angle_deg", 0.5}}}}}}};
    file.add_root(
        {{"rotation", {0, 1, 0, 0}}, {"extensions", {{"KHR_lights_punctual", {{"light", 0}}}}}});
    use(file);
    const io::Picture ghosts =
        render({"--lens", path("single.json"), "--fstop", "64", "--focus", "infinity", "--ghosts",
                "only", "--method", "coating=mgf2", "--spectral", "wavelengths", "--background",
                "0,0,0", "--size", "48x32", "--spp", "512"});
    V3d rgb(0.);
    for (int y = 0; y < 32; ++y)
        for (int x = 0; x < 48; ++x)
            rgb += V3d(double(value_at(ghosts, x, y, "R")), double(value_at(ghosts, x, y, "G")),
                       double(value_at(ghosts, x, y, "B")));
    const auto xyz_bar = io::standard_observer();
    const SpectrumTable d65 = io::find_illuminant("d65");
    V3d expected(0.), white(0.);
    for (int nm = kFirst_nm; nm <= kLast_nm; ++nm) {
        const double r = layer_reflects(kGlass, kLayer, nm);
        for (int c = 0; c < 3; ++c) {
            const double light = double(xyz_bar[size_t(c)].at_nm(nm)) * double(d65.at_nm(nm));
            white[c] += light;
            expected[c] += light * r * r * (1 - r) * (1 - r);
        }
    }
    white /= white.y;
    const V3d seen = srgb_to_xyz(white) * rgb;
    ASSERT_GT(seen.y, 0);
    // At the lightness of white, where differences count most.
    const V3d lab = xyz_to_lab(expected / expected.y, white);
    EXPECT_GT(std::hypot(lab.y, lab.z), 20) << "it has a colour";
    EXPECT_LT(delta_e_2000(xyz_to_lab(seen / seen.y, white), lab), 1);
}

TEST_F(CliGhosts, SayWhereThereAreNone) {
    const auto expect = [&](const Words& words, const char* text) {
        Words all = words;
        all.insert(all.end(), {"-o", path("never.exr")});
        const Finished run = run_petzval(render_words(all, scene_));
        EXPECT_EQ(run.exit_code, 2) << run.err;
        EXPECT_NE(run.err.find(text), std::string::npos) << run.err;
    };
    expect({"--lens", "double-gauss-100mm-f2", "--ghosts", "only"},
           "--ghosts only: shows light that two surfaces of the lens reflect");
    expect({"--lens", "thin", "--fstop", "2", "--focus", "1m", "--ghosts", "only"},
           "--ghosts only: needs a lens that is traced");
    expect({"--lens", "singlet:schott:N-BK7", "--fstop", "8", "--focus", "1m", "--ghosts", "only"},
           "--ghosts only: needs a lens that is traced");
    std::ofstream(path("bare.json"))
        << R"({"surfaces": [{"radius": 50, "thickness": 5, "semi_diameter": 8,
            "medium": {"n": 1.5}}, {"radius": -50, "thickness": 48, "semi_diameter": 8, "stop": true, "medium": null}]})";
    expect({"--lens", path("bare.json"), "--focus", "1m", "--method", "coating=year"},
           "states no year");
}

}  // namespace
}  // namespace petzval::apps
