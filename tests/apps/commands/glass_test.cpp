// SPDX-License-Identifier: Apache-2.0
// What info, render and plan say of glass: volumes that are not closed, light that is lost.
#include <fmt/format.h>
#include <gmock/gmock.h>

#include "tests/support/cli.h"

namespace petzval::apps {
namespace {

using testing::HasSubstr;
using testing::Not;

class CliGlass : public CliTest {
  protected:
    enum class Glass { Solid, Thin, MeantThin, Named, Open, InsideOut };

    /// Box of a colour; glass where `thickness` is not negative.
    static void add_box(TinyGltf& file, const char* name, float half_m, float thickness_m,
                        Glass kind = Glass::Solid) {
        std::vector<float> xyz;
        for (int i = 0; i < 8; ++i)
            for (int k = 0; k < 3; ++k) xyz.push_back(i >> k & 1 ? half_m : -half_m);
        std::vector<uint16_t> index = {0, 2, 3, 0, 3, 1, 4, 5, 7, 4, 7, 6, 0, 1, 5, 0, 5, 4,
                                       2, 6, 7, 2, 7, 3, 0, 4, 6, 0, 6, 2, 1, 3, 7, 1, 7, 5};
        if (kind == Glass::Open) index.resize(30);
        if (kind == Glass::InsideOut)
            for (size_t i = 0; i < index.size(); i += 3) std::swap(index[i], index[i + 1]);
        nlohmann::json material = {
            {"name", name},
            {"doubleSided", true},
            {"pbrMetallicRoughness",
             {{"metallicFactor", 0}, {"roughnessFactor", thickness_m < 0 ? 1 : 0}}}};
        if (thickness_m >= 0) {
            auto& more = material["extensions"];
            more["KHR_materials_transmission"] = {{"transmissionFactor", 1}};
            if (kind == Glass::MeantThin) material["extras"]["petzval"]["solid"] = false;
            if (kind == Glass::Named) material["extras"]["petzval"]["glass"] = "schott:N-BK7";
            if (kind != Glass::Thin && kind != Glass::Named)
                more["KHR_materials_volume"] = {{"thicknessFactor", thickness_m}};
        }
        nlohmann::json primitive = {{"material", file.add("materials", material)}};
        primitive["attributes"]["POSITION"] = file.add_positions(xyz);
        primitive["indices"] = file.add_accessor<uint16_t>("SCALAR", index);
        file.add_root({{"mesh", file.add_mesh(primitive)}});
    }
    /// A point light in a box of glass in a room of 4 m.
    std::string lamp_in(Glass kind) const {
        TinyGltf file;
        file.json["extensionsUsed"] = {"KHR_lights_punctual", "KHR_materials_transmission",
                                       "KHR_materials_volume"};
        add_box(file, "room", 2, -1);
        add_box(file, "globe", 0.1f, 0.1f, kind);
        file.json["extensions"]["KHR_lights_punctual"]["lights"] = {
            {{"type", "point"}, {"intensity", 10}}};
        file.add_root({{"extensions", {{"KHR_lights_punctual", {{"light", 0}}}}}});
        const int camera = file.add(
            "cameras", {{"type", "perspective"}, {"perspective", {{"yfov", 1}, {"znear", 0.1}}}});
        file.add_root({{"camera", camera}, {"translation", {0, 0, 1.5}}});
        return file.save_glb(folder_.path / "globe.glb").string();
    }
    Finished rendered(Glass kind) {
        return run_petzval(render_words({"-o", path("out.exr")}, lamp_in(kind)));
    }
};

constexpr const char* kLost =
    "no path finds light that comes through solid glass, or hardly one: point light 0 behind "
    "\"globe\"; what it would light is too dark; give the light a size or a "
    "larger one, or make the glass thin by {\"petzval\": {\"solid\": false}} in its extras";
constexpr const char* kFaulty = "solid glass whose surface is not a closed volume: ";
constexpr const char* kBubble =
    "thin glass in the shape of a closed body: \"globe\"; it refracts nothing, as a soap bubble; ";

TEST_F(CliGlass, LightThatNoPathFindsIsNamed) {
    const Finished info = run_petzval({"info", lamp_in(Glass::Solid)});
    EXPECT_EQ(info.exit_code, 0);
    EXPECT_THAT(info.out, HasSubstr(kLost));
    EXPECT_THAT(info.out, Not(HasSubstr(kFaulty)));
    const Finished run = rendered(Glass::Solid);
    EXPECT_EQ(run.exit_code, 0);
    EXPECT_THAT(run.err, HasSubstr(std::string("warning: ") + kLost));
    const Finished named = rendered(Glass::Named);
    EXPECT_THAT(named.err, HasSubstr(kLost));
    EXPECT_THAT(named.err, Not(HasSubstr(kBubble)));
    const Finished thin = rendered(Glass::MeantThin);
    EXPECT_EQ(thin.exit_code, 0);
    EXPECT_THAT(thin.err, Not(HasSubstr("glass")));
}

TEST_F(CliGlass, ClosedBodiesOfThinGlassAreNamed) {
    EXPECT_THAT(run_petzval({"info", lamp_in(Glass::Thin)}).out, HasSubstr(kBubble));
    const auto json =
        nlohmann::json::parse(run_petzval({"info", "--json", lamp_in(Glass::Thin)}).out);
    EXPECT_THAT(json["warnings"].dump(), HasSubstr("closed body"));
    const Finished run = rendered(Glass::Thin);
    EXPECT_EQ(run.exit_code, 0);
    EXPECT_THAT(run.err, HasSubstr(std::string("warning: ") + kBubble));
    EXPECT_THAT(run.err, Not(HasSubstr(kLost)));
    for (const Glass kind : {Glass::Solid, Glass::MeantThin, Glass::Named, Glass::Open})
        EXPECT_THAT(run_petzval({"info", lamp_in(kind)}).out, Not(HasSubstr("closed body")));
}

TEST_F(CliGlass, PlansCountItAsAtLeast) {
    const auto planned = [&](Glass kind) {
        const Finished run = run_petzval({"plan", lamp_in(kind), "--size", "16x16", "--tolerance",
                                          "50%", "--method", "max-depth=2", "--json"});
        EXPECT_EQ(run.exit_code, 0) << run.err;
        return nlohmann::json::parse(run.out);
    };
    const nlohmann::json lost = planned(Glass::Solid), thin = planned(Glass::Thin);
    EXPECT_TRUE(lost["noise_at_least"].get<bool>());
    EXPECT_EQ(lost["noise_at_least_because"],
              "lamps behind solid glass: no path finds them, or hardly one");
    EXPECT_NE(thin.value("noise_at_least_because", ""),
              lost["noise_at_least_because"].get<std::string>());
}

TEST_F(CliGlass, VolumesThatAreNotClosedAreNamed) {
    for (const auto& [kind, word] :
         {std::pair{Glass::Open, "open"}, std::pair{Glass::InsideOut, "inside out"}}) {
        const std::string named = fmt::format(
            "{}\"globe\" ({}); where it overlaps other glass, absorption and "
            "refraction may be wrong; close all meshes of the material, with faces outwards, or "
            "make the glass thin by {{\"petzval\": {{\"solid\": false}}}} in its extras",
            kFaulty, word);
        EXPECT_THAT(run_petzval({"info", lamp_in(kind)}).out, HasSubstr(named));
        const Finished run = rendered(kind);
        EXPECT_EQ(run.exit_code, 0);
        EXPECT_THAT(run.err, HasSubstr("warning: " + named));
    }
}

}  // namespace
}  // namespace petzval::apps
