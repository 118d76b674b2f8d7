// SPDX-License-Identifier: Apache-2.0
// What a file without lights and cameras gets: the studio light, and a camera that shows all of it.
#include "io/image/picture_files.h"
#include "tests/support/cli.h"

namespace petzval::apps {
namespace {

class CliDarkScene : public CliTest {
  protected:
    CliDarkScene() { scene_ = box(1); }

    /// A white box of that size about (0, 1, 0), in metres. more: of its material.
    std::string box(float side_m, const nlohmann::json& more = {}) {
        TinyGltf file;
        const float r = side_m / 2;
        std::vector<float> xyz;
        for (int i = 0; i < 8; ++i)
            for (int k = 0; k < 3; ++k) xyz.push_back((i >> k & 1 ? r : -r) + (k == 1 ? 1.f : 0.f));
        nlohmann::json primitive;
        nlohmann::json material = {{"doubleSided", true},
                                   {"pbrMetallicRoughness", {{"metallicFactor", 0}}}};
        if (!more.is_null()) material.update(more);
        primitive["material"] = file.add("materials", material);
        primitive["attributes"]["POSITION"] = file.add_positions(xyz);
        primitive["indices"] = file.add_accessor<uint16_t>(
            "SCALAR", {0, 2, 3, 0, 3, 1, 4, 5, 7, 4, 7, 6, 0, 1, 5, 0, 5, 4,
                       2, 6, 7, 2, 7, 3, 0, 4, 6, 0, 6, 2, 1, 3, 7, 1, 7, 5});
        file.add_root({{"mesh", file.add_mesh(primitive)}});
        return file.save_glb(folder_.path / "box.glb").string();
    }
    /// Largest extent of what is not transparent, over that of the picture; its margins in pixels.
    struct Extent {
        double largest;
        int least_margin_px;
    };
    static Extent extent(const io::Picture& p) {
        int left = p.width, right = -1, top = p.height, bottom = -1;
        for (int y = 0; y < p.height; ++y)
            for (int x = 0; x < p.width; ++x) {
                if (!(value_at(p, x, y, "A") > 0.5f)) continue;
                left = std::min(left, x), right = std::max(right, x);
                top = std::min(top, y), bottom = std::max(bottom, y);
            }
        return {std::max(double(right - left + 1) / p.width, double(bottom - top + 1) / p.height),
                std::min({left, top, p.width - 1 - right, p.height - 1 - bottom})};
    }
};

TEST_F(CliDarkScene, IsLitByTheStudio) {
    const Words small = {"--size", "120x80", "--spp", "8", "--aov", "normal"};
    const io::Picture seen = render(small, "seen.exr");
    EXPECT_EQ(metadata_of(seen, "petzval:environment"), "studio");
    EXPECT_EQ(metadata_of(seen, "petzval:background"), "(none)");
    // Mean of the sides of the box, told by their normals.
    std::array<double, 3> sum{};
    std::array<int, 3> count{};
    for (int y = 0; y < 80; ++y)
        for (int x = 0; x < 120; ++x)
            for (size_t k = 0; k < 3; ++k)
                if (value_at(seen, x, y, std::array{"normal.X", "normal.Y", "normal.Z"}[k]) > 0.99f)
                    sum[k] += value_at(seen, x, y, "G"), ++count[k];
    for (const int n : count) ASSERT_GT(n, 10) << count[0] << ' ' << count[1] << ' ' << count[2];
    const double right = sum[0] / count[0], top = sum[1] / count[1], front = sum[2] / count[2];
    EXPECT_GT(front, 1.1 * right);
    EXPECT_GT(top, 1.05 * front);
    EXPECT_GT(right, 0.3);
    EXPECT_LT(top, 1.05);
    const float behind = value_at(seen, 0, 0, "G");
    EXPECT_GT(behind, 0.15f);
    EXPECT_LT(behind, 0.4f);

    Words asked = small;
    asked.insert(asked.end(), {"--env", "studio"});
    EXPECT_TRUE(render_bytes(asked, "asked.exr") == file_bytes(path("seen.exr")));
}

// What glows too little to be seen by is lit as well; a lamp is left alone.
TEST_F(CliDarkScene, IsLitByTheStudioWhereSomethingOnlyGlows) {
    const auto told = [&](const nlohmann::json& emission, const Words& more = {}) {
        scene_ = box(1, emission);
        Words words = render_words({"-o", path("a.exr"), "--size", "24x16"}, scene_);
        words.insert(words.end(), more.begin(), more.end());
        const Finished run = run_petzval(words);
        EXPECT_EQ(run.exit_code, 0) << run.err;
        return run.err.find("studio light is used too (--env studio)") != std::string::npos;
    };
    const nlohmann::json faint = {{"emissiveFactor", {0.009, 0.009, 0.009}}};
    EXPECT_TRUE(told(faint));
    EXPECT_GT(value_at(io::read_picture(path("a.exr")), 12, 8, "G"), 0.1f);
    EXPECT_FALSE(told(faint, {"--background", "0,0,0"}));
    EXPECT_LT(value_at(io::read_picture(path("a.exr")), 12, 8, "G"), 0.02f);
    EXPECT_FALSE(told({{"emissiveFactor", {0.2, 0.2, 0.2}}}));
    nlohmann::json lamp = {{"emissiveFactor", {1, 1, 1}}};
    lamp["extensions"]["KHR_materials_emissive_strength"]["emissiveStrength"] = 2;
    EXPECT_FALSE(told(lamp));
}

// Farther away than --focus takes: the option that is told must be one.
TEST_F(CliDarkScene, AFocusBeyondAllIsCalledInfinity) {
    scene_ = box(4e9f);
    const Words words = {"-o", path("a.exr"), "--size", "24x16", "--spp", "1", "--fstop", "2"};
    const Finished run = run_petzval(render_words(words, scene_));
    EXPECT_EQ(run.exit_code, 0);
    EXPECT_NE(run.err.find("focus: infinity (--focus infinity)"), std::string::npos) << run.err;
}

TEST_F(CliDarkScene, KeepsTheLightThatIsAskedFor) {
    const io::Picture white = render({"--background", "1,1,1", "--spp", "64", "--size", "24x16"});
    EXPECT_EQ(value_at(white, 0, 0, "G"), 1.f);
    EXPECT_EQ(metadata_of(white, "petzval:environment"), "(none)");
    const io::Picture clear = render({"--transparent", "--size", "24x16"});
    EXPECT_EQ(value_at(clear, 0, 0, "A"), 0.f);
    EXPECT_EQ(value_at(clear, 0, 0, "G"), 0.f);
    EXPECT_GT(value_at(clear, 12, 8, "G"), 0.1f);
    EXPECT_EQ(value_at(render({"--background", "0,0,0", "--size", "24x16"}), 12, 8, "G"), 0.f);
}

TEST_F(CliDarkScene, FillsThePicture) {
    for (const char* size : {"96x54", "54x96", "64x64"}) {
        const Extent of = extent(render({"--transparent", "--size", size}));
        EXPECT_GT(of.largest, 0.88) << size;
        EXPECT_GE(of.least_margin_px, 1) << size;
    }
}

TEST_F(CliDarkScene, FillsThePictureOfALensThatIsFocusedNear) {
    for (const float side_m : {3.f, 0.15f}) {
        scene_ = box(side_m);
        for (const Words& lens :
             {Words{"--lens", "double-gauss-100mm-f2"},
              Words{"--lens", "thin", "--focal-length", "100", "--sensor", "36x24"}}) {
            Words words = {"--transparent", "--size", "72x48", "--fstop", "22"};
            words.insert(words.end(), lens.begin(), lens.end());
            words.insert(words.end(), {"-o", path("lens.exr"), "--quiet"});
            const Finished done = run_petzval(render_words(words, scene_));
            ASSERT_EQ(done.exit_code, 0) << done.err;
            const Extent of = extent(io::read_picture(path("lens.exr")));
            EXPECT_GT(of.largest, 0.8) << side_m << lens[1];
            EXPECT_GE(of.least_margin_px, 1) << side_m << lens[1];
        }
    }
}

}  // namespace
}  // namespace petzval::apps
