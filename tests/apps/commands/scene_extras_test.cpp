// SPDX-License-Identifier: Apache-2.0
// A scene's own sky, exposure and view, which the command line goes before; Blender's lamps.
#include "tests/support/cli.h"

namespace petzval::apps {
namespace {

using nlohmann::json;

class SceneExtrasCli : public CliTest {
  protected:
    /// Environment that is red where z < 0 and blue behind.
    void write_sky(const std::string& name) {
        io::Picture sky;
        sky.width = sky.full_width = 8;
        sky.height = sky.full_height = 4;
        sky.channels = {"R", "G", "B"};
        for (int i = 0; i < 32; ++i)
            for (const float v : {i % 8 < 4 ? 1.f : 0.f, 0.f, i % 8 < 4 ? 0.f : 1.f})
                sky.pixels.push_back(v);
        io::write_exr(path(name), sky);
    }
    void save(json ours) {
        TinyGltf file = studio();
        file.json["scenes"][0]["extras"] = {{"petzval", std::move(ours)}};
        scene_ = file.save_glb(path("studio.glb")).string();
    }
    /// What a render says.
    std::string said(Words words) {
        words.insert(words.end(), {"-o", path("out.png")});
        const Finished run = run_petzval(render_words(words, scene_));
        EXPECT_EQ(run.exit_code, 0) << run.err;
        return run.err;
    }
    static V3f corner(const io::Picture& p) {
        return {value_at(p, 0, 0, "R"), value_at(p, 0, 0, "G"), value_at(p, 0, 0, "B")};
    }
};

TEST_F(SceneExtrasCli, TheSkyIsThatOfTheScene) {
    write_sky("sky.exr");
    save({{"sky", "sky.exr"}, {"sky_rotation_deg", 180}});
    const io::Picture shown = render({});
    EXPECT_EQ(corner(shown), V3f(0, 0, 1));
    EXPECT_EQ(metadata_of(shown, "petzval:environmentRotate_deg"), "180");
    EXPECT_NE(metadata_of(shown, "petzval:environment").find("sky.exr"), std::string::npos);
    EXPECT_EQ(corner(render({"--env", path("sky.exr")})), V3f(1, 0, 0));
    EXPECT_EQ(corner(render({"--background", "2,3,4"})), V3f(2, 3, 4));
    EXPECT_EQ(corner(render({"--confine"})), V3f(0, 0, 1));
    const std::string told = said({});
    EXPECT_NE(told.find("the scene asks for its sky, sky.exr, turned by 180 degrees"),
              std::string::npos)
        << told;
}

TEST_F(SceneExtrasCli, TheSkyIsAFileAsAllOthers) {
    std::filesystem::create_directory(path("scene"));
    write_sky("sky.exr");
    save({{"sky", "../sky.exr"}});
    std::filesystem::rename(scene_, path("scene/studio.glb"));
    scene_ = path("scene/studio.glb");
    EXPECT_EQ(corner(render({})), V3f(1, 0, 0));
    expect_refused(1, {{{"--confine"}, "\"../sky.exr\" lies outside the folder of the scene"}});
    expect_refused(2, {{{"-o", path("sky.exr")}, "the sky of the scene"}});
    std::filesystem::remove(path("sky.exr"));
    expect_refused(1, {{{}, "sky.exr"}});
}

TEST_F(SceneExtrasCli, TheDisplayIsThatOfTheScene) {
    const auto png = [&](const Words& words) { return render(words, "out.png").pixels; };
    const auto plain = png({}), dark = png({"--exposure", "-3", "--view", "raw"});
    ASSERT_NE(plain, dark);
    save({{"exposure_ev", -3}, {"view", "RAW"}});
    EXPECT_EQ(png({}), dark);
    EXPECT_EQ(png({"--exposure", "0", "--view", "sRGB"}), plain);
    EXPECT_EQ(png({"--exposure", "0"}), png({"--exposure", "0", "--view", "raw"}));
    const std::string told = said({"--view", "sRGB"});
    EXPECT_NE(told.find("the scene asks for exposure -3 EV (--exposure"), std::string::npos)
        << told;
    save({{"view", "Velvia"}});
    expect_refused(1, {{{}, "/scenes/0/extras/petzval/view"}});
}

TEST_F(SceneExtrasCli, WhiteFilesOfBlenderHaveACause) {
    TinyGltf file = studio();
    for (json& light : file.json["extensions"]["KHR_lights_punctual"]["lights"])
        light["intensity"] = 1e5;
    const auto said_of = [&](const char* generator) {
        file.json["asset"]["generator"] = generator;
        scene_ = file.save_glb(path("studio.glb")).string();
        return said({"--transparent", "--look-at", "0,0,0,0,0,-1", "--fov", "30"});
    };
    const std::string blender = said_of("Khronos glTF Blender I/O v4.2"), other = said_of("other");
    EXPECT_NE(other.find("almost white"), std::string::npos) << other;
    EXPECT_EQ(other.find("Blender"), std::string::npos) << other;
    EXPECT_NE(blender.find("--exposure auto. Blender wrote the file"), std::string::npos)
        << blender;
}

TEST_F(SceneExtrasCli, InfoTellsWhatIsProbablyLost) {
    TinyGltf file = studio();
    file.json["asset"]["generator"] = "Khronos glTF Blender I/O v4.2";
    scene_ = file.save_glb(path("studio.glb")).string();
    const std::string text = run_petzval({"info", scene_}).out;
    EXPECT_NE(text.find("probably lost by the exporter\n  the radius of 2 point or spot lamps"),
              std::string::npos)
        << text;
    const json told = json::parse(run_petzval({"info", scene_, "--json"}).out);
    EXPECT_GE(told.at("probably_lost").size(), 4u);
}

}  // namespace
}  // namespace petzval::apps
