// SPDX-License-Identifier: Apache-2.0
// What the program may read and how much of the machine it takes.
#include <sched.h>

#include "io/image/picture_files.h"
#include "tests/support/cli.h"
#include "tests/support/tiny_png.h"

namespace petzval::apps {
namespace {

class ReadingOptions : public CliTest {
  protected:
    /// A wall with a texture of side * side texels, in the file or beside it.
    TinyGltf textured(uint32_t side) {
        TinyGltf file;
        const std::vector<uint8_t> texels(size_t{4} * side * side, 200);
        const int image = file.add_image(tiny_png(side, side, texels));
        const int texture = file.add("textures", {{"source", image}});
        const int material = file.add(
            "materials", {{"pbrMetallicRoughness", {{"baseColorTexture", {{"index", texture}}}}}});
        const int mesh = file.add_triangle({{"material", material}});
        const int uv = file.add_accessor<float>("VEC2", {0, 0, 1, 0, 0, 1});
        file.json["meshes"][size_t(mesh)]["primitives"][0]["attributes"]["TEXCOORD_0"] = uv;
        file.add_root({{"mesh", mesh}});
        return file;
    }
};

TEST_F(ReadingOptions, MaxMemoryHoldsForAllPicturesOfAScene) {
    const std::string scene = textured(100).save_glb(folder_.path / "t.glb").string();
    const Words info = {"info", scene};
    EXPECT_EQ(run_petzval({"info", scene, "--max-memory", "80kB"}).exit_code, 0);
    const std::string line = error_of({"info", scene, "--max-memory", "79kB"}, 1);
    EXPECT_NE(line.find("t.glb: /images/0: the image of 100x100 pixels"), line.npos) << line;
    EXPECT_NE(line.find("--max-memory"), line.npos) << line;

    // The environment comes on top of the texture, and an iris on top of both.
    io::Picture sky{{.width = 64,
                     .height = 32,
                     .full_width = 64,
                     .full_height = 32,
                     .channels = {"R", "G", "B"},
                     .metadata = {}},
                    std::vector<float>(64 * 32 * 3, 1.f)};
    io::write_exr(path("sky.exr"), sky);
    io::Picture iris = sky;
    io::write_8bit(path("iris.png"), iris);
    const Words all = {"render",     scene,
                       "--size",     "8x8",
                       "--spp",      "1",
                       "--env",      path("sky.exr"),
                       "--fstop",    "2",
                       "--focus",    "1",
                       "--look-at",  "0,0,3,0,0,0",
                       "--aperture", path("iris.png"),
                       "-o",         path("out.exr")};
    const auto with = [&](const std::string& memory) {
        Words words = all;
        words.insert(words.end(), {"--max-memory", memory});
        return words;
    };
    EXPECT_NE(error_of(with("100kB"), 1).find("sky.exr: the picture of 64x32"), std::string::npos);
    EXPECT_NE(error_of(with("130kB"), 1).find("iris.png: the picture of 64x32"), std::string::npos);
    const Finished enough = run_petzval(with("1MiB"));
    EXPECT_EQ(enough.exit_code, 0) << enough.err;
}

TEST_F(ReadingOptions, MaxMemoryHoldsForPicturesByThemselves) {
    const io::Picture picture{{.width = 64,
                               .height = 32,
                               .full_width = 64,
                               .full_height = 32,
                               .channels = {"R", "G", "B"},
                               .metadata = {}},
                              std::vector<float>(64 * 32 * 3, 1.f)};
    io::write_exr(path("a.exr"), picture);
    for (const Words& words : {Words{"image", "diff", path("a.exr"), path("a.exr")},
                               Words{"image", "view", path("a.exr"), "-o", path("a.png")},
                               Words{"image", "spectrum", path("a.exr"), "0,0"}}) {
        Words little = words;
        little.insert(little.end(), {"--max-memory", "24kB"});
        EXPECT_NE(error_of(little, 1).find("a.exr: the picture of 64x32"), std::string::npos);
    }
    EXPECT_EQ(run_petzval({"image", "diff", path("a.exr"), path("a.exr"), "--max-memory", "50kB"})
                  .exit_code,
              0);
}

TEST_F(ReadingOptions, MaxMemoryIsAnAmountAndHoldsForTheRenderToo) {
    expect_refused(2, {{{"--max-memory", "8"}, "\"8\" is not an amount of memory such as 512MB"},
                       {{"--max-memory", "0GB"}, "\"0GB\""},
                       {{"--max-memory", "-1GB"}, "\"-1GB\""},
                       {{"--max-memory", "nanGB"}, "\"nanGB\""},
                       {{"--max-memory", "8gigs"}, "\"8gigs\""}});
    expect_refused(4, {{{"--max-memory", "10MB", "--size", "2000x2000"}, "--size: needs"}});
}

TEST_F(ReadingOptions, ASceneOfTheFileAndARadiusForItsPoints) {
    TinyGltf file = studio();
    file.json["scenes"][0]["name"] = "day";
    nlohmann::json night = file.json["scenes"][0];
    night["name"] = "night";
    night["nodes"].push_back(file.add(
        "nodes", {{"mesh", file.add_mesh(
                               {{"mode", 0},
                                {"attributes", {{"POSITION", file.add_positions({0, 0, 0})}}}})}}));
    file.json["scenes"].push_back(night);
    const std::string scene = file.save_gltf(folder_.path / "two.gltf").string();
    const auto info = [&](Words words) {
        words.insert(words.begin(), {"info", scene});
        return run_petzval(words).out;
    };
    EXPECT_NE(info({}).find("scene 0: day"), std::string::npos);
    const std::string shown = info({"--scene", "night", "--method", "point-line-radius=2cm"});
    EXPECT_NE(shown.find("scene 1: night"), std::string::npos) << shown;
    EXPECT_NE(shown.find("points and lines, as spheres"), std::string::npos) << shown;
    const Words more = {"--scene", "night", "--method", "point-line-radius=2cm"};
    for (Words words : {Words{"info", scene}, Words{"plan", scene, "--size", "8x8"},
                        Words{"render", scene, "-o", path("o.exr")},
                        Words{"chart", scene, "-o", path("chart")}}) {
        words.insert(words.end(), {"--scene", "dusk"});
        const std::string line = error_of(words, 2);
        EXPECT_NE(line.find("no scene \"dusk\"; it has 0 \"day\", 1 \"night\""), line.npos) << line;
    }
    Words plan = {"plan", scene, "--size", "8x8", "--quiet", "--tolerance", "50%"};
    plan.insert(plan.end(), more.begin(), more.end());
    const std::string command = run_petzval(plan).out;
    EXPECT_NE(command.find(" --scene night"), std::string::npos) << command;
    EXPECT_NE(command.find(" --method point-line-radius=0.02"), std::string::npos) << command;
}

// A scene that a stranger sent names what it likes.
TEST_F(ReadingOptions, ConfineKeepsToTheFolderOfTheScene) {
    std::filesystem::create_directories(path("scene"));
    TinyGltf file = studio();
    const std::string scene = file.save_gltf(folder_.path / "scene/s.gltf").string();
    EXPECT_EQ(run_petzval({"info", scene, "--confine"}).exit_code, 0);
    file.json["images"] = {{{"uri", "../secret.png"}}};
    file.json["textures"] = {{{"source", 0}}};
    file.json["materials"][0]["pbrMetallicRoughness"]["baseColorTexture"] = {{"index", 0}};
    (void)file.save_gltf(folder_.path / "scene/s.gltf");
    text_file("secret.png", "hunter2");
    const Words render = {"render", scene, "--size", "8x8", "--spp", "1", "-o", path("o.exr")};
    const auto confined = [](Words words) {
        words.emplace_back("--confine");
        return words;
    };
    for (const Words& words : {Words{"info", scene}, render, Words{"plan", scene},
                               Words{"chart", scene, "-o", path("chart")}}) {
        const std::string line = error_of(confined(words), 1);
        EXPECT_NE(line.find("s.gltf: /images/0/uri: \"../secret.png\" lies outside"), line.npos)
            << line;
    }
    const std::string read = error_of({"info", scene}, 1);
    EXPECT_EQ(read.find("lies outside"), read.npos) << read;
    EXPECT_EQ(read.find("hunter2"), read.npos) << read;
}

TEST_F(ReadingOptions, ConfineHoldsForLensAndIrisOfACamera) {
    std::filesystem::create_directories(path("scene"));
    for (const char* place : {"", "scene/"}) {
        std::filesystem::copy_file(
            std::filesystem::path(PETZVAL_ASSETS) / "lenses/tessar-100mm-f2.8.json",
            path(std::string(place) + "lens.json"));
        text_file(std::string(place) + "iris.svg", R"(<svg><rect width="2" height="1"/></svg>)");
    }
    const auto run = [&](const std::string& lens, const std::string& aperture) {
        TinyGltf file = studio();
        file.json["cameras"][0]["extras"]["petzval"] = {{"lens", lens}, {"aperture", aperture}};
        const std::string scene = file.save_gltf(folder_.path / "scene/s.gltf").string();
        return run_petzval({"render", scene, "--size", "8x8", "--spp", "1", "--focus", "3",
                            "--confine", "--quiet", "-o", path("o.exr")});
    };
    EXPECT_EQ(run("lens.json", "iris.svg").err, "");
    EXPECT_EQ(run("tessar-100mm-f2.8", "star:5").err, "") << "what ships is no file of the scene";
    for (const auto& [lens, aperture] :
         std::vector<std::pair<std::string, std::string>>{{"../lens.json", "circle"},
                                                          {path("lens.json"), "circle"},
                                                          {"lens.json", "../iris.svg"},
                                                          {"lens.json", path("iris.svg")}}) {
        const Finished refused = run(lens, aperture);
        EXPECT_EQ(refused.exit_code, 1) << lens << ' ' << aperture;
        EXPECT_NE(refused.err.find("camera \"wide\": \""), std::string::npos) << refused.err;
        EXPECT_NE(refused.err.find("lies outside the folder"), std::string::npos) << refused.err;
    }
}

TEST_F(ReadingOptions, AVariantStandsInThePictureItsMetadataAndThePlan) {
    TinyGltf file = studio();
    file.json["extensionsUsed"].push_back("KHR_materials_variants");
    file.json["extensions"]["KHR_materials_variants"]["variants"] = {{{"name", "lit one"}}};
    const int glow = file.add("materials", {{"emissiveFactor", {1, 1, 1}}});
    file.json["meshes"][0]["primitives"][0]["extensions"]["KHR_materials_variants"]["mappings"] = {
        {{"material", glow}, {"variants", {0}}}};
    scene_ = file.save_glb(folder_.path / "variants.glb").string();
    const io::Picture plain = render({});
    const io::Picture lit = render({"--variant", "lit one"});
    EXPECT_EQ(metadata_of(plain, "petzval:variant"), "(none)");
    EXPECT_EQ(metadata_of(lit, "petzval:variant"), "lit one");
    const size_t middle = (8 * 16 + 8) * lit.channels.size();
    EXPECT_GT(lit.pixels.at(middle), plain.pixels.at(middle) + 0.5f);

    const Finished plan =
        run_petzval({"plan", scene_, "--size", "8x8", "--tolerance", "100%", "--variant", "0"});
    EXPECT_NE(plan.out.find(" --variant 0 "), plan.out.npos) << plan.out << plan.err;
    for (const Words& words :
         {Words{"info", scene_}, Words{"plan", scene_}, Words{"chart", scene_, "-o", path("c")},
          Words{"render", scene_, "-o", path("o.exr")}}) {
        Words wrong = words;
        wrong.insert(wrong.end(), {"--variant", "lit"});
        EXPECT_TRUE(error_of(wrong, 2).ends_with(
            "no variant \"lit\"; it has 0 \"lit one\"; did you mean lit one?"));
    }
}

TEST_F(ReadingOptions, ThreadsFollowTheAffinityMask) {
    cpu_set_t before, one;
    ASSERT_EQ(sched_getaffinity(0, sizeof before, &before), 0);
    CPU_ZERO(&one);
    for (int i = 0; i < CPU_SETSIZE && CPU_COUNT(&one) == 0; ++i)
        if (CPU_ISSET(i, &before)) CPU_SET(i, &one);
    ASSERT_EQ(sched_setaffinity(0, sizeof one, &one), 0);
    const Finished run = run_petzval({"render", scene_, "--size", "8x8", "--spp", "1", "--quiet",
                                      "-o", path("o.exr"), "--stats", path("s.json")});
    ASSERT_EQ(sched_setaffinity(0, sizeof before, &before), 0);
    EXPECT_EQ(run.exit_code, 0) << run.err;
    EXPECT_EQ(nlohmann::json::parse(file_bytes(path("s.json")))["threads"], 1);
}

}  // namespace
}  // namespace petzval::apps
