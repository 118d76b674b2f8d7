// SPDX-License-Identifier: Apache-2.0
// KHR_materials_dispersion and extras.petzval: what becomes of them, and what is refused.
#include <gtest/gtest.h>

#include "io/glass/catalogue.h"
#include "io/spectra/spectra.h"
#include "tests/support/spectral_gltf.h"
#include "tests/support/tiny_png.h"

namespace petzval::io {
namespace {

using namespace test;
using nlohmann::json;
using nlohmann::literals::operator""_json;

TEST(GltfDispersion, IsCauchysFormulaThroughTheIndex) {
    const Material m = spectral_material_of(prism(dispersing(0.36, 2.42)));
    ASSERT_TRUE(m.glass.has_value());
    EXPECT_EQ(m.ior, 2.42f);
    EXPECT_NEAR(m.glass->index(kLineD_nm), 2.42, 1e-6);
    EXPECT_NEAR(m.glass->abbe(), 20 / 0.36, 1e-4);
    // The extension's own numbers, rounded as its text rounds them.
    for (const double nm : {360., 500., 830.})
        EXPECT_NEAR(m.glass->index(nm), 2.42 + 1.42 / (20 / 0.36) * (523655 / (nm * nm) - 1.5168),
                    1e-5);
    EXPECT_LE(m.glass->first_nm, kFirst_nm);
    EXPECT_GE(m.glass->last_nm, kLast_nm);
}

TEST(GltfDispersion, IndexOf1_5WhereTheFileHasNone) {
    const Material m =
        spectral_material_of(prism({{"KHR_materials_dispersion", {{"dispersion", 1}}}}));
    ASSERT_TRUE(m.glass.has_value());
    EXPECT_NEAR(m.glass->index(kLineD_nm), 1.5, 1e-6);
    EXPECT_NEAR(m.glass->abbe(), 20, 1e-6);
}

TEST(GltfDispersion, NeverBelowAnIndexOf1) {
    for (const double dispersion : {26., 30., 1e3, 3e38}) {
        const Material m = spectral_material_of(prism(dispersing(dispersion, 2)));
        ASSERT_TRUE(m.glass.has_value());
        for (int nm = kFirst_nm; nm <= kLast_nm; ++nm) {
            const double asked = 2 + dispersion / 20 * (523655 / (double(nm) * nm) - 1.5168);
            const double index = m.glass->index(nm);
            ASSERT_GE(index, 1) << dispersion << " at " << nm;
            ASSERT_LE(index, 1e3) << dispersion << " at " << nm;
            if (asked > 900) continue;
            ASSERT_NEAR(index, std::max(asked, 1.), 2e-5 * dispersion);
        }
    }
}

TEST(GltfDispersion, NothingDispersesWhereNothingBends) {
    const auto has_glass = [](json material) {
        return spectral_material_of(material).glass.has_value();
    };
    EXPECT_TRUE(has_glass(prism(dispersing(1))));
    EXPECT_FALSE(has_glass(prism(dispersing(0))));
    EXPECT_FALSE(has_glass(prism({{"KHR_materials_dispersion", json::object()}})));
    for (const double unbending : {0., 1.})
        EXPECT_FALSE(has_glass(prism(dispersing(1, unbending))));

    json thin = prism(dispersing(1)), opaque = thin, metallic = thin, unlit = thin;
    thin["extensions"].erase("KHR_materials_volume");
    opaque["extensions"]["KHR_materials_transmission"]["transmissionFactor"] = 0;
    metallic["pbrMetallicRoughness"]["metallicFactor"] = 1;
    unlit["extensions"]["KHR_materials_unlit"] = json::object();
    for (const json& idle : {thin, opaque, metallic, unlit}) {
        const GltfFile loaded = load(file_with_materials({idle}));
        EXPECT_FALSE(loaded.scene.materials[0].glass.has_value()) << idle;
        EXPECT_TRUE(contains_line(loaded.ignored, "1 dispersion (")) << idle;
        EXPECT_FALSE(contains_line(loaded.honoured, "dispersion of light")) << idle;
    }
}

TEST(GltfDispersion, WrongOnesAreRefused) {
    const std::string path = "/materials/0/extensions/KHR_materials_dispersion/dispersion: must be";
    const GltfFile negative = load(file_with_materials({prism(dispersing(-0.5))}));
    EXPECT_FALSE(negative.scene.materials[0].glass.has_value()) << "0 is taken";
    EXPECT_TRUE(contains_line(negative.warnings, "/dispersion: is -0.5 and must not be below 0"));
    json text = prism(dispersing(1));
    text["extensions"]["KHR_materials_dispersion"]["dispersion"] = "1";
    EXPECT_TRUE(has(refused(text), path + " a number, but is string"));
}

TEST(GltfDispersion, IsListed) {
    const GltfFile loaded = load(file_with_materials({prism(dispersing(1))}));
    EXPECT_TRUE(renders(loaded, "KHR_materials_dispersion"));
    EXPECT_TRUE(contains_line(loaded.honoured, "dispersion of light"));
    EXPECT_FALSE(contains_line(loaded.ignored, "dispersion"));
    EXPECT_TRUE(loaded.warnings.empty());
}

TEST(GltfExtras, GlassOfTheCatalogue) {
    const GltfFile loaded = load(file_with_materials({prism({}, {{"glass", "Schott:n-sf11"}})}));
    const Material& m = loaded.scene.materials[0];
    ASSERT_TRUE(m.glass.has_value());
    EXPECT_EQ(m.glass->name, "schott:N-SF11");
    EXPECT_NEAR(m.glass->index(kLineD_nm), 1.78472, 5e-6);  // Schott's data sheet
    EXPECT_NEAR(m.glass->abbe(), 25.68, 0.005);
    EXPECT_NEAR(m.ior, 1.78472, 5e-6);
    EXPECT_TRUE(contains_line(loaded.honoured, "named glass schott:N-SF11"));
    EXPECT_TRUE(contains_line(loaded.honoured, "dispersion of light"));
    EXPECT_TRUE(loaded.warnings.empty());
}

TEST(GltfExtras, GlassOfOneMakerNeedsNoMaker) {
    const GltfFile loaded = load(file_with_materials({prism({}, {{"glass", "n-sf11"}})}));
    ASSERT_TRUE(loaded.scene.materials[0].glass.has_value());
    EXPECT_EQ(loaded.scene.materials[0].glass->name, "schott:N-SF11");
    EXPECT_TRUE(contains_line(loaded.honoured, "named glass schott:N-SF11"));
}

TEST(GltfExtras, GlassStandsInPlaceOfTheExtensions) {
    const GltfFile loaded =
        load(file_with_materials({prism(dispersing(5, 2.42), {{"glass", "schott:N-BK7"}})}));
    EXPECT_EQ(loaded.scene.materials[0].glass->name, "schott:N-BK7");
    EXPECT_NEAR(loaded.scene.materials[0].ior, 1.5168, 5e-6);
    EXPECT_TRUE(loaded.warnings.empty());  // they are what other programs show
}

TEST(GltfExtras, NamedGlassIsSolidUnlessItIsSaidToBeThin) {
    struct Case {
        json extras;
        bool thickness, solid;
    };
    const std::vector<Case> cases = {
        {R"({"glass": "schott:N-BK7"})"_json, false, true},
        {R"({"glass": "schott:N-BK7"})"_json, true, true},
        {R"({"solid": true})"_json, false, true},
        {R"({"solid": 1})"_json, false, true},
        {R"({"solid": false})"_json, true, false},
        {R"({"solid": 0})"_json, true, false},
        {R"({"solid": false})"_json, false, false},
        {R"({"glass": "schott:N-BK7", "solid": false})"_json, true, false},
        {R"({"glass": "schott:N-BK7", "solid": true})"_json, false, true},
        {R"({"illuminant": "a"})"_json, false, false},
        {R"({"illuminant": "a"})"_json, true, true}};
    for (const Case& one : cases) {
        json material = thing(one.extras);
        material["pbrMetallicRoughness"]["metallicFactor"] = 0;
        material["emissiveFactor"] = {1, 1, 1};
        auto& more = material["extensions"];
        more["KHR_materials_transmission"]["transmissionFactor"] = 1;
        if (one.thickness) more["KHR_materials_volume"]["thicknessFactor"] = 0.1;
        const GltfFile loaded = load(file_with_materials({material}));
        const Material& m = loaded.scene.materials[0];
        EXPECT_EQ(m.refracts(), one.solid) << one.extras;
        EXPECT_EQ(m.meant_thin, one.extras.contains("solid") && !one.solid) << one.extras;
        EXPECT_EQ(m.glass.has_value(), one.extras.contains("glass"));
        EXPECT_TRUE(loaded.warnings.empty()) << one.extras;
    }
}

TEST(GltfExtras, SolidGlassDispersesAndAbsorbsWithoutAThickness) {
    json material = prism(dispersing(1), {{"solid", true}});
    material["extensions"]["KHR_materials_volume"] = {
        {"thicknessFactor", 0}, {"attenuationColor", {0.5, 1, 1}}, {"attenuationDistance", 0.2}};
    const GltfFile loaded = load(file_with_materials({material}));
    EXPECT_TRUE(loaded.scene.materials[0].glass.has_value());
    EXPECT_TRUE(contains_line(loaded.honoured, "dispersion of light"));
    EXPECT_EQ(loaded.scene.materials[0].attenuation_distance_m, 0.2f);
}

TEST(GltfExtras, SolidIsWarnedOfWhereNothingIsRefracted) {
    const auto warns = [](json material) {
        const GltfFile loaded = load(file_with_materials({std::move(material)}));
        return contains_line(loaded.warnings,
                             "extras/petzval/solid: has no effect, as the material does not");
    };
    EXPECT_TRUE(warns(thing({{"solid", true}})));
    EXPECT_FALSE(warns(thing({{"solid", false}})));
    json metal = prism({}, {{"solid", true}});
    EXPECT_FALSE(warns(metal));
    metal["pbrMetallicRoughness"]["metallicFactor"] = 1;
    EXPECT_TRUE(warns(metal));
}

TEST(GltfExtras, GlassThatRefractsNothingIsWarnedOf) {
    const GltfFile loaded = load(file_with_materials({thing({{"glass", "schott:N-BK7"}})}));
    EXPECT_NEAR(loaded.scene.materials[0].ior, 1.5168, 5e-6);
    EXPECT_TRUE(contains_line(loaded.warnings, "extras/petzval/glass: disperses nothing"));
    EXPECT_FALSE(contains_line(loaded.honoured, "dispersion of light"));
}

TEST(GltfExtras, IlluminantOfAMaterial) {
    json bulb = thing({{"illuminant", "A"}, {"metal", "al"}}),
         tube = thing({{"illuminant", "f11"}}), wire = thing({{"illuminant", "a"}});
    for (json* shining : {&bulb, &tube, &wire}) (*shining)["emissiveFactor"] = {1, 1, 1};
    const GltfFile loaded = load(file_with_materials({bulb, tube, wire, json::object()}));
    const Scene& scene = loaded.scene;
    ASSERT_EQ(scene.illuminants.size(), 2u);
    EXPECT_EQ(scene.illuminants[0].name, "a");
    EXPECT_EQ(scene.illuminants[1].name, "f11");
    const std::vector<int32_t> expected = {0, 1, 0, -1};
    for (size_t i = 0; i < expected.size(); ++i)
        EXPECT_EQ(scene.materials[i].illuminant, expected[i]);
    EXPECT_EQ(scene.materials[0].metal, 0);
    EXPECT_TRUE(contains_line(loaded.honoured, "illuminant a"));
    EXPECT_TRUE(contains_line(loaded.honoured, "illuminant f11"));
    EXPECT_TRUE(loaded.warnings.empty());

    const GltfFile dark = load(file_with_materials({thing({{"illuminant", "a"}})}));
    EXPECT_TRUE(dark.scene.illuminants.empty());
    EXPECT_EQ(dark.scene.materials[0].illuminant, -1);
    EXPECT_TRUE(contains_line(dark.warnings, "/materials/0/extras/petzval/illuminant: is not"));
}

TEST(GltfExtras, IlluminantsOfLights) {
    const GltfFile loaded =
        load(lit({lamp({{"illuminant", "f11"}}), lamp({{"illuminant", "a"}}, "spot"),
                  lamp({{"illuminant", "F11"}}, "directional"), lamp(json::object())}));
    const Scene& scene = loaded.scene;
    ASSERT_EQ(scene.lights.size(), 4u);
    ASSERT_EQ(scene.illuminants.size(), 2u);
    EXPECT_EQ(scene.illuminants[0].name, "f11");
    EXPECT_EQ(scene.illuminants[1].name, "a");
    EXPECT_EQ(std::get<PointLight>(scene.lights[0]).illuminant, 0);
    EXPECT_EQ(std::get<SpotLight>(scene.lights[1]).illuminant, 1);
    EXPECT_EQ(std::get<SunLight>(scene.lights[2]).illuminant, 0);
    EXPECT_EQ(std::get<PointLight>(scene.lights[3]).illuminant, -1);
    EXPECT_TRUE(contains_line(loaded.honoured, "illuminant f11"));
}

TEST(GltfExtras, UnlitMaterialsHaveNoUseForThem) {
    json unlit = thing({{"metal", "au"}, {"illuminant", "a"}}),
         bare = thing({{"reflectance", "colorchecker:red"}});
    for (json* m : {&unlit, &bare}) {
        (*m)["extensions"]["KHR_materials_unlit"] = json::object();
        const GltfFile loaded = load(file_with_materials({*m}));
        EXPECT_EQ(loaded.scene.materials[0].metal, -1);
        EXPECT_EQ(loaded.scene.materials[0].reflectance, -1);
        EXPECT_EQ(loaded.scene.materials[0].base_color[2], 1.f);
        EXPECT_TRUE(
            contains_line(loaded.warnings, "/materials/0/extras/petzval: an unlit material"));
    }
}

TEST(GltfExtras, ThoseOfOthersAreIgnored) {
    for (const json& extras : {R"(1)"_json, R"("petzval")"_json, R"([{"petzval": 1}])"_json,
                               R"({"glass": "x", "petzvaL": {"glass": 1}})"_json}) {
        TinyGltf file = file_with_materials({{{"extras", extras}}});
        for (const char* other : {"meshes", "asset"}) {
            json& owner = file.json[other];
            (owner.is_array() ? owner[0] : owner)["extras"]["petzval"] = 1;
        }
        EXPECT_TRUE(load(file).warnings.empty()) << extras;
    }
    const Material m = spectral_material_of(thing(json::object()));
    EXPECT_FALSE(m.glass.has_value());
    EXPECT_EQ(m.metal, -1);
    EXPECT_EQ(m.illuminant, -1);
}

TEST(GltfExtras, WrongOnesOfMaterialsAreRefused) {
    struct Wrong {
        json extras;
        const char* expected;
    };
    const std::vector<Wrong> cases = {
        {R"(1)"_json, ": must be an object, but is number"},
        {R"(null)"_json, ": must be an object, but is null"},
        {R"(["glass"])"_json, ": must be an object, but is array"},
        {R"({"glas": "schott:N-BK7"})"_json,
         "/glas: is not known; in a material's extras.petzval there may be glass, metal, ref"},
        {R"({"glass": 1})"_json, "/glass: must be a string, but is number"},
        {R"({"metal": ["au"]})"_json, "/metal: must be a string, but is array"},
        {R"({"solid": "yes"})"_json, "/solid: must be true or false, but is string"},
        {R"({"solid": 2})"_json, "/solid: must be true or false, but is number"},
        {R"({"solid": null})"_json, "/solid: must be true or false, but is null"},
        {R"({"illuminant": null})"_json, "/illuminant: must be a string, but is null"},
        {R"({"glass": "schott:N-BK7", "metal": "au"})"_json,
         ": names a glass and a metal; a material is one of them"},
        {R"({"reflectance": 0.5})"_json, "/reflectance: must be a string, but is number"},
        {R"({"reflectance": "colorchecker:red", "metal": "au"})"_json,
         ": names a metal and a reflectance, which both are its colour; leave out one"},
        {R"({"reflectance": "colorchecker:dark-skn"})"_json,
         "/reflectance: \"colorchecker:dark-skn\" is neither a name nor a relative path to a file; "
         "did you mean colorchecker:dark_skin"},
        {R"({"reflectance": "purple"})"_json,
         "/reflectance: \"purple\" is neither a name nor a relative path to a file; did you mean "
         "colorchecker:purple?"},
        {R"({"reflectance": "\u0007xyz"})"_json,
         "/reflectance: \"\\u0007xyz\" is neither a name nor a relative path to a file; the names "
         "are colorchecker:dark_skin, "},
        {R"({"reflectance": "purple.csv"})"_json, "/reflectance: \"purple.csv\": no such file"},
        {R"({"metal": "gold"})"_json, "/metal: there is no metal \"gold\"; there are ag, al, au, "},
        {R"({"glass": "shott:N-SF11"})"_json,
         "/glass: there is no glass \"shott:N-SF11\"; near are schott:N-SF11, "},
        {R"({"glass": "BK7"})"_json, "/glass: there is no glass \"BK7\"; near are hikari:E-BK7, "},
        {R"({"glass": "F2"})"_json,
         "/glass: the glass \"F2\" has several makers: say which of cdgm:F2, hikari:F2, schott:F2"},
        {R"({"glass": "\u0007"})"_json, "/glass: there is no glass \"\\u0007\""},
        {R"({"illuminant": "b"})"_json,
         "/illuminant: there is no illuminant \"b\"; there are d65, a, f11"},
    };
    for (const Wrong& wrong : cases) {
        json material = thing(wrong.extras);
        material["emissiveFactor"] = {1, 1, 1};
        const std::string message = refused(material);
        EXPECT_TRUE(
            has(message, std::string("test.glb: /materials/0/extras/petzval") + wrong.expected));
    }
}

TEST(GltfExtras, WrongOnesOfLightsAreRefused) {
    const std::string path = "test.glb: /extensions/KHR_lights_punctual/lights/0/extras/petzval";
    EXPECT_TRUE(has(refused(lit({lamp(1)})), path + ": must be an object"));
    EXPECT_TRUE(has(refused(lit({lamp({{"metal", "au"}})})),
                    path + "/metal: is not known; in a light's extras.petzval there may be illum"));
    EXPECT_TRUE(
        has(refused(lit({lamp({{"illuminant", 2}})})), path + "/illuminant: must be a string"));
    EXPECT_TRUE(has(refused(lit({lamp({{"illuminant", "f12"}})})),
                    path + "/illuminant: there is no illuminant \"f12\"; there are d65, a, f11"));
}

}  // namespace
}  // namespace petzval::io
