// SPDX-License-Identifier: Apache-2.0
// Cameras (glTF 2.0, section 3.10) and KHR_lights_punctual.
#include <numbers>

#include "io/base/json_parse.h"
#include "io/gltf/validate/check.h"
#include "io/gltf/validate/extras.h"

namespace petzval {
namespace {

constexpr Range not_negative = {0, std::numeric_limits<float>::max()};

double positive(const JsonCursor& object, const char* key) {
    const double value = object.number(key, not_negative);
    if (value == 0) object.fail(key, "must be more than 0");
    return value;
}

void check_perspective(const JsonCursor& camera) {
    (void)positive(camera, "yfov");
    const double near = positive(camera, "znear");
    if (camera.has("aspectRatio")) (void)positive(camera, "aspectRatio");
    if (camera.has("zfar") && positive(camera, "zfar") <= near)
        camera.fail("zfar", "must be more than znear");
}

void check_orthographic(const JsonCursor& camera) {
    for (const char* key : {"xmag", "ymag"})
        if (camera.number(key) == 0) camera.fail(key, "must not be 0");
    if (positive(camera, "zfar") <= camera.number("znear", not_negative))
        camera.fail("zfar", "must be more than znear");
}

void check_spot(const JsonCursor& spot) {
    const Range angle = {0, std::numbers::pi / 2 + 1e-6};
    const double inner = spot.number_or("innerConeAngle", 0, angle);
    if (inner >= spot.number_or("outerConeAngle", std::numbers::pi / 4, angle))
        spot.fail("innerConeAngle", "must be less than outerConeAngle");
}

void check_light(GltfCheck& check, const JsonCursor& light) {
    (void)light.text_or("name", "");
    (void)light.numbers("color", 3, not_negative);
    (void)light.number_or("intensity", 1, not_negative);
    if (light.has("range")) (void)positive(light, "range");
    check_light_extras(light);
    const std::string type = light.text("type");
    if (type == "spot")
        check_spot(light.object("spot"));
    else if (!type.empty() && type != "point" && type != "directional")
        check.warn(light, "is of the unknown type \"" + printable(type) + "\"");
}

}  // namespace

void check_cameras(GltfCheck& check) {
    for (const JsonCursor& camera : check.root.objects("cameras")) {
        (void)camera_extras(camera);
        const std::string type = camera.text("type");
        if (type == "perspective")
            check_perspective(camera.object("perspective"));
        else if (type == "orthographic")
            check_orthographic(camera.object("orthographic"));
        else if (!type.empty())
            check.warn(camera, "is of the unknown type \"" + printable(type) + "\"");
    }
}

void check_lights(GltfCheck& check) {
    const auto lights = check.root.extension("KHR_lights_punctual");
    if (!lights) return;
    lights->require("lights");
    for (const JsonCursor& light : lights->objects("lights")) check_light(check, light);
}

}  // namespace petzval
