// SPDX-License-Identifier: Apache-2.0
#include "io/gltf/validate/extras.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

namespace petzval::io {
namespace {

// Range of a length, as on the command line: no product of two leaves a float.
constexpr Range kLength = {1e-6, 1e6};

std::optional<std::string> text_at(const JsonCursor& extras, const char* key) {
    if (!extras.has(key)) return std::nullopt;
    std::string text = extras.text(key);
    if (text.empty()) extras.fail(key, "is empty");
    return text;
}

std::optional<float> length_at(const JsonCursor& extras, const char* key) {
    if (!extras.has(key)) return std::nullopt;
    return static_cast<float>(extras.number(key, kLength));
}

// Refuses a key that is not known. what: "material" ...
void require_known_extras(const JsonCursor& owner, const char* what,
                          const std::vector<std::string_view>& known) {
    const auto extras = petzval_extras(owner);
    if (!extras) return;
    for (const auto& [key, unused] : extras->value().items())
        if (std::find(known.begin(), known.end(), key) == known.end())
            extras->fail(key, fmt::format("is not known; in a {}'s extras.petzval there may be {}",
                                          what, fmt::join(known, ", ")));
}

}  // namespace

std::optional<JsonCursor> petzval_extras(const JsonCursor& owner) {
    const auto extras = owner.value().find("extras");
    if (extras == owner.value().end() || !extras->is_object()) return std::nullopt;
    return owner.object("extras").find_object("petzval");
}

std::optional<JsonCursor> check_material_extras(const JsonCursor& material) {
    require_known_extras(material, "material",
                         {"glass", "metal", "reflectance", "illuminant", "solid"});
    const auto extras = petzval_extras(material);
    if (!extras) return extras;
    for (const char* const key : {"glass", "metal", "reflectance", "illuminant"})
        if (extras->has(key)) (void)extras->text(key);
    (void)is_solid(material);
    if (extras->has("glass") && extras->has("metal"))
        extras->fail("names a glass and a metal; a material is one of them");
    if (extras->has("metal") && extras->has("reflectance"))
        extras->fail("names a metal and a reflectance, which both are its colour; leave out one");
    return extras;
}

std::optional<bool> is_solid(const JsonCursor& material) {
    const auto extras = petzval_extras(material);
    if (!extras) return std::nullopt;
    if (!extras->has("solid")) return extras->has("glass") ? std::optional(true) : std::nullopt;
    const nlohmann::json& solid = extras->value().at("solid");
    // The properties of Blender before 3.5 hold a truth as a number.
    if (solid == 0 || solid == 1) return solid == 1;
    extras->check_bool("solid");
    return solid.get<bool>();
}

void check_light_extras(const JsonCursor& light) {
    require_known_extras(light, "light", {"illuminant", "radius_m", "angle_deg", "visible"});
    const auto extras = petzval_extras(light);
    if (extras && extras->has("illuminant")) (void)extras->text("illuminant");
    (void)light_radius_m(light);
    (void)light_angle_deg(light);
    (void)is_unseen(light);
}

float light_angle_deg(const JsonCursor& light) {
    const auto extras = petzval_extras(light);
    return extras ? static_cast<float>(extras->number_or("angle_deg", 0, {0, 180})) : 0.f;
}

bool is_unseen(const JsonCursor& owner) {
    const auto extras = petzval_extras(owner);
    if (!extras || !extras->has("visible")) return false;
    extras->check_bool("visible");
    return !extras->value()["visible"];
}

std::optional<AreaExtras> area_extras(const JsonCursor& node) {
    if (!node.has("extras")) return std::nullopt;  // of millions
    require_known_extras(node, "node",
                         {"area", "shape", "intensity_cd", "color", "illuminant", "visible"});
    const auto extras = petzval_extras(node);
    if (!extras || extras->value().empty()) return std::nullopt;
    extras->require("area");
    const auto sides = extras->numbers("area", 2, kLength);
    AreaExtras area{V2f(static_cast<float>(sides[0]), static_cast<float>(sides[1])), false, {}, {}};
    if (const auto shape = text_at(*extras, "shape")) {
        area.ellipse = shape == "ellipse";
        if (!area.ellipse && shape != "rectangle")
            extras->fail("shape", "must be \"rectangle\" or \"ellipse\"");
    }
    constexpr Range not_negative = {0, std::numeric_limits<float>::max()};
    if (extras->has("intensity_cd"))
        area.intensity_cd = static_cast<float>(extras->number("intensity_cd", not_negative));
    else if (!node.extension("KHR_lights_punctual"))
        extras->fail(
            "says nothing of the light's strength; give its \"intensity_cd\", or the node "
            "a point or spot light of KHR_lights_punctual");
    if (const auto color = extras->numbers("color", 3, not_negative); !color.empty())
        area.color = V3f(static_cast<float>(color[0]), static_cast<float>(color[1]),
                         static_cast<float>(color[2]));
    (void)text_at(*extras, "illuminant");
    (void)is_unseen(node);
    return area;
}

SceneExtras scene_extras(const JsonCursor& scene) {
    require_known_extras(scene, "scene", {"sky", "sky_rotation_deg", "exposure_ev", "view"});
    SceneExtras asked;
    const auto extras = petzval_extras(scene);
    if (!extras) return asked;
    asked.path = extras->path();
    asked.sky = text_at(*extras, "sky");
    asked.sky_rotation_deg =
        static_cast<float>(extras->number_or("sky_rotation_deg", 0, {-360, 360}));
    if (extras->has("exposure_ev"))
        asked.exposure_ev = static_cast<float>(extras->number("exposure_ev", {-100, 100}));
    asked.view = text_at(*extras, "view");
    return asked;
}

std::optional<float> light_radius_m(const JsonCursor& light) {
    constexpr Range range = {0, kLength.high};
    if (const auto extras = petzval_extras(light); extras && extras->has("radius_m"))
        return static_cast<float>(extras->number("radius_m", range));
    const auto extras = light.value().find("extras");
    if (extras == light.value().end() || !extras->is_object()) return std::nullopt;
    const auto radius = extras->find("radius");
    if (radius == extras->end() || !radius->is_number()) return std::nullopt;
    const auto value = radius->get<double>();
    if (!(value >= range.low && value <= range.high)) return std::nullopt;
    return static_cast<float>(value);
}

CameraExtras camera_extras(const JsonCursor& camera) {
    require_known_extras(camera, "camera", {"lens", "fstop", "focus_m", "aperture", "sensor_mm"});
    CameraExtras asked;
    const auto extras = petzval_extras(camera);
    if (!extras) return asked;
    asked.lens = text_at(*extras, "lens");
    asked.aperture = text_at(*extras, "aperture");
    asked.fstop = length_at(*extras, "fstop");
    asked.focus_m = length_at(*extras, "focus_m");
    if (const auto sides = extras->numbers("sensor_mm", 2, kLength); !sides.empty())
        asked.sensor_mm = V2f(static_cast<float>(sides[0]), static_cast<float>(sides[1]));
    return asked;
}

}  // namespace petzval::io
