// SPDX-License-Identifier: Apache-2.0
// petzval info: its table of extensions, and its JSON.
#include "tests/support/cli.h"

namespace petzval::apps {
namespace {

using nlohmann::json;

class Info : public CliTest {
  protected:
    /// The studio with two scenes, variants, an animation of a second, a sheen and an unknown
    /// extension.
    TinyGltf rich() {
        TinyGltf file = studio();
        for (const char* name :
             {"KHR_materials_variants", "KHR_xmp_json_ld", "NV_materials_mdl", "X_y"})
            file.json["extensionsUsed"].push_back(name);
        file.json["asset"]["generator"] = "a\u202eb";
        file.json["extensions"]["KHR_materials_variants"]["variants"] = {{{"name", "dull\n"}},
                                                                         {{"name", "shiny"}}};
        file.json["extensions"]["NV_materials_mdl"] = json::object();
        file.json["scenes"].push_back({{"name", "cellar"}});
        const int times =
            file.add_accessor<float>("SCALAR", {0, 2.5f}, {{"max", json::array({2.5})}});
        const int moves = file.add_accessor<float>("VEC3", {0, 0, 0, 1, 1, 1});
        file.json["animations"] = {
            {{"name", "walk"},
             {"samplers", {{{"input", times}, {"output", moves}}}},
             {"channels", {{{"sampler", 0}, {"target", {{"node", 0}, {"path", "translation"}}}}}}}};
        return file;
    }
    Finished info(const TinyGltf& file, const Words& more = {}) {
        Words words = {"info", file.save_glb(folder_.path / "rich.glb").string()};
        words.insert(words.end(), more.begin(), more.end());
        return run_petzval(words);
    }
    static std::set<std::string> keys_of(const json& object) {
        std::set<std::string> keys;
        for (const auto& [key, unused] : object.items()) keys.insert(key);
        return keys;
    }
};

TEST_F(Info, TellsOfChannelsThatCannotBePlayed) {
    TinyGltf file = rich();
    EXPECT_EQ(info(file).out.find("left out"), std::string::npos);
    file.json["animations"][0]["samplers"][0]["input"] =
        file.add_accessor<float>("SCALAR", {2.5f, 0});
    const Finished text = info(file);
    EXPECT_EQ(text.exit_code, 0) << text.err;
    EXPECT_NE(text.out.find("/animations/0/samplers/0/input: key 1 is before key 0"),
              std::string::npos)
        << text.out;
    const json out = json::parse(info(file, {"--json"}).out);
    EXPECT_NE(out["warnings"].dump().find("key 1 is before key 0"), std::string::npos);
}

TEST_F(Info, HasATableOfTheExtensions) {
    const Finished text = info(rich());
    EXPECT_EQ(text.exit_code, 0) << text.err;
    const auto has = [&](const char* line) {
        EXPECT_NE(text.out.find(line), text.out.npos) << line << '\n' << text.out;
    };
    has("extensions\n"
        "  KHR_lights_punctual     rendered      in 3 objects\n"
        "  KHR_materials_specular  rendered      in 2 objects\n"
        "  KHR_materials_variants  rendered      in 1 object\n"
        "  KHR_xmp_json_ld         ignored       describes, and shows nothing\n"
        "  NV_materials_mdl        ignored       in 1 object: surfaces have the simpler material "
        "beside it\n"
        "  X_y                     ignored       this program does not know it\n");
    has("  variants: 2\n  variant 0: dull\\u000a\n  variant 1: shiny\n");
    has("  scenes: 2\n  scene 0: (unnamed)\n  scene 1: cellar\n");
    has("  animations: 1\n  animation 0: walk, 1 channel, 2.5 s\n");
    has("  memory: 0.");
    has("  triangles: 4 stored, 4 placed\n");
    has("  1 animation (the stored pose is shown; --at TIME plays them)\n");
}

TEST_F(Info, JsonHasTheKeysOfItsSchema) {
    const Finished run = info(rich(), {"--json", "--variant", "shiny"});
    EXPECT_EQ(run.exit_code, 0) << run.err;
    EXPECT_TRUE(std::all_of(run.out.begin(), run.out.end(),
                            [](char c) { return (c >= ' ' && c <= '~') || c == '\n'; }));
    const json out = json::parse(run.out);
    EXPECT_EQ(keys_of(out),
              (std::set<std::string>{
                  "schema",          "version",      "file",     "error",        "generator",
                  "extensions",      "scenes",       "variants", "variant",      "animations",
                  "animation_count", "cameras",      "nodes",    "auto_focus_m", "meshes",
                  "triangles",       "materials",    "images",   "lights",       "scene_extras",
                  "probably_lost",   "memory_bytes", "bounds_m", "honoured",     "ignored",
                  "warnings"}));
    EXPECT_EQ(out["schema"], "petzval.info");
    EXPECT_EQ(out["version"], 1);
    EXPECT_EQ(out["error"], nullptr);
    EXPECT_EQ(out["generator"], "a\u202eb");
    EXPECT_EQ(out["scenes"], (json{"", "cellar"}));
    EXPECT_EQ(out["variants"], (json{"dull\n", "shiny"}));
    EXPECT_EQ(out["variant"], "shiny");
    EXPECT_EQ(out["animations"],
              json::parse(R"([{"name": "walk", "channels": 1, "duration_s": 2.5}])"));
    EXPECT_EQ(out["triangles"], (json{{"stored", 4}, {"placed", 4}}));
    EXPECT_EQ(out["lights"]["point"], 2);
    ASSERT_EQ(out["cameras"].size(), 3u);
    EXPECT_EQ(out["cameras"][0]["name"], "wide");
    EXPECT_NEAR(out["cameras"][0]["fov_deg"].get<double>(), 1.2 * 180 / 3.14159265, 1e-4);
    EXPECT_NEAR(out["cameras"][0]["auto_focus_m"].get<double>(), 2, 0.1);
    EXPECT_EQ(out["cameras"][2]["type"], "orthographic");
    EXPECT_EQ(out["cameras"][2]["auto_focus_m"], nullptr);
    EXPECT_EQ(out["bounds_m"]["min"], (json{-1, -1, -2}));
    // Two walls of four corners and two triangles.
    EXPECT_EQ(out["memory_bytes"]["meshes"], 2 * (4 * 12 + 2 * 12));
    EXPECT_GT(out["memory_bytes"]["bvh"], 0);
    const auto& extensions = out["extensions"];
    ASSERT_EQ(extensions.size(), 6u);
    EXPECT_EQ(extensions[4], (json{{"name", "NV_materials_mdl"},
                                   {"use", "ignored"},
                                   {"changes_picture", true},
                                   {"effect", "surfaces have the simpler material beside it"},
                                   {"objects", 1},
                                   {"required", false}}));
    EXPECT_EQ(extensions[3]["changes_picture"], false);
    EXPECT_EQ(extensions[0]["use"], "rendered");
    EXPECT_EQ(out["warnings"].size(), 2u) << out["warnings"];
}

TEST_F(Info, ShowsTheExtensionsOfAFileThatIsRefusedForOne) {
    TinyGltf file = rich();
    file.json["extensionsRequired"] = {"X_y"};
    const Finished text = info(file);
    EXPECT_EQ(text.exit_code, 1);
    EXPECT_TRUE(text.out.starts_with("extensions\n")) << text.out;
    EXPECT_NE(text.out.find("  X_y                     refused       required: this program does "
                            "not know it\n"),
              text.out.npos)
        << text.out;
    EXPECT_NE(text.err.find("requires the extension X_y"), text.err.npos) << text.err;

    const Finished program = info(file, {"--json"});
    EXPECT_EQ(program.exit_code, 1);
    const json out = json::parse(program.out);
    EXPECT_EQ(keys_of(out),
              (std::set<std::string>{"schema", "version", "file", "error", "extensions"}));
    EXPECT_EQ(out["extensions"][5]["use"], "refused");
    EXPECT_NE(program.err.find(out["error"].get<std::string>()), program.err.npos);
}

TEST_F(Info, SaysNothingOfExtensionsWhereAnotherFaultIsTheReason) {
    TinyGltf file = rich();
    file.json["accessors"][0]["count"] = 1000000;
    EXPECT_EQ(info(file).out, "");
    const json out = json::parse(info(file, {"--json"}).out);
    EXPECT_EQ(out["extensions"], json::array());
    EXPECT_NE(out["error"].get<std::string>().find("/accessors/0"), std::string::npos);
    const json none = json::parse(run_petzval({"info", path("none.glb"), "--json"}).out);
    EXPECT_NE(none["error"].get<std::string>().find("no such file"), std::string::npos);
}

TEST_F(Info, OfAnEmptyFile) {
    const Finished run = info(TinyGltf(), {"--json"});
    EXPECT_EQ(run.exit_code, 0) << run.err;
    const json out = json::parse(run.out);
    EXPECT_EQ(out["bounds_m"], nullptr);
    EXPECT_EQ(out["auto_focus_m"], nullptr);
    EXPECT_EQ(out["memory_bytes"]["bvh"], 0);
}

}  // namespace
}  // namespace petzval::apps
