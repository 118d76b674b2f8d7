// SPDX-License-Identifier: Apache-2.0
// Cameras and lights. One that cannot be shown becomes one of an unknown type, which is left out.
#include <fmt/format.h>

#include "io/gltf/mend/mend.h"
#include "io/gltf/mend/mend_property.h"

namespace petzval::io {
namespace {

using nlohmann::json;

bool is_positive(const json* value) {
    return value && value->is_number() && value->get<double>() > 0;
}
bool is_number(const json* value) {
    return value && value->is_number();
}

void leave_out(const JsonEditor& owner, const std::string& why) {
    owner.warn(why + "; it is left out");
    owner.value()["type"] = "";
}

/// Clipping planes cut nothing off here: a wrong one is replaced.
void mend_planes(const JsonEditor& view, bool needs_far) {
    json *near = view.find("znear"), *far = view.find("zfar");
    const bool wrong_near =
        !is_number(near) || near->get<double>() < 0 || (!needs_far && near->get<double>() == 0);
    const bool wrong_far = (needs_far && !far) || (far && !is_positive(far));
    const bool crossed =
        !wrong_near && !wrong_far && far && far->get<double>() <= near->get<double>();
    if (!wrong_near && !wrong_far && !crossed) return;
    if (near || far) view.warn("has clipping planes that cannot be; they are not used");
    view.value()["znear"] = 0.01;
    view.value().erase("zfar");
    if (needs_far) view.value()["zfar"] = 1e6;
}

void mend_perspective(const JsonEditor& camera, const JsonEditor& view) {
    const json* angle = view.find("yfov");
    if (!angle) return leave_out(camera, "has no yfov");
    if (is_number(angle) && !(angle->get<double>() > 0))
        return leave_out(camera, fmt::format("has a yfov of {}", angle->get<double>()));
    const json* aspect = view.find("aspectRatio");
    if (is_number(aspect) && !is_positive(aspect))
        view.drop("aspectRatio",
                  fmt::format("is {}; it is taken as absent", aspect->get<double>()));
    mend_planes(view, false);
}

void mend_orthographic(const JsonEditor& camera, const JsonEditor& view) {
    for (const char* key : {"xmag", "ymag"}) {
        const json* width = view.find(key);
        if (!width || *width == 0) return leave_out(camera, fmt::format("has an {} of 0", key));
    }
    mend_planes(view, true);
}

void mend_camera(const JsonEditor& camera) {
    const auto perspective = camera.find_object("perspective");
    const auto orthographic = camera.find_object("orthographic");
    if (!camera.find("type") && perspective.has_value() != orthographic.has_value()) {
        camera.value()["type"] = perspective ? "perspective" : "orthographic";
        camera.warn("has no type; what it holds tells");
    }
    const json* type = camera.find("type");
    if (!type) return leave_out(camera, "has no type");
    if (*type == "perspective") {
        if (!camera.find("perspective")) return leave_out(camera, "has no perspective");
        if (perspective) mend_perspective(camera, *perspective);
    } else if (*type == "orthographic") {
        if (!camera.find("orthographic")) return leave_out(camera, "has no orthographic");
        if (orthographic) mend_orthographic(camera, *orthographic);
    }
}

void mend_spot(const JsonEditor& light) {
    if (!light.find("spot")) {
        light.warn("has no spot; a cone of the default angles is taken");
        light.value()["spot"] = json::object();
    }
    const auto spot = light.find_object("spot");
    if (!spot) return;
    for (const GltfProperty& property : rows_at(schema::kLightRows, "spot"))
        mend_property(*spot, property);
    const json* outer = spot->find("outerConeAngle");
    if (outer && !outer->is_number()) return;
    const double outer_rad = outer ? outer->get<double>() : LightRow("outerConeAngle").row.preset;
    if (outer_rad == 0) return leave_out(light, "has an outerConeAngle of 0");
    // The fall-off lies between the angles: a hair of it keeps the edge sharp.
    if (const json* inner = spot->find("innerConeAngle"); is_number(inner))
        spot->clamp("innerConeAngle", {0, 0.9999 * outer_rad});
}

void mend_light(const JsonEditor& light) {
    for (const GltfProperty& property : rows_at(schema::kLightRows, ""))
        mend_property(light, property);
    const json* range = light.find("range");
    if (range && !is_positive(range)) light.value().erase("range");  // ignored in any case
    const json* type = light.find("type");
    if (!type) return leave_out(light, "has no type");
    if (*type == "spot") mend_spot(light);
}

}  // namespace

void mend_cameras(const JsonEditor& root) {
    root.each("cameras", mend_camera);
}

void mend_lights(const JsonEditor& root) {
    const auto lights = root.extension("KHR_lights_punctual");
    if (!lights) return;
    if (!lights->find("lights")) lights->value()["lights"] = json::array();
    lights->each("lights", mend_light);
}

}  // namespace petzval::io
