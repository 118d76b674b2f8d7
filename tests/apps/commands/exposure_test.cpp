// SPDX-License-Identifier: Apache-2.0
// What is told of pictures that show nothing, and --exposure auto.
#include "io/image/picture_files.h"
#include "tests/support/cli.h"

namespace petzval::apps {
namespace {

class CliExposure : public CliTest {
  protected:
    /// The walls, lit by a lamp of that kind and strength.
    std::string lit_by(const char* type, double intensity, const std::string& name = "lit.glb") {
        TinyGltf file = walls();
        file.json["extensionsUsed"].push_back("KHR_lights_punctual");
        file.json["extensions"]["KHR_lights_punctual"]["lights"] = {
            {{"type", type}, {"intensity", intensity}}};
        file.add_root({{"extensions", {{"KHR_lights_punctual", {{"light", 0}}}}}});
        return file.save_glb(folder_.path / name).string();
    }
    Finished run(const std::string& scene, Words words) {
        words.insert(words.end(), {"--look-at", "0,0,0,0,0,-1", "--progress", "none"});
        Finished done = run_petzval(render_words(words, scene));
        EXPECT_EQ(done.exit_code, 0) << done.err;
        return done;
    }
    /// The word after "--exposure " in a text; empty where there is none.
    static std::string typed(const std::string& text) {
        const std::string key = "--exposure ";
        const size_t at = text.find(key);
        if (at == std::string::npos) return "";
        const size_t begin = at + key.size();
        return text.substr(begin, text.find_first_of(" )\n", begin) - begin);
    }
    static double middle(const io::Picture& p) {
        return value_at(p, p.width / 2, p.height / 2, "B");
    }
};

TEST_F(CliExposure, APictureThatIsAlmostBlackSaysWhatToType) {
    const std::string scene = lit_by("point", 1e-3);
    const Finished dark = run(scene, {"-o", path("a.png"), "--stats", path("s.json")});
    EXPECT_NE(file_bytes(path("s.json")).find("the picture is almost black"), std::string::npos);
    EXPECT_NE(dark.err.find("petzval: the picture is almost black: its log-average is "),
              std::string::npos)
        << dark.err;
    EXPECT_NE(dark.err.find(" EV below mid-grey; try --exposure "), std::string::npos);
    EXPECT_GT(std::stod(typed(dark.err)), 5);
    EXPECT_LT(middle(io::read_picture(path("a.png"))), 0.1);

    const Finished better = run(scene, {"-o", path("b.png"), "--exposure", typed(dark.err)});
    EXPECT_EQ(better.err.find("the picture"), std::string::npos) << better.err;
    EXPECT_GT(middle(io::read_picture(path("b.png"))), 0.2);
}

// As of 64 pixels of a hundred that are lit, and 81 of all, which is not yet almost black.
TEST_F(CliExposure, APictureWithOneSmallGlowSaysWhatToType) {
    TinyGltf file;
    add_wall(file, -15, -15, 15, 15, -6, {0.8f, 0.8f, 0.8f});
    add_wall(file, -0.3f, -0.3f, 0.3f, 0.3f, -5.7f, {0, 0, 0});
    nlohmann::json& glow = file.json["materials"].back();
    glow["emissiveFactor"] = {1, 1, 1};
    glow["doubleSided"] = true;
    glow["extensions"]["KHR_materials_emissive_strength"]["emissiveStrength"] = 8;
    file.json["extensionsUsed"].push_back("KHR_materials_emissive_strength");
    const std::string scene = file.save_glb(path("glow.glb")).string();
    const Finished dark = run(scene, {"-o", path("a.png"), "--size", "64x36"});
    EXPECT_NE(dark.err.find("the picture is mostly black: its log-average is "), std::string::npos)
        << dark.err;
    const Finished better =
        run(scene, {"-o", path("a.png"), "--size", "64x36", "--exposure", typed(dark.err)});
    EXPECT_EQ(better.err.find("the picture"), std::string::npos) << better.err;
}

TEST_F(CliExposure, APictureThatIsWhiteSaysSo) {
    const Finished white = run(lit_by("directional", 1e5), {"-o", path("a.jpg")});
    EXPECT_NE(white.err.find("the picture is almost white: "), std::string::npos) << white.err;
    EXPECT_NE(white.err.find("EV above mid-grey"), std::string::npos);
    EXPECT_LT(std::stod(typed(white.err)), -10);
}

TEST_F(CliExposure, NothingIsSaidWhereNothingIsAmiss) {
    const std::string dark = lit_by("point", 1e-3);
    for (const Finished& done :
         {run(dark, {"-o", path("a.exr")}), run(dark, {"-o", path("a.png"), "--quiet"}),
          run(lit_by("point", 10, "well.glb"), {"-o", path("a.png")}),
          run(dark, {"-o", path("a.png"), "--background", "1,1,1"})})
        EXPECT_EQ(done.err.find("the picture"), std::string::npos) << done.err;
}

TEST_F(CliExposure, ABlackPictureSaysThatThereIsNoLight) {
    const Finished black =
        run(scene_, {"-o", path("a.png"), "--method", "max-depth=0", "--background", "0,0,0"});
    EXPECT_NE(black.err.find("the picture is black, and no --exposure can help"), std::string::npos)
        << black.err;
    const Finished found = run(scene_, {"-o", path("a.png"), "--method", "max-depth=0",
                                        "--background", "0,0,0", "--exposure", "auto"});
    EXPECT_NE(found.err.find("exposure: 0 EV (--exposure 0), as no light was found"),
              std::string::npos)
        << found.err;
}

TEST_F(CliExposure, AutoIsANumberThatCanBeTyped) {
    const std::string scene = lit_by("point", 1e-3);
    const Finished found = run(scene, {"-o", path("auto.png"), "-o", path("auto.exr"), "--exposure",
                                       "auto", "--stats", path("stats.json")});
    const std::string ev = typed(found.err);
    EXPECT_NE(found.err.find("exposure: " + ev + " EV (--exposure " + ev + ")\n"),
              std::string::npos)
        << found.err;
    EXPECT_EQ(found.err.find("the picture"), std::string::npos) << found.err;
    run(scene, {"-o", path("typed.png"), "--exposure", ev});
    EXPECT_TRUE(file_bytes(path("auto.png")) == file_bytes(path("typed.png")));
    const auto stats = nlohmann::json::parse(file_bytes(path("stats.json")));
    EXPECT_EQ(stats.at("exposure_ev").dump(), ev);
    EXPECT_FLOAT_EQ(
        std::stof(metadata_of(io::read_picture(path("auto.exr")), "petzval:exposure_ev")),
        std::stof(ev));
}

TEST_F(CliExposure, AutoDoesNotDependOnCropSamplesAndThreads) {
    const std::string scene = lit_by("point", 1e-3);
    const Words words = {"-o", path("a.png"), "--size", "32x18", "--exposure", "auto"};
    const auto with = [&](const Words& more) {
        Words all = words;
        all.insert(all.end(), more.begin(), more.end());
        return typed(run(scene, all).err);
    };
    const std::string ev = with({});
    const io::Picture whole = io::read_picture(path("a.png"));
    EXPECT_EQ(with({"--crop", "20,10,5,4"}), ev);
    const io::Picture part = io::read_picture(path("a.png"));
    for (int y = 0; y < 4; ++y)
        for (int x = 0; x < 5; ++x)
            for (const char* c : {"R", "G", "B"})
                EXPECT_EQ(value_at(part, x, y, c), value_at(whole, x + 20, y + 10, c));
    EXPECT_EQ(with({"--spp", "9"}), ev);
    Words one = render_words(words, scene);
    *(std::find(one.begin(), one.end(), "--threads") + 1) = "1";
    one.insert(one.end(), {"--look-at", "0,0,0,0,0,-1", "--progress", "none"});
    EXPECT_EQ(typed(run_petzval(one).err), ev);
}

TEST_F(CliExposure, APictureIsShownWithAnExposureThatIsFoundInIt) {
    static_cast<void>(run(lit_by("directional", 1e5), {"-o", path("a.exr")}));
    const auto shown = [&](const std::string& exposure) {
        const Finished done = run_petzval(
            {"image", "view", path("a.exr"), "-o", path("b.png"), "--exposure", exposure});
        EXPECT_EQ(done.exit_code, 0) << done.err;
        return done.err;
    };
    const std::string ev = typed(shown("auto"));
    ASSERT_FALSE(ev.empty());
    EXPECT_LT(std::stod(ev), -10);
    const auto found = file_bytes(path("b.png"));
    static_cast<void>(shown(ev + " EV"));
    EXPECT_TRUE(file_bytes(path("b.png")) == found);
}

}  // namespace
}  // namespace petzval::apps
