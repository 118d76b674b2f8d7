// SPDX-License-Identifier: Apache-2.0
// The reasons for which a scene needs wavelengths.
#include <gtest/gtest.h>

#include "apps/setup/spectral_wording.h"
#include "apps/setup/wavelength_reasons.h"
#include "tests/support/spectral_gltf.h"

namespace petzval::apps {
namespace {

using namespace test;
using nlohmann::json;

TEST(NeedsWavelengths, NothingInAnOrdinaryScene) {
    TinyGltf file = file_with_materials({prism(), json::object()});
    file.json["materials"][1]["emissiveFactor"] = {1, 1, 1};
    const io::GltfFile loaded = load(file);
    EXPECT_TRUE(scene_reasons(loaded.scene).empty());
    EXPECT_TRUE(glass_range_warnings(loaded.scene).empty());
    EXPECT_FALSE(glass_beyond(loaded.scene, 100, 5000));
}

TEST(NeedsWavelengths, OneReasonForEachKind) {
    json bulb = thing({{"illuminant", "a"}}), nameless = prism(dispersing(1));
    bulb["emissiveFactor"] = {1, 1, 1};
    nameless.erase("name");
    Scene scene =
        load(file_with_materials({prism({}, {{"glass", "schott:N-SF11"}}), thing({{"metal", "au"}}),
                                  thing({{"reflectance", "colorchecker:red"}}), bulb, nameless,
                                  prism(dispersing(2)), bulb}))
            .scene;
    scene.lights = {PointLight{V3f(0.f), Rgb(1.f), 0}, PointLight{V3f(0.f), Rgb(1.f)}};
    using Kind = WavelengthReason::Kind;
    const std::vector<WavelengthReason> reasons = scene_reasons(scene);
    EXPECT_EQ(reasons,
              (std::vector<WavelengthReason>{{Kind::Glass, "schott:N-SF11", "prism", 2},
                                             {Kind::Metal, "au", "thing"},
                                             {Kind::Reflectance, "colorchecker:red", "thing"},
                                             {Kind::Emitter, "a", "thing", 1},
                                             {Kind::Lamp, "a", ""}}));
    EXPECT_EQ(text_of(reasons),
              "material \"prism\" disperses (schott:N-SF11), and 2 more; "
              "material \"thing\" is a measured metal (au); "
              "material \"thing\" has a measured reflectance (colorchecker:red); "
              "material \"thing\" shines as illuminant a, and 1 more; "
              "a light shines as illuminant a");
    EXPECT_EQ(text_of(scene_reasons(load(file_with_materials({nameless})).scene)),
              "a material without a name disperses (KHR_materials_dispersion)");
}

TEST(NeedsWavelengths, GlassThatIsNotKnownEverywhere) {
    const json flint = prism({}, {{"glass", "schott:N-SF11"}});
    const Scene scene = load(file_with_materials({flint, flint, prism(dispersing(1)),
                                                  thing({{"glass", "schott:N-SF57"}}),
                                                  prism({}, {{"glass", "schott:N-BK7"}})}))
                            .scene;
    EXPECT_EQ(glass_range_warnings(scene),
              std::vector<std::string>{"glass schott:N-SF11 is known from 370 to 2500 nm: "
                                       "the value at the end is held outside"});
    EXPECT_FALSE(glass_beyond(scene, 370, 2500));
    for (const auto& [first_nm, last_nm] : {std::pair{369., 800.}, std::pair{400., 2501.}})
        EXPECT_EQ(glass_beyond(scene, first_nm, last_nm).value_or(""),
                  "glass schott:N-SF11 is known from 370 to 2500 nm, not from " +
                      std::to_string(int(first_nm)) + " to " + std::to_string(int(last_nm)) +
                      " nm");
}

}  // namespace
}  // namespace petzval::apps
